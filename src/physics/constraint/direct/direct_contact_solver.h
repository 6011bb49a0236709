// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "physics/constraint/direct/contact_newton.h"
#include "physics/constraint/namespace.h"
#include "physics/definitions/settings/constraint_settings.h"
#include "physics/dynamic/body_state.h"

namespace embody::physics::constraint {

/// Contacts of few bodies without joints, all at once by a sparse direct solve (docs/physics/direct-solver.md). Knows
/// no island: it is given lists. Keeps its memory from step to step.
class DirectContactSolver {
public:
    static constexpr std::size_t max_bodies = 256;  ///< of a list: half of what BlockPattern takes

    /// Slots of movable bodies, and indices of all the contacts that they have with each other and with bodies that
    /// stand still.
    struct List {
        std::span<const std::uint32_t> bodies, contacts;
        int impulse_parts = 1;  ///< the contacts' impulses are those of the last of so many equal parts of the step
    };

    /// How much effort a list is worth.
    enum class Effort {
        while_slow,  ///< one cheap solve for the whole step, if nothing moves or begins to move
        any,
    };

    enum class Outcome {
        unsolved,  ///< nothing was changed
        solved,
        held,  ///< the last impulses hold everything where it is
    };

    /// Starts a step of `time_step` s, in `substeps` parts for what moves, with its settings.
    void begin(double time_step, int substeps, const ConstraintSettings& settings);
    /// Solves one list through the step: moves its bodies and hands the impulses to its contacts.
    [[nodiscard]] Outcome solve(const List& list, Effort effort, std::span<BodyState> bodies,
                                std::span<const BodyConstants> constants, std::span<Contact> contacts);
    /// Replaces solve() where it is known that the last impulses hold the list.
    static void hold(const List& list, std::span<Contact> contacts);

private:
    /// How a body moves in this step.
    struct Motion {
        std::uint32_t slot = 0;
        Vec6 kick;                                       // of a substep, m/s, rad/s
        double linear_damping = 1, angular_damping = 1;  // factors a substep
        Vec3 acceleration;                               // m/s²
        Vec3 displacement;                               // of the centre of mass, m
        Quat turn;
        Vec3 hidden_momentum;  // as in BodyState
        double hidden_energy = 0;
    };

    void number_bodies(std::span<const std::uint32_t> slots, std::size_t all);
    [[nodiscard]] std::int32_t number_of(std::uint32_t slot) const;
    bool stays_at_rest(const List& list, std::span<BodyState> bodies, std::span<const BodyConstants> constants,
                       std::span<Contact> contacts);
    bool holds_at_rest(const Contact& contact);
    void gather(const List& list, std::span<const BodyState> bodies, std::span<const BodyConstants> constants,
                std::span<const Contact> contacts, int substeps);
    void scatter(std::span<BodyState> bodies, std::span<const BodyConstants> constants, std::span<Contact> contacts,
                 int substeps) const;
    [[nodiscard]] bool is_slow(double most) const;
    [[nodiscard]] bool rest(bool only_slow, std::span<const Contact> contacts);
    [[nodiscard]] bool move(int substeps, std::span<const Contact> contacts);
    void kick();
    void drift();
    void measure_gaps(std::span<const Contact> contacts);
    [[nodiscard]] double worst_gap() const;
    void correct_positions(double fraction, double most, std::span<const Contact> contacts);

    DirectSettings settings_;      // of this step
    double correction_speed_ = 0;  // m/s, of this step: ContactSettings::max_correction_speed
    double time_step_ = 0;         // s
    int moving_substeps_ = 0;
    double substep_ = 0;  // s, of the parts that the list's impulses belong to
    int substeps_ = 0;
    double h_ = 0;  // s, of the running solve
    std::vector<Motion> motion_;
    std::vector<NewtonBody> masses_;
    std::vector<Vec6> velocity_, free_velocity_, shift_;
    std::vector<DirectPatch> patches_;
    ContactNewton newton_;
    std::vector<std::int32_t> number_of_slot_;  // valid where motion_ agrees
};

}  // namespace embody::physics::constraint
