// SPDX-License-Identifier: MIT
//
// PhysX 5 (BSD) on the CPU with its default iterations, once with each of its two solvers. Its cylinders are hulls, so
// prisms of 16 sides replace them.
#include <PxPhysicsAPI.h>
#include <fmt/core.h>

#include "benches/peers/peers.h"

namespace embody::race {
namespace {

using namespace physx;

PxVec3 to_physx(Vec3 v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }
Vec3 from_physx(const PxVec3& v) { return {v.x, v.y, v.z}; }

/// One for the process.
PxPhysics* physics() {
    static PxDefaultAllocator allocator;
    static PxDefaultErrorCallback errors;
    static PxFoundation* foundation = PxCreateFoundation(PX_PHYSICS_VERSION, allocator, errors);
    static PxPhysics* made =
        foundation == nullptr ? nullptr
                              : PxCreatePhysics(PX_PHYSICS_VERSION, *foundation, PxTolerancesScale(), false, nullptr);
    return made;
}

class PhysxEngine : public RaceEngine {
public:
    PhysxEngine(const RaceScene& scene, const EngineSetup& setup, PxSolverType::Enum solver)
        : scene_(scene), setup_(setup), solver_(solver) {}
    ~PhysxEngine() override {
        if (world_ != nullptr) world_->release();
        if (dispatcher_ != nullptr) dispatcher_->release();
        for (PxConvexMesh* hull : hulls_)
            if (hull != nullptr) hull->release();
        if (terrain_ != nullptr) terrain_->release();
        if (material_ != nullptr) material_->release();
    }

    Result<void> build() {
        if (physics() == nullptr) return Error{"physx", "cannot be initialised"};
        PxSceneDesc description(physics()->getTolerancesScale());
        description.gravity = to_physx({0, -race_gravity, 0});
        // 0: the stepping thread does the work.
        dispatcher_ = PxDefaultCpuDispatcherCreate(setup_.threads > 1 ? static_cast<PxU32>(setup_.threads) : 0);
        description.cpuDispatcher = dispatcher_;
        description.filterShader = PxDefaultSimulationFilterShader;
        description.solverType = solver_;
        world_ = physics()->createScene(description);
        if (world_ == nullptr) return Error{"physx", "cannot make a scene"};
        const auto friction = static_cast<float>(scene_.friction);
        material_ = physics()->createMaterial(friction, friction, static_cast<float>(scene_.restitution));
        for (const RaceShape& shape : scene_.shapes)
            if (auto added = add_hull(shape); !added) return added;
        for (const StaticBox& box : scene_.statics) add_static(PxBoxGeometry(to_physx(box.half_extents)), box.position);
        return scene_.terrain.cells > 0 ? add_terrain(scene_.terrain) : Result<void>();
    }

    [[nodiscard]] std::string settings() const override {
        return fmt::format("{}.{}.{}, 4 position and 1 velocity iterations", PX_PHYSICS_VERSION_MAJOR,
                           PX_PHYSICS_VERSION_MINOR, PX_PHYSICS_VERSION_BUGFIX);
    }
    [[nodiscard]] int threads() const override { return setup_.threads; }

    Result<void> add_body(const RaceBody& body) override {
        const Quat q = body.rotation;
        const PxQuat rotation(static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z),
                              static_cast<float>(q.w));
        PxRigidDynamic* made =
            physics()->createRigidDynamic(PxTransform(to_physx(body.position), rotation.getNormalized()));
        attach_shape(*made, body.shape);
        PxRigidBodyExt::setMassAndUpdateInertia(*made, static_cast<float>(body.mass));
        made->setAngularDamping(0);
        made->setLinearVelocity(to_physx(body.velocity));
        world_->addActor(*made);
        if (!setup_.sleep) {
            made->setSleepThreshold(0);
            made->setWakeCounter(1e9f);
        }
        bodies_.push_back(made);
        return {};
    }
    void set_velocity(std::size_t body, Vec3 velocity) override {
        bodies_[body]->setLinearVelocity(to_physx(velocity));
    }
    void step() override {
        world_->simulate(static_cast<float>(race_time_step));
        world_->fetchResults(true);
    }

