// SPDX-License-Identifier: MIT
#include "physics/constraint/sweeps/wide_contact_solver.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>

#include "physics/dynamic/equations_of_motion.h"

namespace embody::physics::constraint {

namespace {

// Minimum number of batches for a worker in the mean of all stages, and in one stage: below it, moving bodies'
// velocities between the workers' caches and waiting at the stages' ends take more time than is saved.
constexpr std::size_t fewest_batches_in_mean = 4, min_parallel_batches = 2;

float to_float(double number) { return static_cast<float>(number); }

// Contact lies in the rows that kernels read.
constexpr std::size_t row_bytes = 8 * sizeof(float);  // of a row of ContactRow
static_assert(offsetof(Contact, normal) == ContactRow::frame * row_bytes);
static_assert(offsetof(Contact, friction_static) == offsetof(Contact, normal) + 6 * sizeof(float));
static_assert(offsetof(Contact, friction) == ContactRow::friction * row_bytes);
static_assert(offsetof(Contact, friction_torsional) == offsetof(Contact, friction) + 6 * sizeof(float));
static_assert(offsetof(Contact, rolling) == ContactRow::rolling * row_bytes);
static_assert(offsetof(Contact, points) == ContactRow::point * row_bytes);
static_assert(sizeof(ContactPoint) == ContactRow::rows_of_point * row_bytes);
static_assert(offsetof(ContactPoint, separation) == 6 * sizeof(float));
static_assert(offsetof(ContactPoint, place) == (ContactRow::point_rest - ContactRow::point) * row_bytes);
static_assert(offsetof(ContactPoint, total) == offsetof(ContactPoint, place) + 4 * sizeof(float));
static_assert(sizeof(Contact) == ContactRow::size * row_bytes);

std::int32_t lane_bits(const Contact& contact) {
    const std::int32_t points = (1 << contact.count) - 1;
    return (contact.sticks ? LaneBit::sticks : 0) | (contact.a_is_round ? LaneBit::round_a : 0) |
           (contact.b_is_round ? LaneBit::round_b : 0) | (contact.are_balls ? LaneBit::turns : 0) |
           points * LaneBit::first_point;
}

bool may_wait(const Contact& contact) {
    return std::any_of(contact.points.begin(), contact.points.begin() + contact.count,
                       [](const ContactPoint& point) { return point.inactive_until > 0; });
}

}  // namespace

void WideContactSolver::add_row(std::uint32_t body) {
    if (body >= row_of_slot_.size()) row_of_slot_.resize(body + 1);
    row_of_slot_[body] = static_cast<std::int32_t>(slot_of_row_.size());
    slot_of_row_.push_back(body);
}

void WideContactSolver::begin(const Members& members, double substep, int substeps) {
    substep_ = substep;
    substeps_ = substeps;
    batches_.clear();
    stages_.clear();
    used_lines_ = used_lanes_ = 0;

    // Row 0 is the immovable world.
    slot_of_row_.assign(1, 0xFFFFFFFFu);
    for (const std::uint32_t body : members.movable) add_row(body);
    movable_rows_ = slot_of_row_.size();
    for (const std::uint32_t body : members.carriers) add_row(body);
    for (std::vector<Row>* rows : {&velocity_, &motion_, &start_, &kick_, &damping_, &kicked_, &inertia_}) {
        rows->resize(slot_of_row_.size());
        rows->front() = {};
    }
    motion_.front() = {{0, 0, 0, 0, 0, 0, 1, 0}};

    groups_.assign(members.groups.begin(), members.groups.end());
    group_of_row_.assign(1, 0);
    for (std::uint32_t i = 0; i < groups_.size(); ++i) group_of_row_.insert(group_of_row_.end(), groups_[i].bodies, i);
    free_.resize(movable_rows_);
    work_.resize(movable_rows_);
    kept_fraction_.resize(groups_.size());
}

void WideContactSolver::fill_row(std::size_t row, const Work& work) {
    BodyState& state = work.bodies[slot_of_row_[row]];
    const BodyConstants& c = work.constants[slot_of_row_[row]];
    velocity_[row] = kick_[row] = kicked_[row] = {};
    damping_[row] = {{1, 1, 1, 1, 1, 1, 1, 1}};
    const double step = substep_ * substeps_;
    const bool is_movable = row < movable_rows_;
    if (is_movable) {
        state.hidden_momentum = {};
        if (has_gyroscopic_torque(state, c, step)) split_gyroscopic_of_turns(state, c, step, substeps_);
    }
    const Vec3 displacement = state.center - state.start_center;
    const Vec3 v = state.linear_velocity, w = state.angular_velocity;
    const Quat& q = state.turn;
    start_[row] = {{to_float(v.x), to_float(v.y), to_float(v.z), to_float(w.x), to_float(w.y), to_float(w.z)}};
    motion_[row] = {{to_float(displacement.x), to_float(displacement.y), to_float(displacement.z), to_float(q.x),
                     to_float(q.y), to_float(q.z), to_float(q.w)}};
    const Mat3& i = state.inverse_inertia;
    inertia_[row] = {{to_float(i.x.x), to_float(i.x.y), to_float(i.x.z), to_float(i.y.y), to_float(i.y.z),
                      to_float(i.z.z), to_float(state.inverse_mass)}};
    if (!is_movable) return;

    // As kick() of equations_of_motion.h, for changes: v₀ + Δ ← (v₀ + Δ + a h) d.
    const double linear = 1 / (1 + substep_ * c.linear_damping), angular = 1 / (1 + substep_ * c.angular_damping);
    const Vec3 a = c.acceleration * (substep_ * linear) + v * (linear - 1);
    const Vec3 t = state.inverse_inertia * c.torque * (substep_ * angular) + w * (angular - 1);
    kick_[row] = {{to_float(a.x), to_float(a.y), to_float(a.z), to_float(t.x), to_float(t.y), to_float(t.z)}};
    const float d = to_float(linear), e = to_float(angular);
    damping_[row] = {{d, d, d, e, e, e, 1, 1}};
}

// All bodies that stand still for ever have row 0.
std::int32_t WideContactSolver::row_of(std::uint32_t body) const {
    if (body >= row_of_slot_.size()) return 0;
    const auto row = static_cast<std::size_t>(row_of_slot_[body]);
    return row < slot_of_row_.size() && slot_of_row_[row] == body ? row_of_slot_[body] : 0;
}

void WideContactSolver::begin_stage() { stages_.push_back(static_cast<std::uint32_t>(batches_.size())); }

void WideContactSolver::add_batch(std::span<const std::uint32_t> batch, int points) {
    batches_.push_back(
        {batch, static_cast<std::uint32_t>(used_lines_), static_cast<std::uint32_t>(used_lanes_), points});
    used_lanes_ += static_cast<std::size_t>(lanes());
    const auto floats = static_cast<std::size_t>(batch_floats(kernels_->lanes, points));
    used_lines_ += (floats + 15) / 16;
}

void WideContactSolver::fill_lanes(const Batch& batch, std::span<const Contact> contacts) {
    std::size_t lane = batch.first_lane;
    for (const std::uint32_t i : batch.contacts) {
        contact_row_[lane] = static_cast<std::int32_t>(i) * ContactRow::size;
        body_a_[lane] = row_of(contacts[i].a);
        body_b_[lane] = row_of(contacts[i].b);
        bits_[lane] = lane_bits(contacts[i]);
        ++lane;
    }

    // The other lanes.
    for (; lane < batch.first_lane + static_cast<std::size_t>(lanes()); ++lane) {
        contact_row_[lane] = contact_row_[lane - 1];
        body_a_[lane] = body_b_[lane] = bits_[lane] = 0;
    }
}

void WideContactSolver::fill_batch(const Batch& batch, std::span<const Contact> contacts) {
    float* data = lines_[batch.first_line].value;
    const std::size_t first = batch.first_lane;
    kernels_->fill(data, batch.points,
                   {.contacts = reinterpret_cast<const float*>(contacts.data()),
                    .contact_row = &contact_row_[first],
                    .body_a = &body_a_[first],
                    .body_b = &body_b_[first],
                    .bits = &bits_[first],
                    .start = start_[0].value,
                    .inertia = inertia_[0].value});

    // What may be written.
    std::int32_t writable[4] = {};
    for (std::uint32_t lane = 0; lane < batch.contacts.size(); ++lane) {
        const auto is_movable = [&](std::int32_t row) { return inertia_[static_cast<std::size_t>(row)].value[6] > 0; };
        writable[0] |= (is_movable(body_a_[first + lane]) ? 1 : 0) << lane;
        writable[1] |= (is_movable(body_b_[first + lane]) ? 1 : 0) << lane;
        const Contact& contact = contacts[contact_of(first + lane)];
        writable[2] |= (resists_rolling(contact) ? 1 : 0) << lane;
        writable[3] |= (may_wait(contact) ? 1 : 0) << lane;
    }
    std::memcpy(data + BatchHead::writable * lanes(), writable, sizeof writable);
}

IndexRange WideContactSolver::batches_of_stage(std::size_t stage) const {
    return {stages_[stage], stage + 1 < stages_.size() ? stages_[stage + 1] : batches_.size()};
}

// A stage's batches lie by falling number of points, those of one number in the order of the contacts. Each worker gets
// as many of each number, and in each the same part of that order: so it meets the same bodies in all stages, and the
// contacts that it had in the touch stage. What is left over is dealt in turn.
void WideContactSolver::deal_stage(std::size_t stage) {
    const IndexRange all = batches_of_stage(stage);
    const std::size_t workers = parts_.size();
    std::size_t turn = 0;
    for (std::size_t first = all.first, last = first; first < all.last; first = last) {
        while (last < all.last && batches_[last].points == batches_[first].points) ++last;
        const std::size_t each = (last - first) / workers, left = (last - first) % workers;
        for (std::size_t worker = 0; worker < workers; ++worker) {
            const bool gets_more = (worker + workers - turn) % workers < left;
            for (std::size_t k = each + (gets_more ? 1 : 0); k > 0; --k) {
                parts_[worker].batches.push_back(static_cast<std::uint32_t>(first++));
            }
        }
        turn = (turn + left) % workers;
    }
}

// Stages of few batches are worker 0's.
void WideContactSolver::deal_batches(int workers) {
    parts_.resize(static_cast<std::size_t>(workers));
    for (Part& part : parts_) {
        part.batches.clear();
        part.end.clear();
    }
    is_shared_.clear();
    for (std::size_t stage = 0; stage < stages_.size(); ++stage) {
        const IndexRange all = batches_of_stage(stage);
        const bool is_shared = all.last - all.first >= min_parallel_batches * parts_.size();
        is_shared_.push_back(is_shared ? 1 : 0);
        if (is_shared) {
            deal_stage(stage);
        } else {
            for (std::size_t i = all.first; i < all.last; ++i)
                parts_[0].batches.push_back(static_cast<std::uint32_t>(i));
        }
        for (Part& part : parts_) part.end.push_back(static_cast<std::uint32_t>(part.batches.size()));
    }
}

template <class Kernel>
void WideContactSolver::sweep_down(const Work& work, int worker, Kernel kernel) {
    const Part& part = parts_[static_cast<std::size_t>(worker)];
    // Nobody waits between two stages of worker 0.
    bool is_pending = false;
    for (std::size_t stage = stages_.size(); stage-- > 0;) {
        const bool is_shared = is_shared_[stage] != 0;
        if (is_shared && is_pending) work.barrier.wait();
        for (std::size_t i = stage > 0 ? part.end[stage - 1] : 0; i < part.end[stage]; ++i) {
            const Batch& batch = batches_[part.batches[i]];
            kernel(lines_[batch.first_line].value, batch.points);
        }
        if (is_shared) work.barrier.wait();
        is_pending = !is_shared;
    }
    if (is_pending) work.barrier.wait();
}

void WideContactSolver::solve_fraction(const Work& work, int worker) {
    const BodyRows rows{velocity_[0].value, motion_[0].value,  start_[0].value,
                        kick_[0].value,     damping_[0].value, kicked_[0].value};
    const ContactKernels& k = *kernels_;
    ContactSweep sweep = work.sweep;

    // Row 0 never moves.
    const IndexRange range = range_of(slot_of_row_.size() - 1, worker, work.workers);
    const auto first_row = static_cast<std::int32_t>(range.first + 1),
               last_row = static_cast<std::int32_t>(range.last + 1);
    for (std::size_t row = range.first + 1; row < range.last + 1; ++row) fill_row(row, work);
    work.barrier.wait();
    const std::vector<std::uint32_t>& own = parts_[static_cast<std::size_t>(worker)].batches;
    for (const std::uint32_t i : own) {
        fill_lanes(batches_[i], work.contacts);
        fill_batch(batches_[i], work.contacts);
        k.separate(lines_[batches_[i].first_line].value, batches_[i].points, sweep);
    }
    for (int substep = 1; substep <= substeps_; ++substep) {
        // Forces, constraints that also correct positions, motion.
        sweep.time = to_float(substep * substep_);
        k.kick(rows, first_row, last_row);
        work.barrier.wait();
        if (substep == 1) {
            sweep_down(work, worker, [&](float* batch, int points) { k.warm_start(batch, points, sweep); });
        }
        for (int pass = 0; pass < work.passes; ++pass) {
            sweep_down(work, worker, [&](float* batch, int points) { k.solve_positions(batch, points, sweep); });
        }
        k.drift(rows, sweep.substep, first_row, last_row);
        work.barrier.wait();

        // Constraints on the velocity alone.
        for (int pass = 0; pass < work.passes; ++pass) {
            sweep.is_first = pass == 0;
            sweep.is_last = pass + 1 == work.passes;
            sweep_down(work, worker, [&](float* batch, int points) { k.solve_velocities(batch, points, sweep); });
        }
    }

    // The contacts must not add energy.
    const std::size_t last_movable = std::min(range.last + 1, movable_rows_);
    for (std::size_t row = range.first + 1; row < last_movable; ++row) measure_work(row, work);
    work.barrier.wait();
    if (worker == 0) set_kept_fractions();
    work.barrier.wait();

    // Results.
    for (std::size_t row = range.first + 1; row < last_movable; ++row) {
        const std::uint32_t body = slot_of_row_[row];
        bound_work(row);
        write_body(row, work.bodies[body], work.constants[body]);
    }
    for (const std::uint32_t i : own) {
        const Batch& batch = batches_[i];
        for (std::uint32_t lane = 0; lane < batch.contacts.size(); ++lane) {
            const std::size_t contact = contact_of(batch.first_lane + lane);
            write_contact(batch, lane, work.softness, work.contacts[contact], work.summaries[contact]);
        }
    }
}

void WideContactSolver::solve(int passes, const ContactSoftness& softness, std::span<BodyState> bodies,
                              std::span<const BodyConstants> constants, std::span<Contact> contacts,
                              std::span<ContactSummary> summaries, TaskPool& pool) {
    if (lines_.size() < used_lines_) {
        // What they held belongs to the last step.
        lines_.clear();
        lines_.resize(used_lines_ + used_lines_ / 2);
    }
    for (std::vector<std::int32_t>* lanes : {&contact_row_, &body_a_, &body_b_, &bits_}) lanes->resize(used_lanes_);
    const ContactSweep sweep{.velocity = velocity_[0].value,
                             .motion = motion_[0].value,
                             .start = start_[0].value,
                             .substep = to_float(substep_),
                             .inverse_substep = to_float(1 / substep_),
                             .bias_rate = to_float(softness.bias_rate),
                             .mass_scale = to_float(softness.mass_scale),
                             .impulse_scale = to_float(softness.impulse_scale),
                             .push_speed = to_float(softness.push_speed)};
    const std::size_t worth_a_worker = fewest_batches_in_mean * stages_.size();
    const int workers =
        batches_.size() < worth_a_worker * static_cast<std::size_t>(pool.workers()) ? 1 : pool.workers();
    deal_batches(workers);
    Barrier barrier(workers);
    const Work work{bodies, constants, contacts, summaries, softness, sweep, passes, workers, barrier};
    if (workers == 1) {
        solve_fraction(work, 0);
    } else {
        pool.run([&](int worker) { solve_fraction(work, worker); });
    }
}

void WideContactSolver::measure_work(std::size_t row, const Work& work) {
    if (!groups_[group_of_row_[row]].is_bounded) return;

    // The kicks alone, as the kernels do them.
    float* free = free_[row].value;
    for (int i = 0; i < 6; ++i) {
        free[i] = 0;
        for (int k = 0; k < substeps_; ++k) free[i] = free[i] * damping_[row].value[i] + kick_[row].value[i];
    }
    const BodyState& state = work.bodies[slot_of_row_[row]];
    const float* v = velocity_[row].value;
    const VelocityPair without{state.linear_velocity + Vec3{free[0], free[1], free[2]},
                               state.angular_velocity + Vec3{free[3], free[4], free[5]}};
    const VelocityPair change{Vec3{v[0], v[1], v[2]} - Vec3{free[0], free[1], free[2]},
                              Vec3{v[3], v[4], v[5]} - Vec3{free[3], free[4], free[5]}};
    work_[row] = contact_work(work.constants[slot_of_row_[row]], state.rotation, without, change);
}

// In the order of the rows, whichever worker measured them.
void WideContactSolver::set_kept_fractions() {
    std::size_t row = 1;
    for (std::size_t i = 0; i < groups_.size(); ++i) {
        ContactWork sum;
        const std::size_t end = row + groups_[i].bodies;
        for (; row < end; ++row) {
            if (groups_[i].is_bounded) sum += work_[row];
        }
        kept_fraction_[i] = to_float(fraction_without_gain(sum));
    }
}

void WideContactSolver::bound_work(std::size_t row) {
    const float fraction = kept_fraction_[group_of_row_[row]];
    if (fraction >= 1) return;
    float* v = velocity_[row].value;
    for (int i = 0; i < 6; ++i) v[i] = free_[row].value[i] + fraction * (v[i] - free_[row].value[i]);
}

void WideContactSolver::write_body(std::size_t row, BodyState& state, const BodyConstants& constants) const {
    const float *v = velocity_[row].value, *x = motion_[row].value;
    state.center = state.start_center + Vec3{x[0], x[1], x[2]};
    state.linear_velocity += Vec3{v[0], v[1], v[2]};
    state.angular_velocity += Vec3{v[3], v[4], v[5]};
    const Quat turn{x[3], x[4], x[5], x[6]};
    if (turn != state.turn) finish_turn(state, constants, turn);
}

void WideContactSolver::write_contact(const Batch& batch, std::uint32_t lane, const ContactSoftness& softness,
                                      Contact& contact, ContactSummary& summary) const {
    const int lanes = kernels_->lanes;
    const float* head = lines_[batch.first_line].value + lane;
    const auto read = [&](int quantity) { return head[quantity * lanes]; };
    const auto read_friction = [&](int first) { return PatchFriction{read(first), read(first + 1), read(first + 2)}; };
    contact.friction = read_friction(BatchHead::friction);
    contact.friction_total = read_friction(BatchHead::friction_total);
    contact.rolling = {read(BatchHead::rolling), read(BatchHead::rolling + 1), read(BatchHead::rolling + 2)};
    contact.sticks = std::bit_cast<std::uint32_t>(read(BatchHead::sticks)) != 0;
    if (contact.are_balls) {
        const auto read_axis = [&](int first) { return Vec3f{read(first), read(first + 1), read(first + 2)}; };
        contact.normal = read_axis(BatchHead::normal);
        contact.tangent_1 = read_axis(BatchHead::tangent_1);
    }
    bool is_pressed = false, is_deep = false;
    for (int i = 0; i < contact.count; ++i) {
        ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
        const float* from = head + (BatchHead::size + i * BatchPoint::size) * lanes;
        point.impulse = from[BatchPoint::impulse * lanes];
        point.total = from[BatchPoint::total * lanes];
        summary.touches = summary.touches || point.total > 0 || point.separation <= 0;
        is_pressed = is_pressed || point.impulse > 0;
        const double sag = softness.sag(from[BatchPoint::normal_response * lanes], point.impulse);
        is_deep = is_deep || -from[BatchPoint::separation * lanes] > sag + softness.penetration_slop;
    }
    summary.is_sunk = is_pressed && is_deep;
}

}  // namespace embody::physics::constraint
