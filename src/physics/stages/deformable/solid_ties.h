// SPDX-License-Identifier: MIT
#pragma once

#include "physics/stages/access.h"
#include "physics/stages/deformable/thin_deformables.h"
#include "physics/stages/namespace.h"

namespace embody::physics::stages {

/// Ties of a sheet or rope to soft solids that have made their substep already. The solid's compliance where it is tied
/// is known, so for the sheet's solve it is a small body there; the resulting pull moves the solid in the same substep,
/// and acts on it in the next (docs/physics/cloth.md).
class SolidTies {
public:
    explicit SolidTies(const DeformableAccess& world) : world_(world) {}

    /// Appends a body and an attachment for each tie of `thin`. `h` is its substep, s.
    void add(ThinDeformable& thin, std::vector<TouchedBody>& bodies, double h);
    /// After its substep: moves the solids, remembers the pulls and takes the attachments away again.
    void take(ThinDeformable& thin);
    /// Lets the pulls of the last substep act on the solid of that slot.
    static void push(const DeformableAccess& world, std::uint32_t slot, SolidDeformable& solid);

private:
    struct Held {
        std::uint32_t slot = 0, body = 0;
        std::size_t tie = 0;    ///< index
        double compliance = 0;  ///< of the solid's point, m/N
    };
    void find_compliance(const DeformableRecord& thin, SolidDeformable& solid, std::span<Held> held);
    void move_solid(DeformableRecord& thin, std::span<const Held> held);

    const DeformableAccess world_;
    std::vector<Held> held_;  // by slot
    std::vector<Vec3> force_, move_;
};

/// Whether a tie holds that node to that other deformable.
bool is_tied(const DeformableRecord& thin, std::uint32_t node, DeformableHandle other);
/// Whether it has a tie to a soft solid that is there.
bool has_solid_ties(const DeformableAccess& world, const DeformableRecord& thin);

}  // namespace embody::physics::stages
