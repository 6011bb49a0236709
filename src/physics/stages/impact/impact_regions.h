// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "physics/definitions/world_settings.h"
#include "physics/stages/access.h"
#include "physics/stages/impact/impact_paths.h"
#include "physics/stages/namespace.h"
#include "physics/state/contact_state.h"
#include "physics/state/impact_memory.h"

namespace embody::physics::stages {

/// Where two bodies meet at the moment of an impact, and the sites of the group that collides there. Like ImpactPaths a
/// view of the world for one step.
class ImpactRegions {
public:
    ImpactRegions(const ImpactAccess& world, BodyPaths& bodies, const ImpactPaths& paths)
        : world_(world),
          memory_(world.impacts),
          bodies_(bodies),
          paths_(paths),
          settings_(paths.settings()),
          step_(world.settings.time_step) {}

    /// Whether the region found at the start of the step is still right at `time`: the bodies have hardly moved on.
    [[nodiscard]] bool is_near(const Contact& contact, double time) const;
    /// The contact region at the moment of impact, found at the bodies' places then, and that moment: the prediction
    /// used the normal of the start of the step. False where they pass each other.
    bool refine(const Contact& contact, double& time, Manifold& manifold);
    /// When the regions found at the ends of the substeps first overlap, s; `never` if they do not. For bodies that
    /// turn so fast that other corners come down than those that were close at the step's start.
    double first_touch(const Contact& contact);
    /// Whether the bodies are apart at the end of the step, if nothing else happens to them.
    bool is_open_at_end(const Contact& contact);

    // Each appends to the sites of the present impact.
    void add_manifold_sites(const Contact& contact, const Manifold& manifold, double time, bool may_bounce);
    void add_point_sites(const Contact& contact, double time);
    /// Sites of the other regions of the two bodies that close as well and whose gaps are within those of the corners
    /// of one region: the other feet of a table that comes down flat, even if micrometres later. `first`, found by
    /// refine() just now, began the impact. A contact collides with a bounce if `may_bounce(contact)`.
    template <class MayBounce>
    void add_sites_beside(std::uint32_t contact, const Manifold& first, double time, const MayBounce& may_bounce) {
        const double nearest = min_separation(first);
        for (const Manifold& other : memory_.manifolds) {
            if (!is_beside(first, nearest, other, world_.contacts.list[contact], time)) continue;
            const auto found = find_contact(contact, other);
            if (!found) continue;
            add_manifold_sites(world_.contacts.list[*found], other, time, may_bounce(*found));
            memory_.site_contact.resize(memory_.sites.size(), *found);
        }
    }
    /// Sites of these bodies' contacts. Requires the lists of each body's contacts.
    void add_loaded_neighbours(std::span<const std::uint32_t> bodies, double time);

private:
    /// The region of the contact among those that collide_at() found; nullptr if there is none.
    [[nodiscard]] const Manifold* find_region(const Contact& contact) const;
    static double min_separation(const Manifold& manifold);
    bool is_beside(const Manifold& first, double nearest, const Manifold& other, const Contact& contact, double time);
    /// The contact of this region, of the same two bodies.
    [[nodiscard]] std::optional<std::uint32_t> find_contact(std::uint32_t beside, const Manifold& manifold) const;
    double closing_speed(const Contact& contact, const Manifold& manifold, double time, double gap);
    [[nodiscard]] bool passes_on(const Contact& contact) const;
    /// The gaps of the contact's points on straight paths, m.
    using PointGaps = std::array<double, Manifold::max_points>;
    [[nodiscard]] PointGaps straight_gaps(const Contact& contact, double time) const;
    void add_points_below(const Contact& contact, const PointGaps& gaps, double highest, double time);
    void collide_at(const Contact& contact, double time);
    struct SitePlace {
        Vec3 arm_a, arm_b, normal;  ///< as in ImpactSite
    };
    void add_site(const Contact& contact, const SitePlace& place, double time, bool may_bounce);

    const ImpactAccess world_;
    ImpactMemory& memory_;
    BodyPaths& bodies_;
    const ImpactPaths& paths_;
    const ImpactSettings& settings_;
    const double step_;
};

}  // namespace embody::physics::stages
