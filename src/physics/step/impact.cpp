// SPDX-License-Identifier: MIT
//
// When in the step bodies collide, and where. Source: B. Mirtich, "Timewarp rigid body simulation", 2000 (impacts in
// the order of their times, each body with its own history); order of impacts before contacts: E. Guendelman et al.,
// 2003.
//
// Each impact happens at its own time t within the step: there the velocities are v + a t, eq. (3) changes them by Δv,
// and the motion goes on from there. To keep one step for all bodies, the body is put on the path that leads through
// the place of impact with the new velocity:  x ← x − t Δv,  v ← v + Δv  at the start of the step. A ball with
// restitution 1 so keeps its energy exactly, whatever the time step.
//
// What hits a heap without a bounce is kept cheap: its time is that of straight paths, its region found anew only where
// the bodies have moved on, and the sliding estimated. Many contacts at once stop it, in an order that no model knows.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "physics/constraint/impact_group.h"
#include "physics/dynamic/equations_of_motion.h"
#include "physics/step/impact_paths.h"
#include "physics/step/step.h"

namespace embody::physics {

namespace {

constexpr double patch_gap = 5e-4;   // m: corners this near to the first one collide together with it
constexpr double near_share = 0.05;  // of a body's size
constexpr double heap_slack = 0.02;  // of a step: in a heap, impacts this near in time may change places
constexpr int most_bounces = 3;      // of one contact in a step; later impacts do not bounce (Zeno's ball)
constexpr int most_impacts = 5;      // of one contact in a step; then the contact solver stops it

class ImpactStage {
public:
    explicit ImpactStage(WorldState& world)
        : world_(world), memory_(world.impact_memory), paths_(world), step_(world.settings.time_step) {}

    void run();

private:
    void predict(std::uint32_t contact);
    void list_contacts();
    void take(const ImpactEvent& event);
    bool is_near(const Contact& contact, double time) const;
    bool refine(const Contact& contact, double& time, Manifold& manifold);
    double closing_speed(const Contact& contact, const Manifold& manifold, double time, double gap) const;
    void collide_at(const Contact& contact, double time);
    bool is_open_at_end(const Contact& contact);
    void add_site(const Contact& contact, Vec3 arm_a, Vec3 arm_b, Vec3 normal, bool may_bounce);
    void add_manifold_sites(const Contact& contact, const Manifold& manifold, double time, bool may_bounce);
    void add_point_sites(const Contact& contact, double time);
    void add_loaded_neighbours(std::uint32_t contact, double time);
    void list_bodies();
    void solve(std::uint32_t contact, double time, SlidePath path);
    void bend_path(const ImpactMemory::Moved& before, double time);
    void note_impulse(Contact& contact, Vec3 position, Vec3 impulse, double time);

