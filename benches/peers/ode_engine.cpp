// SPDX-License-Identifier: MIT
//
// ODE (BSD or LGPL) with its fast solver: contacts are computed anew in each step, at most eight per pair. One thread.
#include <fmt/core.h>
#include <ode/ode.h>

#include <array>
#include <numbers>

#include "benches/peers/peers.h"

namespace embody::race {
namespace {

constexpr int contacts_a_pair = 8;
constexpr dReal bounce_threshold = 1;  // m/s, as in ODE's own demos

dReal to_ode(double number) { return static_cast<dReal>(number); }

/// ODE keeps pointers into this data.
struct HullData {
    std::vector<dReal> planes, points;
    std::vector<unsigned> polygons;
    unsigned faces = 0;
};

HullData hull_data(const RaceShape& shape) {
    HullData data;
    for (const Vec3 v : shape.vertices)
        for (int i = 0; i < 3; ++i) data.points.push_back(to_ode(v[i]));
    for (const auto& t : shape.triangles) {
        const auto corner = [&](std::size_t k) { return shape.vertices[static_cast<std::size_t>(t[k])]; };
        const Vec3 normal = normalized(cross(corner(1) - corner(0), corner(2) - corner(0)));
        for (int i = 0; i < 3; ++i) data.planes.push_back(to_ode(normal[i]));
        data.planes.push_back(to_ode(dot(normal, corner(0))));
        data.polygons.push_back(3);
        for (const int index : t) data.polygons.push_back(static_cast<unsigned>(index));
        ++data.faces;
    }
    return data;
}

class OdeEngine : public RaceEngine {
public:
    OdeEngine(const RaceScene& scene, const EngineSetup& setup) : scene_(scene) {
        static const int initialised = dInitODE2(0);
        static_cast<void>(initialised);
        // The solver shuffles its rows: in the same order in each repeat.
        dRandSetSeed(0);
        world_ = dWorldCreate();
        dWorldSetGravity(world_, 0, to_ode(-race_gravity), 0);
        dWorldSetAutoDisableFlag(world_, setup.sleep ? 1 : 0);
        movable_ = dSweepAndPruneSpaceCreate(nullptr, dSAP_AXES_XZY);
        fixed_ = dSimpleSpaceCreate(nullptr);
        contacts_ = dJointGroupCreate(0);
        for (const RaceShape& shape : scene.shapes) hulls_.push_back(hull_data(shape));
        for (const StaticBox& box : scene.statics) {
            const Vec3 size = 2 * box.half_extents;
            const dGeomID geometry = dCreateBox(fixed_, to_ode(size.x), to_ode(size.y), to_ode(size.z));
            dGeomSetPosition(geometry, to_ode(box.position.x), to_ode(box.position.y), to_ode(box.position.z));
        }
        if (scene.terrain.cells > 0) add_terrain(scene.terrain);
    }
    ~OdeEngine() override {
        dJointGroupDestroy(contacts_);
        dSpaceDestroy(movable_);
        dSpaceDestroy(fixed_);
        dWorldDestroy(world_);
        if (terrain_ != nullptr) dGeomTriMeshDataDestroy(terrain_);
    }

    [[nodiscard]] std::string settings() const override {
        return fmt::format("{} digits, {} iterations, {} contacts a pair", sizeof(dReal) == 4 ? "single" : "double",
                           dWorldGetQuickStepNumIterations(world_), contacts_a_pair);
    }
    [[nodiscard]] int threads() const override { return 1; }

    Result<void> add_body(const RaceBody& body) override {
        const dBodyID id = dBodyCreate(world_);
        set_mass(id, body);
        const dGeomID geometry = add_geometry(body.shape);
        dGeomSetBody(geometry, id);
        if (scene_.shapes[body.shape].kind == ShapeKind::cylinder) {
            // ODE's cylinders have their axis along Z.
            dMatrix3 upright;
            dRFromAxisAndAngle(upright, 1, 0, 0, to_ode(std::numbers::pi / 2));
            dGeomSetOffsetRotation(geometry, upright);
        }
        dBodySetPosition(id, to_ode(body.position.x), to_ode(body.position.y), to_ode(body.position.z));
        const Quat q = body.rotation;
        const dQuaternion rotation = {to_ode(q.w), to_ode(q.x), to_ode(q.y), to_ode(q.z)};
        dBodySetQuaternion(id, rotation);
        bodies_.push_back(id);
        set_velocity(bodies_.size() - 1, body.velocity);
        return {};
    }
    void set_velocity(std::size_t body, Vec3 velocity) override {
        dBodyEnable(bodies_[body]);
        dBodySetLinearVel(bodies_[body], to_ode(velocity.x), to_ode(velocity.y), to_ode(velocity.z));
    }
    void step() override {
        dSpaceCollide(movable_, this, collide_pair);
        dSpaceCollide2(as_geometry(fixed_), as_geometry(movable_), this, collide_pair);
        dWorldQuickStep(world_, to_ode(race_time_step));
        dJointGroupEmpty(contacts_);
    }

