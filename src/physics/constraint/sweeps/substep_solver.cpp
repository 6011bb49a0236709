// SPDX-License-Identifier: MIT
#include "physics/constraint/sweeps/substep_solver.h"

#include <algorithm>

namespace embody::physics::constraint {

namespace {

int joint_passes(std::size_t joints, const JointSettings& settings) {
    const std::size_t passes = static_cast<std::size_t>(settings.sweep_budget) / std::max<std::size_t>(joints, 1);
    const auto least = static_cast<std::size_t>(settings.min_sweeps);
    return static_cast<int>(std::clamp(passes, least, std::max(least, static_cast<std::size_t>(settings.max_sweeps))));
}

// Oscillations of impulses that have not converged would grow from substep to substep: such lists begin anew.
void warm_start_joints(const ConstraintList& list, SolvePhase phase, std::span<BodyState> bodies) {
    const bool are_good = std::all_of(list.joint_order.begin(), list.joint_order.end(),
                                      [&](std::uint32_t i) { return impulses_of(list.joints[i], phase).are_good; });
    for (const std::uint32_t i : list.joint_order) {
        if (!are_good) impulses_of(list.joints[i], phase) = {};
        if (are_good) warm_start_joint(list.joints[i], phase, bodies);
    }
}

// One pass over the joints; returns the largest speed that it had to correct.
double solve_joints(const ConstraintList& list, const JointPhase& phase, std::span<BodyState> bodies,
                    std::span<const BodyConstants> constants) {
    if (list.system) return list.system->round({bodies, constants, list.joints, phase.settings});
    double error = 0;
    for (const std::uint32_t i : list.joint_order) {
        error = std::max(error, solve_joint(list.joints[i], phase, bodies));
    }
    return error;
}

}  // namespace

void solve_phase(const ConstraintList& list, SolvePhase phase, double substep, double time, std::span<BodyState> bodies,
                 std::span<const BodyConstants> constants) {
    const JointSettings& settings = list.settings.joint;
    const ContactPlan plan = jointed_contact_plan(list.contact_order.size(), 1, list.settings.contact);
    const ContactSoftness softness = plan.softness(substep, list.settings.contact);
    const JointSystem::View view{bodies, constants, list.joints, settings};
    const JointPhase joint_phase{phase, substep, settings};
    if (list.system) {
        list.system->begin_phase(phase, substep, JointSystem::Motion::small, view);
    } else {
        warm_start_joints(list, phase, bodies);
    }
    const std::size_t count = list.contact_order.size();
    for (std::size_t k = 0; phase == SolvePhase::position && k < count; ++k) {
        warm_start_contact(list.contacts[list.contact_order[k]], list.prepared[k], time, bodies);
    }

    const int least = plan.passes;
    const int most =
        list.joint_order.empty() ? least : std::max(least, joint_passes(list.joint_order.size(), settings));
    double error = 0;
    for (int pass = 0; pass < most; ++pass) {
        error = solve_joints(list, joint_phase, bodies, constants);
        // Bottom-up while positions are corrected, top-down for the velocities: weights travel down, support travels
        // up.
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t place = phase == SolvePhase::position ? k : count - 1 - k;
            solve_contact(list.contacts[list.contact_order[place]], list.prepared[place], phase, time, softness,
                          bodies);
        }
        if (pass + 1 >= least && error <= settings.speed_tolerance) break;
    }
    if (list.system && phase == SolvePhase::position) list.system->end_position_phase(view);
    for (const std::uint32_t i : list.joint_order) {
        add_to_totals(list.joints[i], phase);
        impulses_of(list.joints[i], phase).are_good = error <= settings.warm_start_tolerance;
    }
}

}  // namespace embody::physics::constraint
