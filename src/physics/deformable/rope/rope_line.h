// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "physics/deformable/cloth/cloth_solver.h"
#include "physics/deformable/contact/nodes.h"
#include "physics/deformable/contact/support_springs.h"
#include "physics/deformable/namespace.h"
#include "physics/deformable/rope/rope_clamps.h"
#include "physics/deformable/rope/rope_folds.h"
#include "physics/deformable/rope/rope_system.h"

namespace embody::physics::deformable {

/// A rope in motion: stretch and bending of a line of nodes by backward Euler, with Newton's method and a direct solve,
/// so that it is exact for any stiffness (docs/physics/ropes.md).
class RopeLine {
public:
    /// `definition` is valid and its matter is a rope.
    explicit RopeLine(const DeformableDefinition& definition);

    /// One substep. `attachment_bodies`: where the attachments hold in `bodies`; `held`: other springs on its nodes
    /// that act and are to no body. Pushes the bodies.
    void advance(const Substep& substep, std::span<const NodeContact> contacts,
                 std::span<const SegmentContact> segment_contacts, std::span<const std::uint32_t> attachment_bodies,
                 std::span<TouchedBody> bodies, std::span<const TouchSpring> held = {});

    // For a solve together with other sheets and ropes that it touches (docs/physics/cloth.md):
    /// Finds touch() and node_stiffness() for the substep.
    void begin(const Substep& substep, std::span<const NodeContact> contacts,
               std::span<const SegmentContact> segment_contacts, std::span<const std::uint32_t> attachment_bodies,
               std::span<const TouchedBody> bodies);
    /// The equations about these moves, without springs; valid until the next call. Their solution is moves again.
    LineSystem linearize(const Substep& substep, std::span<const Vec3> moves);
    /// After linearize(), for a rope that touches itself and no other: solves its equations with these springs
    /// directly, wherever along the rope their nodes lie. False where that fails.
    bool solve_linear(std::span<const TouchSpring> springs, std::span<const BodyInertia> inertias,
                      std::vector<Vec3>& moves, std::vector<BodyMove>& body_moves);
    /// The function that the solve minimises, for the rope alone, without springs and clamps, J.
    [[nodiscard]] double energy(const Substep& substep, std::span<const Vec3> moves) const;
    /// Sets the tensions of its segments for a solve about the moves `from` with the solution `to`: for the next
    /// linearize().
    void predict(const Substep& substep, std::span<const Vec3> from, std::span<const Vec3> to);
    /// Ends the substep with these moves (m), which touch() was solved with, and changes them where the solve could not
    /// know. Pushes the bodies; `fractions` as of TouchSprings::finish().
    void finish(const Substep& substep, std::span<Vec3> moves, std::span<const BodyMove> body_moves,
                std::span<TouchedBody> bodies, std::span<const double> fractions);
    /// As of ClothSheet; a broken rope is not free.
    [[nodiscard]] bool is_free() const;
    std::vector<Vec3> take_impulses(const Substep& substep, std::span<const Vec3> moves);
    /// Moves the nodes by these moves (m) in h seconds; a segment may break.
    void move_nodes(std::span<const Vec3> moves, double h);
    [[nodiscard]] TouchSprings& touch() { return springs_; }
    [[nodiscard]] bool has_clamps() const { return clamps_.holds_any(); }
    /// Length of the first segment at rest, m.
    [[nodiscard]] double segment_length() const { return segments_[0].length; }
    /// Stiffness of each node alone, N/m, since begin().
    [[nodiscard]] std::span<const double> node_stiffness() const { return node_stiffness_; }
    /// The same by direction.
    [[nodiscard]] std::span<const Mat3> directed_stiffness() const { return springs_.directed_stiffness; }
    /// Stops it for good where it is.
    void freeze();

