// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "geometry/bounding_volume_tree.h"
#include "physics/definitions/settings/solid_settings.h"
#include "physics/deformable/namespace.h"
#include "physics/deformable/solid/solid_contact.h"
#include "physics/deformable/solid/solid_deformable.h"

namespace embody::physics::deformable {

/// The displacement by which one solid leaves another that it lies within.
struct ExitDirection {
    int axis = 0;
    double sign = 1;
};
/// The shortest displacement by which the box of `one` leaves that of `two`; of equal ones the first, upwards for the
/// later solid.
[[nodiscard]] ExitDirection min_travel(const Bounds& one, const Bounds& two, bool is_later);

/// A solid's surface as it lies now.
class PlacedSurface {
public:
    explicit PlacedSurface(const SolidDeformable& solid);

    struct Place {
        std::array<std::uint32_t, 3> triangle{};
        std::array<double, 3> weight{};  ///< of its corners in the nearest point
        Vec3 normal;                     ///< outwards
        double distance = 0;             ///< negative inside, m
    };
    /// The place nearest to p, where it is no farther than `reach` (m).
    [[nodiscard]] std::optional<Place> find(Vec3 p, double reach) const;
    /// The place where the line from p along the unit vector of `axis` (0 x, 1 y, 2 z) in the sense of `sign` (±1)
    /// leaves the surface for good; none where it does not cross it. Its normal is that vector, its distance negative.
    [[nodiscard]] std::optional<Place> find_exit(Vec3 p, int axis, double sign) const;
    /// Whether p is inside.
    [[nodiscard]] bool encloses(Vec3 p) const;
    /// Maximum depth of a point inside at which it is known where it came from, m.
    [[nodiscard]] double deepest() const { return deepest_; }
    /// Fraction of this many points, evenly chosen beneath this surface at `depth` over the mean side, that is inside
    /// of the other.
    [[nodiscard]] double fraction_within(const PlacedSurface& other, double depth, std::size_t samples) const;

private:
    [[nodiscard]] Vec3 at(std::uint32_t node) const { return solid_.nodes().position[node]; }
    /// Calls visit(triangle, weights of its corners, place along the axis) for all triangles that the line along `axis`
    /// crosses.
    template <class Visit>
    void visit_crossings(Vec3 p, int axis, Visit&& visit) const;
    const SolidDeformable& solid_;
    std::vector<Vec3> normal_;  // by node
    geometry::BoundingVolumeTree tree_;
    double deepest_ = 0;
};

/// A solid with its number in the list of solids.
struct NumberedSolid {
    const SolidDeformable& solid;
    std::uint32_t number = 0;
};
struct SurfaceSearch {
    double reach = 0;   ///< maximum approach of the two in the step, m
    double radius = 0;  ///< distance that they keep, m
    PairFriction friction;
    bool is_parting = false;  ///< they were being separated in the last step
    SolidContactSettings settings = {};
};
/// Appends a contact for every surface node of `one` that may come to the surface of `two` within a step, with the
/// nearest triangle there. Solids of which much lies within each other are separated along the axis on which their
/// boxes overlap least.
void find_surface_contacts(const NumberedSolid& one, const NumberedSolid& two, const SurfaceSearch& search,
                           std::vector<SolidContact>& contacts);

}  // namespace embody::physics::deformable
