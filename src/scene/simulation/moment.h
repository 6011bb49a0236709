// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "math/transform.h"
#include "scene/document/entity.h"
#include "scene/matter/moving_points.h"

namespace embody::scene {

/// How an entity is and moves now.
struct EntityMotion {
    EntityIndex entity = 0;
    Transform pose;                       ///< of its frame
    Vec3 linear_velocity;                 ///< of the centre of mass, m/s
    Vec3 angular_velocity;                ///< rad/s
    std::uint8_t state = 3;               ///< 0 active, 1 wants to sleep, 2 asleep, 3 static or kinematic
    const ShownPoints* points = nullptr;  ///< of an entity that is not one body
};

/// Recorded points of an entity: grains, drops or nodes, in units of 1 / units_per_metre.
class RecordedPoints final : public ShownPoints {
public:
    using Places = std::shared_ptr<const std::vector<std::int32_t>>;  ///< x, y, z of each
    static constexpr double units_per_metre = 16384;                  ///< 0.06 mm

    /// `part` of the way from the places `from` to those of `to`, which may be null.
    RecordedPoints(Places from, Places to, double part, double radius, bool is_liquid)
        : from_(std::move(from)), to_(std::move(to)), part_(part), radius_(radius), is_liquid_(is_liquid) {}

    void read(std::vector<Vec3>& positions) const override;
    [[nodiscard]] std::size_t count() const;
    [[nodiscard]] double radius() const override { return radius_; }
    [[nodiscard]] bool is_liquid() const override { return is_liquid_; }

private:
    Places from_, to_;
    double part_, radius_;
    bool is_liquid_;
};

/// An entity at a moment of a take.
struct EntityMoment {
    EntityMotion motion;                           ///< its points are `points`
    std::shared_ptr<const RecordedPoints> points;  ///< null: it was one body
    RecordedPoints::Places point_steps;  ///< how far the points came since the sample before; null: they were at rest
};

/// All entities at a moment of a take, ascending.
struct Moment {
    double time = 0;         ///< simulated, s
    std::uint64_t step = 0;  ///< of the sample at or before it
    double interval = 0;     ///< s between the samples that point_steps tells of
    std::vector<EntityMoment> entities;
};

}  // namespace embody::scene
