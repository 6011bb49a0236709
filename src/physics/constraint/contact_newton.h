// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "physics/constraint/block_cholesky.h"
#include "physics/constraint/direct_patch.h"

namespace embody::physics {

/// A movable body of a direct solve.
struct NewtonBody {
    double mass = 0;              ///< kg
    Mat3 inertia = Mat3::zero();  ///< world axes, about the centre of mass, kg m²
};

/// Newton's method for the velocities of a list of bodies and the loads of the patches between them
/// (docs/physics/direct-solver.md). Keeps its memory, and what it found about the graphs it met, from step to step.
class ContactNewton {
public:
    /// Starts a step: the first list is the first again.
    void begin_step() { next_structure_ = 0; }
    /// Starts the next list of the step. Patches number the bodies by their place.
    void begin(std::span<const NewtonBody> bodies, std::span<const DirectPatch> patches);

    /// From the velocities that the forces alone would give, finds the true ones and each patch's impulse. False where
    /// the method does not converge.
    bool find_velocities(std::span<const Vec6> free, std::span<Vec6> velocity, std::span<DirectPatch> patches);

    /// Small motions that close `share` of the gaps and overlaps of all loaded points, each by `most` m at most; after
    /// find_velocities(), with its factors.
    void find_shifts(std::span<const DirectPatch> patches, double share, double most, std::span<Vec6> shifts);

private:
    /// What was found about the graph of one list.
    struct Structure {
        std::vector<std::array<std::int32_t, 2>> ends;  ///< of the patches
        std::size_t bodies = 0;
        BlockCholesky matrix;
        std::vector<std::uint32_t> edge_of_patch;
    };

    void find_structure(std::span<const DirectPatch> patches);
    void factor(std::span<DirectPatch> patches);
    void set_patch_velocities(std::span<const Vec6> velocity, std::span<DirectPatch> patches) const;
    bool step(std::span<const Vec6> free, std::span<Vec6> velocity, std::span<DirectPatch> patches);
    bool evaluate_after(std::span<DirectPatch> patches) const;

    std::span<const NewtonBody> bodies_;
    double stiffness_ = 0;      // k, kg
    bool has_factors_ = false;  // of this list
    std::vector<Vec6> direction_;
    std::vector<Structure> structures_;
    std::size_t next_structure_ = 0;
    Structure* structure_ = nullptr;
};

}  // namespace embody::physics
