// SPDX-License-Identifier: MIT
#include "physics/constraint/substep_solver.h"

#include <algorithm>

namespace embody::physics {

namespace {

int joint_passes(std::size_t joints) {
    constexpr std::size_t budget = 512;
    return static_cast<int>(std::clamp<std::size_t>(budget / std::max<std::size_t>(joints, 1), 4, 64));
}

// More joints than this do not converge in their passes: what is left over would swing up from substep to substep if
// they began with the last impulses. A chain of 24 links burst within 3 s.
constexpr std::size_t most_warm_joints = 16;

// A joint list is done when no row has to change its speed by more than this, m/s or rad/s.
constexpr double joint_tolerance = 1e-10;

}  // namespace

void solve_phase(const ConstraintList& list, SolvePhase phase, double substep, std::span<BodyState> bodies) {
    const ContactSoftness softness = contact_softness(substep, list.contact_order.size());
    const bool is_warm = list.joint_order.size() <= most_warm_joints;
    for (const std::uint32_t i : list.joint_order) {
        if (!is_warm) forget_impulses(list.joints[i], phase);
        warm_start_joint(list.joints[i], phase, bodies);
    }
    for (const std::uint32_t i : list.contact_order) {
        const bool is_first = phase == SolvePhase::position;
        if (is_first) warm_start_contact(list.contacts[i], bodies);
    }

    const int least = contact_passes(list.contact_order.size());
    const int most = list.joint_order.empty() ? least : std::max(least, joint_passes(list.joint_order.size()));
    for (int pass = 0; pass < most; ++pass) {
        double error = 0;
        for (const std::uint32_t i : list.joint_order) {
            error = std::max(error, solve_joint(list.joints[i], phase, substep, bodies));
        }
        // Bottom-up while positions are mended, top-down for the velocities: weights travel down, support travels up.
        const std::size_t count = list.contact_order.size();
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t place = phase == SolvePhase::position ? k : count - 1 - k;
            solve_contact(list.contacts[list.contact_order[place]], phase, softness, bodies);
        }
        if (pass + 1 >= least && error <= joint_tolerance) break;
    }
    for (const std::uint32_t i : list.joint_order) add_to_totals(list.joints[i], phase);
}

}  // namespace embody::physics
