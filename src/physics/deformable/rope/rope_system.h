// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "physics/deformable/contact/touch_springs.h"
#include "physics/deformable/namespace.h"
#include "physics/linear/band_cholesky.h"
#include "physics/linear/envelope_cholesky.h"

namespace embody::physics::deformable {

/// A twist as a stiffness of rank one: its moment y (N m) pushes the unknowns with -y times the derivatives of the
/// angle by them, and y = stiffness (offset + growth of the angle by the unknowns).
struct TwistMode {
    double compliance = 1;      ///< 1 / stiffness, rad/(N m)
    double offset = 0;          ///< rad
    std::vector<Vec3> by_node;  ///< one a node of the rope, rad/m
    std::array<std::uint32_t, 2> body{no_body, no_body};
    std::array<Vec3, 2> by_turn;  ///< of these bodies
};

/// Coupling of a rope with a body that holds its direction: second derivatives of the energy by a node's place and the
/// body's turn.
struct TurnCoupling {
    std::uint32_t body = no_body, node = 0;
    Mat3 by_node_and_turn;  ///< N
};

/// The same of the turn alone, with the torque at turn zero.
struct TurnStiffness {
    std::uint32_t body = no_body;
    Mat3 stiffness;  ///< N m
    Vec3 load;       ///< N m
};

/// A square in the energy of a wire's folds, ½ weight (residual + growth)²: the growth is by the moves of three nodes
/// in a row, by the turn of a body, and by the turns of two segments about themselves, which the system finds.
struct FoldRow {
    static constexpr std::size_t none = ~std::size_t{0};
    double weight = 0, residual = 0;
    std::size_t first_node = 0;
    std::array<Vec3, 3> by_node;
    std::array<std::size_t, 2> angle{none, none};  ///< segments
    std::array<double, 2> by_angle{};
    std::uint32_t body = no_body;
    Vec3 by_turn;
    bool is_link = false;  ///< two segments, or one and a clamp, that are not twisted against each other
    bool begins_span = false;
};

/// The linear system of one iteration of Newton's method of a rope: its nodes, six unknowns for each touched body, and
/// twists, one each. A body touches few of the nodes: its unknowns stand behind the last of these, so that the rows of
/// the factor are no longer than from the first to the last node that a body touches. Where the rope touches itself the
/// row of the later node reaches back to the earlier one.
class RopeSystem {
public:
    /// All zero.
    void reset(std::size_t nodes);
    /// Adds squares about these moves; what couples nodes alone goes into the band, but not of links.
    void add(std::vector<FoldRow> folds, std::span<const Vec3> moves, std::span<const BodyMove> body_moves);

    BandCholesky band;
    std::vector<Vec3> rhs;  ///< by node, N
    std::vector<TurnCoupling> couplings;
    std::vector<TurnStiffness> turns;  ///< bodies of these three are held by springs too
    std::vector<TwistMode> twists;

    /// Adds the springs, holds the fixed nodes, and solves. `moments`: of the twists. False where the matrix is not
    /// positive definite.
    bool solve(std::span<const TouchSpring> springs, std::span<const BodyInertia> inertias,
               const std::vector<bool>& fixed, std::vector<Vec3>& moves, std::vector<BodyMove>& body_moves,
               std::vector<double>& moments);

private:
    static constexpr std::size_t none = ~std::size_t{0};
    [[nodiscard]] bool moves(std::uint32_t body) const { return body != no_body && body_row_[body] != none; }
    void add_springs(std::span<const TouchSpring> springs, std::span<const BodyInertia> inertias);
    void order_unknowns(std::span<const TouchSpring> springs, const std::vector<bool>& fixed);
    void fill_folds(const std::vector<bool>& fixed);
    void fill_matrix(std::span<const TouchSpring> springs, std::span<const BodyInertia> inertias,
                     const std::vector<bool>& fixed);
    bool solve_twists(const std::vector<bool>& fixed, std::vector<double>& moments);

    std::vector<std::uint32_t> moving_;                // bodies that are unknowns
    std::vector<std::size_t> node_row_, body_row_;     // first row of a node, of a body; none: it is no unknown
    std::vector<std::size_t> angle_row_;               // of a segment's turn about itself; none: no fold needs it
    std::vector<FoldRow> folds_;                       // residual: at no moves
    std::vector<std::size_t> first_column_;            // by row
    std::vector<std::size_t> first_node_, last_node_;  // by body: that it touches
    // Two nodes that the band does not couple, first < second: where a rope touches itself.
    struct FarCoupling {
        std::size_t first = 0, second = 0;
        Mat3 stiffness;  // N/m
    };
    std::vector<FarCoupling> far_;
    std::vector<std::size_t> first_partner_;  // by node: the first that its row couples it with
    EnvelopeCholesky matrix_;
    std::vector<double> values_;  // by row: the load, then the solution
};

}  // namespace embody::physics::deformable
