// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "foundation/task_pool.h"
#include "math/kernel_width.h"
#include "physics/definitions/settings/thin_settings.h"
#include "physics/deformable/cloth/cloth_matrix.h"
#include "physics/deformable/contact/body_block.h"
#include "physics/deformable/contact/touch_springs.h"
#include "physics/deformable/namespace.h"
#include "physics/linear/band_cholesky.h"
#include "physics/linear/conjugate_gradient.h"

namespace embody::physics::deformable {

/// A sheet's part of the equations, an entry a node.
struct SheetSystem {
    const ClothMatrix* matrix = nullptr;
    std::span<const Vec3> rhs;            ///< N
    std::span<const Vec3> small_load;     ///< N
    std::span<const std::uint8_t> fixed;  ///< nodes that do not move
    /// Beside the matrix, as of gas inside: stiffness gradient gradientᵀ. None: no such term.
    std::span<const Vec3> gradient = {};
    double stiffness = 0;
};

/// The function that the equations minimise, for these moves, J, one number a node.
double energy_of(const SheetSystem& sheet, std::span<const Vec3> moves);

/// A rope's part of them. The solver adds the springs to `matrix` and factorises it.
struct LineSystem {
    BandCholesky* matrix = nullptr;
    std::span<const Vec3> rhs;         ///< N
    std::span<const Vec3> small_load;  ///< N
    const std::vector<bool>* fixed = nullptr;
};

/// The conjugate gradient (linear/conjugate_gradient.h) for the moves of nodes and touched bodies,
///   (A + springs) d = rhs.
/// Preconditioned by the inverse of everything that couples a node with itself and with the bodies that hold it, and of
/// all that couples the nodes of a line: springs and lines of any stiffness cost no iterations. Sheets are solved in
/// floats, sums are in doubles and in a fixed order: same bits for any worker count.
class ClothSolver {
public:
    /// Nodes are counted through, sheet after sheet, then line after line: by those numbers springs name them. `moves`:
    /// first guess and answer. It ends when the residual is gradient_tolerance of the small loads in the norm of the
    /// preconditioner. Returns the number of iterations, or not_finite where numbers became non-finite, or indefinite.
    int solve(std::span<const SheetSystem> sheets, std::span<const LineSystem> lines,
              std::span<const TouchSpring> springs, std::span<const BodyInertia> bodies, std::span<Vec3> moves,
              std::span<BodyMove> body_moves, TaskPool& workers);

    static constexpr int not_finite = -1;  ///< in the place of a number of iterations
    /// The same: the matrix was not positive definite in a direction, so the moves are no answer. Only for sheets with
    /// terms beside the matrix.
    static constexpr int indefinite = -2;
    /// Of the world, before a step's first solve().
    void set(const ClothSettings& settings) { settings_ = settings; }

private:
    static constexpr std::size_t min_parallel_count = 1000;  // nodes

