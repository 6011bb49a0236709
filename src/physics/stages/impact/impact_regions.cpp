// SPDX-License-Identifier: MIT
#include "physics/stages/impact/impact_regions.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "physics/definitions/world_settings.h"
#include "physics/state/contact_state.h"
#include "physics/state/rigid_state.h"

namespace embody::physics::stages {

namespace {

ImpactCoefficients coefficients_of(const Material& material, double restitution) {
    return {material.friction_dynamic, material.friction_static, restitution};
}

}  // namespace

void ImpactRegions::collide_at(const Contact& contact, double time) {
    memory_.manifolds.clear();
    const BodyRecord &a = world_.rigid.record(contact.a), &b = world_.rigid.record(contact.b);

    // The touch stage's memory of the pair is of other poses, and stays so.
    const BroadPhase::Pair pair{contact.a, contact.b};
    const TouchMemory& touch = world_.contacts.touch;
    const auto watch = std::lower_bound(touch.watches.begin(), touch.watches.end(), pair,
                                        [](const PairWatch& w, const BroadPhase::Pair& p) { return w.pair < p; });
    PairMemory pair_memory = touch.records[watch->record].memory;
    collide(*a.shape, bodies_.pose_at(contact.a, time), *b.shape, bodies_.pose_at(contact.b, time),
            settings_.search_margin, pair_memory, memory_.manifolds);
}

double ImpactRegions::min_separation(const Manifold& manifold) {
    double least = ImpactPaths::never;
    for (int i = 0; i < manifold.count; ++i) {
        least = std::min(least, manifold.points[static_cast<std::size_t>(i)].separation);
    }
    return least;
}

bool ImpactRegions::is_beside(const Manifold& first, double nearest, const Manifold& other, const Contact& contact,
                              double time) {
    const bool is_first = other.piece_a == first.piece_a && other.piece_b == first.piece_b && other.part == first.part;
    if (is_first || other.count == 0) return false;
    const double gap = min_separation(other);
    return gap <= nearest + settings_.patch_gap &&
           closing_speed(contact, other, time, gap) >= settings_.min_impact_speed;
}

std::optional<std::uint32_t> ImpactRegions::find_contact(std::uint32_t beside, const Manifold& manifold) const {
    const Contact& known = world_.contacts.list[beside];
    const std::array<std::uint32_t, 5> key{known.a, known.b, manifold.piece_a, manifold.piece_b, manifold.part};
    const auto found = std::lower_bound(world_.contacts.list.begin(), world_.contacts.list.end(), key,
                                        [](const Contact& c, const auto& k) { return contact_key(c) < k; });
    if (found == world_.contacts.list.end() || contact_key(*found) != key) return std::nullopt;
    return static_cast<std::uint32_t>(found - world_.contacts.list.begin());
}

// Closing speed of the nearest points of the region, m/s.
double ImpactRegions::closing_speed(const Contact& contact, const Manifold& manifold, double time, double gap) {
    const BodyState &a = bodies_.kept_state_at(contact.a, time), &b = bodies_.kept_state_at(contact.b, time);
    double speed = 0;
    for (int i = 0; i < manifold.count; ++i) {
        const ManifoldPoint& point = manifold.points[static_cast<std::size_t>(i)];
        if (point.separation > gap + settings_.patch_gap) continue;
        const auto velocity = [&](const BodyState& body) { return velocity_at(body, point.position - body.center); };
        speed = std::max(speed, -dot(velocity(b) - velocity(a), manifold.normal));
    }
    return speed;
}

bool ImpactRegions::is_near(const Contact& contact, double time) const {
    const BodyState &a = world_.rigid.motion[contact.a], &b = world_.rigid.motion[contact.b];
    const double reach_a = world_.rigid.record(contact.a).reach, reach_b = world_.rigid.record(contact.b).reach;
    const double travel = time * (length(b.linear_velocity - a.linear_velocity) + length(a.angular_velocity) * reach_a +
                                  length(b.angular_velocity) * reach_b);
    double size = ImpactPaths::never;
    for (const double reach : {reach_a, reach_b}) {
        if (reach > 0) size = std::min(size, reach);
    }
    return travel < settings_.region_travel_fraction * size;
}

const Manifold* ImpactRegions::find_region(const Contact& contact) const {
    const auto found = std::find_if(memory_.manifolds.begin(), memory_.manifolds.end(), [&](const Manifold& m) {
        return m.piece_a == contact.piece_a && m.piece_b == contact.piece_b && m.part == contact.part;
    });
    return found != memory_.manifolds.end() && found->count > 0 ? &*found : nullptr;
}

double ImpactRegions::first_touch(const Contact& contact) {
    const double start = paths_.earliest_time(contact), substep = step_ / world_.settings.substeps;
    double last_time = start, last_gap = 0;
    for (int k = 0; k <= world_.settings.substeps; ++k) {
        const double time = k == 0 ? start : k * substep;
        if (k > 0 && time <= start) continue;
        collide_at(contact, time);
        const Manifold* region = find_region(contact);
        const double gap = region != nullptr ? min_separation(*region) : ImpactPaths::never;
        const bool was_seen = last_gap < ImpactPaths::never;
        if (gap <= 0 && last_gap > 0) {
            return was_seen ? last_time + (time - last_time) * last_gap / (last_gap - gap) : time;
        }
        last_time = time;
        last_gap = gap;
    }
    return ImpactPaths::never;
}

// Follows the closing surfaces (secant method) for a few iterations.
bool ImpactRegions::refine(const Contact& contact, double& time, Manifold& manifold) {
    const bool is_rough = paths_.hits_pile(contact) && !paths_.bounces(contact);
    const int max_iterations = is_rough ? settings_.rough_refine_iterations : settings_.refine_iterations;
    const double start = paths_.earliest_time(contact);
    const double tolerance = is_rough ? settings_.patch_gap : settings_.touch_gap;
    const double last_gap = settings_.refine_gap_ratio * settings_.patch_gap;
    for (int iteration = 0; iteration < max_iterations; ++iteration) {
        collide_at(contact, time);
        const Manifold* found = find_region(contact);
        if (found == nullptr) return false;
        manifold = *found;

        const double gap = min_separation(manifold), speed = closing_speed(contact, manifold, time, gap);
        if (speed < settings_.min_impact_speed) return false;
        const bool is_touching = std::fabs(gap) <= tolerance || (gap < 0 && time <= start);
        if (is_touching || (iteration + 1 == max_iterations && gap < last_gap)) return true;
        time = std::max(start, time + gap / speed);
        if (time > step_) return false;
    }
    return false;
}

bool ImpactRegions::is_open_at_end(const Contact& contact) {
    collide_at(contact, step_);
    return std::all_of(memory_.manifolds.begin(), memory_.manifolds.end(),
                       [](const Manifold& manifold) { return min_separation(manifold) > 0; });
}

void ImpactRegions::add_site(const Contact& contact, const SitePlace& place, double time, bool may_bounce) {
    const BodyState &a = bodies_.kept_state_at(contact.a, time), &b = bodies_.kept_state_at(contact.b, time);
    const Vec3 velocity = velocity_at(b, place.arm_b) - velocity_at(a, place.arm_a);
    const Material material = paths_.material_of(contact);
    const bool bounces = may_bounce && -dot(velocity, place.normal) >= material.restitution_threshold;
    memory_.sites.push_back({contact.a, contact.b, place.arm_a, place.arm_b, place.normal,
                             coefficients_of(material, bounces ? material.restitution : 0), Vec3{}});
}

// A flat region collides as one patch at its middle and, where it tilts, at its corners.
void ImpactRegions::add_manifold_sites(const Contact& contact, const Manifold& manifold, double time, bool may_bounce) {
    const double nearest = min_separation(manifold);
    const Vec3 center_a = bodies_.kept_state_at(contact.a, time).center;
    const Vec3 center_b = bodies_.kept_state_at(contact.b, time).center;
    const auto add = [&](Vec3 position) {
        add_site(contact, {position - center_a, position - center_b, manifold.normal}, time, may_bounce);
    };
    Vec3 sum;
    int count = 0;
    for (int i = 0; i < manifold.count; ++i) {
        const ManifoldPoint& point = manifold.points[static_cast<std::size_t>(i)];
        if (point.separation > nearest + settings_.patch_gap) continue;
        sum += point.position;
        ++count;
    }
    if (count > 1) add(sum / count);
    for (int i = 0; i < manifold.count; ++i) {
        const ManifoldPoint& point = manifold.points[static_cast<std::size_t>(i)];
        if (point.separation <= nearest + settings_.patch_gap) add(point.position);
    }
}

ImpactRegions::PointGaps ImpactRegions::straight_gaps(const Contact& contact, double time) const {
    const ImpactPaths::Gaps now = paths_.gaps_at(contact, 0);
    PointGaps gaps{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(contact.count); ++i)
        gaps[i] = now[i].size + now[i].rate * time;
    return gaps;
}

// The same by the region found at the start of the step: the points whose gaps are at most `highest`, as a patch at
// their middle and one by one. Without the patch, which is solved first, a body that lands flat would lean to the
// corner that happens to be solved first.
void ImpactRegions::add_points_below(const Contact& contact, const PointGaps& gaps, double highest, double time) {
    Vec3 arm_a, arm_b;
    int touching = 0;
    const auto count = static_cast<std::size_t>(contact.count);
    for (std::size_t i = 0; i < count; ++i) {
        if (!(gaps[i] <= highest)) continue;
        arm_a += contact.points[i].arm_a;
        arm_b += contact.points[i].arm_b;
        ++touching;
    }
    if (touching > 1) add_site(contact, {arm_a / touching, arm_b / touching, contact.normal}, time, false);
    for (std::size_t i = 0; i < count; ++i) {
        if (!(gaps[i] <= highest)) continue;
        add_site(contact, {contact.points[i].arm_a, contact.points[i].arm_b, contact.normal}, time, false);
    }
}

void ImpactRegions::add_point_sites(const Contact& contact, double time) {
    const PointGaps gaps = straight_gaps(contact, time);
    const double nearest = *std::min_element(gaps.begin(), gaps.begin() + contact.count);
    add_points_below(contact, gaps, nearest + settings_.patch_gap, time);
}

// Whether the two bodies pass an impact on by one of their own, which returns most of the energy.
bool ImpactRegions::passes_on(const Contact& contact) const {
    return paths_.bounces(contact) && paths_.material_of(contact).restitution >= settings_.elastic_restitution;
}

// Loaded contacts of the colliding bodies take part, without a bounce. Others that collide at the same time have their
// own events, and so have elastic ones: one after the other, as the balls of Newton's cradle do, keeps their energy.
void ImpactRegions::add_loaded_neighbours(std::span<const std::uint32_t> bodies, double time) {
    for (const std::uint32_t body : bodies) {
        if (world_.rigid.motion[body].inverse_mass == 0) continue;
        for (std::uint32_t k = memory_.first_of_body[body]; k < memory_.first_of_body[body + 1]; ++k) {
            const std::uint32_t other = memory_.of_body[k];
            if (!world_.contacts.summaries[other].was_loaded) continue;
            const auto& known = memory_.site_contact;
            if (std::find(known.begin(), known.end(), other) != known.end()) continue;
            if (passes_on(world_.contacts.list[other])) continue;
            const Contact& contact = world_.contacts.list[other];
            add_points_below(contact, straight_gaps(contact, time), settings_.patch_gap, time);
            memory_.site_contact.resize(memory_.sites.size(), other);
        }
    }
}

}  // namespace embody::physics::stages