    WorldState& world_;
    ImpactMemory& memory_;
    ImpactPaths paths_;
    const double step_;
};

void ImpactStage::predict(std::uint32_t contact) {
    if (memory_.impacts[contact] >= most_impacts) return;
    const double time = paths_.predict(world_.contacts[contact]);
    if (time > step_) return;
    memory_.events.push_back({time, contact, memory_.version[contact]});
    std::push_heap(memory_.events.begin(), memory_.events.end(), std::greater<>());
}

// The contacts of each body.
void ImpactStage::list_contacts() {
    if (memory_.has_lists) return;
    memory_.has_lists = true;
    const std::vector<ContactGlance>& contacts = world_.contact_glances;
    std::vector<std::uint32_t>& first = memory_.first_of_body;
    first.assign(world_.motion.size() + 2, 0);
    for (const ContactGlance& contact : contacts) {
        ++first[contact.a + 2];
        ++first[contact.b + 2];
    }
    for (std::size_t i = 2; i < first.size(); ++i) first[i] += first[i - 1];

    // While the lists are filled, an entry moves on to where the next body's begins.
    memory_.of_body.resize(2 * contacts.size());
    for (std::uint32_t i = 0; i < contacts.size(); ++i) {
        memory_.of_body[first[contacts[i].a + 1]++] = i;
        memory_.of_body[first[contacts[i].b + 1]++] = i;
    }
}

void ImpactStage::collide_at(const Contact& contact, double time) {
    memory_.manifolds.clear();
    const BodyRecord &a = world_.record(contact.a), &b = world_.record(contact.b);

    // The touch stage's memory of the pair is of other poses, and stays so.
    const BroadPhase::Pair pair{contact.a, contact.b};
    const auto record = std::lower_bound(world_.pair_records.begin(), world_.pair_records.end(), pair,
                                         [](const PairRecord& r, const BroadPhase::Pair& p) { return r.pair < p; });
    PairMemory pair_memory = record->memory;
    collide(*a.shape, paths_.pose_at(contact.a, time), *b.shape, paths_.pose_at(contact.b, time), 0.02, pair_memory,
            memory_.manifolds);
}

double least_separation(const Manifold& manifold) {
    double least = ImpactPaths::never;
    for (int i = 0; i < manifold.count; ++i) {
        least = std::min(least, manifold.points[static_cast<std::size_t>(i)].separation);
    }
    return least;
}

// How fast the nearest points of the region close, m/s.
double ImpactStage::closing_speed(const Contact& contact, const Manifold& manifold, double time, double gap) const {
    double speed = 0;
    for (int i = 0; i < manifold.count; ++i) {
        const ManifoldPoint& point = manifold.points[static_cast<std::size_t>(i)];
        if (point.separation > gap + patch_gap) continue;
        const auto velocity = [&](std::uint32_t body) {
            return velocity_at(world_.motion[body], point.position - paths_.center_at(body, time)) +
                   paths_.free_acceleration(body) * time;
        };
        speed = std::max(speed, -dot(velocity(contact.b) - velocity(contact.a), manifold.normal));
    }
    return speed;
}

// Whether the region found at the start of the step is still right at `time`: the bodies have hardly moved on.
bool ImpactStage::is_near(const Contact& contact, double time) const {
    const BodyState &a = world_.motion[contact.a], &b = world_.motion[contact.b];
    const double reach_a = world_.record(contact.a).reach, reach_b = world_.record(contact.b).reach;
    const double way = time * (length(b.linear_velocity - a.linear_velocity) + length(a.angular_velocity) * reach_a +
                               length(b.angular_velocity) * reach_b);
    double size = ImpactPaths::never;
    for (const double reach : {reach_a, reach_b}) {
        if (reach > 0) size = std::min(size, reach);
    }
    return way < near_share * size;
}

// The contact region at the moment of impact, found at the bodies' places then: the prediction used the normal of the
// start of the step. Follows the closing surfaces (secant) for a few rounds. False: they pass each other.
bool ImpactStage::refine(const Contact& contact, double& time, Manifold& manifold) {
    const bool is_rough = paths_.hits_heap(contact) && !paths_.bounces(contact);
    const int most_rounds = is_rough ? 2 : 8;
    const double start = paths_.earliest_time(contact);
    const double tolerance = is_rough ? patch_gap : ImpactPaths::touch_gap;
    for (int round = 0; round < most_rounds; ++round) {
        collide_at(contact, time);
        const auto found = std::find_if(memory_.manifolds.begin(), memory_.manifolds.end(), [&](const Manifold& m) {
            return m.piece_a == contact.piece_a && m.piece_b == contact.piece_b;
        });
        if (found == memory_.manifolds.end() || found->count == 0) return false;
        manifold = *found;

        const double gap = least_separation(manifold), speed = closing_speed(contact, manifold, time, gap);
        if (speed < ImpactPaths::slowest_impact) return false;
        const bool is_touching = std::fabs(gap) <= tolerance || (gap < 0 && time <= start);
        if (is_touching || (round + 1 == most_rounds && gap < 10 * patch_gap)) return true;
        time = std::max(start, time + gap / speed);
        if (time > step_) return false;
    }
    return false;
}

// Whether the bodies are apart at the end of the step, if nothing else happens to them.
bool ImpactStage::is_open_at_end(const Contact& contact) {
    collide_at(contact, step_);
    return std::all_of(memory_.manifolds.begin(), memory_.manifolds.end(),
                       [](const Manifold& manifold) { return least_separation(manifold) > 0; });
}

ImpactCoefficients coefficients_of(const Material& material, double restitution) {
    return {material.friction_dynamic, material.friction_static, restitution};
}

void ImpactStage::add_site(const Contact& contact, Vec3 arm_a, Vec3 arm_b, Vec3 normal, bool may_bounce) {
    const Vec3 velocity = velocity_at(world_.motion[contact.b], arm_b) - velocity_at(world_.motion[contact.a], arm_a);
    const bool bounces = may_bounce && -dot(velocity, normal) >= contact.material.restitution_threshold;
    memory_.sites.push_back({contact.a, contact.b, arm_a, arm_b, normal,
                             coefficients_of(contact.material, bounces ? contact.material.restitution : 0), Vec3{}});
}

// A flat region collides as one patch at its middle and, where it tilts, at its corners.
void ImpactStage::add_manifold_sites(const Contact& contact, const Manifold& manifold, double time, bool may_bounce) {
    const double nearest = least_separation(manifold);
    const Vec3 center_a = paths_.center_at(contact.a, time), center_b = paths_.center_at(contact.b, time);
    const auto add = [&](Vec3 position) {
        add_site(contact, position - center_a, position - center_b, manifold.normal, may_bounce);
    };
    Vec3 sum;
    int count = 0;
    for (int i = 0; i < manifold.count; ++i) {
        const ManifoldPoint& point = manifold.points[static_cast<std::size_t>(i)];
        if (point.separation > nearest + patch_gap) continue;
        sum += point.position;
        ++count;
    }
    if (count > 1) add(sum / count);
    for (int i = 0; i < manifold.count; ++i) {
        const ManifoldPoint& point = manifold.points[static_cast<std::size_t>(i)];
        if (point.separation <= nearest + patch_gap) add(point.position);
    }
}

// The same by the region found at the start of the step.
void ImpactStage::add_point_sites(const Contact& contact, double time) {
    std::array<double, Manifold::max_points> gap{};
    double nearest = ImpactPaths::never;
    const auto count = static_cast<std::size_t>(contact.count);
    for (std::size_t i = 0; i < count; ++i) {
        const ImpactPaths::Gap now = paths_.gap_at(contact, contact.points[i], 0);
        gap[i] = now.size + now.rate * time;
        nearest = std::min(nearest, gap[i]);
    }
    Vec3 arm_a, arm_b;
    int touching = 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (gap[i] > nearest + patch_gap) continue;
        arm_a += contact.points[i].arm_a;
        arm_b += contact.points[i].arm_b;
        ++touching;
    }
    if (touching > 1) add_site(contact, arm_a / touching, arm_b / touching, contact.normal, false);
    for (std::size_t i = 0; i < count; ++i) {
        if (gap[i] > nearest + patch_gap) continue;
        add_site(contact, contact.points[i].arm_a, contact.points[i].arm_b, contact.normal, false);
    }
}

// Loaded contacts of the colliding bodies take part, without a bounce. Others that collide at the same time have their
// own events: one after the other, as the balls of Newton's cradle do it, keeps the energy of elastic bodies.
void ImpactStage::add_loaded_neighbours(std::uint32_t contact, double time) {
    const Contact& first = world_.contacts[contact];
    for (const std::uint32_t body : {first.a, first.b}) {
        if (world_.motion[body].inverse_mass == 0) continue;
        for (std::uint32_t k = memory_.first_of_body[body]; k < memory_.first_of_body[body + 1]; ++k) {
            const std::uint32_t other = memory_.of_body[k];
            if (!world_.contact_glances[other].was_loaded) continue;
            const auto& known = memory_.site_contact;
            if (std::find(known.begin(), known.end(), other) != known.end()) continue;
            const Contact& c = world_.contacts[other];
            for (int i = 0; i < c.count; ++i) {
                const ContactPoint& point = c.points[static_cast<std::size_t>(i)];
                const ImpactPaths::Gap now = paths_.gap_at(c, point, 0);
                if (now.size + now.rate * time > patch_gap) continue;
                add_site(c, point.arm_a, point.arm_b, c.normal, false);
                memory_.site_contact.push_back(other);
            }
        }
    }
}

// The report wants each impulse at a point: the nearest of the region found at the start.
void ImpactStage::note_impulse(Contact& contact, Vec3 position, Vec3 impulse, double time) {
    ContactPoint* nearest = &contact.points[0];
    for (int i = 1; i < contact.count; ++i) {
        ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
        const auto far = [&](const ContactPoint& p) {
            return length_squared(position_of(contact, p, world_.motion) - position);
        };
        if (far(point) < far(*nearest)) nearest = &point;
    }
    nearest->total.normal += static_cast<float>(dot(impulse, contact.normal));
    nearest->total.tangent_1 += static_cast<float>(dot(impulse, contact.tangent_1));
    nearest->total.tangent_2 += static_cast<float>(dot(impulse, contact.tangent_2));
    if (!contact.had_impact) ++world_.report.impacts;
    contact.had_impact = true;

    // Until then the bodies' new paths overlap where they part.
    for (int i = 0; i < contact.count; ++i) {
        ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
        const double parting = dot(relative_velocity(contact, point, world_.motion), contact.normal);
        point.inactive_until = parting > 0 ? static_cast<float>(time) : 0;
    }
}

// The movable bodies of the sites, each once.
void ImpactStage::list_bodies() {
    memory_.bodies.clear();
    for (const ImpactSite& site : memory_.sites) {
        for (const std::uint32_t body : {site.a, site.b}) {
            const auto is_it = [body](const ImpactMemory::Moved& moved) { return moved.body == body; };
            const bool is_known = std::any_of(memory_.bodies.begin(), memory_.bodies.end(), is_it);
            if (world_.motion[body].inverse_mass > 0 && !is_known) memory_.bodies.push_back({body, false, {}, {}});
        }
    }
}

// Puts a body back to the start of the step, on the path that leads through the place of impact with the new velocity.
void ImpactStage::bend_path(const ImpactMemory::Moved& before, double time) {
    BodyState& state = world_.motion[before.body];
    state.center -= (state.linear_velocity - before.linear_velocity) * time;
    if (state.angular_velocity != before.angular_velocity) {
        state.rotation = normalized(cayley(-time * state.angular_velocity) *
                                    (cayley(time * before.angular_velocity) * state.rotation));
        state.turn = state.rotation * conjugate(state.start_rotation);
    }
}

// Solves the collision of the sites, which `contact` began.
void ImpactStage::solve(std::uint32_t contact, double time, SlidePath path) {
    memory_.site_contact.assign(memory_.sites.size(), contact);
    add_loaded_neighbours(contact, time);
    list_bodies();

    // Velocities at the time of impact, the collision, and back to the start of the step on the new path.
    for (ImpactMemory::Moved& moved : memory_.bodies) {
        BodyState& state = world_.motion[moved.body];
        state.linear_velocity += paths_.free_acceleration(moved.body) * time;
        moved.linear_velocity = state.linear_velocity;
        moved.angular_velocity = state.angular_velocity;
    }
    const ImpactReport report = solve_impact_group(memory_.sites, world_.motion, memory_.group, path);
    if (!report.converged) {
        world_.report.limits |= static_cast<std::uint32_t>(StepLimit::impact_rounds_exhausted);
    }
    for (ImpactMemory::Moved& moved : memory_.bodies) {
        BodyState& state = world_.motion[moved.body];
        moved.has_changed =
            state.linear_velocity != moved.linear_velocity || state.angular_velocity != moved.angular_velocity;
        bend_path(moved, time);
        state.linear_velocity -= paths_.free_acceleration(moved.body) * time;
        if (moved.has_changed) memory_.last_time[moved.body] = time;
    }
    for (std::size_t i = 0; i < memory_.sites.size(); ++i) {
        const ImpactSite& site = memory_.sites[i];
        if (site.impulse == Vec3{}) continue;
        note_impulse(world_.contacts[memory_.site_contact[i]], site.arm_b + paths_.center_at(site.b, time),
                     site.impulse, time);
    }
}

// The next impact, if its place and time are right; else it comes back with better ones.
void ImpactStage::take(const ImpactEvent& event) {
    Contact& contact = world_.contacts[event.contact];
    double time = event.time;
    Manifold manifold;
    const bool in_heap = paths_.hits_heap(contact), is_rough = in_heap && !paths_.bounces(contact);
    const bool as_found = is_rough && is_near(contact, time);
    if (!as_found) {
        if (!refine(contact, time, manifold)) {
            // They pass each other: the region found at the start must not hold them up.
            if (is_open_at_end(contact)) paths_.leave_open(contact);
            return;
        }
        if (!memory_.events.empty() && time > memory_.events.front().time + (in_heap ? heap_slack * step_ : 1e-12)) {
            memory_.events.push_back({time, event.contact, ++memory_.version[event.contact]});
            std::push_heap(memory_.events.begin(), memory_.events.end(), std::greater<>());
            return;
        }
    }
    list_contacts();
    memory_.sites.clear();
    const bool may_bounce = memory_.impacts[event.contact]++ < most_bounces && paths_.bounces(contact);
    if (may_bounce) paths_.note_bounce(contact);
    if (as_found) {
        add_point_sites(contact, time);
    } else {
        add_manifold_sites(contact, manifold, time, may_bounce);
    }
    solve(event.contact, time, in_heap ? SlidePath::estimated : SlidePath::followed);

    // What the moved bodies touch next is to be predicted anew.
    for (const ImpactMemory::Moved& moved : memory_.bodies) {
        if (!moved.has_changed) continue;
        for (std::uint32_t k = memory_.first_of_body[moved.body]; k < memory_.first_of_body[moved.body + 1]; ++k) {
            const std::uint32_t other = memory_.of_body[k];
            const ContactGlance& glance = world_.contact_glances[other];
            if (glance.was_touching && !glance.bounces) continue;
            ++memory_.version[other];
            predict(other);
        }
    }
}

void ImpactStage::run() {
    const std::size_t count = world_.contacts.size();
    memory_.version.assign(count, 0);
    memory_.impacts.assign(count, 0);
    memory_.events.clear();
    memory_.has_lists = false;
    for (std::uint32_t i = 0; i < count; ++i) {
        if (!paths_.is_surely_slow(world_.contact_glances[i])) predict(i);
    }
    std::size_t left = 64 + 32 * count;
    while (!memory_.events.empty()) {
        const ImpactEvent event = memory_.events.front();
        std::pop_heap(memory_.events.begin(), memory_.events.end(), std::greater<>());
        memory_.events.pop_back();
        if (event.version != memory_.version[event.contact]) continue;
        if (left-- == 0) {
            world_.report.limits |= static_cast<std::uint32_t>(StepLimit::impact_rounds_exhausted);
            return;
        }
        take(event);
    }
}

}  // namespace

void solve_impacts(WorldState& world) {
    if (!world.contacts.empty()) ImpactStage(world).run();
}

}  // namespace embody::physics
