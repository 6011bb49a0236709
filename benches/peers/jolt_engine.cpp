// SPDX-License-Identifier: MIT
//
// Jolt Physics (MIT) with its default settings.
#include <Jolt/Jolt.h>
// Jolt.h must be included first.
#include <Jolt/Core/Factory.h>
#include <Jolt/Core/JobSystemSingleThreaded.h>
#include <Jolt/Core/JobSystemThreadPool.h>
#include <Jolt/Core/TempAllocator.h>
#include <Jolt/Physics/Body/BodyCreationSettings.h>
#include <Jolt/Physics/Collision/Shape/BoxShape.h>
#include <Jolt/Physics/Collision/Shape/ConvexHullShape.h>
#include <Jolt/Physics/Collision/Shape/CylinderShape.h>
#include <Jolt/Physics/Collision/Shape/MeshShape.h>
#include <Jolt/Physics/Collision/Shape/SphereShape.h>
#include <Jolt/Physics/PhysicsSettings.h>
#include <Jolt/Physics/PhysicsSystem.h>
#include <Jolt/RegisterTypes.h>
#include <fmt/core.h>

#include "benches/peers/peers.h"

namespace embody::race {
namespace {

constexpr JPH::ObjectLayer fixed_layer = 0, moving_layer = 1;
constexpr unsigned most_bodies = 10240, most_pairs = 65536;
constexpr unsigned scratch_bytes = 64u << 20;

class BroadPhaseLayers final : public JPH::BroadPhaseLayerInterface {
public:
    [[nodiscard]] JPH::uint GetNumBroadPhaseLayers() const override { return 2; }
    [[nodiscard]] JPH::BroadPhaseLayer GetBroadPhaseLayer(JPH::ObjectLayer layer) const override {
        return JPH::BroadPhaseLayer(static_cast<JPH::BroadPhaseLayer::Type>(layer));
    }
};
class BroadPhaseFilter final : public JPH::ObjectVsBroadPhaseLayerFilter {
public:
    [[nodiscard]] bool ShouldCollide(JPH::ObjectLayer layer, JPH::BroadPhaseLayer other) const override {
        return layer == moving_layer || other == JPH::BroadPhaseLayer(moving_layer);
    }
};
class PairFilter final : public JPH::ObjectLayerPairFilter {
public:
    [[nodiscard]] bool ShouldCollide(JPH::ObjectLayer a, JPH::ObjectLayer b) const override {
        return a == moving_layer || b == moving_layer;
    }
};

JPH::Vec3 to_jolt(Vec3 v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }
JPH::RVec3 to_jolt_position(Vec3 v) {
    return {static_cast<JPH::Real>(v.x), static_cast<JPH::Real>(v.y), static_cast<JPH::Real>(v.z)};
}
JPH::Quat to_jolt(Quat q) {
    return JPH::Quat(static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z), static_cast<float>(q.w))
        .Normalized();
}
Vec3 from_jolt(JPH::Vec3Arg v) { return {v.GetX(), v.GetY(), v.GetZ()}; }

/// Registers types and allocators, once per process.
void initialise() {
    static const bool done = [] {
        JPH::RegisterDefaultAllocator();
        JPH::Factory::sInstance = new JPH::Factory();
        JPH::RegisterTypes();
        return true;
    }();
    static_cast<void>(done);
}

Result<JPH::ShapeRefC> make_shape(const RaceShape& shape) {
    switch (shape.kind) {
        case ShapeKind::box:
            return JPH::ShapeRefC(new JPH::BoxShape(to_jolt(shape.half_extents)));
        case ShapeKind::sphere:
            return JPH::ShapeRefC(new JPH::SphereShape(static_cast<float>(shape.radius)));
        case ShapeKind::cylinder:
            return JPH::ShapeRefC(
                new JPH::CylinderShape(static_cast<float>(shape.half_height), static_cast<float>(shape.radius)));
        case ShapeKind::hull:
            break;
    }
    JPH::Array<JPH::Vec3> points;
    for (const Vec3 v : shape.vertices) points.push_back(to_jolt(v));
    const auto made = JPH::ConvexHullShapeSettings(points).Create();
    if (made.HasError()) return Error{"hull", made.GetError().c_str()};
    return JPH::ShapeRefC(made.Get());
}

class JoltEngine : public RaceEngine {
public:
    Result<void> build(const RaceScene& scene, const EngineSetup& setup) {
        scene_ = &scene;
        threads_ = setup.threads;
        if (setup.threads == 1)
            jobs_ = std::make_unique<JPH::JobSystemSingleThreaded>(JPH::cMaxPhysicsJobs);
        else
            jobs_ = std::make_unique<JPH::JobSystemThreadPool>(JPH::cMaxPhysicsJobs, JPH::cMaxPhysicsBarriers,
                                                               setup.threads - 1);
        system_.Init(most_bodies, 0, most_pairs, most_pairs, layers_, broad_phase_filter_, pair_filter_);
        system_.SetGravity(to_jolt(Vec3{0, -race_gravity, 0}));
        JPH::PhysicsSettings settings = system_.GetPhysicsSettings();
        settings.mAllowSleeping = setup.sleep;
        system_.SetPhysicsSettings(settings);
        for (const RaceShape& shape : scene.shapes) {
            auto made = make_shape(shape);
            if (!made) return made.error();
            shapes_.push_back(*made);
        }
        for (const StaticBox& box : scene.statics)
            add_static(new JPH::BoxShape(to_jolt(box.half_extents)), box.position);
        return scene.terrain.cells > 0 ? add_terrain(scene.terrain) : Result<void>();
    }

