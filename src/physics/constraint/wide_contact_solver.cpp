// SPDX-License-Identifier: MIT
#include "physics/constraint/wide_contact_solver.h"

#include <algorithm>
#include <bit>

#include "physics/dynamic/equations_of_motion.h"

namespace embody::physics {

namespace {

constexpr double push_speed = 3;  // m/s: overlapping bodies part no faster than this
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

void fill_point(Lane lane, const Contact& contact, const ContactPoint& point, std::span<const BodyState> bodies) {
    // In double: what both bodies have in common takes no digits from what they differ in.
    const Vec3 velocity = relative_velocity(contact, point, bodies);
    lane.set(BatchPoint::start_speed,
             Vec3{dot(velocity, contact.normal), dot(velocity, contact.tangent_1), dot(velocity, contact.tangent_2)});
    lane.set(BatchPoint::arm_a, point.arm_a);
    lane.set(BatchPoint::arm_b, point.arm_b);
    lane.set(BatchPoint::separation_found, point.separation);
    lane.set(BatchPoint::normal_mass, 1);  // it exists; prepare() puts the mass here
    lane.set(BatchPoint::impulse_normal, point.impulse.normal);
    lane.set(BatchPoint::impulse_1, point.impulse.tangent_1);
    lane.set(BatchPoint::impulse_2, point.impulse.tangent_2);
    lane.set(BatchPoint::total_normal, point.total.normal);
    lane.set(BatchPoint::total_1, point.total.tangent_1);
    lane.set(BatchPoint::total_2, point.total.tangent_2);
    lane.set_mask(BatchPoint::sticks, point.sticks);
    lane.set(BatchPoint::inactive_until, point.inactive_until);
}

bool resists_turning(const Material& material) {
    return material.friction_rolling > 0 || material.friction_torsional > 0;
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
    contacts_.clear();
    lines_.clear();

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
        if (has_gyroscopic_torque(state, c, step)) split_gyroscopic(state, c, step);
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

void WideContactSolver::add_batch(std::span<const std::uint32_t> batch, std::span<const Contact> contacts,
                                  std::span<const BodyState> bodies) {
    const int lanes = kernels_->lanes;
    Batch placed{static_cast<std::uint32_t>(lines_.size()), static_cast<std::uint32_t>(contacts_.size()),
                 static_cast<std::uint32_t>(batch.size()), 0};
    contacts_.insert(contacts_.end(), batch.begin(), batch.end());
    for (const std::uint32_t i : batch) placed.points = std::max(placed.points, contacts[i].count);
    const auto floats = static_cast<std::size_t>(batch_floats(lanes, placed.points));
    lines_.resize(lines_.size() + (floats + 15) / 16, CacheLine{});
    float* data = lines_[placed.first_line].value;

    std::int32_t writable_a = 0, writable_b = 0, turning = 0;
    for (std::size_t k = 0; k < batch.size(); ++k) {
        const Contact& contact = contacts[batch[k]];
        const BodyState &a = bodies[contact.a], &b = bodies[contact.b];
        Lane head(data, lanes, k);
        head.set_integer(BatchHead::body_a, row_of(contact.a, bodies));
        head.set_integer(BatchHead::body_b, row_of(contact.b, bodies));
        head.set(BatchHead::inverse_mass_a, a.inverse_mass);
        head.set(BatchHead::inverse_mass_b, b.inverse_mass);
        head.set_symmetric(BatchHead::inverse_inertia_a, a.inverse_inertia);
        head.set_symmetric(BatchHead::inverse_inertia_b, b.inverse_inertia);
        head.set(BatchHead::normal, contact.normal);
        head.set(BatchHead::tangent_1, contact.tangent_1);
        head.set(BatchHead::tangent_2, contact.tangent_2);
        head.set(BatchHead::friction_static, contact.material.friction_static);
        head.set(BatchHead::friction_dynamic, contact.material.friction_dynamic);
        head.set(BatchHead::friction_torsional, contact.material.friction_torsional);
        head.set(BatchHead::friction_rolling, contact.material.friction_rolling);
        head.set(BatchHead::start_spin, b.angular_velocity - a.angular_velocity);
        head.set(BatchHead::turning, contact.turning);
        head.set_mask(BatchHead::round_a, contact.a_is_round);
        head.set_mask(BatchHead::round_b, contact.b_is_round);
        writable_a |= (a.inverse_mass > 0 ? 1 : 0) << k;
        writable_b |= (b.inverse_mass > 0 ? 1 : 0) << k;
        turning |= (resists_turning(contact.material) ? 1 : 0) << k;
        for (int i = 0; i < contact.count; ++i) {
            float* point = data + (BatchHead::size + i * BatchPoint::size) * lanes;
            fill_point(Lane(point, lanes, k), contact, contact.points[static_cast<std::size_t>(i)], bodies);
        }
    }
    Lane(data, lanes, 0).set_integer(BatchHead::writable, writable_a);
    Lane(data, lanes, 1).set_integer(BatchHead::writable, writable_b);
    Lane(data, lanes, 2).set_integer(BatchHead::writable, turning);
    kernels_->prepare(data, placed.points);
    batches_.push_back(placed);
}

template <class Kernel>
void WideContactSolver::sweep_up(Kernel kernel) {
    for (const Batch& batch : batches_) kernel(lines_[batch.first_line].value, batch.points);
}

template <class Kernel>
void WideContactSolver::sweep_down(Kernel kernel) {
    for (auto batch = batches_.rbegin(); batch != batches_.rend(); ++batch) {
        kernel(lines_[batch->first_line].value, batch->points);
    }
}

void WideContactSolver::run(int passes, const ContactSoftness& softness) {
    kicked_ = velocity_;
    const auto row_count = static_cast<std::int32_t>(velocity_.size());
    const BodyRows rows{velocity_[0].value, motion_[0].value,  start_[0].value,
                        kick_[0].value,     damping_[0].value, kicked_[0].value};
    ContactSweep sweep{.velocity = rows.velocity,
                       .motion = rows.motion,
                       .substep = to_float(substep_),
                       .bias_rate = to_float(softness.bias_rate),
                       .mass_scale = to_float(softness.mass_scale),
                       .impulse_scale = to_float(softness.impulse_scale),
                       .push_speed = to_float(push_speed)};
    const ContactKernels& k = *kernels_;

    sweep_up([&](float* batch, int points) { k.separate(batch, points, sweep); });
    for (int substep = 1; substep <= substeps_; ++substep) {
        // Forces, constraints that also mend positions, motion.
        sweep.time = to_float(substep * substep_);
        k.kick(rows, 1, row_count);
        sweep_up([&](float* batch, int points) { k.warm_start(batch, points, sweep); });
        for (int pass = 0; pass < passes; ++pass) {
            sweep_down([&](float* batch, int points) { k.solve_positions(batch, points, sweep); });
        }
        k.drift(rows, sweep.substep, 1, row_count);

        // Constraints on the velocity alone.
        for (int pass = 0; pass < passes; ++pass) {
            sweep.is_first = pass == 0;
            sweep.is_last = pass + 1 == passes;
            sweep_down([&](float* batch, int points) { k.solve_velocities(batch, points, sweep); });
        }
    }
}

void WideContactSolver::write_body(std::size_t row, BodyState& state, const BodyConstants& constants) const {
    const float *v = velocity_[row].value, *x = motion_[row].value;
    state.center = state.start_center + Vec3{x[0], x[1], x[2]};
    state.linear_velocity += Vec3{v[0], v[1], v[2]};
    state.angular_velocity += Vec3{v[3], v[4], v[5]};
    const Quat turn{x[3], x[4], x[5], x[6]};
    if (turn == state.turn) return;

    // The momentum that turned with the mean velocity belongs to another velocity of the turned body.
    const bool has_hidden = state.hidden_momentum != Vec3{};
    const Vec3 momentum = has_hidden ? momentum_of(state, constants) : Vec3{};
    state.turn = turn;
    state.rotation = normalized(turn * state.start_rotation);
    refresh_inertia(state, constants);
    if (has_hidden) state.angular_velocity = state.inverse_inertia * momentum;
}

void WideContactSolver::write_contact(const Batch& batch, std::uint32_t lane, Contact& contact) const {
    const int lanes = kernels_->lanes;
    const float* head = lines_[batch.first_line].value + lane;
    contact.turning = {head[BatchHead::turning * lanes], head[(BatchHead::turning + 1) * lanes],
                       head[(BatchHead::turning + 2) * lanes]};
    for (int i = 0; i < contact.count; ++i) {
        ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
        const float* from = head + (BatchHead::size + i * BatchPoint::size) * lanes;
        const auto read = [&](int quantity) { return from[quantity * lanes]; };
        point.normal_mass = read(BatchPoint::normal_mass);
        point.impulse = {read(BatchPoint::impulse_normal), read(BatchPoint::impulse_1), read(BatchPoint::impulse_2)};
        point.total = {read(BatchPoint::total_normal), read(BatchPoint::total_1), read(BatchPoint::total_2)};
        point.sticks = std::bit_cast<std::uint32_t>(from[BatchPoint::sticks * lanes]) != 0;
    }
}

void WideContactSolver::finish(std::span<BodyState> bodies, std::span<const BodyConstants> constants,
                               std::span<Contact> contacts) const {
    for (std::size_t row = 1; row < movable_rows_; ++row) {
        const std::uint32_t body = slot_of_row_[row];
        write_body(row, bodies[body], constants[body]);
    }
    for (const Batch& batch : batches_) {
        for (std::uint32_t lane = 0; lane < batch.contact_count; ++lane) {
            write_contact(batch, lane, contacts[contacts_[batch.first_contact + lane]]);
        }
    }
}

}  // namespace embody::physics