    [[nodiscard]] BodyState state(std::size_t body) const override {
        const PxRigidDynamic& actor = *bodies_[body];
        const PxTransform pose = actor.getGlobalPose();
        return {from_physx(pose.p),
                {pose.q.x, pose.q.y, pose.q.z, pose.q.w},
                from_physx(actor.getLinearVelocity()),
                from_physx(actor.getAngularVelocity())};
    }
    [[nodiscard]] int count_asleep() const override {
        int count = 0;
        for (const PxRigidDynamic* body : bodies_) count += body->isSleeping() ? 1 : 0;
        return count;
    }

private:
    void attach_shape(PxRigidDynamic& body, std::size_t index) {
        const RaceShape& shape = scene_.shapes[index];
        if (shape.kind == ShapeKind::box)
            PxRigidActorExt::createExclusiveShape(body, PxBoxGeometry(to_physx(shape.half_extents)), *material_);
        else if (shape.kind == ShapeKind::sphere)
            PxRigidActorExt::createExclusiveShape(body, PxSphereGeometry(static_cast<float>(shape.radius)), *material_);
        else
            PxRigidActorExt::createExclusiveShape(body, PxConvexMeshGeometry(hulls_[index]), *material_);
    }
    void add_static(const PxGeometry& geometry, Vec3 position) {
        world_->addActor(*PxCreateStatic(*physics(), PxTransform(to_physx(position)), geometry, *material_));
    }
    [[nodiscard]] static PxCookingParams cooking() { return PxCookingParams(physics()->getTolerancesScale()); }

    /// Adds a hull for the shape; null where the shape is no hull.
    Result<void> add_hull(const RaceShape& shape) {
        hulls_.push_back(nullptr);
        if (shape.kind != ShapeKind::hull && shape.kind != ShapeKind::cylinder) return {};
        std::vector<PxVec3> points;
        for (const Vec3 v : shape.vertices) points.push_back(to_physx(v));
        PxConvexMeshDesc description;
        description.points.count = static_cast<PxU32>(points.size());
        description.points.stride = sizeof(PxVec3);
        description.points.data = points.data();
        description.flags = PxConvexFlag::eCOMPUTE_CONVEX;
        hulls_.back() = PxCreateConvexMesh(cooking(), description, physics()->getPhysicsInsertionCallback());
        if (hulls_.back() == nullptr || hulls_.back()->getNbVertices() != points.size())
            return Error{"hull", "not all vertices were kept"};
        return {};
    }
    Result<void> add_terrain(const Terrain& terrain) {
        std::vector<PxVec3> vertices;
        for (const Vec3 v : terrain.vertices) vertices.push_back(to_physx(v));
        PxTriangleMeshDesc description;
        description.points.count = static_cast<PxU32>(vertices.size());
        description.points.stride = sizeof(PxVec3);
        description.points.data = vertices.data();
        description.triangles.count = static_cast<PxU32>(terrain.indices.size() / 3);
        description.triangles.stride = 3 * sizeof(int);
        description.triangles.data = terrain.indices.data();
        terrain_ = PxCreateTriangleMesh(cooking(), description, physics()->getPhysicsInsertionCallback());
        if (terrain_ == nullptr) return Error{"terrain", "cannot be cooked"};
        add_static(PxTriangleMeshGeometry(terrain_), {});
        return {};
    }

    const RaceScene& scene_;
    EngineSetup setup_;
    PxSolverType::Enum solver_;
    PxDefaultCpuDispatcher* dispatcher_ = nullptr;
    PxScene* world_ = nullptr;
    PxMaterial* material_ = nullptr;
    PxTriangleMesh* terrain_ = nullptr;
    std::vector<PxConvexMesh*> hulls_;
    std::vector<PxRigidDynamic*> bodies_;
};

Result<std::unique_ptr<RaceEngine>> make(const RaceScene& scene, const EngineSetup& setup, PxSolverType::Enum solver) {
    auto engine = std::make_unique<PhysxEngine>(scene, setup, solver);
    if (auto built = engine->build(); !built) return built.error();
    return std::unique_ptr<RaceEngine>(std::move(engine));
}

}  // namespace

Result<std::unique_ptr<RaceEngine>> make_physx_pgs_engine(const RaceScene& scene, const EngineSetup& setup) {
    return make(scene, setup, PxSolverType::ePGS);
}
Result<std::unique_ptr<RaceEngine>> make_physx_tgs_engine(const RaceScene& scene, const EngineSetup& setup) {
    return make(scene, setup, PxSolverType::eTGS);
}

}  // namespace embody::race
