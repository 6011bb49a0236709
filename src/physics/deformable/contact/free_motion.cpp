// SPDX-License-Identifier: MIT
#include "physics/deformable/contact/free_motion.h"

#include <algorithm>

namespace embody::physics::deformable {

void keep_momenta(std::span<const FreePart> parts, double h, const ThinContactSettings& settings) {
    constexpr double line_inertia = 1e-9;  // of the whole inertia: rounding leaves 1e-15 of it about a straight line
    // Calls `use` with mass (kg), place (m), momentum with what is given (N s) and move of each node.
    const auto for_each_node = [&](auto&& use) {
        for (const FreePart& part : parts) {
            const Nodes& nodes = *part.nodes;
            for (std::size_t i = 0; i < nodes.size(); ++i)
                use(nodes.mass[i], nodes.position[i], nodes.mass[i] * nodes.mean_velocity[i] + part.given[i],
                    part.moves[i]);
        }
    };
    double mass = 0;
    Vec3 momentum, moved, center;
    for_each_node([&](double m, Vec3 position, Vec3 of_node, Vec3 move) {
        mass += m;
        center += m * position;
        momentum += of_node;
        moved += m / h * move;
    });
    center = center / mass;
    Vec3 angular;
    for_each_node([&](double, Vec3 position, Vec3 of_node, Vec3) { angular += cross(position - center, of_node); });
    const Vec3 mean = momentum / mass, shift = (h / mass) * (momentum - moved), new_center = center + h * mean;
    for_each_node([&](double, Vec3, Vec3, Vec3& move) { move += shift; });
    // The turn changes the arms, too, so it takes some iterations.
    for (int iteration = 0; iteration < settings.momentum_iterations; ++iteration) {
        Mat3 inertia = Mat3::zero();
        Vec3 missing = angular;
        for_each_node([&](double m, Vec3 position, Vec3, Vec3 move) {
            const Vec3 arm = position + move - new_center;
            missing -= m * cross(arm, move / h - mean);
            inertia += m * (length_squared(arm) * Mat3::identity() - outer(arm, arm));
        });
        // A straight line has no inertia about itself.
        inertia += line_inertia * trace(inertia) * Mat3::identity();
        const Vec3 spin = solve(inertia, missing);
        if (!is_finite(spin) || length(spin) * h > settings.max_momentum_turn) return;
        for_each_node(
            [&](double, Vec3 position, Vec3, Vec3& move) { move += h * cross(spin, position + move - new_center); });
    }
}

std::vector<Vec3> impulses_of_flow(const Nodes& nodes, std::span<const Vec3> moves, const Substep& substep) {
    std::vector<Vec3> impulses(nodes.flow.size());
    for (std::size_t i = 0; i < impulses.size(); ++i) {
        if (nodes.inverse_mass[i] > 0)
            impulses[i] = substep.h * nodes.flow[i].force(moves[i] / substep.h, substep.time + substep.h);
    }
    return impulses;
}

double flow_energy(const NodeFlow& flow, Vec3 move, const Substep& substep) {
    const Vec3 beyond = move - substep.h * flow.expected_velocity(substep.time + substep.h);
    return dot(scale(flow.drag, beyond), beyond) / (2 * substep.h);
}

double WholeMotion::inverse_mass_at(Vec3 place, Vec3 n) const {
    const Vec3 turning = cross(place - center, n);
    return 1 / mass + dot(turning, solve(inertia, turning));
}

void WholeMotion::strike(Vec3 impulse, Vec3 place) {
    velocity += impulse / mass;
    spin += solve(inertia, cross(place - center, impulse));
}

WholeMotion motion_of_whole(const Nodes& nodes) {
    double mass = 0;
    Vec3 center, momentum, turning;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        mass += nodes.mass[i];
        center += nodes.mass[i] * nodes.position[i];
        momentum += nodes.mass[i] * nodes.mean_velocity[i];
    }
    center = center / mass;
    Mat3 inertia = Mat3::zero();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Vec3 arm = nodes.position[i] - center;
        turning += cross(arm, nodes.mass[i] * nodes.mean_velocity[i]);
        inertia += nodes.mass[i] * (length_squared(arm) * Mat3::identity() - outer(arm, arm));
    }
    return {momentum / mass, solve(inertia, turning), mass, center, inertia};
}

void change_substep(Nodes& nodes, double h, Vec3 acceleration, bool is_free) {
    const double last = nodes.substep, back = (h - last) / 2;
    nodes.substep = h;
    const auto rests = [&] { return std::ranges::all_of(nodes.mean_velocity, [](Vec3 v) { return v == Vec3{}; }); };
    if (back == 0 || (last > 0 ? !is_free : rests())) return;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (nodes.inverse_mass[i] > 0) nodes.mean_velocity[i] -= back * acceleration;
    }
}

void set_velocities(Nodes& nodes, std::span<const Vec3> moves, double h) {
    double mass = 0;
    Vec3 change;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        mass += nodes.mass[i];
        change += nodes.mass[i] * (moves[i] / h - nodes.mean_velocity[i]);
    }
    const Vec3 half = change / (2 * mass);
    nodes.substep = h;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        nodes.mean_velocity[i] = moves[i] / h;
        nodes.velocity[i] = nodes.inverse_mass[i] > 0 ? nodes.mean_velocity[i] + half : Vec3{};
    }
}

}  // namespace embody::physics::deformable
