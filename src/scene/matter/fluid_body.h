// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "scene/matter/liquids.h"
#include "scene/matter/momenta.h"
#include "scene/matter/moving_points.h"

namespace embody::scene {

/// A body of liquid as particles of a fluid of the physics, which may also have bodies of liquid of the same matter.
class FluidBody final : public MovingPoints {
public:
    /// `world` and `liquids` outlive it. The error's `where` is an attribute or "shape".
    static Result<std::unique_ptr<FluidBody>> create(physics::World& world, Liquids& liquids,
                                                     const LiquidDefinition& definition);
    ~FluidBody() override;

    /// Lost particles are left out.
    void read(std::vector<Vec3>& positions) const override;
    [[nodiscard]] double radius() const override;  ///< of a ball with a particle's volume
    [[nodiscard]] bool is_liquid() const override { return true; }
    void read_velocities(std::vector<Vec3>& velocities) const override;
    [[nodiscard]] std::uint64_t membership() const override;
    /// Of the cells that its particles are made for, m.
    [[nodiscard]] double cell_size() const { return matter_.cell_size; }
    /// Cells whose sizes differ by no more than this factor, 1.26 in volume, count as the same.
    static constexpr double max_cell_ratio = 1.08;
    /// What became of it when it was filled beside a fluid of its matter with other cells that it could join.
    enum class Join { none_other, joined, apart };
    [[nodiscard]] Join join() const { return join_; }
    /// The fluid of the world that its particles belong to; null while it is disabled.
    [[nodiscard]] physics::FluidHandle fluid() const { return part_ ? part_->fluid : physics::FluidHandle{}; }
    /// Its particles in that fluid; null while it is disabled.
    [[nodiscard]] Liquids::Part* part() const { return part_; }
    /// Taps wait while it has so many.
    [[nodiscard]] std::size_t max_drops() const;
    [[nodiscard]] double particle_mass() const;  ///< kg
    /// Gains what has this mass (kg) as drops that `make_drops` makes for a number of them: whole drops, so that of all
    /// that it ever gains it is no more than half a drop ahead or behind. Together they have these momenta.
    Result<void> gain(const Momenta& momenta,
                      const std::function<Result<std::vector<physics::FluidDrop>>(std::size_t)>& make_drops);
    /// Its drops are these, and have these momenta together: what follows when it was made for a thing that melts.
    Result<void> begin_with(std::span<const physics::FluidDrop> drops, const Momenta& momenta);
    [[nodiscard]] physics::SleepState state() const override;
    [[nodiscard]] Vec3 center_of_mass() const override;
    [[nodiscard]] double mass() const override;
    [[nodiscard]] Bounds bounds() const override;
    [[nodiscard]] std::optional<double> drop_distance(double max_distance) const override;
    [[nodiscard]] std::optional<SurfaceHit> cast_ray(Vec3 origin, Vec3 direction, double max_distance) const override;
    /// Liquid flows through a hand: always null.
    [[nodiscard]] physics::BodyHandle hold(Vec3) override { return {}; }
    [[nodiscard]] Vec3 linear_velocity() const override;
    /// Changes the matter.
    Result<void> set_definition(const PointsDefinition& definition) override;
    Result<void> move(const Transform& motion) override;
    Result<void> set_points(std::span<const Vec3> positions, std::span<const Vec3> velocities) override;
    Result<void> set_velocity(Vec3 linear, Vec3 angular) override;
    Result<void> apply_impulse(Vec3 impulse) override;
    Result<void> apply_force(Vec3 force) override;
    /// Removes the particles from the world, and adds them again in the same state.
    Result<void> set_enabled(bool enabled) override;

private:
    FluidBody(physics::World& world, Liquids& liquids) : world_(world), liquids_(liquids) {}
    [[nodiscard]] std::vector<physics::FluidDrop> particles() const;  ///< in the order of their ids
    [[nodiscard]] std::size_t count() const;
    Result<void> put(const std::vector<physics::FluidDrop>& particles);
    /// Gives its last particles, as many as `velocities`, those nearest to these that have the momenta together.
    Result<void> set_last_velocities(const std::vector<Vec3>& velocities, const Momenta& momenta);
    /// Fills the shape: sets the cell size and returns the places of the particles, in the shape's frame, m.
    Result<std::vector<Vec3>> fill(const LiquidDefinition& definition);

    physics::World& world_;
    Liquids& liquids_;
    physics::FluidDefinition matter_;
    Vec3 force_;                ///< constant, N
    double set_cell_size_ = 0;  ///< m, told by hand; 0: none
    std::size_t particle_budget_ = 0;
    Bounds room_;  ///< where it began, m, world: where it is to be while it has no particle
    Join join_ = Join::none_other;
    Liquids::Part* part_ = nullptr;         ///< null while it is disabled
    std::vector<physics::FluidDrop> kept_;  ///< state of the particles while it is disabled
    double ahead_ = 0;                      ///< what it has gained in drops beyond what melted, kg
    bool has_run_ = false;                  ///< whether kept_ is of a run, and not as it was filled
};

/// Null for points that are no liquid, and for a null pointer.
inline const FluidBody* as_liquid(const MovingPoints* points) { return dynamic_cast<const FluidBody*>(points); }
inline FluidBody* as_liquid(MovingPoints* points) { return dynamic_cast<FluidBody*>(points); }

}  // namespace embody::scene
