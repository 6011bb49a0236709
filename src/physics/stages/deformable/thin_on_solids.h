// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <utility>

#include "physics/deformable/solid/surface_pairs.h"
#include "physics/stages/access.h"
#include "physics/stages/deformable/thin_deformables.h"
#include "physics/stages/namespace.h"

namespace embody::physics::stages {

/// Sheets and ropes on soft solids that have made their substep already (docs/physics/cloth.md). For the sheet each is
/// a body that cannot be moved; the sheet's push acts on the solid from its next substep on.
class ThinOnSolids {
public:
    /// Surfaces of solids as they lie now, by slot, found when first needed.
    using Surfaces = std::map<std::uint32_t, PlacedSurface>;
    /// All enabled solids of the world as they lie now, asleep or not.
    ThinOnSolids(const DeformableAccess& world, Surfaces& surfaces) : world_(world), surfaces_(surfaces) {}

    /// Appends the solids within reach of `thin` to the bodies that it touches, and contacts of its nodes with them.
    /// `h` is its substep, s.
    void add(ThinDeformable& thin, std::vector<TouchedBody>& bodies, double h);
    /// After its substep: remembers its pushes on the solids, which are those of `bodies` from `first` on, and removes
    /// the contacts again.
    void take(ThinDeformable& thin, std::span<const TouchedBody> bodies, std::size_t first);

private:
    // Beyond all slots of bodies.
    static constexpr std::uint32_t first_solid_slot = 0x80000000u;
    struct Held {
        std::uint32_t body = 0, node = 0;
        PlacedSurface::Place place;
        double following = 1;  ///< fraction of a new push that acts on the solid
    };
    static std::pair<std::uint32_t, std::uint32_t> touch_of(const SurfacePush& push);
    static std::pair<std::uint32_t, std::uint32_t> key(const Held& held) { return {held.body, held.node}; }
    const PlacedSurface& surface(std::uint32_t slot);
    void add_solid(ThinDeformable& thin, std::uint32_t slot, std::vector<TouchedBody>& bodies, double h);
    void uncover(ThinDeformable& thin, std::uint32_t solid, double distance) const;
    void find_following(SolidDeformable& solid, const Nodes& sheet, double h, std::span<Held> held);

    const DeformableAccess world_;
    Surfaces& surfaces_;
    std::vector<Held> held_;                // of the sheet at hand, in the order of its contacts
    std::vector<NodeContact> with_bodies_;  // its contacts without solids
    std::vector<SheetContact> between_;     // likewise
    std::vector<Vec3> push_, move_;
};

}  // namespace embody::physics::stages
