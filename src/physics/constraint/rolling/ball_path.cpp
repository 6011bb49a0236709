// SPDX-License-Identifier: MIT
//
// A ball along still ground: in parts of the step it moves along the plane that touches it, is put back onto the ground
// there, and its motion is turned with the normal. A mesh stands for a smooth surface where its edges turn by less than
// smooth_edge_angle: there the turn takes no energy. Whatever error the parts make, the speed follows from the energy:
//     T₁ = T₀ + m a · (x₁ − x₀) + work of friction,
// so the ball loses in its motion what putting it back onto the ground lifts it.
#include "physics/constraint/rolling/ball_path.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "physics/collision/queries/ball_touch.h"
#include "physics/dynamic/equations_of_motion.h"

namespace embody::physics::constraint {

namespace {

constexpr double same_normal = 1 - 1e-9;   // cosine: 4e-5 rad; a mesh's floats leave 1e-7 of a flat face
constexpr double min_travel = 1e-9;        // of the radius, in a part: a ball that moves less stands still
constexpr double level_sine = 1e-6;        // of the slope: rounding leaves 1e-15 on level ground
constexpr double beside_gap = 1e-6;        // of the radius: a place within this touches; rounding leaves 1e-15
constexpr double max_counted_parts = 1e6;  // no integer takes more than 2e9; max_parts is far below

const double smooth_cosine = std::cos(smooth_edge_angle);

}  // namespace

BallPath::BallPath(const BallInStep& ball, BallSurroundings& surroundings)
    : ball_(ball),
      limits_(ball.settings),
      settings_(ball.settings.ball),
      state_(ball.state),
      step_(ball.step),
      radius_(ball.radius),
      acceleration_(ball.constants.acceleration),
      mass_(ball.constants.mass),
      grounds_(surroundings.grounds),
      touches_(surroundings.touches),
      ground_of_(surroundings.ground_of) {
    for (const std::uint32_t index : ball.own) {
        const Contact& contact = ball.all_contacts[index];
        was_touching_ = was_touching_ || contact.was_touching;
        bounces_ = bounces_ || contact.bounces;
        resists_ = resists_ || contact.friction_rolling > 0 || contact.friction_torsional > 0;
    }
}

void BallPath::find(Vec3 center, double margin) {
    touches_.clear();
    ground_of_.clear();
    for (std::size_t i = 0; i < grounds_.size(); ++i) {
        find_ball_touches(ball_.shape, radius_, center, *grounds_[i].shape, grounds_[i].pose, margin, touches_);
        ground_of_.resize(touches_.size(), i);
    }
}

// Puts the ball onto the ground around it: the surfaces there count as planes. The touch is the last one that moved the
// ball.
bool BallPath::settle(BallPlace& at, const Vec3* last_normal, double margin) {
    constexpr double rounding = 1e-12;  // m; a centre metres away is known to 1e-15
    find(at.center, margin);
    if (touches_.empty()) return false;
    Vec3 displacement;
    std::size_t chosen = 0;
    for (int iteration = 0; iteration < settings_.settle_iterations; ++iteration) {
        double least = 1e300;
        std::size_t nearest = 0;
        for (std::size_t i = 0; i < touches_.size(); ++i) {
            const double gap = touches_[i].gap + dot(displacement, touches_[i].normal);
            if (gap >= least) continue;
            least = gap;
            nearest = i;
        }
        if (iteration > 0 && least > -rounding) break;
        chosen = nearest;
        displacement -= touches_[nearest].normal * least;
    }
    if (!(length(displacement) < settings_.part_travel_fraction * radius_)) return false;
    at.center += displacement;
    at.touch = touches_[chosen];
    at.ground = ground_of_[chosen];

    // A place that the ball comes to while another touches is hit.
    const auto is_beside = [&](const BallTouch& touch) {
        return touch.gap + dot(displacement, touch.normal) < rounding + beside_gap * radius_ &&
               dot(touch.normal, at.touch.normal) < smooth_cosine && dot(touch.normal, at.motion.velocity) <= 0;
    };
    return std::none_of(touches_.begin(), touches_.end(), is_beside) ||
           (last_normal != nullptr && dot(*last_normal, at.touch.normal) < smooth_cosine);
}

// The ball comes to a place at a real angle to the last one: the velocity into it is lost, as in any impact without a
// bounce. False where the ball bounces or is wedged between the two, which the contact solver handles.
bool BallPath::hit(BallPlace& at, Vec3 last_normal) {
    const Vec3 n = at.touch.normal;
    const double closing = -dot(at.motion.velocity, n);
    if (bounces_ || closing < 0) return false;
    at.motion.velocity += n * closing;
    if (dot(at.motion.velocity, last_normal) < length(acceleration_) * step_ / ball_.substeps) return false;
    at.rolls = push_along(at.motion, n, {}, closing, grounds_[at.ground].friction, 1).sticks;
    return true;
}

// Whether all that was found is one flat face.
bool BallPath::is_flat(const BallPlace& at) const {
    return std::all_of(touches_.begin(), touches_.end(), [&](const BallTouch& touch) {
        return touch.is_flat && dot(touch.normal, at.touch.normal) >= same_normal;
    });
}

// The ground is flat as far as the ball gets, and level or resisting: the contact solver loses no energy there.
// Triangles beyond a hollow edge cannot be seen before it: so the place that the ball gets to is checked, too.
bool BallPath::is_plain(const BallPlace& at) {
    const bool is_level = length(cross(acceleration_, at.touch.normal)) <= level_sine * length(acceleration_);
    if (!(is_level || resists_) || !is_flat(at)) return false;
    find(at.center + at.motion.velocity * step_, limits_.touch_gap);
    return is_flat(at);
}

bool BallPath::begin(BallPlace& at, bool has_company) {
    const double inertia = ball_.constants.inertia.x.x / (mass_ * radius_ * radius_);
    at = {};
    at.center = state_.center;
    at.rotation = state_.rotation;
    at.motion = {state_.linear_velocity, state_.angular_velocity, radius_, inertia};
    const double speed = length(at.motion.velocity);
    const double reach = speed * step_ + length(acceleration_) * step_ * step_ / 2;
    if (!settle(at, nullptr, std::min(reach, radius_) + limits_.touch_gap)) return false;
    const Vec3 n = at.touch.normal;
    const double gap = at.touch.gap, closing = -dot(at.motion.velocity, n);
    const bool is_on_face = is_flat(at);
    const double max_depth = settings_.max_depth_fraction * radius_;
    if (gap > std::min(limits_.touch_gap, max_depth) || gap < -max_depth || is_plain(at)) return false;
    const double max_parting = limits_.max_parting_speed + (bounces_ ? 0 : settings_.max_parting_fraction * speed);
    if (-closing > max_parting) return false;
    const double slowest_impact = limits_.max_approach_speed;
    if (closing > (was_touching_ && !bounces_ ? slowest_impact + smooth_edge_angle * speed : slowest_impact))
        return false;

    // The remaining velocity into the ground is removed; the energy of lifting the ball out is taken from its motion.
    at.motion.velocity += n * closing;
    const Vec3 along = acceleration_ - n * dot(acceleration_, n);
    const double least = resists_ ? settings_.slow_resisted_speed : is_on_face ? 0 : settings_.slow_speed;
    if (!has_company && length(at.motion.velocity) + length(along) * step_ < least) return false;
    const BallFriction& friction = grounds_[at.ground].friction;
    at.rolls = friction.at_rest > 0 && length(at.motion.slip(n)) <= settings_.roll_slip_fraction * speed;
    const double start = at.motion.energy(), given = dot(acceleration_, at.center - state_.center);
    return std::fabs(gap) < settings_.min_sag || set_energy(at.motion, n, start + given, at.rolls);
}

int BallPath::count_parts(const BallPlace& at) const {
    const double speed = length(at.motion.velocity) + length(acceleration_) * step_ / 2;
    const double max_closeness = 1 - settings_.min_hollow_fraction;
    double curvature = 0;
    for (const BallTouch& touch : touches_) {
        const double own =
            std::max({length(touch.shape_operator.x), length(touch.shape_operator.y), length(touch.shape_operator.z)});
        curvature = std::max(curvature, touch.knows_curvature ? own / (1 - std::min(max_closeness, own * radius_))
                                        : touch.is_flat       ? 0
                                                              : 1 / radius_);
    }
    const double rate = std::max(speed * curvature, std::sqrt(length(acceleration_) * curvature));
    const double parts =
        std::max({rate * step_ / settings_.part_turn, speed * step_ / (settings_.part_travel_fraction * radius_),
                  static_cast<double>(ball_.substeps)});
    return static_cast<int>(std::ceil(std::min(parts, max_counted_parts)));
}

// The ground's acceleration on the ball, m/s²: on a smooth mesh by the curvature κ, the centre's path having κ/(1 + κ
// r); else by the last part.
double BallPath::load(const BallPlace& at) const {
    double centripetal = at.centripetal;
    const double squared = length_squared(at.motion.velocity);
    if (at.touch.knows_curvature && squared > 0) {
        const double curvature = dot(at.motion.velocity, at.touch.shape_operator * at.motion.velocity) / squared;
        centripetal = squared * curvature / std::max(settings_.min_hollow_fraction, 1 + curvature * radius_);
    }
    return -dot(acceleration_, at.touch.normal) - centripetal;
}

// Whether free flight takes it off the ground within a step's time.
bool BallPath::leaves(const BallPlace& at) {
    constexpr double clear = 1e-11;  // m: a gap is known to 1e-15
    find(at.center + (at.motion.velocity + acceleration_ * (step_ / 2)) * step_, clear);
    return touches_.empty();
}

// Moves the ball along the plane that touches it at the start, pressed by so much (m/s²). Returns the work of friction,
// J/kg.
double BallPath::move_along_plane(const BallPlace& from, BallPlace& to, double pressing, double time) const {
    const Vec3 n = from.touch.normal, along = acceleration_ - n * dot(acceleration_, n);
    const BallPush push = push_along(to.motion, n, along, pressing, grounds_[from.ground].friction, time);
    to.center += push.mean_velocity * time;
    to.rolls = push.sticks;
    const Vec3 turned = (from.motion.spin + to.motion.spin) * (time / 2);
    to.rotation = normalized(cayley(turned) * from.rotation);
    return push.work;
}

// Turns the motion with the ground, which loses no energy, or hits a place at a real angle to the last one. Returns the
// energy lost, J/kg, <= 0; none where the ball bounces or is wedged.
std::optional<double> BallPath::turn_or_hit(BallPlace& at, Vec3 last_normal, double time) {
    const Vec3 n = at.touch.normal;
    if (dot(last_normal, n) >= smooth_cosine) {
        at.centripetal = dot(at.motion.velocity, n - last_normal) / time;
        turn_with_normal(at.motion, last_normal, n, at.rolls);
        return 0;
    }
    const double before = at.motion.energy();
    if (!hit(at, last_normal)) return std::nullopt;
    at.centripetal = 0;
    return at.motion.energy() - before;
}

bool BallPath::advance(BallPlace& at, double time, int halvings) {
    const auto in_halves = [&] {
        return halvings > 0 && advance(at, time / 2, halvings - 1) && advance(at, time / 2, halvings - 1);
    };
    const double pressing = load(at);
    if (pressing < 0 && leaves(at)) return false;

    // Along the plane, and back onto the ground.
    BallPlace next = at;
    const double friction_work = move_along_plane(at, next, std::max(0.0, pressing), time);
    const Vec3 last_normal = at.touch.normal;
    const double moved = length(next.center - at.center);
    if (!settle(next, &last_normal, smooth_edge_angle * moved + beside_gap * radius_)) return in_halves();

    // Sets the speed by the energy that is left.
    const std::optional<double> lost = turn_or_hit(next, last_normal, time);
    if (!lost) return false;
    const double left = at.motion.energy() + dot(acceleration_, next.center - at.center) + friction_work + *lost;
    const bool may_halve = halvings > 0 && moved > min_travel * radius_;
    if (!set_energy(next.motion, next.touch.normal, left, next.rolls) && may_halve) return in_halves();
    at = next;
    return true;
}

bool BallPath::write(const BallPlace& at, Vec3 received, RolledBall& rolled) const {
    if (!is_finite(at.center) || !is_finite(at.motion.velocity) || !is_finite(at.motion.spin)) return false;
    rolled.body = ball_.body;
    rolled.state = state_;
    rolled.state.center = at.center;
    rolled.state.rotation = at.rotation;
    rolled.state.turn = at.rotation * conjugate(state_.start_rotation);
    rolled.state.linear_velocity = at.motion.velocity;
    rolled.state.angular_velocity = at.motion.spin;
    double best = -2;
    for (const std::uint32_t index : ball_.own) {
        const Contact& contact = ball_.all_contacts[index];
        const double sign = contact.b == ball_.body ? 1 : -1, cosine = sign * dot(contact.normal, at.touch.normal);
        if (cosine <= best) continue;
        best = cosine;
        rolled.contact = index;
        rolled.impulse =
            ((at.motion.velocity - state_.linear_velocity - acceleration_ * step_) * mass_ - received) * sign;
    }
    return true;
}

bool BallPath::advance(BallPlace& at, double time) { return advance(at, time, settings_.max_halvings); }

bool BallPath::see_curvature(BallPlace& at, double part) {
    if (at.touch.knows_curvature || at.touch.is_flat) return true;
    BallPlace trial = at;
    if (!advance(trial, part)) return false;
    at.centripetal = trial.centripetal;
    return true;
}

bool BallPath::roll(RolledBall& rolled) {
    BallPlace start;
    if (!begin(start, false)) return false;
    int parts = count_parts(start);
    if (parts > settings_.max_parts) return false;
    if (!see_curvature(start, step_ / parts)) return false;
    BallPlace at = start;
    for (int i = 0; i < parts; ++i) {
        if (!advance(at, step_ / parts)) return false;
    }
    return write(at, {}, rolled);
}

}  // namespace embody::physics::constraint
