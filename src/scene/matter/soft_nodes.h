// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "physics/inter/world.h"
#include "scene/matter/moving_points.h"

namespace embody::scene {

/// The nodes of a deformable of the physics: they carry what is drawn.
class SoftNodes final : public MovingPoints {
public:
    /// `world` outlives them.
    static Result<std::unique_ptr<SoftNodes>> create(physics::World& world,
                                                     const physics::DeformableDefinition& definition);
    ~SoftNodes() override;

    void read(std::vector<Vec3>& positions) const override;
    [[nodiscard]] double radius() const override { return 0; }
    [[nodiscard]] const physics::DeformableDefinition* deformable() const override;
    [[nodiscard]] physics::DeformableHandle handle() const override { return handle_; }
    [[nodiscard]] std::vector<std::uint32_t> broken_segments() const override {
        return world_.broken_segments(handle_);
    }
    [[nodiscard]] std::optional<Transform> pose() const override { return world_.pose(handle_); }
    [[nodiscard]] Vec3 linear_velocity() const override;
    [[nodiscard]] Vec3 angular_velocity() const override;
    [[nodiscard]] physics::SleepState state() const override;
    [[nodiscard]] Vec3 center_of_mass() const override { return world_.center_of_mass(handle_); }
    [[nodiscard]] double mass() const override { return world_.mass(handle_); }
    [[nodiscard]] Bounds bounds() const override;
    [[nodiscard]] std::optional<double> drop_distance(double most) const override;
    [[nodiscard]] std::optional<SurfaceHit> cast_ray(Vec3 origin, Vec3 direction, double most) const override;
    /// A hand that holds the nodes around the place: a body without weight that collides with nothing.
    [[nodiscard]] physics::BodyHandle hold(Vec3 position) override;
    void let_go() override;
    Result<void> set_definition(const PointsDefinition& definition) override;
    Result<void> hang(std::vector<HeldNode> held) override;
    Result<void> attach(Holds holds) override;
    [[nodiscard]] Holds holds() const override;
    Result<void> move(const Transform& motion) override;
    Result<void> set_velocity(Vec3 linear, Vec3 angular) override;
    Result<void> apply_impulse(Vec3 impulse) override;
    Result<void> apply_force(Vec3 force) override;
    Result<void> set_enabled(bool enabled) override;

private:
    SoftNodes(physics::World& world, physics::DeformableHandle handle) : world_(world), handle_(handle) {}
    Result<void> apply_holds();
    [[nodiscard]] bool is_blocked(Vec3 place) const;
    [[nodiscard]] std::optional<SurfaceHit> meet_line(Vec3 origin, Vec3 direction, double most) const;
    [[nodiscard]] std::optional<SurfaceHit> meet_faces(Vec3 origin, Vec3 direction, double most) const;

    physics::World& world_;
    physics::DeformableHandle handle_;
    std::vector<std::array<std::uint32_t, 3>> faces_;  ///< a solid's outer ones, counter-clockwise from outside, or
                                                       ///< those of cloth; none of a rope
    std::vector<std::uint32_t> surface_;               ///< their nodes, ascending
    Holds holds_;
    std::vector<physics::Attachment> held_;  ///< by a hand
    bool has_hung_ = false;
    physics::BodyHandle hand_;
    physics::ShapeHandle hand_shape_;
};

}  // namespace embody::scene