    [[nodiscard]] std::string settings() const override {
        const JPH::PhysicsSettings& settings = system_.GetPhysicsSettings();
        return fmt::format("{} velocity and {} position iterations", settings.mNumVelocitySteps,
                           settings.mNumPositionSteps);
    }
    [[nodiscard]] int threads() const override { return threads_; }

    Result<void> add_body(const RaceBody& body) override {
        JPH::BodyCreationSettings made(shapes_[body.shape], to_jolt_position(body.position), to_jolt(body.rotation),
                                       JPH::EMotionType::Dynamic, moving_layer);
        made.mFriction = static_cast<float>(scene_->friction);
        made.mRestitution = static_cast<float>(scene_->restitution);
        made.mLinearDamping = 0;
        made.mAngularDamping = 0;
        made.mLinearVelocity = to_jolt(body.velocity);
        made.mOverrideMassProperties = JPH::EOverrideMassProperties::CalculateInertia;
        made.mMassPropertiesOverride.mMass = static_cast<float>(body.mass);
        bodies_.push_back(face().CreateAndAddBody(made, JPH::EActivation::Activate));
        if (bodies_.back().IsInvalid()) return Error{"body", "Jolt's room for bodies is full"};
        return {};
    }
    void set_velocity(std::size_t body, Vec3 velocity) override {
        face().ActivateBody(bodies_[body]);
        face().SetLinearVelocity(bodies_[body], to_jolt(velocity));
    }
    void step() override {
        // Before the first step the trees are built at once, as the documentation advises after loading.
        if (!optimised_) system_.OptimizeBroadPhase();
        optimised_ = true;
        system_.Update(static_cast<float>(race_time_step), 1, &scratch_, jobs_.get());
    }

    [[nodiscard]] BodyState state(std::size_t body) const override {
        const JPH::BodyInterface& face = system_.GetBodyInterfaceNoLock();
        const JPH::BodyID id = bodies_[body];
        const JPH::RVec3 position = face.GetCenterOfMassPosition(id);
        const JPH::Quat q = face.GetRotation(id);
        return {{position.GetX(), position.GetY(), position.GetZ()},
                {q.GetX(), q.GetY(), q.GetZ(), q.GetW()},
                from_jolt(face.GetLinearVelocity(id)),
                from_jolt(face.GetAngularVelocity(id))};
    }
    [[nodiscard]] int count_asleep() const override {
        return static_cast<int>(bodies_.size()) -
               static_cast<int>(system_.GetNumActiveBodies(JPH::EBodyType::RigidBody));
    }

private:
    JPH::BodyInterface& face() { return system_.GetBodyInterfaceNoLock(); }

    void add_static(const JPH::ShapeRefC& shape, Vec3 position) {
        JPH::BodyCreationSettings made(shape, to_jolt_position(position), JPH::Quat::sIdentity(),
                                       JPH::EMotionType::Static, fixed_layer);
        made.mFriction = static_cast<float>(scene_->friction);
        made.mRestitution = static_cast<float>(scene_->restitution);
        face().CreateAndAddBody(made, JPH::EActivation::DontActivate);
    }
    Result<void> add_terrain(const Terrain& terrain) {
        JPH::VertexList vertices;
        for (const Vec3 v : terrain.vertices)
            vertices.push_back({static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)});
        JPH::IndexedTriangleList triangles;
        for (std::size_t i = 0; i + 2 < terrain.indices.size(); i += 3) {
            const auto index = [&](std::size_t k) { return static_cast<JPH::uint32>(terrain.indices[i + k]); };
            triangles.push_back(JPH::IndexedTriangle(index(0), index(1), index(2), 0));
        }
        const auto made = JPH::MeshShapeSettings(vertices, triangles).Create();
        if (made.HasError()) return Error{"terrain", made.GetError().c_str()};
        add_static(made.Get(), {});
        return {};
    }

    const RaceScene* scene_ = nullptr;
    int threads_ = 1;
    bool optimised_ = false;
    BroadPhaseLayers layers_;
    BroadPhaseFilter broad_phase_filter_;
    PairFilter pair_filter_;
    JPH::TempAllocatorImplWithMallocFallback scratch_{scratch_bytes};
    std::unique_ptr<JPH::JobSystem> jobs_;
    JPH::PhysicsSystem system_;
    std::vector<JPH::ShapeRefC> shapes_;
    std::vector<JPH::BodyID> bodies_;
};

}  // namespace

Result<std::unique_ptr<RaceEngine>> make_jolt_engine(const RaceScene& scene, const EngineSetup& setup) {
    initialise();
    auto engine = std::make_unique<JoltEngine>();
    if (auto built = engine->build(scene, setup); !built) return built.error();
    return std::unique_ptr<RaceEngine>(std::move(engine));
}

}  // namespace embody::race
