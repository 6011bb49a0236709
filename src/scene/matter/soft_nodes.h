// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "physics/inter/world.h"
#include "scene/matter/deformable_surface.h"
#include "scene/matter/moving_points.h"
#include "scene/matter/slack_line.h"

namespace embody::scene {

/// Holds of a deformable's nodes, in addition to pins.
struct Holds {
    std::vector<physics::Attachment> attachments;
    std::vector<physics::Clamp> clamps;
    std::vector<physics::Tie> ties;  ///< of cloth and ropes
};

/// The nodes of a deformable of the physics; they deform the drawn form.
class SoftNodes final : public MovingPoints {
public:
    /// `world` outlives them.
    static Result<std::unique_ptr<SoftNodes>> create(physics::World& world,
                                                     const physics::DeformableDefinition& definition);
    ~SoftNodes() override;

    void read(std::vector<Vec3>& positions) const override;
    [[nodiscard]] double radius() const override { return 0; }
    [[nodiscard]] std::uint64_t membership() const override { return world_.node_positions(handle_).size(); }
    void read_velocities(std::vector<Vec3>& velocities) const override;
    /// The mesh that deforms the drawn form, at rest.
    [[nodiscard]] const physics::DeformableDefinition& definition() const { return *world_.deformable(handle_); }
    /// The same when it had so many points: a sheet that tears gets more. Of fewer than it began with: those.
    [[nodiscard]] physics::DeformableDefinition definition_of(std::size_t points) const;
    /// What had torn of a sheet when it had so many points.
    [[nodiscard]] std::vector<physics::TornCorner> torn_corners(std::size_t points) const;
    /// Tears it as that says, where it is. What it has torn already comes first.
    Result<void> tear(const std::vector<physics::TornCorner>& corners);
    /// Handle for ties to it.
    [[nodiscard]] physics::DeformableHandle handle() const { return handle_; }
    /// Broken segments of a rope: segment k is between the points k and k + 1.
    [[nodiscard]] std::vector<std::uint32_t> broken_segments() const { return world_.broken_segments(handle_); }
    /// Pose of the entity's frame.
    [[nodiscard]] Transform pose() const { return world_.pose(handle_); }
    [[nodiscard]] Vec3 linear_velocity() const override;
    [[nodiscard]] Vec3 angular_velocity() const override;
    [[nodiscard]] physics::SleepState state() const override;
    [[nodiscard]] Vec3 center_of_mass() const override { return world_.center_of_mass(handle_); }
    [[nodiscard]] double mass() const override { return world_.mass(handle_); }
    [[nodiscard]] Bounds bounds() const override;
    [[nodiscard]] std::optional<double> drop_distance(double max_distance) const override;
    [[nodiscard]] std::optional<SurfaceHit> cast_ray(Vec3 origin, Vec3 direction, double max_distance) const override;
    /// A hand that holds the nodes around the place: a body without weight that collides with nothing. Where other
    /// hands hold all of them, the body of one of these.
    [[nodiscard]] physics::BodyHandle hold(Vec3 position) override;
    void let_go(physics::BodyHandle hand) override;
    Result<void> set_definition(const PointsDefinition& definition) override;
    /// Instead of the initial state of the definition: its nodes at these places (m), one a node, and lasting
    /// deformation; velocities are the definition's. Call before hang().
    Result<void> begin_as(std::span<const Vec3> places, const physics::LastingDeformation& lasting);
    [[nodiscard]] physics::LastingDeformation lasting_deformation() const {
        return world_.lasting_deformation(handle_);
    }
    /// Initial arcs of a slack rope between the nodes that pins hold at these places, clear of bodies. Call only once,
    /// when everything around it is there.
    Result<void> hang(std::vector<HeldNode> held);
    /// Holds nodes by bodies and by other deformables, and a rope's directions at bodies or pins, in addition to the
    /// holds of hands.
    Result<void> attach(Holds holds);
    /// The holds whose bodies and deformables still exist; not those of hands.
    [[nodiscard]] Holds holds() const;
    Result<void> move(const Transform& motion) override;
    Result<void> set_points(std::span<const Vec3> positions, std::span<const Vec3> velocities) override;
    Result<void> set_velocity(Vec3 linear, Vec3 angular) override;
    Result<void> apply_impulse(Vec3 impulse) override;
    Result<void> apply_force(Vec3 force) override;
    Result<void> set_enabled(bool enabled) override;

private:
    SoftNodes(physics::World& world, physics::DeformableHandle handle, DeformableSurface surface)
        : world_(world), handle_(handle), surface_(std::move(surface)), surface_points_(membership()) {}
    // Of the present mesh.
    [[nodiscard]] const DeformableSurface& surface() const;
    /// A body that holds nodes in a hand.
    struct Hand {
        physics::BodyHandle body;
        physics::ShapeHandle shape;
        std::vector<physics::Attachment> held;
        int holds = 1;  ///< that were not let go
    };
    Result<void> apply_holds();
    [[nodiscard]] bool is_blocked(Vec3 place) const;
    [[nodiscard]] Hand* hand_at(std::uint32_t node);
    [[nodiscard]] Result<Hand> make_hand(Vec3 position);
    void remove(const Hand& hand);

    physics::World& world_;
    physics::DeformableHandle handle_;
    mutable DeformableSurface surface_;
    mutable std::uint64_t surface_points_;  // that it is made of
    Holds holds_;
    std::vector<Hand> hands_;
    bool has_hung_ = false;
};

/// Null for grains, for liquids, and for a null pointer.
inline SoftNodes* as_soft(MovingPoints* points) { return dynamic_cast<SoftNodes*>(points); }
inline const SoftNodes* as_soft(const MovingPoints* points) { return dynamic_cast<const SoftNodes*>(points); }

}  // namespace embody::scene
