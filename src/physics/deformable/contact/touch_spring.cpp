// SPDX-License-Identifier: MIT
#include "physics/deformable/contact/touch_spring.h"

#include <algorithm>
#include <cmath>

namespace embody::physics::deformable {

namespace {

// Friction: k (hold + slip) up to its limit. Beyond it, the secant through that limit at the expected slip, which can
// only stop sliding; where the slip is so long that friction cannot end it in this substep, the limit itself. The
// expected slip of a sticking point, and of every one where the solves are few (predicts_slip), is that of the point
// alone with the limit instead of the larger force that it had.
// A point that stuck in the last substep sticks up to the static limit. Returns the change of the force, N.
double choose_friction(TouchSpring& spring, Vec3 s, double load, bool is_predicted) {
    constexpr double stuck_fraction = 0.99;  // of k times the stretch: below it the force was that of a secant
    double limit = spring.friction.coefficient(spring.sticks) * load;
    const double inertia = spring.inertia / (1 + spring.inertia * spring.body_compliance);  // that slips
    const Mat3 plane = Mat3::identity() - outer(spring.normal, spring.normal);
    const Vec3 loose = spring.hold - across(spring.carried, spring.normal);  // stretch with s = 0
    const Vec3 stretch = loose + across(s, spring.normal), force = across(spring.force(s), spring.normal);
    const double size = length(stretch);
    const double excess = length(force) - limit;
    const bool has_stuck = length(force) > stuck_fraction * spring.stiffness * size;
    const double expected =
        !is_predicted && (has_stuck || spring.predicts_slip) && excess > 0 ? size + excess / inertia : size;
    const bool sticks = limit > 0 && spring.stiffness * expected <= limit;
    if (!sticks) limit = spring.friction.sliding * load;
    const double tangent = sticks ? spring.stiffness : limit > 0 ? limit / expected : 0;
    spring.matrix = tangent * plane;
    spring.load = -tangent * loose;
    if (!sticks && inertia * expected > 2 * limit && size > 0) {
        const Vec3 displacement = stretch / size;
        spring.load -= (limit - tangent * dot(displacement, loose)) * displacement;
        spring.matrix = spring.matrix - tangent * outer(displacement, displacement);
    }
    return length(force - (spring.load - spring.matrix * s));
}

}  // namespace

void choose_contact(TouchSpring& spring, Vec3 s, bool is_predicted, SpringChange& sum) {
    const double push_before = dot(spring.pull, spring.normal);
    const double depth = -(spring.gap + dot(spring.normal, s)), push = push_before + spring.stiffness * depth;
    const bool is_new = !spring.acts;
    if (is_new != (push <= 0)) sum.change += std::fabs(push);
    // Only a solve releases a contact that pushed in the last substep: by the stiff spring every tiny move would be a
    // separation.
    spring.acts = push > 0 || (is_predicted && push_before > 0);
    // For a contact that does not touch: the force that would bring the point there alone.
    sum.near += spring.acts ? std::fabs(push) : std::min(std::fabs(push), spring.inertia * std::fabs(depth));
    if (!spring.acts) {
        spring.matrix = Mat3::zero();
        spring.load = {};
        return;
    }
    sum.acting += std::fabs(push);
    // For a point that was not held back the depth determines the force that stops it, not the force of the spring.
    const double expected = is_predicted ? push_before + spring.stiffness * spring.returned
                            : is_new     ? push_before + spring.inertia * depth
                                         : push;
    sum.change += choose_friction(spring, s, expected, is_predicted);
    spring.matrix += spring.stiffness * outer(spring.normal, spring.normal);
    spring.load += (push_before - spring.stiffness * spring.gap) * spring.normal;
}

Vec3 held_stretch(TouchSpring& spring, Vec3 stretch, double push, double h) {
    const double size = length(stretch);
    const double most = spring.friction.coefficient(spring.sticks) * push / spring.stiffness;
    spring.sticks = size - most <= PairFriction::stribeck_speed * h;
    return size > most ? (most / size) * stretch : stretch;
}

double contact_stiffness(double mass, double force, double h, double gravity, const ThinContactSettings& settings) {
    const double carried = gravity > 0 ? force / gravity : 0;
    return std::max(settings.stiffness_factor * mass, settings.load_stiffness_factor * carried) / (h * h);
}

double kept_push(const TouchSpring& spring, double push) {
    return std::max(0.0, push - spring.stiffness * spring.returned);
}

std::vector<BodyInertia> inertias_of(std::span<const TouchedBody> bodies, double h) {
    std::vector<BodyInertia> inertias;
    for (const TouchedBody& body : bodies) {
        BodyInertia inertia;
        if (body.inverse_mass > 0) {
            // Fixed axes get a million times the inertia of the freest one; where none turns, that of a mass at a
            // million metres: both keep the inverse finite.
            constexpr double of_freest = 1e-6, of_inverse_mass = 1e-12;  // the latter in 1/m²
            const Mat3& inverse = body.inverse_inertia;
            const double least = std::max(of_freest * trace(inverse), of_inverse_mass * body.inverse_mass);
            inertia = {true, 1 / (body.inverse_mass * h * h),
                       (1 / (h * h)) * inverse_or_zero(inverse + least * Mat3::identity())};
        }
        inertias.push_back(inertia);
    }
    return inertias;
}

Vec3 TouchSpring::lead(std::span<const Vec3> node_moves, std::span<const BodyMove> body_moves) const {
    Vec3 s;
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) s += weight[k] * node_moves[node[k]];
    if (body != no_body) s -= body_moves[body].shift + cross(body_moves[body].turn, arm);
    return s;
}

