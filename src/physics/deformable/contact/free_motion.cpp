// SPDX-License-Identifier: MIT
#include "physics/deformable/contact/free_motion.h"

#include "math/mat3.h"

namespace embody::physics::deformable {

void keep_momenta(const Nodes& nodes, std::span<const Vec3> given, double h, const ThinContactSettings& settings,
                  std::span<Vec3> moves) {
    constexpr double line_inertia = 1e-9;  // of the whole inertia: rounding leaves 1e-15 of it about a straight line
    double mass = 0;
    Vec3 momentum, moved, center;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        mass += nodes.mass[i];
        center += nodes.mass[i] * nodes.position[i];
        momentum += nodes.mass[i] * nodes.mean_velocity[i] + given[i];
        moved += nodes.mass[i] / h * moves[i];
    }
    center = center / mass;
    Vec3 angular;
    for (std::size_t i = 0; i < nodes.size(); ++i)
        angular += cross(nodes.position[i] - center, nodes.mass[i] * nodes.mean_velocity[i] + given[i]);
    const Vec3 mean = momentum / mass, shift = (h / mass) * (momentum - moved), new_center = center + h * mean;
    for (Vec3& move : moves) move += shift;
    // The turn changes the arms, too, so it takes some iterations.
    for (int iteration = 0; iteration < settings.momentum_iterations; ++iteration) {
        Mat3 inertia = Mat3::zero();
        Vec3 missing = angular;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const Vec3 arm = nodes.position[i] + moves[i] - new_center;
            missing -= nodes.mass[i] * cross(arm, moves[i] / h - mean);
            inertia += nodes.mass[i] * (length_squared(arm) * Mat3::identity() - outer(arm, arm));
        }
        // A straight line has no inertia about itself.
        inertia += line_inertia * trace(inertia) * Mat3::identity();
        const Vec3 spin = solve(inertia, missing);
        if (!is_finite(spin) || length(spin) * h > settings.max_momentum_turn) return;
        for (std::size_t i = 0; i < nodes.size(); ++i)
            moves[i] += h * cross(spin, nodes.position[i] + moves[i] - new_center);
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
    return {momentum / mass, solve(inertia, turning)};
}

void set_velocities(Nodes& nodes, std::span<const Vec3> moves, double h) {
    double mass = 0;
    Vec3 change;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        mass += nodes.mass[i];
        change += nodes.mass[i] * (moves[i] / h - nodes.mean_velocity[i]);
    }
    const Vec3 half = change / (2 * mass);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        nodes.mean_velocity[i] = moves[i] / h;
        nodes.velocity[i] = nodes.inverse_mass[i] > 0 ? nodes.mean_velocity[i] + half : Vec3{};
    }
}

}  // namespace embody::physics::deformable
