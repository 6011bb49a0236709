// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "physics/constraint/direct/direct_patch.h"
#include "physics/constraint/namespace.h"
#include "physics/definitions/settings/direct_settings.h"
#include "physics/linear/block_cholesky.h"

namespace embody::physics::constraint {

/// A movable body of a direct solve.
struct NewtonBody {
    double mass = 0;              ///< kg
    Mat3 inertia = Mat3::zero();  ///< world axes, about the centre of mass, kg m²
};

/// Newton's method for the velocities of a list of bodies and the loads of the patches between them
/// (docs/physics/direct-solver.md). Keeps its memory, and what it found about the graphs it met, from step to step.
class ContactNewton {
public:
    /// Starts a step, with its settings.
    void begin_step(const DirectSettings& settings) {
        settings_ = settings;
        ++step_;
        work_ = 0;
    }
    /// Starts a list. Patches number the bodies by their place; `key` names lists that are likely the same ones as in
    /// the last step.
    void begin(std::uint32_t key, std::span<const NewtonBody> bodies, std::span<const DirectPatch> patches);
    /// A list for which the method failed, or that does not come to rest, is not tried again for a while.
    void abandon();
    /// The list was solved, and its bodies hardly move.
    void note_rest();
    [[nodiscard]] bool has_given_up(std::uint32_t key) const;
    /// Products of two 6×6 blocks that one iteration takes.
    [[nodiscard]] std::size_t block_products() const { return structure_->matrix.block_products(); }

    /// The same, done in this step so far.
    [[nodiscard]] std::size_t work() const { return work_; }

    /// From the velocities by the forces alone, finds the true ones and each patch's impulse. False where the method
    /// does not converge.
    bool find_velocities(std::span<const Vec6> free, std::span<Vec6> velocity, std::span<DirectPatch> patches);
    /// The same for bodies that hardly move: friction and loads together, from where nothing moves.
    bool find_rest(std::span<const Vec6> free, std::span<Vec6> velocity, std::span<DirectPatch> patches);

    /// Before find_shifts(): bodies may slide while they are moved. Else what sticks stays where it is.
    void drop_friction(std::span<DirectPatch> patches);
    /// Small motions that close `fraction` of the gaps and overlaps of all loaded points, each by at most `most` m;
    /// after find_velocities() or find_rest(), with the last factors.
    void find_shifts(std::span<const DirectPatch> patches, double fraction, double most, std::span<Vec6> shifts);

private:
    /// What was found about the graph of one list.
    struct Structure {
        std::uint32_t key = 0;
        std::uint64_t idle_until = 0, idle = 0;         ///< step; steps between the last two attempts
        std::uint64_t last_rest = 0;                    ///< step that found it at rest
        std::uint64_t rests = 0;                        ///< steps in a row that found it so
        std::uint64_t last_step = 0;                    ///< in which it was used
        std::vector<std::array<std::int32_t, 2>> ends;  ///< of the patches
        std::size_t bodies = 0;
        BlockCholesky matrix;
        std::vector<std::uint32_t> edge_of_patch;
    };

    void find_structure(std::uint32_t key, std::span<const DirectPatch> patches);
    Structure& structure_of(std::uint32_t key);
    void factor(std::span<DirectPatch> patches);
    void set_patch_velocities(std::span<const Vec6> velocity, std::span<DirectPatch> patches) const;
    void begin_from(std::span<const Vec6> free, std::span<Vec6> velocity, std::span<DirectPatch> patches);
    bool iterate(std::span<const Vec6> free, int iterations, std::span<Vec6> velocity, std::span<DirectPatch> patches);
    bool step(std::span<const Vec6> free, std::span<Vec6> velocity, std::span<DirectPatch> patches);
    bool evaluate_after(double fraction, std::span<DirectPatch> patches);
    double slope_at(double fraction, std::span<const DirectPatch> patches) const;
    double find_fraction(std::span<const DirectPatch> patches) const;

    DirectSettings settings_;  // of this step
    std::span<const NewtonBody> bodies_;
    double full_stiffness_ = 0;
    double stiffness_ = 0;                              // k, kg
    bool has_factors_ = false;                          // of this list
    std::size_t work_ = 0;                              // products of 6×6 blocks
    FrictionBound bound_ = FrictionBound::undamped;     // undamped takes whole steps; else the line search shortens
                                                        // them
    double slope_by_mass_ = 0, curvature_by_mass_ = 0;  // of f along the step, kg m²/s²
    std::vector<Vec6> direction_, right_side_;
    std::vector<Structure> structures_;
    std::vector<std::uint32_t> structure_of_key_;  // valid where structures_ agrees
    std::uint64_t step_ = 0;
    Structure* structure_ = nullptr;
};

}  // namespace embody::physics::constraint
