// SPDX-License-Identifier: MIT
#include "physics/constraint/wide_contact_solver.h"

#include <algorithm>
#include <bit>

#include "physics/dynamic/equations_of_motion.h"

namespace embody::physics {

namespace {

// Below this a step is done before a second worker has begun, or a stage before both have met at its end.
constexpr std::size_t fewest_contacts_shared = 400, fewest_batches_shared = 2;
constexpr float mask_set = std::bit_cast<float>(0xFFFFFFFFu);

float to_float(double number) { return static_cast<float>(number); }

/// One lane of a batch or of one of its points.
class Lane {
public:
    Lane(float* part, int lanes, std::size_t lane) : part_(part + lane), lanes_(lanes) {}
    void set(int quantity, double number) { part_[quantity * lanes_] = to_float(number); }
    void set(int quantity, Vec3 v) {
        set(quantity, v.x);
        set(quantity + 1, v.y);
        set(quantity + 2, v.z);
    }
    void set_symmetric(int quantity, const Mat3& m) {
        const double numbers[6] = {m.x.x, m.x.y, m.x.z, m.y.y, m.y.z, m.z.z};
        for (int i = 0; i < 6; ++i) set(quantity + i, numbers[i]);
    }
    void set_mask(int quantity, bool is_set) { part_[quantity * lanes_] = is_set ? mask_set : 0.0F; }
    void set_integer(int quantity, std::int32_t number) { part_[quantity * lanes_] = std::bit_cast<float>(number); }

private:
    float* part_;
    int lanes_;
};

void fill_point(Lane lane, const Contact& contact, const ContactPoint& point, Vec3 anchor) {
    const Vec3 offset = Vec3(point.arm_a) - anchor;
    lane.set(BatchPoint::along_1, dot(offset, contact.tangent_1));
    lane.set(BatchPoint::along_2, dot(offset, contact.tangent_2));
    lane.set(BatchPoint::separation_found, point.separation);
    lane.set(BatchPoint::normal_mass, 1);  // it exists; prepare() puts the mass here
    lane.set(BatchPoint::impulse, point.impulse);
    lane.set(BatchPoint::total, point.total);
    lane.set(BatchPoint::inactive_until, point.inactive_until);
}

Vec3 numbers(const PatchFriction& friction) { return {friction.along_1, friction.along_2, friction.twist}; }

// The region's place and its motion at the step's start. In double: what both bodies have in common takes no digits
// from what they differ in.
void fill_anchor(Lane head, const Contact& contact, const Anchor& anchor, const BodyState& a, const BodyState& b) {
    const Vec3 velocity = velocity_at(b, anchor.arm_b) - velocity_at(a, anchor.arm_a);
    const Vec3 spin = b.angular_velocity - a.angular_velocity;
    const Vec3 n = contact.normal, t1 = contact.tangent_1, t2 = contact.tangent_2;
    head.set(BatchHead::normal, n);
    head.set(BatchHead::tangent_1, t1);
    head.set(BatchHead::tangent_2, t2);
    head.set(BatchHead::arm_a, anchor.arm_a);
    head.set(BatchHead::arm_b, anchor.arm_b);
    head.set(BatchHead::start_speed, Vec3{dot(velocity, n), dot(velocity, t1), dot(velocity, t2)});
    head.set(BatchHead::start_spin, Vec3{dot(spin, t1), dot(spin, t2), dot(spin, n)});
}

// Slower than this in a step the inertia hardly turns with the body: no gyroscopic torque, rad.
constexpr double least_turn = 1e-3;

bool has_gyroscopic_torque(const BodyState& state, const BodyConstants& constants, double time) {
    return !constants.is_isotropic && length_squared(state.angular_velocity) * time * time > least_turn * least_turn;
}

}  // namespace

void WideContactSolver::append_row(std::uint32_t body, const BodyState& state) {
    const Vec3 way = state.center - state.start_center;
    const Vec3 v = state.linear_velocity, w = state.angular_velocity;
    const Quat& q = state.turn;
    velocity_.push_back({});
    start_.push_back({{to_float(v.x), to_float(v.y), to_float(v.z), to_float(w.x), to_float(w.y), to_float(w.z)}});
    motion_.push_back({{to_float(way.x), to_float(way.y), to_float(way.z), to_float(q.x), to_float(q.y), to_float(q.z),
                        to_float(q.w)}});
    kick_.push_back({});
    damping_.push_back({{1, 1, 1, 1, 1, 1, 1, 1}});
    slot_of_row_.push_back(body);
    if (body >= row_of_slot_.size()) row_of_slot_.resize(body + 1);
    row_of_slot_[body] = static_cast<std::int32_t>(slot_of_row_.size() - 1);
}

void WideContactSolver::begin(std::span<const std::uint32_t> movable, std::span<BodyState> bodies,
                              std::span<const BodyConstants> constants, double substep, int substeps) {
    substep_ = substep;
    substeps_ = substeps;
    for (std::vector<Row>* rows : {&velocity_, &motion_, &start_, &kick_, &damping_}) rows->clear();
    slot_of_row_.clear();
    batches_.clear();
    stages_.clear();
    contacts_.clear();
    rows_of_contact_.clear();
    used_lines_ = 0;

    // The immovable world.
    velocity_.push_back({});
    motion_.push_back({{0, 0, 0, 0, 0, 0, 1, 0}});
    start_.push_back({});
    kick_.push_back({});
    damping_.push_back({});
    slot_of_row_.push_back(0xFFFFFFFFu);

    const double step = substep * substeps;
    for (const std::uint32_t body : movable) {
        BodyState& state = bodies[body];
        const BodyConstants& c = constants[body];
        state.hidden_momentum = {};
        if (has_gyroscopic_torque(state, c, step)) split_gyroscopic_of_turns(state, c, step, substeps);
        append_row(body, state);

        // As kick() of equations_of_motion.h, for changes: v₀ + Δ ← (v₀ + Δ + a h) d.
        const double linear = 1 / (1 + substep * c.linear_damping), angular = 1 / (1 + substep * c.angular_damping);
        const Vec3 a = c.acceleration * (substep * linear) + state.linear_velocity * (linear - 1);
        const Vec3 t = state.inverse_inertia * c.torque * (substep * angular) + state.angular_velocity * (angular - 1);
        kick_.back() = {{to_float(a.x), to_float(a.y), to_float(a.z), to_float(t.x), to_float(t.y), to_float(t.z)}};
        const float d = to_float(linear), e = to_float(angular);
        damping_.back() = {{d, d, d, e, e, e, 1, 1}};
    }
    movable_rows_ = slot_of_row_.size();
}

// Bodies that stand still for ever share row 0; a kinematic one gets a row when the first contact meets it.
std::int32_t WideContactSolver::row_of(std::uint32_t body, std::span<const BodyState> bodies) {
    const BodyState& state = bodies[body];
    if (state.inverse_mass == 0 && state.linear_velocity == Vec3{} && state.angular_velocity == Vec3{}) return 0;
    const bool is_known = body < row_of_slot_.size() &&
                          static_cast<std::size_t>(row_of_slot_[body]) < slot_of_row_.size() &&
                          slot_of_row_[static_cast<std::size_t>(row_of_slot_[body])] == body;
    if (!is_known) append_row(body, state);
    return row_of_slot_[body];
}

void WideContactSolver::begin_stage() { stages_.push_back(static_cast<std::uint32_t>(batches_.size())); }

void WideContactSolver::add_batch(std::span<const std::uint32_t> batch, int points, std::span<const Contact> contacts,
                                  std::span<const BodyState> bodies) {
    batches_.push_back({static_cast<std::uint32_t>(used_lines_), static_cast<std::uint32_t>(contacts_.size()),
                        static_cast<std::uint32_t>(batch.size()), points});
    for (const std::uint32_t i : batch) {
        contacts_.push_back(i);
        rows_of_contact_.push_back({row_of(contacts[i].a, bodies), row_of(contacts[i].b, bodies)});
    }
    const auto floats = static_cast<std::size_t>(batch_floats(kernels_->lanes, points));
    used_lines_ += (floats + 15) / 16;
}

void WideContactSolver::fill_batch(const Batch& batch, std::span<const Contact> contacts,
                                   std::span<const BodyState> bodies) {
    const int lanes = kernels_->lanes;
    float* data = lines_[batch.first_line].value;
    std::fill_n(data, batch_floats(lanes, batch.points), 0.0F);

    std::int32_t writable_a = 0, writable_b = 0, rolling = 0;
    for (std::size_t k = 0; k < batch.contact_count; ++k) {
        const Contact& contact = contacts[contacts_[batch.first_contact + k]];
        const auto [row_a, row_b] = rows_of_contact_[batch.first_contact + k];
        const BodyState &a = bodies[contact.a], &b = bodies[contact.b];
        Lane head(data, lanes, k);
        head.set_integer(BatchHead::body_a, row_a);
        head.set_integer(BatchHead::body_b, row_b);
        head.set(BatchHead::inverse_mass_a, a.inverse_mass);
        head.set(BatchHead::inverse_mass_b, b.inverse_mass);
        head.set_symmetric(BatchHead::inverse_inertia_a, a.inverse_inertia);
        head.set_symmetric(BatchHead::inverse_inertia_b, b.inverse_inertia);
        const Anchor anchor = anchor_of(contact);
        fill_anchor(head, contact, anchor, a, b);
        head.set(BatchHead::friction_static, contact.material.friction_static);
        head.set(BatchHead::friction_dynamic, contact.material.friction_dynamic);
        head.set(BatchHead::friction_torsional, contact.material.friction_torsional);
        head.set(BatchHead::friction_rolling, contact.material.friction_rolling);
        head.set(BatchHead::friction, numbers(contact.friction));
        head.set(BatchHead::friction_total, numbers(contact.friction_total));
        head.set(BatchHead::rolling, contact.rolling);
        head.set_mask(BatchHead::sticks, contact.sticks);
        head.set_mask(BatchHead::round_a, contact.a_is_round);
        head.set_mask(BatchHead::round_b, contact.b_is_round);
        writable_a |= (a.inverse_mass > 0 ? 1 : 0) << k;
        writable_b |= (b.inverse_mass > 0 ? 1 : 0) << k;
        rolling |= (resists_rolling(contact) ? 1 : 0) << k;
        for (int i = 0; i < contact.count; ++i) {
            float* point = data + (BatchHead::size + i * BatchPoint::size) * lanes;
            fill_point(Lane(point, lanes, k), contact, contact.points[static_cast<std::size_t>(i)], anchor.arm_a);
        }
    }
    Lane(data, lanes, 0).set_integer(BatchHead::writable, writable_a);
    Lane(data, lanes, 1).set_integer(BatchHead::writable, writable_b);
    Lane(data, lanes, 2).set_integer(BatchHead::writable, rolling);
    kernels_->prepare(data, batch.points);
}

template <class Kernel>
void WideContactSolver::for_each_batch(const Work& work, int worker, Kernel kernel) {
    const Share share = share_of(batches_.size(), worker, work.workers);
    for (std::size_t i = share.first; i < share.last; ++i) kernel(batches_[i]);
}

template <class Kernel>
void WideContactSolver::sweep_down(const Work& work, int worker, Kernel kernel) {
    // Stages of few batches are worker 0's; nobody waits between two of them.
    bool is_pending = false;
    for (std::size_t stage = stages_.size(); stage-- > 0;) {
        const std::size_t first = stages_[stage];
        const std::size_t last = stage + 1 < stages_.size() ? stages_[stage + 1] : batches_.size();
        const bool is_shared = last - first >= fewest_batches_shared * static_cast<std::size_t>(work.workers);
        if (is_shared && is_pending) work.barrier.wait();
        const Share share = is_shared     ? share_of(last - first, worker, work.workers)
                            : worker == 0 ? Share{0, last - first}
                                          : Share{};
        for (std::size_t i = first + share.first; i < first + share.last; ++i) {
            kernel(lines_[batches_[i].first_line].value, batches_[i].points);
        }
        if (is_shared) work.barrier.wait();
        is_pending = !is_shared;
    }
    if (is_pending) work.barrier.wait();
}

void WideContactSolver::solve_share(const Work& work, int worker) {
    const BodyRows rows{velocity_[0].value, motion_[0].value,  start_[0].value,
                        kick_[0].value,     damping_[0].value, kicked_[0].value};
    const ContactKernels& k = *kernels_;
    ContactSweep sweep = work.sweep;

    // Row 0 never moves.
    const Share share = share_of(velocity_.size() - 1, worker, work.workers);
    const auto first_row = static_cast<std::int32_t>(share.first + 1),
               last_row = static_cast<std::int32_t>(share.last + 1);
    for_each_batch(work, worker, [&](const Batch& batch) {
        fill_batch(batch, work.contacts, work.bodies);
        k.separate(lines_[batch.first_line].value, batch.points, sweep);
    });
    for (int substep = 1; substep <= substeps_; ++substep) {
        // Forces, constraints that also mend positions, motion.
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

    // Results.
    for (std::int32_t row = first_row; row < last_row; ++row) {
        const auto r = static_cast<std::size_t>(row);
        const std::uint32_t body = slot_of_row_[r];
        if (r < movable_rows_) write_body(r, work.bodies[body], work.constants[body]);
    }
    for_each_batch(work, worker, [&](const Batch& batch) {
        for (std::uint32_t lane = 0; lane < batch.contact_count; ++lane) {
            write_contact(batch, lane, work.contacts[contacts_[batch.first_contact + lane]]);
        }
    });
}

void WideContactSolver::solve(int passes, const ContactSoftness& softness, std::span<BodyState> bodies,
                              std::span<const BodyConstants> constants, std::span<Contact> contacts, TaskPool& pool) {
    if (lines_.size() < used_lines_) lines_.resize(used_lines_ + used_lines_ / 2);
    kicked_.assign(velocity_.size(), {});
    const ContactSweep sweep{.velocity = velocity_[0].value,
                             .motion = motion_[0].value,
                             .substep = to_float(substep_),
                             .bias_rate = to_float(softness.bias_rate),
                             .mass_scale = to_float(softness.mass_scale),
                             .impulse_scale = to_float(softness.impulse_scale),
                             .push_speed = to_float(softness.push_speed)};
    const int workers =
        batches_.size() * static_cast<std::size_t>(lanes()) < fewest_contacts_shared ? 1 : pool.workers();
    Barrier barrier(workers);
    const Work work{bodies, constants, contacts, sweep, passes, workers, barrier};
    if (workers == 1) {
        solve_share(work, 0);
    } else {
        pool.run([&](int worker) { solve_share(work, worker); });
    }
}

void WideContactSolver::write_body(std::size_t row, BodyState& state, const BodyConstants& constants) const {
    const float *v = velocity_[row].value, *x = motion_[row].value;
    state.center = state.start_center + Vec3{x[0], x[1], x[2]};
    state.linear_velocity += Vec3{v[0], v[1], v[2]};
    state.angular_velocity += Vec3{v[3], v[4], v[5]};
    const Quat turn{x[3], x[4], x[5], x[6]};
    if (turn != state.turn) finish_turn(state, constants, turn);
}

void WideContactSolver::write_contact(const Batch& batch, std::uint32_t lane, Contact& contact) const {
    const int lanes = kernels_->lanes;
    const float* head = lines_[batch.first_line].value + lane;
    const auto read = [&](int quantity) { return head[quantity * lanes]; };
    const auto read_friction = [&](int first) { return PatchFriction{read(first), read(first + 1), read(first + 2)}; };
    contact.friction = read_friction(BatchHead::friction);
    contact.friction_total = read_friction(BatchHead::friction_total);
    contact.rolling = {read(BatchHead::rolling), read(BatchHead::rolling + 1), read(BatchHead::rolling + 2)};
    contact.sticks = std::bit_cast<std::uint32_t>(read(BatchHead::sticks)) != 0;
    for (int i = 0; i < contact.count; ++i) {
        ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
        const float* from = head + (BatchHead::size + i * BatchPoint::size) * lanes;
        point.normal_mass = from[BatchPoint::normal_mass * lanes];
        point.impulse = from[BatchPoint::impulse * lanes];
        point.total = from[BatchPoint::total * lanes];
    }
}

}  // namespace embody::physics
