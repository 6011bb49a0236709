// SPDX-License-Identifier: MIT
//
// When in the step bodies collide, and where. Source: B. Mirtich, "Timewarp rigid body simulation", 2000 (impacts in
// the order of their times, each body with its own history); order of impacts before contacts: E. Guendelman et al.,
// 2003.
//
// Each impact happens at its own time t within the step: there the velocities are v + a t, eq. (3) changes them by Δv,
// and the motion goes on from there. To keep one step for all bodies, the body is put on the path that leads through
// the place of impact with the new velocity:  x ← x − t Δv,  v ← v + Δv  at the start of the step. A ball with
// restitution 1 so keeps its energy exactly, whatever the time step. Spinning bodies are moved likewise by their free
// rotation (BodyPaths), forward to the impact and back, and jointed bodies as their joints allow. Impacts of the same
// instant on the same bodies are one.
//
// The impact of a body that hits a pile without a bounce is kept cheap: its time is that of straight paths, its region
// is found anew only where the bodies have moved on, and the sliding is estimated. Many contacts stop such a body at
// once, in an order that no model predicts.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "foundation/task_pool.h"
#include "foundation/zone.h"
#include "physics/definitions/step_report.h"
#include "physics/definitions/world_settings.h"
#include "physics/dynamic/equations_of_motion.h"
#include "physics/stages/access.h"
#include "physics/stages/impact/impact_assembly.h"
#include "physics/stages/impact/impact_regions.h"
#include "physics/stages/stages.h"
#include "physics/state/contact_state.h"
#include "physics/state/impact_memory.h"
#include "physics/state/joint_state.h"
#include "physics/state/ledger.h"
#include "physics/state/rigid_state.h"

namespace embody::physics::stages {

namespace {

constexpr double time_rounding = 1e-12;  // s: moments within this are one; a step of 1e-5 s is the shortest

class ImpactStage {
public:
    explicit ImpactStage(const ImpactAccess& world)
        : world_(world),
          memory_(world.impacts),
          bodies_(world),
          paths_(world, bodies_),
          regions_(world, bodies_, paths_),
          settings_(world.settings.solver.constraint.impact),
          step_(world.settings.time_step),
          max_assembly_nodes_(settings_.budget.nodes_per_bounce * paths_.max_pile_bounces()) {
        memory_.assembly_nodes = 0;
    }

    void run();

private:
    void push(double time, std::uint32_t contact);
    void predict(std::uint32_t contact);
    void note(std::uint32_t contact, ImpactPaths::Prediction next);
    void predict_all();
    void predict_again();
    void list_contacts();
    bool count_impact(std::uint32_t contact);
    void count_assembly();
    [[nodiscard]] bool is_left_to_contacts(const Contact& contact) const;
    bool add_region(std::uint32_t contact, const Manifold& manifold, double time);
    bool joins_in(std::uint32_t contact, double time);
    void add_simultaneous(double time);
    void take(const ImpactEvent& event);
    void list_bodies(std::size_t first);
    void gather(double time);
    void go_to(double time);
    void solve(double time, SlidePath path);
    void open_jointed_contacts();
    [[nodiscard]] bool keeps_apart_when_held(const Contact& contact) const;
    void note_joint_impulses();
    void go_back(double time);
    void note_impulse(Contact& contact, Vec3 position, Vec3 impulse, double time);

