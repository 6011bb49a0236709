// SPDX-License-Identifier: MIT
#include "scene/embody/entity_body.h"

#include "attributes/physical_kind.h"
#include "attributes/to_physics.h"
#include "scene/document/document_field.h"
#include "scene/embody/primitive_facts.h"

namespace embody::scene {

using attributes::AttributeEntry;
using attributes::AttributeLevel;
using attributes::AttributeSet;
using attributes::Matter;

namespace {

// Hull and triangles of a model of the catalogue, scaled.
class CatalogGeometry final : public attributes::ModelGeometry {
public:
    CatalogGeometry(const catalog::Catalog& catalog, std::int64_t id, double scale)
        : catalog_(catalog), id_(id), scale_(scale) {}

    Result<std::vector<Vec3>> hull_points() override {
        Result<std::vector<Vec3>> points = catalog_.hull_points(id_);
        if (points.ok())
            for (Vec3& point : points.value()) point *= scale_;
        return points;
    }

    Result<physics::MeshShape> mesh() override {
        Result<geometry::TriangleMesh> read = catalog_.mesh(id_);
        if (!read.ok()) return read.error();
        physics::MeshShape shape;
        shape.positions.reserve(read.value().positions.size());
        for (const auto& position : read.value().positions)
            shape.positions.push_back(to_vec3f(to_vec3(position) * scale_));
        shape.triangles = read.value().triangles;
        return shape;
    }

    Result<std::vector<std::vector<Vec3>>> convex_parts(int max_hulls, double hull_error) override {
        Result<catalog::ConvexParts> parts = catalog_.convex_parts(id_, max_hulls, hull_error / scale_);
        if (!parts.ok()) return parts.error();
        std::vector<std::vector<Vec3>> scaled;
        for (const std::vector<Vec3f>& hull : parts.value().hulls) {
            scaled.emplace_back();
            for (const Vec3f& point : hull) scaled.back().push_back(to_vec3(point) * scale_);
        }
        return scaled;
    }

private:
    const catalog::Catalog& catalog_;
    std::int64_t id_;
    double scale_;
};

}  // namespace

Result<physics::BodyDefinition> body_of(const Entity& entity, const AttributeSet& attributes,
                                        const attributes::Taxonomy* taxonomy) {
    physics::BodyDefinition body;
    if (matter_of(attributes) == Matter::none) {
        body.kind = physics::BodyKind::static_body;
        body.enabled = false;
    } else {
        Result<physics::BodyDefinition> made = attributes::body_from_attributes(attributes, taxonomy);
        if (!made.ok()) return in_place("attributes", made.error());
        body = std::move(made).value();
        body.enabled = entity.enabled;
    }

    // The mass of a primitive is that of its attributes; the physics computes its centre and its moments.
    if (std::holds_alternative<physics::ShapeDefinition>(entity.geometry)) {
        // The mesh collides as its convex hull, but its mass properties are those of the enclosed volume.
        const bool is_mesh =
            std::holds_alternative<physics::MeshShape>(std::get<physics::ShapeDefinition>(entity.geometry));
        const auto is_known = [&](const char* name) {
            const AttributeEntry* held = attributes.find(name);
            return held &&
                   (held->level == AttributeLevel::manual || (is_mesh && held->level != AttributeLevel::standard));
        };
        const AttributeEntry* mass = attributes.find("mass");
        if (mass && mass->level == AttributeLevel::standard) body.mass.mass.reset();
        if (!is_known("center_of_mass")) body.mass.center_of_mass.reset();
        if (!is_known("inertia")) body.mass.inertia.reset();
        body.mass.density *= attributes.number("fill_fraction", 1);
    }

    // Pose and initial velocity.
    body.position = entity.pose.position;
    body.rotation = entity.pose.rotation;
    body.linear_velocity = entity.linear_velocity;
    body.angular_velocity = entity.angular_velocity;
    body.force = entity.force;
    body.torque = entity.torque;
    body.start_asleep = entity.start_asleep;
    body.allow_sleep = entity.allow_sleep;
    body.continuous = body.continuous || entity.continuous;
    body.user_data = entity.index;
    return body;
}

Result<physics::ShapeDefinition> shape_of(const Entity& entity, const AttributeSet& attributes, KnownModels& models) {
    if (const auto* shape = std::get_if<physics::ShapeDefinition>(&entity.geometry)) {
        // Triangles have no inside that could move; a mesh that a person made movable collides as its convex hull.
        const auto* mesh = std::get_if<physics::MeshShape>(shape);
        if (!mesh || is_static(kind_of(attributes))) return *shape;
        return hull_of(*mesh);
    }
    const Result<const KnownModel*> model = models.find(std::get<ModelReference>(entity.geometry).key);
    if (!model.ok()) return model.error();
    CatalogGeometry geometry(*models.catalog(), model.value()->summary.id, entity.scale);
    Result<physics::ShapeDefinition> shape = attributes::shape_from_attributes(
        attributes, attributes::scaled(model.value()->facts.geometry, entity.scale), geometry);
    if (!shape.ok()) return in_place("model", shape.error());
    return shape;
}

GeometryKey shape_key(const Entity& entity, const AttributeSet& attributes) {
    GeometryKey key = key_of(entity.geometry);
    if (key.of != GeometryKey::Of::model) return key;
    key.words.push_back(attributes.word("collision_shape", ""));
    key.numbers.push_back(entity.scale);
    if (key.words.back() == "decomposition")
        for (const char* limit : {"max_hulls", "hull_error"}) key.numbers.push_back(attributes.number(limit, 0));
    return key;
}

}  // namespace embody::scene
