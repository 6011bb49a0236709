// SPDX-License-Identifier: MIT
#include "scene/sample_documents.h"

#include "attributes/physical_kind.h"
#include "physics/every_shape.h"

namespace embody::scene::samples {

using namespace embody::physics;

Entity& add(Document& document, const std::string& name, const ShapeDefinition& shape, Vec3 position) {
    Entity entity;
    entity.index = document.next_index++;
    entity.name = name;
    entity.geometry = shape;
    entity.pose.position = position;
    document.entities.push_back(std::move(entity));
    return document.entities.back();
}

Document floor_and_box(double height) {
    Document document;
    add(document, "Floor", BoxShape{{10, 0.5, 10}}, {0, -0.5, 0}).attributes["kind"] =
        to_value(attributes::PhysicalKind::static_body);
    add(document, "Box", BoxShape{{0.25, 0.25, 0.25}}, {0, height, 0});
    return document;
}

namespace {

void add_shapes(Document& document) {
    add(document, "Plane", PlaneShape{{0, 2, 0}, -0.125}, {});
    add(document, "Sphere", SphereShape{0.3}, {1, 1, 0});
    add(document, "Box", BoxShape{{0.1, 0.2, 0.3}}, {2, 1, 0});
    add(document, "Capsule", CapsuleShape{0.1, 0.2}, {3, 1, 0});
    add(document, "Cylinder", CylinderShape{0.1, 0.2}, {4, 1, 0});
    add(document, "Cone", ConeShape{0.1, 0.2}, {5, 1, 0});
    add(document, "Hull", HullShape{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1.0 / 3}}}, {6, 1, 0});
    HeightfieldShape field;
    field.columns = 3;
    field.rows = 2;
    field.cell_x = 0.5;
    field.heights = {0, 0.1F, 0.2F, 1.0F / 3, 0.4F, -0.5F};
    add(document, "Heightfield", field, {0, -5, 0});
    MeshShape mesh;
    mesh.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0.3F}};
    mesh.triangles = {{0, 1, 2}};
    add(document, "Mesh", mesh, {0, -6, 0});
    CompoundShape compound;
    compound.children.push_back({SphereShape{0.1}, {{0, 0.5, 0}, {}}});
    compound.children.push_back({BoxShape{{0.2, 0.2, 0.2}}, {{0, 0, 0}, from_axis_angle({0, 1, 0}, 0.7)}});
    for_each_shape_of_lengths<ConvexShape>([&](const auto& shape) { compound.children.push_back({shape, {}}); });
    add(document, "Compound", compound, {7, 1, 0});
    WallShape wall;
    wall.length = 4;
    wall.rise = 0.25;
    wall.start_cut = {0.05, -0.05};
    wall.end_cut = {0.1, 0.2};
    wall.openings = {{1, 0.9, 2.1, 0, OpeningKind::door, 7}, {2.5, 0.8, 1, 0.9, OpeningKind::window}};
    add(document, "Wall", wall, {0, 0, 12});
    add(document, "Slab", SlabShape{{{0, 0}, {3, 0}, {3, 2}, {1, 1}}, 0.2}, {0, 0, 14});
    document.entities.push_back({});
    document.entities.back().index = document.next_index++;
    document.entities.back().geometry = ModelReference{"sweethome3d:chair"};
    document.entities.back().scale = 1.5;
}

