// SPDX-License-Identifier: MIT
//
// Box3D (MIT) with four substeps, as its documentation advises. It has no cylinders: prisms of 16 sides replace them.
#include <box3d/box3d.h>
#include <fmt/core.h>

#include "benches/peers/peers.h"

namespace embody::race {
namespace {

constexpr int substeps = 4;

b3Vec3 to_box3d(Vec3 v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }
Vec3 from_box3d(b3Vec3 v) { return {v.x, v.y, v.z}; }

class Box3dEngine : public RaceEngine {
public:
    Result<void> build(const RaceScene& scene, const EngineSetup& setup) {
        scene_ = &scene;
        threads_ = setup.threads;
        b3WorldDef definition = b3DefaultWorldDef();
        definition.gravity = to_box3d({0, -race_gravity, 0});
        definition.enableSleep = setup.sleep;
        definition.workerCount = setup.threads;
        world_ = b3CreateWorld(&definition);
        for (const RaceShape& shape : scene.shapes)
            if (auto added = add_hull(shape); !added) return added;
        for (const StaticBox& box : scene.statics) {
            const b3BodyId body = make_body(b3_staticBody, {.position = box.position});
            attach_box(body, box.half_extents, material(1));
        }
        if (scene.terrain.cells > 0) add_terrain(scene.terrain);
        return {};
    }
    ~Box3dEngine() override {
        if (b3World_IsValid(world_)) b3DestroyWorld(world_);
        for (b3HullData* hull : hulls_)
            if (hull != nullptr) b3DestroyHull(hull);
        if (terrain_ != nullptr) b3DestroyMesh(terrain_);
    }

    [[nodiscard]] std::string settings() const override {
        const b3Version version = b3GetVersion();
        return fmt::format("{}.{}.{}, {} substeps", version.major, version.minor, version.revision, substeps);
    }
    [[nodiscard]] int threads() const override { return threads_; }

    Result<void> add_body(const RaceBody& body) override {
        const b3BodyId id = make_body(b3_dynamicBody, body);
        const RaceShape& shape = scene_->shapes[body.shape];
        const b3ShapeDef surface = material(body.mass / shape.volume);
        if (shape.kind == ShapeKind::sphere) {
            const b3Sphere sphere{{0, 0, 0}, static_cast<float>(shape.radius)};
            b3CreateSphereShape(id, &surface, &sphere);
        } else if (shape.kind == ShapeKind::box) {
            attach_box(id, shape.half_extents, surface);
        } else {
            b3CreateHullShape(id, &surface, hulls_[body.shape]);
        }
        bodies_.push_back(id);
        return {};
    }
    void set_velocity(std::size_t body, Vec3 velocity) override {
        b3Body_SetLinearVelocity(bodies_[body], to_box3d(velocity));
    }
    void step() override { b3World_Step(world_, static_cast<float>(race_time_step), substeps); }

    [[nodiscard]] BodyState state(std::size_t body) const override {
        const b3BodyId id = bodies_[body];
        const auto position = b3Body_GetPosition(id);
        const b3Quat q = b3Body_GetRotation(id);
        return {{position.x, position.y, position.z},
                {q.v.x, q.v.y, q.v.z, q.s},
                from_box3d(b3Body_GetLinearVelocity(id)),
                from_box3d(b3Body_GetAngularVelocity(id))};
    }
    [[nodiscard]] int count_asleep() const override {
        return static_cast<int>(bodies_.size()) - b3World_GetAwakeBodyCount(world_);
    }

private:
    [[nodiscard]] b3ShapeDef material(double density) const {
        b3ShapeDef definition = b3DefaultShapeDef();
        definition.baseMaterial.friction = static_cast<float>(scene_->friction);
        definition.baseMaterial.restitution = static_cast<float>(scene_->restitution);
        definition.density = static_cast<float>(density);
        return definition;
    }
    b3BodyId make_body(b3BodyType type, const RaceBody& body) {
        b3BodyDef definition = b3DefaultBodyDef();
        definition.type = type;
        const b3Vec3 at = to_box3d(body.position);
        definition.position = {at.x, at.y, at.z};
        definition.rotation = {to_box3d({body.rotation.x, body.rotation.y, body.rotation.z}),
                               static_cast<float>(body.rotation.w)};
        definition.linearVelocity = to_box3d(body.velocity);
        return b3CreateBody(world_, &definition);
    }
    static void attach_box(b3BodyId body, Vec3 half_extents, const b3ShapeDef& surface) {
        const b3Vec3 half = to_box3d(half_extents);
        const b3BoxHull hull = b3MakeBoxHull(half.x, half.y, half.z);
        b3CreateHullShape(body, &surface, &hull.base);
    }
    /// Adds a hull for the shape; null where the shape is no hull.
    Result<void> add_hull(const RaceShape& shape) {
        hulls_.push_back(nullptr);
        if (shape.kind != ShapeKind::hull && shape.kind != ShapeKind::cylinder) return {};
        std::vector<b3Vec3> points;
        for (const Vec3 v : shape.vertices) points.push_back(to_box3d(v));
        const int count = static_cast<int>(points.size());
        hulls_.back() = b3CreateHull(points.data(), count, count);
        if (hulls_.back() == nullptr || hulls_.back()->vertexCount != count)
            return Error{"hull", "not all vertices were kept"};
        return {};
    }
    void add_terrain(const Terrain& terrain) {
        std::vector<b3Vec3> vertices;
        for (const Vec3 v : terrain.vertices) vertices.push_back(to_box3d(v));
        std::vector<std::int32_t> indices(terrain.indices.begin(), terrain.indices.end());
        b3MeshDef definition{};
        definition.vertices = vertices.data();
        definition.indices = indices.data();
        definition.vertexCount = static_cast<int>(vertices.size());
        definition.triangleCount = static_cast<int>(indices.size() / 3);
        definition.identifyEdges = true;
        terrain_ = b3CreateMesh(&definition, nullptr, 0);
        const b3ShapeDef surface = material(1);
        b3CreateMeshShape(make_body(b3_staticBody, {}), &surface, terrain_, {1, 1, 1});
    }

    const RaceScene* scene_ = nullptr;
    int threads_ = 1;
    b3WorldId world_{};
    std::vector<b3BodyId> bodies_;
    std::vector<b3HullData*> hulls_;
    b3MeshData* terrain_ = nullptr;
};

}  // namespace

Result<std::unique_ptr<RaceEngine>> make_box3d_engine(const RaceScene& scene, const EngineSetup& setup) {
    auto engine = std::make_unique<Box3dEngine>();
    if (auto built = engine->build(scene, setup); !built) return built.error();
    return std::unique_ptr<RaceEngine>(std::move(engine));
}

}  // namespace embody::race
