// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "foundation/task_pool.h"
#include "math/kernel_width.h"
#include "physics/constraint/contact/contact.h"
#include "physics/constraint/contact/contact_work.h"
#include "physics/constraint/namespace.h"
#include "physics/constraint/sweeps/contact_batch.h"
#include "physics/constraint/sweeps/contact_solver.h"

namespace embody::physics::constraint {

/// Contacts of bodies without joints, as many at once as the processor has lanes (docs/physics/wide-solver.md). Knows
/// no island: it is given bodies, and batches in the order in which they are to be solved. Keeps its memory from step
/// to step.
class WideContactSolver {
public:
    explicit WideContactSolver(const ContactKernels& kernels) : kernels_(&kernels) {}
    [[nodiscard]] int lanes() const { return kernels_->lanes; }

    /// Movable bodies that touch each other, directly or through others, and nobody else.
    struct Group {
        std::uint32_t bodies = 0;  ///< how many
        bool is_bounded = false;   ///< its contacts must not add energy; false where kinematic bodies move it
    };
    /// Bodies (slots) that contacts move, group after group, and kinematic ones in motion; all others stand still.
    struct Members {
        std::span<const std::uint32_t> movable, carriers;
        std::span<const Group> groups;
    };

    /// Starts a step of `substeps` substeps of `substep` s.
    void begin(const Members& members, double substep, int substeps);
    /// Begins a stage: what is added from here on is solved after all that was added before.
    void begin_stage();
    /// Adds contacts of different movable bodies, at most lanes() of them, with up to `points` points. The batches of
    /// one stage have no movable body in common. The list of contacts stays where it is until they are solved.
    void add_batch(std::span<const std::uint32_t> batch, int points);
    /// Solves the step, with `passes` sweeps before and after the drift of each substep, and writes the motion to the
    /// bodies, the impulses to the contacts and their results to the contact summaries. The result is the same for any
    /// number of workers.
    void solve(int passes, const ContactSoftness& softness, std::span<BodyState> bodies,
               std::span<const BodyConstants> constants, std::span<Contact> contacts,
               std::span<ContactSummary> summaries, TaskPool& pool);
    /// Fraction of what the contacts did to a movable body that it kept in the last solve(), see contact_work.h:
    /// impulses are written without that factor.
    [[nodiscard]] double kept_fraction(std::uint32_t body) const {
        return static_cast<double>(kept_fraction_[group_of_row_[static_cast<std::size_t>(row_of(body))]]);
    }

private:
    struct alignas(32) Row {
        float value[8] = {};
    };
    struct alignas(64) CacheLine {
        float value[16];
    };
    struct Batch {
        std::span<const std::uint32_t> contacts;
        std::uint32_t first_line = 0;  ///< into lines_
        std::uint32_t first_lane = 0;
        int points = 0;
    };
    /// State that is common to the workers of a step.
    struct Work {
        std::span<BodyState> bodies;
        std::span<const BodyConstants> constants;
        std::span<Contact> contacts;
        std::span<ContactSummary> summaries;
        const ContactSoftness& softness;
        ContactSweep sweep;
        int passes;
        int workers;
        Barrier& barrier;
    };
    /// One worker's batches.
    struct Part {
        std::vector<std::uint32_t> batches;  ///< stage by stage
        std::vector<std::uint32_t> end;      ///< of each stage, into batches
    };

    void add_row(std::uint32_t body);
    void fill_row(std::size_t row, const Work& work);
    [[nodiscard]] std::int32_t row_of(std::uint32_t body) const;
    [[nodiscard]] std::size_t contact_of(std::size_t lane) const {
        return static_cast<std::size_t>(contact_row_[lane] / ContactRow::size);
    }
    [[nodiscard]] IndexRange batches_of_stage(std::size_t stage) const;
    void deal_stage(std::size_t stage);
    void deal_batches(int workers);
    void fill_lanes(const Batch& batch, std::span<const Contact> contacts);
    void fill_batch(const Batch& batch, std::span<const Contact> contacts);
    void solve_fraction(const Work& work, int worker);
    /// Calls kernel(batch's floats, points) for this worker's batches, stage after stage from the top down.
    template <class Kernel>
    void sweep_down(const Work& work, int worker, Kernel kernel);
    void measure_work(std::size_t row, const Work& work);
    void set_kept_fractions();
    void bound_work(std::size_t row);
    void write_body(std::size_t row, BodyState& state, const BodyConstants& constants) const;
    void write_contact(const Batch& batch, std::uint32_t lane, const ContactSoftness& softness, Contact& contact,
                       ContactSummary& summary) const;

    const ContactKernels* kernels_;
    double substep_ = 0;  // s
    int substeps_ = 0;

    // Row 0 is the immovable world; then the movable bodies, then the kinematic ones in motion.
    std::vector<Row> velocity_, motion_, start_, kick_, damping_, kicked_, inertia_;
    std::vector<std::uint32_t> slot_of_row_;
    std::vector<std::int32_t> row_of_slot_;  // valid where slot_of_row_ agrees
    std::size_t movable_rows_ = 0;
    std::vector<Row> free_;          // change of the velocity in the step without contacts
    std::vector<ContactWork> work_;  // of the contacts on each movable body
    std::vector<std::uint32_t> group_of_row_;
    std::vector<Group> groups_;
    std::vector<float> kept_fraction_;  // of what contacts did to a group

    std::vector<Batch> batches_;
    std::vector<std::uint32_t> stages_;                               // first batch of each
    std::vector<std::uint8_t> is_shared_;                             // each stage
    std::vector<Part> parts_;                                         // by worker
    std::vector<std::int32_t> contact_row_, body_a_, body_b_, bits_;  // lane by lane: BatchSource
    std::vector<CacheLine> lines_;                                    // never shrinks
    std::size_t used_lines_ = 0, used_lanes_ = 0;
};

}  // namespace embody::physics::constraint