    [[nodiscard]] BodyState state(std::size_t body) const override {
        const dReal *position = dBodyGetPosition(bodies_[body]), *rotation = dBodyGetQuaternion(bodies_[body]);
        return {vector(position),
                {rotation[1], rotation[2], rotation[3], rotation[0]},
                vector(dBodyGetLinearVel(bodies_[body])),
                vector(dBodyGetAngularVel(bodies_[body]))};
    }
    [[nodiscard]] int count_asleep() const override {
        int count = 0;
        for (const dBodyID body : bodies_) count += dBodyIsEnabled(body) == 0 ? 1 : 0;
        return count;
    }

private:
    static Vec3 vector(const dReal* v) { return {v[0], v[1], v[2]}; }
    // In ODE a space is a kind of geometry.
    static dGeomID as_geometry(dSpaceID space) { return reinterpret_cast<dGeomID>(space); }

    static void collide_pair(void* self, dGeomID a, dGeomID b) {
        if (dGeomIsSpace(a) != 0 || dGeomIsSpace(b) != 0) {
            dSpaceCollide2(a, b, self, collide_pair);
        } else {
            static_cast<OdeEngine*>(self)->add_contacts(a, b);
        }
    }

    void add_contacts(dGeomID a, dGeomID b) {
        const dBodyID body_a = dGeomGetBody(a), body_b = dGeomGetBody(b);
        const auto moves = [](dBodyID body) { return body != nullptr && dBodyIsEnabled(body) != 0; };
        if (!moves(body_a) && !moves(body_b)) return;
        std::array<dContact, contacts_a_pair> found;
        const int count = dCollide(a, b, contacts_a_pair, &found[0].geom, static_cast<int>(sizeof(dContact)));
        for (int i = 0; i < count; ++i) {
            dContact& contact = found[static_cast<std::size_t>(i)];
            contact.surface.mode = dContactApprox1;
            contact.surface.mu = to_ode(scene_.friction);
            if (scene_.restitution > 0) {
                contact.surface.mode |= dContactBounce;
                contact.surface.bounce = to_ode(scene_.restitution);
                contact.surface.bounce_vel = bounce_threshold;
            }
            dJointAttach(dJointCreateContact(world_, contacts_, &contact), body_a, body_b);
        }
    }

    void set_mass(dBodyID id, const RaceBody& body) {
        const RaceShape& shape = scene_.shapes[body.shape];
        const Mat3 inertia = body.mass / shape.volume * shape.inertia;
        dMass mass;
        dMassSetParameters(&mass, to_ode(body.mass), 0, 0, 0, to_ode(inertia(0, 0)), to_ode(inertia(1, 1)),
                           to_ode(inertia(2, 2)), to_ode(inertia(0, 1)), to_ode(inertia(0, 2)), to_ode(inertia(1, 2)));
        dBodySetMass(id, &mass);
    }
    dGeomID add_geometry(std::size_t index) {
        const RaceShape& shape = scene_.shapes[index];
        const Vec3 size = 2 * shape.half_extents;
        switch (shape.kind) {
            case ShapeKind::box:
                return dCreateBox(movable_, to_ode(size.x), to_ode(size.y), to_ode(size.z));
            case ShapeKind::sphere:
                return dCreateSphere(movable_, to_ode(shape.radius));
            case ShapeKind::cylinder:
                return dCreateCylinder(movable_, to_ode(shape.radius), to_ode(2 * shape.half_height));
            case ShapeKind::hull:
                break;
        }
        HullData& hull = hulls_[index];
        return dCreateConvex(movable_, hull.planes.data(), hull.faces, hull.points.data(),
                             static_cast<unsigned>(hull.points.size() / 3), hull.polygons.data());
    }
    void add_terrain(const Terrain& terrain) {
        for (const Vec3 v : terrain.vertices)
            for (int i = 0; i < 3; ++i) terrain_vertices_.push_back(static_cast<float>(v[i]));
        terrain_indices_.assign(terrain.indices.begin(), terrain.indices.end());
        terrain_ = dGeomTriMeshDataCreate();
        dGeomTriMeshDataBuildSingle(terrain_, terrain_vertices_.data(), 3 * sizeof(float),
                                    static_cast<int>(terrain.vertices.size()), terrain_indices_.data(),
                                    static_cast<int>(terrain_indices_.size()), 3 * sizeof(dTriIndex));
        // Contacts of convex shapes with triangles need the angles between the triangles.
        constexpr unsigned face_angles = 1u << dTRIDATAPREPROCESS_BUILD_FACE_ANGLES;
        dGeomTriMeshDataPreprocess2(terrain_, face_angles, nullptr);
        dCreateTriMesh(fixed_, terrain_, nullptr, nullptr, nullptr);
    }

    const RaceScene& scene_;
    dWorldID world_ = nullptr;
    dSpaceID movable_ = nullptr, fixed_ = nullptr;
    dJointGroupID contacts_ = nullptr;
    dTriMeshDataID terrain_ = nullptr;
    std::vector<dBodyID> bodies_;
    std::vector<HullData> hulls_;
    std::vector<float> terrain_vertices_;
    std::vector<dTriIndex> terrain_indices_;
};

}  // namespace

Result<std::unique_ptr<RaceEngine>> make_ode_engine(const RaceScene& scene, const EngineSetup& setup) {
    return std::unique_ptr<RaceEngine>(std::make_unique<OdeEngine>(scene, setup));
}

}  // namespace embody::race
