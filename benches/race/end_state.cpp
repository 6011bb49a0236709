// SPDX-License-Identifier: MIT
#include "benches/race/end_state.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace embody::race {
namespace {

// A top cube that is half a cube lower has fallen; an overlap of a tenth of a cube is more than a contact.
constexpr double fallen_depth = 0.5;      // m
constexpr double greatest_overlap = 0.1;  // m
constexpr double energy_tolerance = 1e-3;

// A structure that stands has come to rest after so many frames; then its cubes' mean speed is below `rest_speed`.
constexpr int frames_to_rest = 300;
constexpr double rest_speed = 0.05;  // m/s

double potential_energy(const RaceBody& body, Vec3 position) { return body.mass * race_gravity * position.y; }

}  // namespace

RunWatch::RunWatch(const RaceScene& scene) : scene_(scene), bodies_(scene.bodies) {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        if (bodies_[i].position.y > bodies_[top_body_].position.y) top_body_ = i;
        energy_given_ += potential_energy(bodies_[i], bodies_[i].position);
    }
}

double RunWatch::kinetic_energy(const RaceBody& body, const BodyState& state) const {
    const RaceShape& shape = scene_.shapes[body.shape];
    const Vec3 spin = rotate_inverse(state.rotation, state.angular_velocity);
    const Vec3 angular_momentum = body.mass / shape.volume * (shape.inertia * spin);
    return 0.5 * (body.mass * length_squared(state.velocity) + dot(spin, angular_momentum));
}

bool RunWatch::stands(const RaceEngine& engine) const {
    return engine.state(top_body_).position.y >= scene_.bodies[top_body_].position.y - fallen_depth;
}

bool RunWatch::must_stand() const { return scene_.stands_until && *scene_.stands_until >= frames_; }

void RunWatch::before_frame(int frame, const RaceEngine& engine) {
    frames_ = frame + 1;
    if (scene_.stands_until && frame == *scene_.stands_until) fell_early_ = !stands(engine);
}

void RunWatch::before_event(const RaceEvent& event, const RaceEngine& engine) {
    if (event.spawned) {
        const RaceBody& body = *event.spawned;
        bodies_.push_back(body);
        energy_given_ += kinetic_energy(body, {.velocity = body.velocity}) + potential_energy(body, body.position);
        return;
    }
    BodyState state = engine.state(event.body);
    const double before = kinetic_energy(bodies_[event.body], state);
    state.velocity = event.velocity;
    energy_given_ += kinetic_energy(bodies_[event.body], state) - before;
}

EndState RunWatch::finish(const RaceEngine& engine) const {
    EndState end;
    std::vector<BodyState> states;
    double top = -1e300;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        states.push_back(engine.state(i));
        end.kinetic_energy += kinetic_energy(bodies_[i], states[i]);
        end.potential_energy += potential_energy(bodies_[i], states[i].position);
        top = std::max(top, states[i].position.y);
    }
    // After a hit the height of a structure has no meaning.
    const bool was_hit = scene_.stands_until && !must_stand();
    if (scene_.true_top && !was_hit) end.top_gap = top - *scene_.true_top;
    end.overlap = measure_overlap(scene_, bodies_, states);
    end.asleep = engine.count_asleep();
    end.wrong = judge(end, stands(engine));
    return end;
}

std::string RunWatch::judge(const EndState& end, bool standing) const {
    const double energy = end.kinetic_energy + end.potential_energy;
    if (!std::isfinite(energy)) return "not finite";
    if (end.overlap.escaped > 0) return fmt::format("{} escaped", end.overlap.escaped);
    if (fell_early_) return "fell before it was hit";
    if (must_stand() && !standing) return "fell";
    double mass = 0;
    for (const RaceBody& body : bodies_) mass += body.mass;
    if (must_stand() && frames_ >= frames_to_rest && end.kinetic_energy > 0.5 * mass * rest_speed * rest_speed)
        return "still moving";
    const double deepest = std::max(end.overlap.bodies, end.overlap.statics);
    if (deepest > greatest_overlap) return fmt::format("overlap {:.2f} m", deepest);
    if (energy > energy_given_ + energy_tolerance * std::fabs(energy_given_)) return "gained energy";
    return {};
}

}  // namespace embody::race