    // Coupling of a line and a body: a column for each unknown of the body, and the line's solution for it.
    struct LineHold {
        std::uint32_t body = 0;
        std::size_t line = 0;
        std::array<std::vector<Vec3>, 6> column, given;
    };
    // Coupling by springs of a node of a sheet with another node of any member.
    struct Link {
        std::uint32_t row = 0, column = 0;
        Block block;
    };
    // A run of slices of one sheet, and its links.
    struct Chunk {
        std::size_t sheet = 0, first = 0, last = 0;
        std::size_t first_link = 0, last_link = 0;
    };
    struct WorkerSystem;
    void lay_out(std::span<const SheetSystem> sheets, std::span<const LineSystem> lines);
    bool prepare(std::span<const SheetSystem> sheets, std::span<const LineSystem> lines,
                 std::span<const TouchSpring> springs, std::span<const BodyInertia> bodies, TaskPool& workers);
    [[nodiscard]] bool is_between_sheets(const TouchSpring& spring, std::span<const BodyInertia> bodies) const;
    static void add_links(const TouchSpring& spring, std::vector<Link>& links);
    void sort_links(std::vector<Link>& links);
    void prepare_bodies(std::span<const TouchSpring> springs, std::span<const BodyInertia> bodies);
    bool prepare_lines(std::span<const LineSystem> lines, std::span<const TouchSpring> springs);
    void prepare_line_holds(std::span<const TouchSpring> springs, std::span<const BodyInertia> bodies);
    void apply_line_hold(const LineHold& hold);
    double guess(std::span<const SheetSystem> sheets, std::span<const LineSystem> lines,
                 std::span<const TouchSpring> springs, std::span<const Vec3> moves);
    void find_residual(std::span<const SheetSystem> sheets, std::span<const TouchSpring> springs,
                       std::span<const BodyInertia> bodies, TaskPool& workers);
    [[nodiscard]] ClothVectors vectors_of(std::size_t sheet);
    void multiply_rows(std::span<const SheetSystem> sheets, std::size_t chunk);
    void find_pull(std::size_t chunk);
    double add_pull(const SheetSystem& sheet, std::size_t chunk);
    template <class Kernel>
    [[nodiscard]] double sum_of_chunk(std::size_t chunk, Kernel kernel);
    void add_springs(std::span<const TouchSpring> springs, std::span<const BodyInertia> bodies);
    void precondition_bodies(std::span<const TouchSpring> springs, std::span<const BodyInertia> bodies);
    void precondition_lines();
    void add_line_pulls();
    void follow_bodies();
    void solve_lines(std::span<Vec3> rhs) const;
    void turn_others(double beta);
    void advance_others(double alpha);
    [[nodiscard]] double sum_of_others() const;
    [[nodiscard]] Vec3 p_of(std::uint32_t node) const;
    [[nodiscard]] bool is_contained(const TouchSpring& spring, std::span<const BodyInertia> bodies) const;
    [[nodiscard]] bool is_same_block(std::uint32_t a, std::uint32_t b) const {
        return a == b || (a >= nodes_ && b >= nodes_ && line_of_[a - nodes_] == line_of_[b - nodes_]);
    }

    ClothSettings settings_;
    std::vector<Block> own_, inverse_;  // node's own block, springs with it, and its inverse
    SliceBlocks own_blocks_, inverse_blocks_;
    // As in linear/conjugate_gradient.h: of nodes of sheets, of bodies, of nodes of lines.
    SliceVectors p_, q_, r_, z_, x_;
    std::vector<Float4> quads_;  // p again, node by node
    std::vector<BodyMove> body_p_, body_q_, body_r_, body_z_, body_x_;
    std::vector<Vec3> line_p_, line_q_, line_r_, line_z_, line_x_;
    std::vector<Vec3> line_ap_, line_az_;  // A p and A z with a line's own matrix A; q has its other couplings
    std::vector<BodyBlock> body_blocks_;   // with springs, less the compliance of nodes
    std::vector<LineHold> line_holds_;
    std::vector<std::uint32_t> line_of_;
    std::vector<std::size_t> line_first_;  // of line_of_, one more than lines
    std::vector<bool> line_fixed_;
    std::vector<const BandCholesky*> factors_;
    std::vector<Chunk> chunks_;
    std::vector<std::size_t> sheet_first_, sheet_slice_;  // node and slice where a sheet begins
    std::vector<std::uint32_t> place_;                    // of a node: lanes of all slices counted through
    std::vector<std::uint32_t> coupled_;  // springs that are neither in the preconditioner's blocks nor in links
    std::vector<Link> links_;             // by row
    const ClothRowKernels* kernels_ = &widest_kernels<ClothRowKernels>();
    SliceVectors gradients_;                      // of sheets' terms beside the matrix; none: without slices
    std::vector<double> pulls_;                   // gradient · p by chunk
    std::vector<double> curvatures_, residuals_;  // p · q and z · r by chunk; the last one has all the rest
    std::size_t nodes_ = 0;                       // of sheets
};

}  // namespace embody::physics::deformable