    const ImpactAccess world_;
    ImpactMemory& memory_;
    BodyPaths bodies_;
    ImpactPaths paths_;
    ImpactRegions regions_;
    const ImpactSettings& settings_;
    const double step_;
    const std::size_t max_assembly_nodes_;  // in a step
};

void ImpactStage::push(double time, std::uint32_t contact) {
    memory_.next_time[contact] = time;
    memory_.events.push_back({time, contact, memory_.version[contact]});
    std::push_heap(memory_.events.begin(), memory_.events.end(), std::greater<>());
}

void ImpactStage::predict(std::uint32_t contact) {
    memory_.is_open[contact] = 0;
    memory_.next_time[contact] = ImpactPaths::never;
    if (memory_.impacts[contact] >= settings_.budget.max_impacts) return;
    note(contact, paths_.predict(world_.contacts.list[contact]));
}

void ImpactStage::note(std::uint32_t contact, ImpactPaths::Prediction next) {
    if (next.may_hide) next.time = regions_.first_touch(world_.contacts.list[contact]);
    memory_.is_open[contact] = next.is_open && next.time > step_ ? 1 : 0;
    if (next.time <= step_) push(next.time, contact);
}

// Each contact is examined by itself, so on all workers; the events are listed in the order of the contacts.
void ImpactStage::predict_all() {
    EMBODY_ZONE("predict impacts");
    constexpr std::size_t min_parallel_count = 1000;  // contacts: below, waking the workers costs more
    const std::size_t count = world_.contacts.list.size();
    std::vector<ImpactPaths::Prediction>& first = memory_.first;
    first.assign(count, {});
    parallel_for(world_.workers, count, count >= min_parallel_count, [&](int, IndexRange range) {
        for (auto i = static_cast<std::uint32_t>(range.first); i < range.last; ++i) {
            if (paths_.is_surely_slow(world_.contacts.summaries[i])) continue;
            first[i] = paths_.predict_straight(world_.contacts.list[i]);
        }
    });

    // Where straight paths are not accurate enough.
    memory_.uncertain.clear();
    memory_.uncertain_bodies.clear();
    for (std::uint32_t i = 0; i < count; ++i) {
        if (first[i].is_certain) continue;
        memory_.uncertain.push_back(i);
        for (const std::uint32_t body : {world_.contacts.summaries[i].a, world_.contacts.summaries[i].b}) {
            if (paths_.turns_far(body)) memory_.uncertain_bodies.push_back(body);
        }
    }
    bodies_.remember(memory_.uncertain_bodies);
    parallel_for(world_.workers, memory_.uncertain.size(), memory_.uncertain.size() >= min_parallel_count / 4,
                 [&](int, IndexRange range) {
                     for (std::size_t k = range.first; k < range.last; ++k) {
                         const std::uint32_t i = memory_.uncertain[k];
                         first[i] = paths_.predict_exactly(world_.contacts.list[i]);
                     }
                 });
    for (std::uint32_t i = 0; i < count; ++i) note(i, first[i]);
}

// The contacts of each body.
void ImpactStage::list_contacts() {
    if (memory_.has_lists) return;
    memory_.has_lists = true;
    const std::vector<ContactSummary>& contacts = world_.contacts.summaries;
    std::vector<std::uint32_t>& first = memory_.first_of_body;
    first.assign(world_.rigid.motion.size() + 2, 0);
    for (const ContactSummary& contact : contacts) {
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

// The report has each impulse at a point: the nearest of the region found at the start.
void ImpactStage::note_impulse(Contact& contact, Vec3 position, Vec3 impulse, double time) {
    ContactPoint* nearest = &contact.points[0];
    for (int i = 1; i < contact.count; ++i) {
        ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
        const auto far = [&](const ContactPoint& p) {
            return length_squared(position_of(contact, p, world_.rigid.motion) - position);
        };
        if (far(point) < far(*nearest)) nearest = &point;
    }
    nearest->total += static_cast<float>(dot(impulse, contact.normal));
    contact.friction_total.along_1 += static_cast<float>(dot(impulse, contact.tangent_1));
    contact.friction_total.along_2 += static_cast<float>(dot(impulse, tangent_2(contact)));
    if (!contact.had_impact) ++world_.report.impacts;
    contact.had_impact = true;

    // Until then the bodies' new paths overlap, although the bodies separate.
    for (int i = 0; i < contact.count; ++i) {
        ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
        const double parting = dot(relative_velocity(contact, point, world_.rigid.motion), contact.normal);
        point.inactive_until = parting > 0 ? static_cast<float>(time) : 0;
    }
}

// The movable bodies of the sites from `first` on, each once.
void ImpactStage::list_bodies(std::size_t first) {
    for (const ImpactSite& site : std::span(memory_.sites).subspan(first)) {
        for (const std::uint32_t body : {site.a, site.b}) {
            const auto is_it = [body](const ImpactMemory::Moved& moved) { return moved.body == body; };
            const bool is_known = std::any_of(memory_.bodies.begin(), memory_.bodies.end(), is_it);
            if (world_.rigid.motion[body].inverse_mass > 0 && !is_known)
                memory_.bodies.push_back({body, false, {}, {}, {}});
        }
    }
}

// All that takes part: what collides, what joints connect with it, what carries either, and what joints connect with
// that.
void ImpactStage::gather(double time) {
    memory_.bodies.clear();
    list_bodies(0);
    gather_jointed(world_);
    memory_.neighbours.clear();
    for (const ImpactMemory::Moved& moved : memory_.bodies) memory_.neighbours.push_back(moved.body);
    const std::size_t colliding = memory_.sites.size();
    regions_.add_loaded_neighbours(memory_.neighbours, time);
    if (memory_.sites.size() == colliding) return;
    list_bodies(colliding);
    gather_jointed(world_);
}

// Impacts of large assemblies cost as much as the bounces of a pile, and have the same budget.
void ImpactStage::count_assembly() {
    const bool had_any_left = memory_.assembly_nodes < max_assembly_nodes_;
    if (!memory_.jointed.empty()) memory_.assembly_nodes += memory_.jointed.size() + memory_.jointed_joints.size();
    if (had_any_left && memory_.assembly_nodes >= max_assembly_nodes_) {
        world_.report.limits |= static_cast<std::uint32_t>(StepLimit::impact_iterations_exhausted);
    }
}

bool ImpactStage::is_left_to_contacts(const Contact& contact) const {
    if (memory_.assembly_nodes < max_assembly_nodes_) return false;
    return has_joints(world_, contact.a) || has_joints(world_, contact.b);
}

// The bodies at the place of the impact. Joints have kept the bodies that they hold from falling on the path there.
void ImpactStage::go_to(double time) {
    for (ImpactMemory::Moved& moved : memory_.bodies) moved.start = world_.rigid.motion[moved.body];
    ImpactJoints& joints = memory_.group.joints;
    const auto bounces = [](const ImpactSite& site) { return site.coefficients.restitution > 0; };
    memory_.is_flown = !memory_.jointed.empty() && can_fly_jointed(world_) &&
                       std::any_of(memory_.sites.begin(), memory_.sites.end(), bounces);
    if (memory_.is_flown) fly_jointed(world_, time);
    for (ImpactMemory::Moved& moved : memory_.bodies) {
        const bool is_there =
            memory_.is_flown && std::binary_search(memory_.jointed.begin(), memory_.jointed.end(), moved.body);
        if (!is_there) world_.rigid.motion[moved.body] = bodies_.state_at(moved.body, time);
    }
    joints.clear();
    if (!memory_.jointed.empty()) {
        const ImpactJoints::View view{world_.rigid.motion, world_.rigid.constants, world_.joints.active,
                                      world_.settings.solver.constraint.joint};
        move_carriers(world_, time);
        joints.set({memory_.jointed, memory_.jointed_joints}, view);
        joints.project(view);
        put_carriers_back(world_);
    }
    for (ImpactMemory::Moved& moved : memory_.bodies) {
        moved.linear_velocity = world_.rigid.motion[moved.body].linear_velocity;
        moved.angular_velocity = world_.rigid.motion[moved.body].angular_velocity;
    }
}

// Solves the collision of the sites.
void ImpactStage::solve(double time, SlidePath path) {
    EMBODY_ZONE("solve impact");
    // To the place of the impact, the collision, and back to the start of the step on the new path.
    gather(time);
    count_assembly();
    go_to(time);
    const ImpactReport report =
        solve_impact_group(memory_.sites, world_.rigid.motion, memory_.group, settings_.solver, path);
    if (!report.converged) {
        world_.report.limits |= static_cast<std::uint32_t>(StepLimit::impact_iterations_exhausted);
    }
    if (world_.ledger) world_.ledger->note_impact(memory_.sites, report.energy_change);
    for (std::size_t i = 0; i < memory_.sites.size(); ++i) {
        const ImpactSite& site = memory_.sites[i];
        if (site.impulse == Vec3{}) continue;
        const BodyState& b = world_.rigid.motion[site.b];
        const Vec3 center = b.inverse_mass > 0 ? b.center : bodies_.kept_state_at(site.b, time).center;
        note_impulse(world_.contacts.list[memory_.site_contact[i]], site.arm_b + center, site.impulse, time);
    }
    note_joint_impulses();
    go_back(time);
}

void ImpactStage::note_joint_impulses() {
    if (memory_.jointed.empty()) return;
    memory_.pushes.clear();
    for (const ImpactSite& site : memory_.sites) {
        if (site.impulse == Vec3{}) continue;
        memory_.pushes.push_back({site.a, -site.impulse, site.arm_a});
        memory_.pushes.push_back({site.b, site.impulse, site.arm_b});
    }
    memory_.group.joints.add_to_totals(memory_.pushes, {world_.rigid.motion, world_.rigid.constants,
                                                        world_.joints.active, world_.settings.solver.constraint.joint});
}

void ImpactStage::go_back(double time) {
    for (ImpactMemory::Moved& moved : memory_.bodies) {
        const BodyState& state = world_.rigid.motion[moved.body];
        moved.has_changed =
            state.linear_velocity != moved.linear_velocity || state.angular_velocity != moved.angular_velocity;
    }
    const ImpactJoints& joints = memory_.group.joints;
    const auto is_changed = [&](const ImpactMemory::Moved& m) {
        return m.has_changed && joints.number_of(m.body) >= 0;
    };
    const bool joints_answer = std::any_of(memory_.bodies.begin(), memory_.bodies.end(), is_changed);
    if (memory_.is_flown && joints_answer) fly_jointed(world_, -time);
    for (const ImpactMemory::Moved& moved : memory_.bodies) {
        const BodyState state = world_.rigid.motion[moved.body];
        world_.rigid.motion[moved.body] = moved.start;
        if (!moved.has_changed) continue;
        if (joints.number_of(moved.body) < 0) {
            bodies_.lead_through(moved.body, state, time);
        } else if (memory_.is_flown) {
            bodies_.begin_anew(moved.body, state);
        } else {
            bodies_.change_velocities(moved.body, state.linear_velocity - moved.linear_velocity,
                                      state.angular_velocity - moved.angular_velocity, time);
        }
        memory_.last_time[moved.body] = time;
    }
}

// Whether the contact may bounce once more.
bool ImpactStage::count_impact(std::uint32_t contact) {
    std::uint8_t& count = memory_.impacts[contact];
    const bool may_bounce = count < settings_.budget.max_bounces && paths_.bounces(world_.contacts.list[contact]);
    if (count < settings_.budget.max_impacts) ++count;
    return may_bounce;
}

// Adds the sites of the contact, whose region is `manifold`, and of the contacts that come down with it. Returns
// whether it bounces.
bool ImpactStage::add_region(std::uint32_t contact, const Manifold& manifold, double time) {
    const bool may_bounce = count_impact(contact);
    regions_.add_manifold_sites(world_.contacts.list[contact], manifold, time, may_bounce);
    memory_.site_contact.resize(memory_.sites.size(), contact);
    if (!may_bounce) return false;
    regions_.add_sites_beside(contact, manifold, time, [this](std::uint32_t other) { return count_impact(other); });
    paths_.note_bounce(world_.contacts.list[contact]);
    return true;
}

// Whether the contact, of a body that takes part, collides at this instant, too; if so, adds its sites.
bool ImpactStage::joins_in(std::uint32_t contact, double time) {
    const double latest = time + settings_.budget.simultaneous_fraction * step_;
    const auto& known = memory_.site_contact;
    double own_time = memory_.next_time[contact];
    if (own_time > latest || !paths_.bounces(world_.contacts.list[contact])) return false;
    if (std::find(known.begin(), known.end(), contact) != known.end()) return false;
    Manifold manifold;
    if (!regions_.refine(world_.contacts.list[contact], own_time, manifold) || own_time > latest) return false;

    // Its event is void.
    ++memory_.version[contact];
    memory_.next_time[contact] = ImpactPaths::never;
    add_region(contact, manifold, time);
    return true;
}

// Impacts of the same instant on the same bodies are one collision: one after the other, the first would turn what is
// symmetric. Balls that touch in a row still pass the impact on one by one: the next ones begin to approach by it.
void ImpactStage::add_simultaneous(double time) {
    memory_.bodies.clear();
    list_bodies(0);
    for (std::size_t i = 0; i < memory_.bodies.size(); ++i) {
        const std::uint32_t body = memory_.bodies[i].body;
        for (std::uint32_t k = memory_.first_of_body[body]; k < memory_.first_of_body[body + 1]; ++k) {
            if (memory_.sites.size() >= settings_.budget.max_simultaneous_sites) return;
            const std::size_t known = memory_.sites.size();
            if (joins_in(memory_.of_body[k], time)) list_bodies(known);
        }
    }
}

// Solves the next impact, if its place and time are accurate; else it is queued again with better ones.
void ImpactStage::take(const ImpactEvent& event) {
    Contact& contact = world_.contacts.list[event.contact];
    if (is_left_to_contacts(contact)) return;
    double time = event.time;
    Manifold manifold;
    const bool in_pile = paths_.hits_pile(contact), is_rough = in_pile && !paths_.bounces(contact);
    const bool as_found = is_rough && regions_.is_near(contact, time);
    if (!as_found) {
        if (!regions_.refine(contact, time, manifold)) {
            // The surfaces pass each other: the region found at the start must not stop the bodies.
            if (regions_.is_open_at_end(contact)) {
                paths_.leave_open(contact);
                memory_.is_open[event.contact] = 1;
            }
            return;
        }
        const double tolerance = in_pile ? settings_.budget.pile_order_fraction * step_ : time_rounding;
        if (!memory_.events.empty() && time > memory_.events.front().time + tolerance) {
            ++memory_.version[event.contact];
            push(time, event.contact);
            return;
        }
    }
    list_contacts();
    memory_.sites.clear();
    memory_.site_contact.clear();
    if (as_found) {
        count_impact(event.contact);
        regions_.add_point_sites(contact, time);
        memory_.site_contact.assign(memory_.sites.size(), event.contact);
    } else if (add_region(event.contact, manifold, time)) {
        add_simultaneous(time);
    }
    solve(time, in_pile ? SlidePath::estimated : SlidePath::followed);
    predict_again();
}

// What the moved bodies touch next.
void ImpactStage::predict_again() {
    for (const ImpactMemory::Moved& moved : memory_.bodies) {
        if (!moved.has_changed) continue;
        if (paths_.turns_far(moved.body)) bodies_.remember({&moved.body, 1});
        for (std::uint32_t k = memory_.first_of_body[moved.body]; k < memory_.first_of_body[moved.body + 1]; ++k) {
            const std::uint32_t other = memory_.of_body[k];
            const ContactSummary& summary = world_.contacts.summaries[other];
            if (summary.was_touching && !summary.bounces) continue;
            ++memory_.version[other];
            predict(other);
        }
    }
}

// Joints take the bodies that they hold off their free paths. Contacts of these are open if they carried nothing and
// the surfaces stay apart on paths that joints change as in the last step, even if that change is wrong by a tenth.
void ImpactStage::open_jointed_contacts() {
    if (world_.joints.active.empty()) return;
    for (std::uint32_t i = 0; i < world_.contacts.list.size(); ++i) {
        const Contact& contact = world_.contacts.list[i];
        if (!memory_.has_jointed_path[contact.a] && !memory_.has_jointed_path[contact.b]) continue;
        memory_.is_open[i] = !contact.was_loaded && keeps_apart_when_held(contact) ? 1 : 0;
    }
}

bool ImpactStage::keeps_apart_when_held(const Contact& contact) const {
    using HeldAcceleration = ImpactMemory::HeldAcceleration;
    const auto held = [&](std::uint32_t body) {
        const bool is_held = memory_.has_jointed_path[body] && body < memory_.held_accelerations.size();
        if (!is_held) return HeldAcceleration{};
        HeldAcceleration now = memory_.held_accelerations[body];

        // The path of a carried body is that without its weight.
        now.linear =
            to_vec3f(Vec3(now.linear) + world_.rigid.constants[body].acceleration - bodies_.free_acceleration(body));
        return now;
    };
    const HeldAcceleration a = held(contact.a), b = held(contact.b);
    const double closing = dot(contact.normal, Vec3(a.linear) - Vec3(b.linear)) +
                           settings_.held_acceleration_tolerance * (length(Vec3(a.linear)) + length(Vec3(b.linear))) +
                           a.turning + b.turning;
    const double start = paths_.earliest_time(contact), time = step_ - start;
    const ImpactPaths::Gaps first = paths_.gaps_at(contact, start), last = paths_.gaps_at(contact, step_);
    for (std::size_t k = 0; k < static_cast<std::size_t>(contact.count); ++k) {
        const bool begins_apart = first[k].size > settings_.touch_gap || first[k].rate > closing * time;
        if (!begins_apart || last[k].size <= closing * time * time / 2) return false;
    }
    return true;
}

void ImpactStage::run() {
    const std::size_t count = world_.contacts.list.size();
    memory_.version.assign(count, 0);
    memory_.next_time.assign(count, ImpactPaths::never);
    memory_.is_open.assign(count, 0);
    memory_.impacts.assign(count, 0);
    memory_.events.clear();
    memory_.has_lists = memory_.has_joint_lists = false;
    predict_all();
    std::size_t left = settings_.budget.events_per_contact * count;
    while (!memory_.events.empty()) {
        const ImpactEvent event = memory_.events.front();
        std::pop_heap(memory_.events.begin(), memory_.events.end(), std::greater<>());
        memory_.events.pop_back();
        if (event.version != memory_.version[event.contact]) continue;
        if (left-- == 0) {
            world_.report.limits |= static_cast<std::uint32_t>(StepLimit::impact_iterations_exhausted);
            break;
        }
        memory_.next_time[event.contact] = ImpactPaths::never;
        take(event);
    }
    open_jointed_contacts();
}

}  // namespace

void solve_impacts(const ImpactAccess& world) {
    if (!world.contacts.list.empty()) ImpactStage(world).run();
}

}  // namespace embody::physics::stages
