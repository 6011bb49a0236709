// SPDX-License-Identifier: MIT
#include <cmath>
#include <nlohmann/json.hpp>

#include "scene/document/document_field.h"
#include "scene/file/json/field_reader.h"
#include "scene/file/json/parts.h"

namespace embody::scene {

using nlohmann::json;
using namespace embody::physics;

namespace {

// Types in the order of ShapeDefinition's alternatives.
constexpr std::initializer_list<const char*> shape_types = {"sphere", "box",   "capsule",     "cylinder", "cone",
                                                            "hull",   "plane", "heightfield", "mesh",     "compound"};

bool need_number(FieldReader& reader, const char* name, double& value) {
    const json* field = reader.need(name, "a length in metres");
    return field && read_number(*field, reader.path(name), value, reader.error(), positive);
}

void read_round(FieldReader& reader, double& radius, double& half_height) {
    need_number(reader, "radius", radius);
    need_number(reader, "half_height", half_height);
}

void read_points(FieldReader& reader, const char* name, std::vector<Vec3>& points) {
    const json* list = reader.need(name, "a list of points [x, y, z]");
    if (!list || !read_array(*list, reader.path(name), reader.error())) return;
    points.resize(list->size());
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!read_vector((*list)[i], element_path(reader.path(name), i), points[i], reader.error())) return;
}

HeightfieldShape read_heightfield(FieldReader& reader) {
    HeightfieldShape field;
    reader.whole("columns", field.columns, 2, 1 << 15);
    reader.whole("rows", field.rows, 2, 1 << 15);
    reader.number("cell_x", field.cell_x, positive);
    reader.number("cell_z", field.cell_z, positive);
    const json* list = reader.need("heights", "columns × rows numbers, row by row");
    if (!list || !read_array(*list, reader.path("heights"), reader.error())) return field;
    if (list->size() != static_cast<std::size_t>(field.columns) * static_cast<std::size_t>(field.rows)) {
        reader.fail(reader.path("heights"),
                    "must have columns × rows = " + std::to_string(static_cast<long long>(field.columns) * field.rows) +
                        " numbers, has " + std::to_string(list->size()));
        return field;
    }
    field.heights.resize(list->size());
    for (std::size_t i = 0; i < field.heights.size(); ++i) {
        double height = 0;
        if (!read_number((*list)[i], element_path(reader.path("heights"), i), height, reader.error(), {-1e30, 1e30}))
            break;
        field.heights[i] = static_cast<float>(height);
    }
    return field;
}

void read_triangles(FieldReader& reader, MeshShape& mesh) {
    const json* list = reader.need("triangles", "a list of three vertex numbers each");
    const std::string where = reader.path("triangles");
    if (!list || !read_array(*list, where, reader.error())) return;
    mesh.triangles.resize(list->size());
    const auto last = static_cast<double>(mesh.positions.size()) - 1;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const json& triangle = (*list)[i];
        if (!triangle.is_array() || triangle.size() != 3)
            return reader.fail(element_path(where, i), "must be three vertex numbers");
        for (std::size_t k = 0; k < 3; ++k) {
            const std::string at = element_path(element_path(where, i), k);
            double vertex = 0;
            if (!read_number(triangle[k], at, vertex, reader.error(), {0, last})) return;
            if (vertex != std::floor(vertex)) return reader.fail(at, "must be a whole number");
            mesh.triangles[i][k] = static_cast<std::uint32_t>(vertex);
        }
    }
}

MeshShape read_mesh(FieldReader& reader) {
    MeshShape mesh;
    std::vector<Vec3> positions;
    read_points(reader, "positions", positions);
    if (!reader.ok()) return mesh;
    mesh.positions.reserve(positions.size());
    for (const Vec3& position : positions) mesh.positions.push_back(to_vec3f(position));
    read_triangles(reader, mesh);
    return mesh;
}

void read_children(FieldReader& reader, CompoundShape& compound);

ShapeDefinition read_shape(FieldReader& reader, std::size_t type) {
    switch (type) {
        case 0: {
            SphereShape sphere;
            need_number(reader, "radius", sphere.radius);
            return sphere;
        }
        case 1: {
            BoxShape box;
            if (const json* field = reader.need("half_extents", "half the lengths of the edges, [x, y, z]"))
                read_vector(*field, reader.path("half_extents"), box.half_extents, reader.error());
            return box;
        }
        case 2: {
            CapsuleShape capsule;
            read_round(reader, capsule.radius, capsule.half_height);
            return capsule;
        }
        case 3: {
            CylinderShape cylinder;
            read_round(reader, cylinder.radius, cylinder.half_height);
            return cylinder;
        }
        case 4: {
            ConeShape cone;
            read_round(reader, cone.radius, cone.half_height);
            return cone;
        }
        case 5: {
            HullShape hull;
            read_points(reader, "points", hull.points);
            return hull;
        }
        case 6: {
            PlaneShape plane;
            reader.vector("normal", plane.normal);
            reader.number("offset", plane.offset);
            return plane;
        }
        case 7:
            return read_heightfield(reader);
        case 8:
            return read_mesh(reader);
        default: {
            CompoundShape compound;
            read_children(reader, compound);
            return compound;
        }
    }
}

