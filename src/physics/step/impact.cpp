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
#include <algorithm>
#include <cmath>
#include <queue>

#include "physics/constraint/impact_group.h"
#include "physics/dynamic/equations_of_motion.h"
#include "physics/step/step.h"

namespace embody::physics {

namespace {

constexpr double never = 1e300;
constexpr double touch_gap = 1e-6;       // m: bodies this near touch
constexpr double patch_gap = 5e-4;       // m: corners this near to the first one collide together with it
constexpr int most_bounces = 3;          // of one contact in a step; later impacts do not bounce (Zeno's ball)
constexpr int most_impacts = 5;          // of one contact in a step; then the contact solver stops it
constexpr double slowest_impact = 0.02;  // m/s: slower contacts rest

// A predicted impact. Outdated once one of the bodies has had another one (its version has moved on).
struct Event {
    double time;
    std::uint32_t contact;
    std::uint32_t version;
    bool operator>(const Event& other) const {
        return time != other.time ? time > other.time : contact > other.contact;
    }
};

class ImpactStage {
public:
    explicit ImpactStage(WorldState& world)
        : world_(world), step_(world.settings.time_step), substep_(step_ / world.settings.substeps) {}

    void run();

private:
    struct Gap {
        double size, rate;  // m, m/s
    };
    Gap gap_at(const Contact& contact, const ContactPoint& point, double time) const;
    double touch_time(const Contact& contact, const ContactPoint& point, double start) const;
    double next_impact(const Contact& contact) const;
    void leave_open_points(Contact& contact, bool pass);
    bool is_open_at_end(const Contact& contact);
    double slowest_speed(const Contact& contact, double acceleration) const;
    Vec3 free_acceleration(std::uint32_t body) const;
    double earliest_time(const Contact& contact) const;
    bool is_slow(const Contact& contact) const;
    void prepare();
    void push(std::uint32_t contact);
    bool refine(const Contact& contact, double& time, Manifold& manifold);
    void collide_at(const Contact& contact, double time, std::vector<Manifold>& manifolds) const;
    Transform pose_at(std::uint32_t body, double time) const;
    Vec3 center_at(std::uint32_t body, double time) const;
    void handle(std::uint32_t contact, double time, const Manifold& manifold);
    void add_manifold_sites(const Contact& contact, const Manifold& manifold, double time, bool may_bounce);
    void add_loaded_neighbours(std::uint32_t contact, double time);
    void note_impulse(Contact& contact, Vec3 position, Vec3 impulse, double time);

