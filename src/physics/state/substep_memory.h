// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "physics/constraint/direct/direct_contact_solver.h"
#include "physics/constraint/joint/joint_system.h"
#include "physics/constraint/sweeps/contact_solver.h"
#include "physics/constraint/sweeps/wide_contact_solver.h"
#include "physics/dynamic/body_state.h"
#include "physics/optimization/islands.h"
#include "physics/optimization/solve_schedule.h"
#include "physics/state/namespace.h"

namespace embody::physics::state {

/// Islands by the solver that solves them in the substeps (docs/physics/wide-solver.md).
struct IslandsBySolver {
    /// Islands with contacts only that are solved by one plan.
    struct Wide {
        ContactPlan plan;
        std::vector<Island> islands;  ///< empty: the plan was used in an earlier step
    };
    std::vector<std::uint32_t> free;  ///< bodies that nothing holds
    std::vector<Island> one_by_one;   ///< islands of joints and contacts, or of too many joints
    std::vector<Island> jointed;      ///< joints only, all at once
    std::vector<Wide> wide;           ///< contacts only; the finest plan first

    void clear() {
        free.clear();
        one_by_one.clear();
        jointed.clear();
        for (Wide& group : wide) group.islands.clear();
    }
    void add(const Island& island, const ContactPlan& plan) {
        auto group = std::find_if(wide.begin(), wide.end(),
                                  [&](const Wide& known) { return known.plan.substeps <= plan.substeps; });
        if (group == wide.end() || group->plan.substeps != plan.substeps) group = wide.insert(group, {plan, {}});
        if (group->islands.empty()) group->plan = plan;
        group->islands.push_back(island);
    }
};

/// The step in which the last impulses of a body's island held it in place.
struct HeldRecord {
    std::uint64_t step = 0;
    std::uint32_t contacts = 0;  ///< of the island
};

/// The solvers of the substeps and their memory, so that a steady step allocates nothing. From the last step they keep
/// the impulses that held bodies, the islands that the direct solver gave up, and the joints' systems.
struct SubstepMemory {
    WideContactSolver wide_solver{widest_kernels<ContactKernels>()};
    DirectContactSolver direct_solver;
    std::vector<HeldRecord> held;                        ///< by slot
    std::map<std::uint32_t, JointSystem> joint_systems;  ///< by an island's first body
    SolveSchedule schedule;
    std::vector<PreparedContact> prepared_contacts;
    std::vector<Vec3> kicked_velocity;  ///< linear velocity before the constraints, m/s
    IslandsBySolver islands;

    // Lists of the islands that the wide solver solves together.
    std::vector<std::uint32_t> wide_contacts, wide_bodies, wide_carriers;
    std::vector<WideContactSolver::Group> wide_groups;

    std::vector<std::pair<std::uint32_t, BodyState>> carriers;  ///< kinematic; of one jointed island, at step start

    /// Bound of the kinetic energy of an island of joints and contacts, J, and of the energy to correct its joints.
    struct EnergyBound {
        Island island;
        const JointSystem* system;
        double energy, correction;
    };
    std::vector<EnergyBound> energy_bounds;

    /// Bodies that joints hold, at the step's start.
    struct HeldStart {
        std::uint32_t body;
        Vec3 linear_velocity, angular_velocity;
    };
    std::vector<HeldStart> held_starts;
};

}  // namespace embody::physics::state
