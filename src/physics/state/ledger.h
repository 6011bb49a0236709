// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "physics/constraint/contact/contact.h"
#include "physics/constraint/impact/impact_group.h"
#include "physics/constraint/joint/joint.h"
#include "physics/definitions/step_account.h"
#include "physics/optimization/islands.h"
#include "physics/state/namespace.h"

namespace embody::physics::state {

struct WorldState;

/// Keeps the account of energy and momenta of one step after the other, by double entry: forces and impulses as the
/// stages report them, and the changes of the bodies' states (docs/physics/energy.md). It reads the world and changes
/// nothing. The steps of a world call these in the order of its stages.
class Ledger {
public:
    /// Lives no longer than the world.
    explicit Ledger(const WorldState& world) : world_(world) {}

    void begin();
    void close_wake();
    void begin_impacts();
    /// Adds a group of sites that eq. (3) has solved, its bodies at the place and time of the impact.
    void note_impact(std::span<const ImpactSite> sites, double energy_change);
    void close_impacts();
    /// The fraction of the impulses reported by its contacts that a body was given.
    void note_kept_fraction(std::uint32_t body, double fraction) { motions_[body].kept_fraction = fraction; }
    /// The body's velocities were scaled by this fraction, which keeps energy from growing.
    void note_scaled(std::uint32_t body, double fraction);
    /// The body was moved through the step by the equations of pure rolling.
    void note_rolled(std::uint32_t body) { motions_[body].rolls = true; }
    /// An island was solved through the next `time`, s: a substep where there are joints, else the step.
    void close_island(const Island& island, double time);
    void close_substeps();
    void close_limits();
    void close_continuous();
    void close_deformables();
    void close_sleep();
    [[nodiscard]] StepAccount finish();

private:
    const WorldState& world_;
    /// A body's state when the running stage began, and its means over the stage.
    struct Motion {
        Vec3 center, velocity, spin;
        Quat rotation;
        Vec3 mean_center, mean_velocity, mean_spin;
        Vec3 moment;                         ///< of its contacts over the stage, about the centre of mass, N m s
        Vec3 scaled_impulse, scaled_moment;  ///< by note_scaled(), N s, N m s
        double kept_fraction = 1;            ///< of its contacts' impulses
        bool rolls = false;                  ///< pure rolling through the whole step: its contacts do no work
    };
    /// Work and impulses of contacts and joints before the running part of the step.
    struct ContactTotals {
        std::array<float, 4> normal{};
        std::array<float, 3> friction{};
    };
    struct JointTotals {
        Vec3 linear, angular;
    };
    /// An impulse of body a on body b at one place.
    struct Push {
        std::uint32_t a = 0, b = 0;
        Vec3 arm_a, arm_b;  ///< from the centres of mass
        Vec3 impulse, moment;
    };
    void remember(std::uint32_t body);
    void remember_totals(std::uint32_t contact);
    void set_means(std::uint32_t body);
    void set_spins(const Island& island);
    void add_displaced(std::uint32_t body);
    void add_forces(std::uint32_t body);
    void add_damping(std::uint32_t body);
    void add_scaling(std::uint32_t body);
    void add_correction(std::uint32_t body);
    template <class Visit>
    void for_each_push(const Island& island, Visit visit) const;
    void add_push(const Push& push, StepCause cause);
    void note_blow(const Joint& joint);
    void add_joint(std::uint32_t index);
    void add(StepCause cause, double work, Vec3 linear, Vec3 angular);
    void measure(StepCause cause);

    StepAccount account_;
    Conserved last_;                             // sums when a measured stage began
    std::vector<Motion> motions_;                // by slot
    double time_ = 0;                            // s, of the running part
    std::vector<ContactTotals> contact_totals_;  // by contact
    std::vector<JointTotals> joint_totals_;      // by active joint
};

}  // namespace embody::physics::state
