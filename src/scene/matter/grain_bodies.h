// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "physics/inter/world.h"
#include "scene/matter/moving_points.h"

namespace embody::scene {

/// Grains as balls of the rigid solver, one body each.
class GrainBodies final : public MovingPoints {
public:
    /// `world` outlives them. Makes all of them or none.
    static Result<std::unique_ptr<GrainBodies>> create(physics::World& world, const GrainDefinition& definition);
    ~GrainBodies() override;

    void read(std::vector<Vec3>& positions) const override;
    [[nodiscard]] double radius() const override { return radius_; }
    [[nodiscard]] Vec3 linear_velocity() const override;
    [[nodiscard]] physics::SleepState state() const override;
    [[nodiscard]] Vec3 center_of_mass() const override;
    [[nodiscard]] double mass() const override;
    [[nodiscard]] Bounds bounds() const override;
    [[nodiscard]] std::optional<double> drop_distance(double max_distance) const override;
    [[nodiscard]] physics::BodyHandle hold(Vec3 position) override;
    Result<void> set_definition(const PointsDefinition& definition) override;
    Result<void> move(const Transform& motion) override;
    Result<void> set_points(std::span<const Vec3> positions, std::span<const Vec3> velocities) override;
    Result<void> set_velocity(Vec3 linear, Vec3 angular) override;
    Result<void> apply_impulse(Vec3 impulse) override;
    Result<void> apply_force(Vec3 force) override;
    Result<void> set_enabled(bool enabled) override;

private:
    GrainBodies(physics::World& world, double radius) : world_(world), radius_(radius) {}

    physics::World& world_;
    double radius_;
    physics::ShapeHandle shape_;
    std::vector<physics::BodyHandle> balls_;
};

}  // namespace embody::scene