    /// Instead of the definition's.
    void set_attachments(const std::vector<Attachment>& attachments) { springs_.attachments = attachments; }
    void set_clamps(const std::vector<Clamp>& clamps) { clamps_.set(clamps); }
    [[nodiscard]] Nodes& nodes() { return nodes_; }
    [[nodiscard]] const Nodes& nodes() const { return nodes_; }
    /// Tension of each segment, from node k to k + 1, N; below zero: compression. 0 where it is broken.
    [[nodiscard]] std::span<const double> tensions() const { return tensions_; }
    [[nodiscard]] bool is_broken(std::size_t segment) const { return segments_[segment].is_broken; }
    void set_broken(std::size_t segment, bool is_broken) { segments_[segment].is_broken = is_broken; }
    /// Segments that broke in the last substep.
    struct Break {
        std::uint32_t segment = 0;
        double tension = 0;  ///< when it broke, N
    };
    [[nodiscard]] std::span<const Break> new_breaks() const { return new_breaks_; }
    /// Twists between clamps that hold, in the last substep.
    [[nodiscard]] std::span<const RopeTwist> twists() const { return clamps_.twists(); }
    /// Takes over broken segments, twists and contacts from another rope of as many segments.
    void go_on_from(const RopeLine& other);
    [[nodiscard]] RopeFolds& folds() { return folds_; }
    [[nodiscard]] const RopeFolds& folds() const { return folds_; }
    [[nodiscard]] std::span<const TouchSpring> springs() const { return springs_.springs(); }
    [[nodiscard]] double elastic_energy() const;
    /// True once a number was non-finite: the rope stays where it last was.
    [[nodiscard]] bool is_frozen() const { return is_frozen_; }
    /// Iterations of Newton's method in the last substep.
    [[nodiscard]] int iterations() const { return iterations_; }

private:
    // Turn of the direction at a node, with its derivatives by the three nodes.
    struct Bend {
        bool is_whole = false;
        double stiffness = 0;  // EI / l, N m
        Vec3 turn;
        std::array<Mat3, 3> by_node;
        Mat3 damping = Mat3::zero();  // over the substep, of the turn's change, N m
    };
    struct Tension {
        double force = 0, slope = 0;  // N, N/m
        double energy = 0;            // J
    };
    // The matrix and right side about `moves_`; forces of springs not yet.
    void assemble(const Substep& substep, bool with_curvature = true);
    void add_stretch(std::size_t segment, double h);
    void add_curvature(std::size_t node);
    bool solve_iteration(const Substep& substep, std::span<const BodyInertia> inertias);
    // The function that the iteration's step minimises: inertia, elastic energy, damping and springs of these moves, J.
    [[nodiscard]] double merit(const Substep& substep, std::span<const BodyInertia> inertias,
                               std::span<const Vec3> moves, std::span<const BodyMove> body_moves,
                               SpringEnergy spring_energy = energy_of) const;
    [[nodiscard]] double merit_pressed(const Substep& substep, std::span<const BodyInertia> inertias) const;
    bool take_step(const Substep& substep, std::span<const BodyInertia> inertias);
    bool solve_moves(const Substep& substep, std::span<const TouchedBody> bodies);
    void begin_supports(const Substep& substep, std::span<const TouchedBody> bodies);
    [[nodiscard]] std::vector<TouchSpring> all_springs() const;
    void break_segments();
    [[nodiscard]] Tension tension_at(std::size_t segment, double length) const;
    [[nodiscard]] Tension damped_tension_at(std::size_t segment, double length, double h) const;
    void begin_substep(double h);
    [[nodiscard]] Bend bend_at(std::size_t node, std::span<const Vec3> positions) const;
    [[nodiscard]] double energy_without_folds(const Substep& substep, std::span<const Vec3> moves) const;
    [[nodiscard]] double fold_energy(std::span<const Vec3> moves, std::span<const BodyMove> body_moves) const;
    // How clamps lie, by node.
    using Frames = std::function<std::optional<RopeClamps::Frame>(std::size_t)>;
    [[nodiscard]] Frames start_frames() const;
    [[nodiscard]] Frames end_frames(std::span<const BodyMove> body_moves) const;
    [[nodiscard]] std::vector<RopeCorner> corners(std::span<const Vec3> positions, const Frames& frames) const;
    [[nodiscard]] std::vector<Vec3> unstretched_moves(double h) const;
    void push_by_folds(const Substep& substep, std::span<const BodyMove> body_moves, std::span<TouchedBody> bodies);

    Rope rope_;
    Nodes nodes_;
    std::vector<RopeSegment> segments_;
    std::vector<bool> fixed_;
    TouchSprings springs_;
    SupportSprings supports_;  // of the bodies that it pushes, where it is solved alone
    RopeClamps clamps_;
    RopeFolds folds_;
    std::vector<double> tensions_;
    std::vector<Break> new_breaks_;

    // Of the substep.
    RopeSystem system_;
    std::vector<Vec3> places_, moves_, next_moves_;
    std::vector<TouchSpring> held_;
    std::vector<Vec3> small_load_;       // N
    std::vector<Bend> bends_;            // by node, when the substep began
    std::vector<double> start_lengths_;  // of segments, then, m
    std::vector<double> pulls_;          // of segments, as the last iteration predicted them, N
    std::vector<double> node_stiffness_;
    std::vector<BodyMove> body_moves_, next_body_moves_;
    std::vector<double> moments_;  // of twists, as the last iteration predicted them, N m
    bool is_frozen_ = false;
    int iterations_ = 0;
};

}  // namespace embody::physics::deformable
