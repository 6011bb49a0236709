// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "physics/constraint/joint/joint.h"
#include "physics/constraint/joint/own_spin.h"
#include "physics/constraint/namespace.h"
#include "physics/linear/block_lu.h"

namespace embody::physics::constraint {

/// Bodies that joints connect: slots of the movable ones, ascending, and indices of the joints.
struct JointedList {
    std::span<const std::uint32_t> bodies, joints;
};

/// All joints of a list at once, by a sparse direct solve (docs/physics/joints.md). One list keeps one system from step
/// to step: it remembers the order of elimination.
class JointSystem {
public:
    /// The arrays that slots and indices lead into, and the step's settings.
    struct View {
        std::span<BodyState> bodies;
        std::span<const BodyConstants> constants;
        std::span<Joint> joints;
        const JointSettings& settings;
    };

    /// Whether a list is small enough.
    [[nodiscard]] static bool fits(const JointedList& list) {
        return list.bodies.size() + list.joints.size() <= BlockPattern::max_nodes;
    }

    /// How far a body may turn in a substep. Small: the joints are solved by their rows at its start. That is robust,
    /// but loses some energy and leaves errors to be corrected.
    enum class Motion { any, small };

    /// What happens to the joints' errors in a motion. Kept: the motion back leads to where it began.
    enum class Errors { corrected, kept };

    /// Takes the list over. Bodies keep their slots and joints their places until the next call. A joint's body that
    /// the list lacks is taken as immovable.
    void set(const JointedList& list, const View& view);
    /// The joints' impulses are not those of a known substep: the next phase starts without them.
    void start_cold() { impulse_time_ = 0; }

    /// Moves bodies that only joints and forces act on through `time`, s: halves of the kick, the joints' impulses and
    /// the drift; back, if the time is negative. A motion that is too fast for one step is taken in parts. Bodies
    /// outside the list that are joined to the list's move by their own velocities.
    void advance(double time, const View& view, Errors errors = Errors::corrected);
    /// Lists those bodies as they are now.
    void list_carriers(const View& view, std::vector<std::pair<std::uint32_t, BodyState>>& carriers) const;

    // For use where others change velocities between iterations. The joints must have been prepared anew.

    /// Starts a phase of a substep, s.
    void begin_phase(SolvePhase phase, double substep, Motion motion, const View& view);
    /// One iteration of Newton's method. Returns the largest speed that it had to correct, m/s or rad/s; where that is
    /// only rounding, nothing is changed.
    double round(const View& view);
    /// After the last iteration of the position phase: prepares the bodies for their drift.
    void end_position_phase(const View& view);

    /// Of the list, J.
    [[nodiscard]] double kinetic_energy(const View& view) const;
    /// Scales the velocities where they have more energy than that, unless motors or moving bodies outside the list may
    /// have added it; returns the factor, at most 1.
    double bound_energy(double most, const View& view) const;
    /// Of the list, kg.
    [[nodiscard]] double mass(const View& view) const;

private:
    struct Body {
        std::uint32_t slot = 0;
        bool has_gyroscopic_torque = false;
        Vec3 spin_axis;                 // see OwnSpin, body axes; zero: the body has none
        OwnSpin own_spin;               // of this substep, taken off the angular velocity
        Mat3 inertia = Mat3::zero();    // world axes, when the phase began, kg m²
        Mat3 turning = Mat3::zero();    // Motion::small: how joints hold against turning, kg m²
        Vec3 free_velocity, free_spin;  // without the joints' impulses; the spin of isotropic bodies
        Vec3 free_momentum;             // angular, of the others
        Vec3 last_velocity, last_spin;  // after the last iteration
        Transform after;                // centre of mass and rotation after the drift, as it looks now
        Vec6 impulse;                   // of the joints
        Vec6 second_half;               // change of the velocities after the drift
    };
    /// A joint's bodies and blocks.
    struct Place {
        std::uint32_t joint = 0;      // index
        std::int32_t a = -1, b = -1;  // numbers of the bodies; −1: not in the list
        std::uint32_t edge_a = 0, edge_b = 0;
        bool is_held = false;  // its free row is part of the factors
        JointPose before, after;
    };

    /// What advance() goes back to.
    struct Start {
        std::vector<BodyState> bodies, carriers;
        std::vector<Joint> joints;
        double impulse_time = 0;
    };

    void advance(double time, int halvings, const View& view);
    bool advance_in_one(double time, Motion motion, const View& view);
    void remember(Start& start, const View& view) const;
    void go_back(const Start& start, const View& view);
    void drift_all(const View& view);
    void prepare_all(const View& view) const;
    bool iterate(const View& view);
    void add_impulses_to_totals(const View& view) const;

    void find_spin_axes(const View& view);
    void take_spin_aside(Body& body, double time, const View& view);
    void drift_spinning(Body& body, const View& view);
    void add_turning(const Place& place, const Joint& joint);
    void absorb_changes(const View& view);
    double choose_holds(const View& view);
    double find_excess(const View& view);
    double find_residuals(const View& view);
    void sum_impulses(const View& view, bool with_free_rows);
    void factor(const View& view);
    void add_body_blocks(const View& view);
    void add_turning_forces(const Place& place, const View& view);
    void add_joint_blocks(std::size_t number, const View& view);
    void apply_solution(const View& view);

    std::vector<Body> bodies_;
    std::vector<std::uint32_t> carriers_;  // slots of bodies outside the list that joints hold on to
    std::vector<Place> places_;
    std::vector<std::array<std::int32_t, 2>> ends_;  // of the joints, as analysed
    std::size_t analysed_bodies_ = 0;
    std::vector<BlockPattern::Edge> edges_;
    BlockLu matrix_;
    std::vector<Vec6> unknowns_;  // velocities of the bodies, impulses of the joints

    SolvePhase phase_ = SolvePhase::position;
    double substep_ = 0;  // s
    bool is_first_ = true, is_linear_ = false, has_factors_ = false;
    Errors errors_ = Errors::corrected;
    double impulse_time_ = 0;  // s: duration of the last impulses of the position phase, both halves
    bool has_motor_ = false;
    std::vector<Start> starts_;  // by the number of halvings left
    double last_error_ = 0;
};

}  // namespace embody::physics::constraint
