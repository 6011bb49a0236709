// SPDX-License-Identifier: MIT
//
// Bullet (zlib licence) with its default solver. Debian builds it without threads, so it steps with one.
#include <btBulletDynamicsCommon.h>
#include <fmt/core.h>

#include <cmath>

#include "benches/peers/peers.h"

namespace embody::race {
namespace {

btVector3 to_bullet(Vec3 v) {
    return {static_cast<btScalar>(v.x), static_cast<btScalar>(v.y), static_cast<btScalar>(v.z)};
}
btQuaternion to_bullet(Quat q) {
    return {static_cast<btScalar>(q.x), static_cast<btScalar>(q.y), static_cast<btScalar>(q.z),
            static_cast<btScalar>(q.w)};
}
Vec3 from_bullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

std::unique_ptr<btCollisionShape> make_shape(const RaceShape& shape) {
    switch (shape.kind) {
        case ShapeKind::box:
            return std::make_unique<btBoxShape>(to_bullet(shape.half_extents));
        case ShapeKind::sphere:
            return std::make_unique<btSphereShape>(static_cast<btScalar>(shape.radius));
        case ShapeKind::cylinder:
            return std::make_unique<btCylinderShape>(to_bullet(Vec3{shape.radius, shape.half_height, shape.radius}));
        case ShapeKind::hull:
            break;
    }
    auto hull = std::make_unique<btConvexHullShape>();
    for (const Vec3 v : shape.vertices) hull->addPoint(to_bullet(v), false);
    hull->recalcLocalAabb();
    return hull;
}

class BulletEngine : public RaceEngine {
public:
    BulletEngine(const RaceScene& scene, const EngineSetup& setup)
        : friction_(static_cast<btScalar>(scene.friction)),
          restitution_(static_cast<btScalar>(scene.restitution)),
          sleep_(setup.sleep) {
        world_.setGravity(to_bullet(Vec3{0, -race_gravity, 0}));
        for (const RaceShape& shape : scene.shapes) shapes_.push_back(make_shape(shape));
        for (const StaticBox& box : scene.statics)
            add_static(std::make_unique<btBoxShape>(to_bullet(box.half_extents)), box.position);
        if (scene.terrain.cells > 0) add_terrain(scene.terrain);
    }
    ~BulletEngine() override {
        for (const auto& body : bodies_) world_.removeRigidBody(body.get());
        for (const auto& body : statics_) world_.removeRigidBody(body.get());
    }

    [[nodiscard]] std::string settings() const override {
        const int version = btGetVersion();
        return fmt::format("{}.{:02}, {} iterations", version / 100, version % 100,
                           world_.getSolverInfo().m_numIterations);
    }
    [[nodiscard]] int threads() const override { return 1; }

    Result<void> add_body(const RaceBody& body) override {
        btCollisionShape* shape = shapes_[body.shape].get();
        const auto mass = static_cast<btScalar>(body.mass);
        btVector3 inertia;
        shape->calculateLocalInertia(mass, inertia);
        auto made = std::make_unique<btRigidBody>(
            description(mass, shape, btTransform(to_bullet(body.rotation), to_bullet(body.position)), inertia));
        made->setLinearVelocity(to_bullet(body.velocity));
        if (!sleep_) made->setActivationState(DISABLE_DEACTIVATION);
        world_.addRigidBody(made.get());
        bodies_.push_back(std::move(made));
        return {};
    }
    void set_velocity(std::size_t body, Vec3 velocity) override {
        bodies_[body]->activate(true);
        bodies_[body]->setLinearVelocity(to_bullet(velocity));
    }
    // One step of exactly this length, without substeps.
    void step() override { world_.stepSimulation(static_cast<btScalar>(race_time_step), 0); }

    [[nodiscard]] BodyState state(std::size_t body) const override {
        const btRigidBody& b = *bodies_[body];
        const btQuaternion q = b.getWorldTransform().getRotation();
        return {from_bullet(b.getWorldTransform().getOrigin()),
                {q.x(), q.y(), q.z(), q.w()},
                from_bullet(b.getLinearVelocity()),
                from_bullet(b.getAngularVelocity())};
    }
    [[nodiscard]] int count_asleep() const override {
        int count = 0;
        for (const auto& body : bodies_) count += body->getActivationState() == ISLAND_SLEEPING ? 1 : 0;
        return count;
    }

private:
    [[nodiscard]] btRigidBody::btRigidBodyConstructionInfo description(btScalar mass, btCollisionShape* shape,
                                                                       const btTransform& pose,
                                                                       const btVector3& inertia) const {
        btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape, inertia);
        info.m_startWorldTransform = pose;
        // Bullet multiplies the two bodies' coefficients.
        info.m_friction = std::sqrt(friction_);
        info.m_restitution = std::sqrt(restitution_);
        return info;
    }
    void add_static(std::unique_ptr<btCollisionShape> shape, Vec3 position) {
        const btTransform pose(btQuaternion::getIdentity(), to_bullet(position));
        statics_.push_back(std::make_unique<btRigidBody>(description(0, shape.get(), pose, {0, 0, 0})));
        world_.addRigidBody(statics_.back().get());
        static_shapes_.push_back(std::move(shape));
    }
    void add_terrain(const Terrain& terrain) {
        for (const Vec3 v : terrain.vertices)
            for (int i = 0; i < 3; ++i) terrain_vertices_.push_back(static_cast<btScalar>(v[i]));
        terrain_indices_ = terrain.indices;
        terrain_ = std::make_unique<btTriangleIndexVertexArray>(
            static_cast<int>(terrain_indices_.size() / 3), terrain_indices_.data(), static_cast<int>(3 * sizeof(int)),
            static_cast<int>(terrain.vertices.size()), terrain_vertices_.data(),
            static_cast<int>(3 * sizeof(btScalar)));
        add_static(std::make_unique<btBvhTriangleMeshShape>(terrain_.get(), true), {});
    }

    btScalar friction_, restitution_;
    bool sleep_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broad_phase_;
    btSequentialImpulseConstraintSolver solver_;
    btDiscreteDynamicsWorld world_{&dispatcher_, &broad_phase_, &solver_, &configuration_};
    std::vector<std::unique_ptr<btCollisionShape>> shapes_, static_shapes_;
    std::vector<std::unique_ptr<btRigidBody>> bodies_, statics_;
    std::vector<btScalar> terrain_vertices_;
    std::vector<int> terrain_indices_;
    std::unique_ptr<btTriangleIndexVertexArray> terrain_;
};

}  // namespace

Result<std::unique_ptr<RaceEngine>> make_bullet_engine(const RaceScene& scene, const EngineSetup& setup) {
    return std::unique_ptr<RaceEngine>(std::make_unique<BulletEngine>(scene, setup));
}

}  // namespace embody::race