    WorldState& world_;
    const double step_, substep_;
    std::vector<double> last_time_;               // by body: its last impact in this step, s
    std::vector<std::uint8_t> is_supported_;      // by body: a contact carried it in the last step
    std::vector<std::uint32_t> first_, of_body_;  // contacts of each body
    std::vector<std::uint32_t> version_;          // by contact
    std::vector<std::uint8_t> impacts_;           // by contact, in this step
    std::priority_queue<Event, std::vector<Event>, std::greater<>> events_;
    std::vector<ImpactSite> sites_;
    std::vector<std::uint32_t> site_contact_;  // contact of each site
    std::vector<Manifold> manifolds_;
};

// What carries a body cancels its weight: only bodies in free motion gain speed before the impact.
Vec3 ImpactStage::free_acceleration(std::uint32_t body) const {
    return world_.motion[body].inverse_mass > 0 && !is_supported_[body] ? world_.constants[body].acceleration : Vec3{};
}

double ImpactStage::earliest_time(const Contact& contact) const {
    return std::max(last_time_[contact.a], last_time_[contact.b]);
}

// Classification (paper, eq. 4): slower contacts rest. Loaded ones and ones that do not bounce must be far faster to
// count as a collision: the contact solver stops them as well. If they also touch already there is none to come.
double ImpactStage::slowest_speed(const Contact& contact, double acceleration) const {
    const bool bounces = contact.material.restitution > 0;
    if (contact.was_touching && !bounces) return never;
    const double slowest = std::max(slowest_impact, 2 * std::fabs(acceleration) * substep_);
    return contact.was_loaded || !bounces ? 5 * slowest : slowest;
}

// Gap and its rate at `time`, the turning of the bodies included: a foot of a spinning chair does not move straight.
ImpactStage::Gap ImpactStage::gap_at(const Contact& contact, const ContactPoint& point, double time) const {
    const auto move = [&](std::uint32_t body, Vec3 arm, bool is_round, Vec3& velocity) {
        const BodyState& state = world_.motion[body];
        const Quat turn = normalized(cayley(state.angular_velocity * time) * state.turn);
        const Vec3 turned = is_round ? arm : rotate(turn, arm);
        velocity = state.linear_velocity + free_acceleration(body) * time + cross(state.angular_velocity, turned);
        const Vec3 by_turning = is_round ? cross(state.angular_velocity * time, arm) : turned - arm;
        return center_at(body, time) - state.start_center + by_turning;
    };
    Vec3 velocity_a, velocity_b;
    const Vec3 move_a = move(contact.a, point.arm_a, contact.a_is_round, velocity_a);
    const Vec3 move_b = move(contact.b, point.arm_b, contact.b_is_round, velocity_b);
    return {point.separation + dot(contact.normal, move_b - move_a), dot(contact.normal, velocity_b - velocity_a)};
}

// The first time at which the point touches, `never` if it does not within the step.
double ImpactStage::touch_time(const Contact& contact, const ContactPoint& point, double start) const {
    const Gap first = gap_at(contact, point, start);
    if (first.size <= touch_gap) return start;
    const Gap last = gap_at(contact, point, step_);
    if (last.size > 0) {
        // Open at both ends; a parabola that opens upwards may dip through in between.
        const double acceleration = step_ > start ? (last.rate - first.rate) / (step_ - start) : 0;
        const double discriminant = first.rate * first.rate - 2 * acceleration * first.size;
        if (first.rate >= 0 || discriminant < 0) return never;
        const double time = start + 2 * first.size / (-first.rate + std::sqrt(discriminant));
        return time <= step_ ? time : never;
    }

    // Closed at the end: the root between, by the regula falsi (Illinois).
    double low = start, high = step_, at_low = first.size, at_high = last.size;
    double time = high;
    for (int i = 0; i < 8; ++i) {
        time = low + (high - low) * at_low / (at_low - at_high);
        const double gap = gap_at(contact, point, time).size;
        if (std::fabs(gap) < touch_gap) break;
        (gap > 0 ? low : high) = time;
        (gap > 0 ? at_low : at_high) = gap;
        (gap > 0 ? at_high : at_low) /= 2;
    }
    return time;
}

// The first time at which a point of the contact closes fast enough to be an impact; `never` if none does.
double ImpactStage::next_impact(const Contact& contact) const {
    const double start = earliest_time(contact);
    const double slowest = slowest_speed(contact, dot(contact.normal, world_.settings.gravity));
    double first = never;
    if (slowest == never) return never;
    for (int i = 0; i < contact.count; ++i) {
        const ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
        const double time = touch_time(contact, point, start);
        if (time < first && gap_at(contact, point, time).rate < -slowest) first = time;
    }
    return first;
}

void ImpactStage::prepare() {
    const auto& contacts = world_.contacts;
    is_supported_.assign(world_.motion.size(), 0);
    for (const Contact& contact : contacts) {
        if (contact.was_loaded) is_supported_[contact.a] = is_supported_[contact.b] = 1;
    }
    last_time_.assign(world_.motion.size(), 0);
    version_.assign(contacts.size(), 0);
    impacts_.assign(contacts.size(), 0);
    first_.assign(world_.motion.size() + 1, 0);
    for (const Contact& contact : contacts) {
        ++first_[contact.a + 1];
        ++first_[contact.b + 1];
    }
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    of_body_.resize(2 * contacts.size());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t i = 0; i < contacts.size(); ++i) {
        of_body_[next[contacts[i].a]++] = i;
        of_body_[next[contacts[i].b]++] = i;
    }
}

// Whether no point can close as fast as an impact does: most contacts of a heap at rest, told without a root search.
bool ImpactStage::is_slow(const Contact& contact) const {
    if (earliest_time(contact) > 0) return false;
    const double slowest = slowest_speed(contact, dot(contact.normal, world_.settings.gravity));
    if (slowest == never) return true;
    double gain = 0;
    for (const std::uint32_t body : {contact.a, contact.b}) {
        const double turning = length_squared(world_.motion[body].angular_velocity) * world_.record(body).reach;
        gain += step_ * (length(free_acceleration(body)) + turning);
    }
    return contact.approach_speed + gain < slowest;
}

void ImpactStage::push(std::uint32_t contact) {
    if (impacts_[contact] >= most_impacts || is_slow(world_.contacts[contact])) return;
    const double time = next_impact(world_.contacts[contact]);
    if (time <= step_) events_.push({time, contact, version_[contact]});

    leave_open_points(world_.contacts[contact], false);
}

// What closes fast but meets after this step is the next step's impact: the substeps must not brake it before. Tells by
// the path of each point, unless the surfaces are known to `pass` each other.
void ImpactStage::leave_open_points(Contact& contact, bool pass) {
    const double slowest = slowest_speed(contact, dot(contact.normal, world_.settings.gravity));
    if (slowest == never) return;
    for (int i = 0; i < contact.count; ++i) {
        ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
        const Gap now = gap_at(contact, point, 0);
        const bool stays_open = now.size > 0 && (pass || gap_at(contact, point, step_).size > 0);
        if (now.rate < -slowest && stays_open) {
            point.inactive_until = static_cast<float>(step_);
        } else if (point.inactive_until >= static_cast<float>(step_)) {
            point.inactive_until = 0;
        }
    }
}

Vec3 ImpactStage::center_at(std::uint32_t body, double time) const {
    const BodyState& state = world_.motion[body];
    return state.center + state.linear_velocity * time + free_acceleration(body) * (time * time / 2);
}

Transform ImpactStage::pose_at(std::uint32_t body, double time) const {
    BodyState state = world_.motion[body];
    state.center = center_at(body, time);
    state.rotation = normalized(cayley(state.angular_velocity * time) * state.rotation);
    return body_pose(state, world_.constants[body].local_center);
}

void ImpactStage::collide_at(const Contact& contact, double time, std::vector<Manifold>& manifolds) const {
    manifolds.clear();
    collide(*world_.record(contact.a).shape, pose_at(contact.a, time), *world_.record(contact.b).shape,
            pose_at(contact.b, time), 0.02, manifolds);
}

double least_separation(const Manifold& manifold) {
    double least = never;
    for (int i = 0; i < manifold.count; ++i) {
        least = std::min(least, manifold.points[static_cast<std::size_t>(i)].separation);
    }
    return least;
}

// The contact region at the moment of impact, found at the bodies' places then: the prediction used the normal of the
// start of the step. Follows the closing surfaces (secant) for a few rounds. False: they pass each other.
bool ImpactStage::refine(const Contact& contact, double& time, Manifold& manifold) {
    constexpr int most_rounds = 8;
    const double start = earliest_time(contact);
    for (int round = 0; round < most_rounds; ++round) {
        collide_at(contact, time, manifolds_);
        const Manifold* found = nullptr;
        for (const Manifold& m : manifolds_) {
            if (m.piece_a == contact.piece_a && m.piece_b == contact.piece_b) found = &m;
        }
        if (!found || found->count == 0) return false;
        manifold = *found;

        // Gap and closing speed of the nearest point.
        const double gap = least_separation(manifold);
        double speed = 0;
        for (int i = 0; i < manifold.count; ++i) {
            const ManifoldPoint& point = manifold.points[static_cast<std::size_t>(i)];
            if (point.separation > gap + patch_gap) continue;
            const auto velocity = [&](std::uint32_t body) {
                return velocity_at(world_.motion[body], point.position - center_at(body, time)) +
                       free_acceleration(body) * time;
            };
            speed = std::max(speed, -dot(velocity(contact.b) - velocity(contact.a), manifold.normal));
        }
        if (speed < slowest_impact) return false;
        const bool is_touching = std::fabs(gap) <= touch_gap || (gap < 0 && time <= start);
        if (is_touching || (round + 1 == most_rounds && gap < 10 * patch_gap)) return true;
        time = std::max(start, time + gap / speed);
        if (time > step_) return false;
    }
    return false;
}

// Whether the bodies are apart at the end of the step, if nothing else happens to them.
bool ImpactStage::is_open_at_end(const Contact& contact) {
    collide_at(contact, step_, manifolds_);
    return std::all_of(manifolds_.begin(), manifolds_.end(),
                       [](const Manifold& manifold) { return least_separation(manifold) > 0; });
}

ImpactCoefficients coefficients_of(const Material& material, double restitution) {
    return {material.friction_dynamic, material.friction_static, restitution};
}

// A flat region collides as one patch at its middle and, where it tilts, at its corners.
void ImpactStage::add_manifold_sites(const Contact& contact, const Manifold& manifold, double time, bool may_bounce) {
    const double nearest = least_separation(manifold);
    const auto add = [&](Vec3 position) {
        ImpactSite site;
        site.a = contact.a;
        site.b = contact.b;
        site.arm_a = position - center_at(contact.a, time);
        site.arm_b = position - center_at(contact.b, time);
        site.normal = manifold.normal;
        const Vec3 velocity =
            velocity_at(world_.motion[site.b], site.arm_b) - velocity_at(world_.motion[site.a], site.arm_a);
        const bool bounces = may_bounce && -dot(velocity, site.normal) >= contact.material.restitution_threshold;
        site.coefficients = coefficients_of(contact.material, bounces ? contact.material.restitution : 0);
        sites_.push_back(site);
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

// Loaded contacts of the colliding bodies take part, without a bounce. Others that collide at the same time have their
// own events: one after the other, as the balls of Newton's cradle do it, keeps the energy of elastic bodies.
void ImpactStage::add_loaded_neighbours(std::uint32_t contact, double time) {
    const Contact& first = world_.contacts[contact];
    for (const std::uint32_t body : {first.a, first.b}) {
        if (world_.motion[body].inverse_mass == 0) continue;
        for (std::uint32_t k = first_[body]; k < first_[body + 1]; ++k) {
            const std::uint32_t other = of_body_[k];
            const Contact& c = world_.contacts[other];
            const bool is_known = std::find(site_contact_.begin(), site_contact_.end(), other) != site_contact_.end();
            if (!c.was_loaded || is_known) continue;
            for (int i = 0; i < c.count; ++i) {
                const ContactPoint& point = c.points[static_cast<std::size_t>(i)];
                const double speed = dot(relative_velocity(c, point, world_.motion), c.normal);
                if (current_separation(c, point, world_.motion) + speed * time > patch_gap) continue;
                sites_.push_back(
                    {c.a, c.b, point.arm_a, point.arm_b, c.normal, coefficients_of(c.material, 0), Vec3{}});
                site_contact_.push_back(other);
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

void ImpactStage::handle(std::uint32_t contact, double time, const Manifold& manifold) {
    sites_.clear();
    site_contact_.clear();
    const bool may_bounce = impacts_[contact]++ < most_bounces;
    add_manifold_sites(world_.contacts[contact], manifold, time, may_bounce);
    site_contact_.assign(sites_.size(), contact);
    add_loaded_neighbours(contact, time);

    // Velocities at the time of impact, the collision, and back to the start of the step on the new path.
    std::vector<std::uint32_t> bodies;
    for (const ImpactSite& site : sites_) {
        for (const std::uint32_t body : {site.a, site.b}) {
            if (world_.motion[body].inverse_mass > 0) bodies.push_back(body);
        }
    }
    std::sort(bodies.begin(), bodies.end());
    bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
    std::vector<BodyState> before;
    for (const std::uint32_t body : bodies) {
        world_.motion[body].linear_velocity += free_acceleration(body) * time;
        before.push_back(world_.motion[body]);
    }
    const ImpactReport report = solve_impact_group(sites_, world_.motion);
    if (!report.converged) {
        world_.report.limits |= static_cast<std::uint32_t>(StepLimit::impact_rounds_exhausted);
    }
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        BodyState& state = world_.motion[bodies[i]];
        const bool changed =
            state.linear_velocity != before[i].linear_velocity || state.angular_velocity != before[i].angular_velocity;
        state.center -= (state.linear_velocity - before[i].linear_velocity) * time;
        if (state.angular_velocity != before[i].angular_velocity) {
            state.rotation = normalized(cayley(-time * state.angular_velocity) *
                                        (cayley(time * before[i].angular_velocity) * state.rotation));
            state.turn = state.rotation * conjugate(state.start_rotation);
        }
        state.linear_velocity -= free_acceleration(bodies[i]) * time;
        if (changed) last_time_[bodies[i]] = time;
    }
    for (std::size_t i = 0; i < sites_.size(); ++i) {
        if (sites_[i].impulse == Vec3{}) continue;
        note_impulse(world_.contacts[site_contact_[i]], sites_[i].arm_b + center_at(sites_[i].b, time),
                     sites_[i].impulse, time);
    }

    // What these bodies touch next is to be predicted anew.
    for (const std::uint32_t body : bodies) {
        for (std::uint32_t k = first_[body]; k < first_[body + 1]; ++k) {
            ++version_[of_body_[k]];
            push(of_body_[k]);
        }
    }
}

void ImpactStage::run() {
    if (world_.contacts.empty()) return;
    prepare();
    for (std::uint32_t i = 0; i < world_.contacts.size(); ++i) push(i);
    std::size_t left = 64 + 32 * world_.contacts.size();
    while (!events_.empty()) {
        const Event event = events_.top();
        events_.pop();
        if (event.version != version_[event.contact]) continue;
        if (left-- == 0) {
            world_.report.limits |= static_cast<std::uint32_t>(StepLimit::impact_rounds_exhausted);
            return;
        }
        Contact& contact = world_.contacts[event.contact];
        double time = event.time;
        Manifold manifold;
        if (!refine(contact, time, manifold)) {
            // They pass each other: the region found at the start must not hold them up.
            if (is_open_at_end(contact)) leave_open_points(contact, true);
        } else if (!events_.empty() && time > events_.top().time + 1e-12) {
            ++version_[event.contact];
            events_.push({time, event.contact, version_[event.contact]});
        } else {
            handle(event.contact, time, manifold);
        }
    }
}

}  // namespace

void solve_impacts(WorldState& world) { ImpactStage(world).run(); }

}  // namespace embody::physics
