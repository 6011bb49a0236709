// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include "benches/race/engine.h"
#include "foundation/version.h"
#include "physics/inter/world.h"

namespace embody::race {
namespace {

using physics::StepStage;

/// Name of a stage; empty for a number that is no stage.
std::string_view stage_name(StepStage stage) {
    switch (stage) {
        case StepStage::wake:
            return "wake";
        case StepStage::fluids:
            return "fluids";
        case StepStage::find_pairs:
            return "find_pairs";
        case StepStage::touch:
            return "touch";
        case StepStage::impact:
            return "impact";
        case StepStage::islands:
            return "islands";
        case StepStage::substeps:
            return "substeps";
        case StepStage::continuous:
            return "continuous";
        case StepStage::deformables:
            return "deformables";
        case StepStage::sleep:
            return "sleep";
        case StepStage::count:
            break;
    }
    return {};
}

physics::ShapeDefinition shape_definition(const RaceShape& shape) {
    switch (shape.kind) {
        case ShapeKind::box:
            return physics::BoxShape{shape.half_extents};
        case ShapeKind::sphere:
            return physics::SphereShape{shape.radius};
        case ShapeKind::cylinder:
            return physics::CylinderShape{shape.radius, shape.half_height};
        case ShapeKind::hull:
            break;
    }
    return physics::HullShape{shape.vertices};
}

physics::MeshShape mesh_of(const Terrain& terrain) {
    physics::MeshShape mesh;
    for (const Vec3 v : terrain.vertices) mesh.positions.push_back(to_vec3f(v));
    for (std::size_t i = 0; i + 2 < terrain.indices.size(); i += 3) {
        const auto index = [&](std::size_t k) { return static_cast<std::uint32_t>(terrain.indices[i + k]); };
        mesh.triangles.push_back({index(0), index(1), index(2)});
    }
    return mesh;
}

/// This project, through its public interface only.
class EmbodyEngine : public RaceEngine {
public:
    Result<void> build(const RaceScene& scene, const EngineSetup& setup) {
        auto world = physics::World::create({.gravity = {0, -race_gravity, 0},
                                             .time_step = race_time_step,
                                             .sleeping = setup.sleep,
                                             .workers = setup.threads});
        if (!world) return world.error();
        world_ = std::move(*world);
        material_ = {
            .friction_static = scene.friction, .friction_dynamic = scene.friction, .restitution = scene.restitution};
        for (const RaceShape& shape : scene.shapes) {
            auto handle = world_->create_shape(shape_definition(shape));
            if (!handle) return handle.error();
            shapes_.push_back(*handle);
        }
        for (const StaticBox& box : scene.statics)
            if (auto added = add_static(physics::BoxShape{box.half_extents}, box.position); !added) return added;
        return scene.terrain.cells > 0 ? add_static(mesh_of(scene.terrain), {}) : Result<void>();
    }

    [[nodiscard]] std::string settings() const override {
        return fmt::format("{}, {} substeps", version_text, world_->settings().substeps);
    }
    [[nodiscard]] int threads() const override { return world_->settings().workers; }

    Result<void> add_body(const RaceBody& body) override {
        auto handle = world_->create_body({.shape = shapes_[body.shape],
                                           .position = body.position,
                                           .rotation = body.rotation,
                                           .linear_velocity = body.velocity,
                                           .mass = {.mass = body.mass},
                                           .material = material_});
        if (!handle) return handle.error();
        bodies_.push_back(*handle);
        return {};
    }
    void set_velocity(std::size_t body, Vec3 velocity) override {
        const auto set = world_->set_velocity(bodies_[body], velocity, world_->angular_velocity(bodies_[body]));
        static_cast<void>(set.ok());  // cannot fail: the velocity is finite and the body exists
    }
    void step() override { world_->step(); }

    [[nodiscard]] BodyState state(std::size_t body) const override {
        const physics::BodyHandle handle = bodies_[body];
        return {world_->center_of_mass(handle), world_->pose(handle).rotation, world_->linear_velocity(handle),
                world_->angular_velocity(handle)};
    }
    [[nodiscard]] int count_asleep() const override { return static_cast<int>(world_->last_report().bodies_asleep); }
    [[nodiscard]] std::vector<StageTime> stages() const override {
        std::vector<StageTime> times;
        const auto& milliseconds = world_->last_report().stage_milliseconds;
        for (std::size_t i = 0; i < milliseconds.size(); ++i)
            times.push_back({stage_name(static_cast<StepStage>(i)), milliseconds[i]});
        return times;
    }

private:
    Result<void> add_static(const physics::ShapeDefinition& definition, Vec3 position) {
        auto shape = world_->create_shape(definition);
        if (!shape) return shape.error();
        auto body = world_->create_body(
            {.kind = physics::BodyKind::static_body, .shape = *shape, .position = position, .material = material_});
        return body ? Result<void>() : body.error();
    }

    std::unique_ptr<physics::World> world_;
    physics::Material material_;
    std::vector<physics::ShapeHandle> shapes_;
    std::vector<physics::BodyHandle> bodies_;
};

}  // namespace

Result<std::unique_ptr<RaceEngine>> make_embody_engine(const RaceScene& scene, const EngineSetup& setup) {
    auto engine = std::make_unique<EmbodyEngine>();
    if (auto built = engine->build(scene, setup); !built) return built.error();
    return std::unique_ptr<RaceEngine>(std::move(engine));
}

}  // namespace embody::race
