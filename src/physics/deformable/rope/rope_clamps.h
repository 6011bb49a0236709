// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "physics/deformable/namespace.h"
#include "physics/deformable/rope/rope_segment.h"
#include "physics/deformable/rope/rope_system.h"

namespace embody::physics::deformable {

/// Where a rope's direction is held, and the twist of its spans from one such place to the next
/// (docs/physics/ropes.md).
class RopeClamps {
public:
    /// Input at the start of a substep.
    struct Start {
        const Rope& rope;
        std::span<const RopeSegment> segments;
        const Nodes& nodes;
        const std::vector<bool>& fixed;
        const TouchSprings& springs;  ///< for the attachments
        std::span<const TouchedBody> bodies;
        const Substep& substep;
    };

    /// Spans between clamps that were there already keep their twist, others begin without.
    void set(const std::vector<Clamp>& clamps);
    [[nodiscard]] const std::vector<Clamp>& clamps() const { return clamps_; }
    void begin(const Start& start);
    [[nodiscard]] bool holds_any() const { return !held_.empty(); }
    [[nodiscard]] bool holds(std::size_t node) const;
    [[nodiscard]] bool has_twist() const { return !spans_.empty(); }
    /// How a clamp lies in the world: along the rope, and a vector across it.
    struct Frame {
        Vec3 axis, side;
    };
    /// Of a held node after these moves of the bodies (none: on the path of what holds it), since begin().
    [[nodiscard]] std::optional<Frame> frame_at(std::size_t node, std::span<const BodyMove> body_moves) const;
    /// When the substep began.
    [[nodiscard]] std::optional<Frame> start_frame_at(std::size_t node) const;
    /// The body that turns the node's clamp; no_body: none.
    [[nodiscard]] std::uint32_t body_at(std::size_t node) const;

    /// Adds to the system about these moves. `with_curvature`: also the sideways forces of the moments on bent rope,
    /// which are positive definite only as long as the rope does not buckle.
    void add(std::span<const Vec3> places, std::span<const Vec3> moves, std::span<const BodyMove> body_moves,
             bool with_curvature, RopeSystem& system) const;
    /// Moments of the twists, as a solve has predicted them, N m.
    void predict(std::span<const double> moments);
    /// Elastic energy and damping, J.
    [[nodiscard]] double energy(std::span<const Vec3> places, std::span<const BodyMove> body_moves) const;
    /// Pushes the bodies, and stores the twists.
    void finish(std::span<const Vec3> places, std::span<const BodyMove> body_moves, double h,
                std::span<TouchedBody> bodies);

    /// In the last substep.
    [[nodiscard]] std::span<const RopeTwist> twists() const { return twists_; }
    [[nodiscard]] double elastic_energy() const { return elastic_energy_; }

private:
    // A clamp whose holder exists.
    struct Held {
        Clamp clamp;
        std::uint32_t body = no_body, slot = no_body;  // no_body: the world
        Vec3 axis, side;                               // unit, at the substep's end on the body's path
        Frame start;                                   // when it began
    };
    // Between a clamp and half of a segment at it.
    struct HalfBend {
        std::size_t held = 0, segment = 0;
        double stiffness = 0;  // N m
        Vec3 start;            // turn of the direction when the substep began
        Mat3 damping = Mat3::zero();
    };
    struct Span {
        std::size_t from = 0, to = 0;       // indices of held_
        double stiffness = 0, damping = 0;  // GJ / L, N m/rad; the same of the change in the substep
        double straight = 0;                // the angle without twist, rad
        double angle = 0, moment = 0;       // when the substep began; as predicted, N m
    };
    // Memory of a span from substep to substep.
    struct Memory {
        std::uint32_t from = 0, to = 0;            // nodes
        std::uint32_t from_slot = 0, to_slot = 0;  // of the bodies
        double straight = 0, angle = 0;
    };
    // Directions along a span, those of its clamps first and last, and the curvature between each and the next.
    struct Bow {
        std::vector<SegmentDirection> directions;
        std::vector<Vec3> curvature;
    };
    [[nodiscard]] Frame frame_of(const Held& held, std::span<const BodyMove> body_moves) const;
    [[nodiscard]] double read_angle(std::size_t from_node, std::size_t to_node, const Frame& from, const Frame& to,
                                    std::span<const Vec3> places) const;
    [[nodiscard]] double angle_of(const Span& span, std::span<const Vec3> places,
                                  std::span<const BodyMove> body_moves) const;
    [[nodiscard]] Vec3 turn_of(const HalfBend& bend, std::span<const Vec3> places,
                               std::span<const BodyMove> body_moves) const;
    [[nodiscard]] Bow bow_of(const Span& span, std::span<const Vec3> places,
                             std::span<const BodyMove> body_moves) const;
    [[nodiscard]] TwistMode mode_of(const Span& span, const Bow& bow) const;
    void find_held(const Start& start, std::vector<Frame>& at_start);
    void find_bends(const Start& start, std::span<const Frame> at_start);
    void find_spans(const Start& start, std::span<const Frame> at_start);
    void add_curvature(const HalfBend& bend, std::span<const Vec3> places, std::span<const Vec3> moves,
                       std::span<const BodyMove> body_moves, RopeSystem& system) const;
    void add_curvature(const Span& span, const Bow& bow, std::span<const Vec3> moves, RopeSystem& system) const;

    std::vector<Clamp> clamps_;  // by node
    std::vector<Memory> memory_;
    std::vector<RopeTwist> twists_;
    double elastic_energy_ = 0;

    // Of the substep.
    std::vector<double> lengths_;  // of segments at rest, m
    double fold_limit_ = 0;        // RopeSettings::fold_limit
    std::vector<Held> held_;
    std::vector<HalfBend> bends_;
    std::vector<Span> spans_;
};

}  // namespace embody::physics::deformable