// The convex alternatives of a shape as a compound's child holds them.
struct AsChild {
    template <class Shape>
    bool operator()(const Shape& shape) const {
        if constexpr (std::is_assignable_v<decltype(child.shape)&, const Shape&>) {
            child.shape = shape;
            return true;
        } else {
            return false;
        }
    }
    CompoundChild& child;
};

void read_children(FieldReader& reader, CompoundShape& compound) {
    const json* list = reader.need("children", "a list of convex shapes, each with an optional position and rotation");
    if (!list || !read_array(*list, reader.path("children"), reader.error())) return;
    for (std::size_t i = 0; i < list->size(); ++i) {
        FieldReader child_reader((*list)[i], element_path(reader.path("children"), i), reader.error());
        CompoundChild child;
        child_reader.vector("position", child.local.position);
        child_reader.rotation("rotation", child.local.rotation);
        std::size_t type = 0;
        child_reader.need("type", "the kind of shape");
        // Only convex shapes may be children; the wrong ones are not even in the list.
        if (!child_reader.choice("type", type, {"sphere", "box", "capsule", "cylinder", "cone", "hull"})) return;
        std::visit(AsChild{child}, read_shape(child_reader, type));
        if (!child_reader.finish()) return;
        compound.children.push_back(std::move(child));
    }
}

// Writers, one an alternative.
struct ShapeWriter {
    json operator()(const SphereShape& s) const { return {{"type", "sphere"}, {"radius", s.radius}}; }
    json operator()(const BoxShape& s) const {
        return {{"type", "box"}, {"half_extents", vector_to_json(s.half_extents)}};
    }
    json operator()(const CapsuleShape& s) const { return round("capsule", s.radius, s.half_height); }
    json operator()(const CylinderShape& s) const { return round("cylinder", s.radius, s.half_height); }
    json operator()(const ConeShape& s) const { return round("cone", s.radius, s.half_height); }
    json operator()(const HullShape& s) const {
        json points = json::array();
        for (const Vec3& point : s.points) points.push_back(vector_to_json(point));
        return {{"type", "hull"}, {"points", std::move(points)}};
    }
    json operator()(const PlaneShape& s) const {
        return {{"type", "plane"}, {"normal", vector_to_json(s.normal)}, {"offset", s.offset}};
    }
    json operator()(const HeightfieldShape& s) const {
        json heights = json::array();
        for (const float height : s.heights) heights.push_back(float_to_json(height));
        return {{"type", "heightfield"}, {"columns", s.columns}, {"rows", s.rows},
                {"cell_x", s.cell_x},    {"cell_z", s.cell_z},   {"heights", std::move(heights)}};
    }
    json operator()(const MeshShape& s) const {
        json positions = json::array();
        for (const Vec3f& p : s.positions)
            positions.push_back(json::array({float_to_json(p.x), float_to_json(p.y), float_to_json(p.z)}));
        json triangles = json::array();
        for (const auto& t : s.triangles) triangles.push_back(json::array({t[0], t[1], t[2]}));
        return {{"type", "mesh"}, {"positions", std::move(positions)}, {"triangles", std::move(triangles)}};
    }
    json operator()(const CompoundShape& s) const {
        json children = json::array();
        for (const CompoundChild& child : s.children) {
            json written = std::visit(*this, child.shape);
            written["position"] = vector_to_json(child.local.position);
            written["rotation"] = rotation_to_json(child.local.rotation);
            children.push_back(std::move(written));
        }
        return {{"type", "compound"}, {"children", std::move(children)}};
    }
    static json round(const char* type, double radius, double half_height) {
        return {{"type", type}, {"radius", radius}, {"half_height", half_height}};
    }
};

}  // namespace

Result<ShapeDefinition> shape_from_json(const json& value, const std::string& where) {
    std::optional<Error> error;
    FieldReader reader(value, where, error);
    std::size_t type = 0;
    ShapeDefinition shape;
    reader.need("type", "the kind of shape, e.g. \"box\"");
    if (reader.choice("type", type, shape_types)) shape = read_shape(reader, type);
    reader.finish();
    if (error) return *error;

    // What a single field cannot show: four points without a volume, a triangle of no area …
    if (const Result<void> valid = physics::validate(shape); !valid.ok()) {
        Error refused = valid.error();
        refused.where = where + (refused.where.empty() ? "" : "." + document_field(refused.where));
        return refused;
    }
    return shape;
}

json shape_to_json(const ShapeDefinition& shape) { return std::visit(ShapeWriter{}, shape); }

}  // namespace embody::scene