double energy_of(const TouchSpring& spring, std::span<const Vec3> node_moves, std::span<const BodyMove> body_moves) {
    if (!spring.acts) return 0;
    const Vec3 s = spring.lead(node_moves, body_moves);
    return 0.5 * dot(s, spring.matrix * s) - dot(spring.load, s);
}

double energy_pressed(const TouchSpring& spring, std::span<const Vec3> node_moves,
                      std::span<const BodyMove> body_moves) {
    if (spring.is_attachment) return energy_of(spring, node_moves, body_moves);
    const double depth = -(spring.gap + dot(spring.normal, spring.lead(node_moves, body_moves)));
    const double push = std::max(0.0, dot(spring.pull, spring.normal) + spring.stiffness * depth);
    return push * push / (2 * spring.stiffness);
}

double energy_of(const BodyInertia& inertia, const BodyMove& move) {
    if (!inertia.moves) return 0;
    return inertia.mass / 2 * length_squared(move.shift) + 0.5 * dot(move.turn, inertia.inertia * move.turn);
}

std::vector<double> fractions_of(std::span<const TouchSpring> springs, std::span<const Vec3> node_moves,
                                 std::span<const BodyMove> body_moves, std::span<const BodyInertia> inertias,
                                 const Substep& substep) {
    const double most = substep.settings.thin_contact.max_energy_ratio;  // times the energy of the body's move
    const double slow_push = substep.settings.thin_contact.free_push_speed, h = substep.h;
    std::vector<BodyMove> pushes(inertias.size());
    for (const TouchSpring& spring : springs) {
        if (!spring.acts || !moves_body(spring, inertias)) continue;
        const Vec3 force = spring.force(spring.lead(node_moves, body_moves));
        pushes[spring.body].shift -= force;
        pushes[spring.body].turn -= cross(spring.arm, force);
    }
    std::vector<double> fractions(inertias.size(), 1);
    for (std::size_t b = 0; b < inertias.size(); ++b) {
        if (!inertias[b].moves) continue;
        const auto& [force, torque] = pushes[b];
        const double pushed = length_squared(force) / (2 * inertias[b].mass) +
                              0.5 * dot(torque, inverse_or_zero(inertias[b].inertia) * torque);
        const double moved = energy_of(inertias[b], body_moves[b]);
        const double small = 0.5 * inertias[b].mass * slow_push * slow_push * h * h;
        if (pushed > most * moved + small) fractions[b] = std::sqrt(moved / pushed);
    }
    return fractions;
}

}  // namespace embody::physics::deformable