// The sphere and the box of add_shapes.
void fill_entities(Document& document) {
    Entity& sphere = *document.find(2);
    sphere.attributes = {{"mass", 2.5},
                         {"center_of_mass", Vec3{0, 0.01, 0}},
                         {"inertia", Mat3{{0.1, 0.01, 0}, {0.01, 0.1, 0}, {0, 0, 0.1}}},
                         {"friction_static", 0.7},
                         {"friction_combine", std::string("maximum")},
                         {"kinematic", true}};
    sphere.pose.rotation = from_axis_angle({0, 0, 1}, 1.0 / 3);
    sphere.kept = KeptForm{.fingerprint = "0123456789abcdef",
                           .places = {{1.0 / 3, 2, 3, -4, 5e-300, 6}},
                           .plastic_strain = {{0.1, 0.2, 0.3, 0.4, 0.5}},
                           .broken = {1, 7},
                           .bend = {{30, 0.1, -0.2, 0, 1e-300, 1.0 / 3}},
                           .cell_size = 0.02};
    sphere.linear_velocity = {1, 2, 3};
    sphere.angular_velocity = {0.1, 0, 0};
    sphere.force = {0, 0, 0.25};
    sphere.torque = {0, 1e-300, 0};
    sphere.tap = {.litres_per_minute = 60, .radius = 0.02, .speed = 3, .position = {0, -0.5, 0}, .liquid = 3};
    sphere.drain = {.radius = 0.05, .position = {0, 0.1, 0}, .open = false};
    sphere.starts_empty = true;
    Entity& box = *document.find(3);
    box.enabled = false;
    box.start_asleep = true;
    box.allow_sleep = false;
    box.continuous = true;
    box.category = "toy \"quoted\" ünïcödé";
    box.color = {0.1, 0.2, 0.3};
}

void add_joints(Document& document) {
    SceneJoint joint;
    joint.index = 1;
    joint.name = "glue";
    joint.entity_b = 2;
    document.joints.push_back(joint);
    joint.index = 2;
    joint.entity_a = 3;
    joint.definition.joint = BallJoint{};
    joint.definition.frame_a.position = {0.1, 0.2, 0.3};
    joint.definition.bodies_collide = true;
    document.joints.push_back(joint);
    joint.index = 3;
    joint.definition.joint = HingeJoint{JointLimit{-1, 1}, JointMotor{2, 30}};
    document.joints.push_back(joint);
    joint.index = 7;
    joint.definition.joint = SliderJoint{JointLimit{0, 0.5}, {}};
    document.joints.push_back(joint);
}

void add_actions(Document& document) {
    const Trigger triggers[] = {AtTime{1, {}},
                                AtTime{0, 0.5},
                                OnContactBegin{{Target::By::category, 0, "toy"}, 0.5},
                                OnContactEnd{{Target::By::index, 3, {}}},
                                OnEnterVolume{{{0, 0, 0}, {1, 1, 1}}},
                                OnFallAsleep{},
                                OnSignal{"k", {}},
                                OnSignal{{}, "Start"}};
    const Effect effects[] = {SetAttribute{"restitution", 0.5},
                              ApplyImpulse{{1, 0, 0}, {}},
                              ApplyImpulse{{1, 0, 0}, Vec3{0, 1, 0}},
                              ApplyForce{{0, 9, 0}, 0.5},
                              SetVelocity{{1, 0, 0}, {0, 1, 0}},
                              Spawn{{{0, 5, 0}, {}}, {0, -1, 0}},
                              Remove{},
                              SetEnabled{false},
                              SetOpen{false},
                              Melt{3},
                              Freeze{},
                              Pause{}};
    std::uint32_t id = 1;
    for (const Trigger& trigger : triggers)
        for (const Effect& effect : effects) {
            Action action;
            action.id = id++;
            action.name = "action";
            action.sender = {Target::By::name, 0, "Sphere"};
            action.receiver = {Target::By::index, 2, {}};
            action.trigger = trigger;
            action.effect = effect;
            action.once = id % 2 == 0;
            action.enabled = id % 3 != 0;
            document.actions.push_back(action);
        }
}

}  // namespace

Document everything() {
    Document document;
    document.title = "Everything";
    document.description = "One of each.";
    document.settings.gravity = {0, -1.62, 0};
    document.settings.time_step = 1.0 / 240;
    document.settings.substeps = 7;
    document.settings.time_to_sleep = 0.75;
    document.settings.sleeping = false;
    document.settings.shock_propagation = false;
    document.settings.wind = {3, 0, -1};
    document.settings.gustiness = 0.3;
    document.settings.gust_time = 1.5;
    document.settings.air_density = 1.1;
    document.settings.max_linear_speed = 500;
    document.settings.max_angular_speed = 600;
    document.camera = {Vec3{1, 2, 3}, Vec3{0, 0.1, 0}};
    add_shapes(document);
    fill_entities(document);
    add_joints(document);
    add_actions(document);
    document.next_index = 40;
    return document;
}

}  // namespace embody::scene::samples
