// SPDX-License-Identifier: MIT
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "scene/document/document_field.h"
#include "scene/file/json/field_reader.h"
#include "scene/file/json/parts.h"
#include "scene/file/json/read_alternative.h"

namespace embody::scene {

using nlohmann::json;
using namespace embody::physics;

namespace {

void read_length(const json& field, const std::string& where, double& length, std::optional<Error>& error) {
    read_number(field, where, length, error, positive);
}

void read_length(const json& field, const std::string& where, Vec3& lengths, std::optional<Error>& error) {
    read_vector(field, where, lengths, error);
}

void read_fields(FieldReader& reader, HasLengths auto& shape) {
    shape.lengths(shape, [&](const char* name, auto& length, const char* expected) {
        if (const json* field = reader.need(name, expected))
            read_length(*field, reader.path(name), length, reader.error());
    });
}

void read_points(FieldReader& reader, const char* name, std::vector<Vec3>& points) {
    const json* list = reader.need(name, "a list of points [x, y, z]");
    if (!list || !read_array(*list, reader.path(name), reader.error())) return;
    points.resize(list->size());
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!read_vector((*list)[i], element_path(reader.path(name), i), points[i], reader.error())) return;
}

void read_fields(FieldReader& reader, HullShape& hull) { read_points(reader, "points", hull.points); }

void read_fields(FieldReader& reader, PlaneShape& plane) {
    reader.vector("normal", plane.normal);
    reader.number("offset", plane.offset);
}

void read_fields(FieldReader& reader, HeightfieldShape& field) {
    reader.whole("columns", field.columns, 2, 1 << 15);
    reader.whole("rows", field.rows, 2, 1 << 15);
    reader.number("cell_x", field.cell_x, positive);
    reader.number("cell_z", field.cell_z, positive);
    const json* list = reader.need("heights", "columns × rows numbers, row by row");
    if (!list || !read_array(*list, reader.path("heights"), reader.error())) return;
    if (list->size() != static_cast<std::size_t>(field.columns) * static_cast<std::size_t>(field.rows)) {
        reader.fail(reader.path("heights"),
                    "must have columns × rows = " + std::to_string(static_cast<long long>(field.columns) * field.rows) +
                        " numbers, has " + std::to_string(list->size()));
        return;
    }
    field.heights.resize(list->size());
    for (std::size_t i = 0; i < field.heights.size(); ++i) {
        double height = 0;
        if (!read_number((*list)[i], element_path(reader.path("heights"), i), height, reader.error(), {-1e30, 1e30}))
            break;
        field.heights[i] = static_cast<float>(height);
    }
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

void read_fields(FieldReader& reader, MeshShape& mesh) {
    std::vector<Vec3> positions;
    read_points(reader, "positions", positions);
    if (!reader.ok()) return;
    mesh.positions.reserve(positions.size());
    for (const Vec3& position : positions) mesh.positions.push_back(to_vec3f(position));
    read_triangles(reader, mesh);
}

void read_fields(FieldReader& reader, CompoundShape& compound) {
    const json* list = reader.need("children", "a list of convex shapes, each with an optional position and rotation");
    if (!list || !read_array(*list, reader.path("children"), reader.error())) return;
    for (std::size_t i = 0; i < list->size(); ++i) {
        FieldReader child_reader((*list)[i], element_path(reader.path("children"), i), reader.error());
        CompoundChild child;
        child_reader.vector("position", child.local.position);
        child_reader.rotation("rotation", child.local.rotation);
        child_reader.need("type", "the kind of shape");
        // Only convex shapes may be children; the list has no others.
        if (!read_alternative(child_reader, child.shape)) return;
        std::visit([&](auto& shape) { read_fields(child_reader, shape); }, child.shape);
        if (!child_reader.finish()) return;
        compound.children.push_back(std::move(child));
    }
}

WallOpening read_opening(FieldReader& reader) {
    WallOpening opening;
    std::size_t kind = 0;
    if (reader.need("kind", "hole, door or window") &&
        reader.choice("kind", kind, {opening_kinds[0], opening_kinds[1], opening_kinds[2]}))
        opening.kind = static_cast<OpeningKind>(kind);
    for (const auto& [name, value] : {std::pair{"offset", &opening.offset}, std::pair{"width", &opening.width},
                                      std::pair{"height", &opening.height}})
        if (const json* field = reader.need(name, "a length in metres"))
            read_number(*field, reader.path(name), *value, reader.error());
    reader.number("sill", opening.sill, not_negative);
    int owner = 0;
    reader.whole("entity", owner, 1, static_cast<int>(last_document_index));
    opening.owner = static_cast<std::uint32_t>(owner);
    reader.finish();
    return opening;
}

void read_fields(FieldReader& reader, WallShape& wall) {
    for (const auto& [name, value] : {std::pair{"length", &wall.length}, std::pair{"height", &wall.height},
                                      std::pair{"thickness", &wall.thickness}})
        if (const json* field = reader.need(name, a_length))
            read_number(*field, reader.path(name), *value, reader.error(), positive);
    reader.number("rise", wall.rise);
    reader.numbers("start_cut", wall.start_cut);
    reader.numbers("end_cut", wall.end_cut);
    const json* list = reader.list("openings");
    if (!list) return;
    for (std::size_t i = 0; i < list->size() && reader.ok(); ++i) {
        FieldReader item((*list)[i], element_path(reader.path("openings"), i), reader.error());
        wall.openings.push_back(read_opening(item));
    }
}

void read_fields(FieldReader& reader, SlabShape& slab) {
    if (const json* field = reader.need("thickness", a_length))
        read_number(*field, reader.path("thickness"), slab.thickness, reader.error(), positive);
    const json* list = reader.need("points", "the corners [x, z] in order");
    if (!list || !read_array(*list, reader.path("points"), reader.error())) return;
    slab.points.resize(list->size());
    for (std::size_t i = 0; i < slab.points.size(); ++i) {
        const json& corner = (*list)[i];
        const std::string where = element_path(reader.path("points"), i);
        if (!corner.is_array() || corner.size() != 2) return reader.fail(where, "must be two numbers [x, z]");
        for (std::size_t k = 0; k < 2; ++k)
            if (!read_number(corner[k], element_path(where, k), slab.points[i][k], reader.error())) return;
    }
}

// Writers of the alternatives.
struct ShapeWriter {
    json operator()(const HasLengths auto& s) const {
        json written = {{"type", s.name}};
        s.lengths(s,
                  [&](const char* name, const auto& length, const char*) { written[name] = length_to_json(length); });
        return written;
    }
    json operator()(const HullShape& s) const {
        json points = json::array();
        for (const Vec3& point : s.points) points.push_back(vector_to_json(point));
        return {{"type", s.name}, {"points", std::move(points)}};
    }
    json operator()(const PlaneShape& s) const {
        return {{"type", s.name}, {"normal", vector_to_json(s.normal)}, {"offset", s.offset}};
    }
    json operator()(const HeightfieldShape& s) const {
        json heights = json::array();
        for (const float height : s.heights) heights.push_back(float_to_json(height));
        return {{"type", s.name},     {"columns", s.columns}, {"rows", s.rows},
                {"cell_x", s.cell_x}, {"cell_z", s.cell_z},   {"heights", std::move(heights)}};
    }
    json operator()(const MeshShape& s) const {
        json positions = json::array();
        for (const Vec3f& p : s.positions)
            positions.push_back(json::array({float_to_json(p.x), float_to_json(p.y), float_to_json(p.z)}));
        json triangles = json::array();
        for (const auto& t : s.triangles) triangles.push_back(json::array({t[0], t[1], t[2]}));
        return {{"type", s.name}, {"positions", std::move(positions)}, {"triangles", std::move(triangles)}};
    }
    json operator()(const WallShape& s) const {
        json written = {{"type", s.name}, {"length", s.length}, {"height", s.height}, {"thickness", s.thickness}};
        if (s.rise != 0) written["rise"] = s.rise;
        if (s.start_cut != WallShape{}.start_cut) written["start_cut"] = s.start_cut;
        if (s.end_cut != WallShape{}.end_cut) written["end_cut"] = s.end_cut;
        for (const WallOpening& opening : s.openings) {
            json one = {{"kind", opening_kinds[static_cast<std::size_t>(opening.kind)]},
                        {"offset", opening.offset},
                        {"width", opening.width},
                        {"height", opening.height},
                        {"sill", opening.sill}};
            if (opening.owner != 0) one["entity"] = opening.owner;
            written["openings"].push_back(std::move(one));
        }
        return written;
    }
    json operator()(const SlabShape& s) const {
        return {{"type", s.name}, {"thickness", s.thickness}, {"points", s.points}};
    }
    json operator()(const CompoundShape& s) const {
        json children = json::array();
        for (const CompoundChild& child : s.children) {
            json written = std::visit(*this, child.shape);
            written["position"] = vector_to_json(child.local.position);
            written["rotation"] = rotation_to_json(child.local.rotation);
            children.push_back(std::move(written));
        }
        return {{"type", s.name}, {"children", std::move(children)}};
    }
    static json length_to_json(double length) { return length; }
    static json length_to_json(Vec3 lengths) { return vector_to_json(lengths); }
};

}  // namespace

Result<ShapeDefinition> shape_from_json(const json& value, const std::string& where) {
    std::optional<Error> error;
    FieldReader reader(value, where, error);
    ShapeDefinition shape;
    reader.need("type", "the kind of shape, e.g. \"box\"");
    if (read_alternative(reader, shape)) std::visit([&](auto& one) { read_fields(reader, one); }, shape);
    reader.finish();
    if (error) return *error;

    // Errors that no single field shows: four points without a volume, a triangle without area …
    if (const Result<void> valid = physics::validate(shape); !valid.ok()) {
        Error refused = valid.error();
        refused.where = where + (refused.where.empty() ? "" : "." + document_field(refused.where));
        return refused;
    }
    return shape;
}

json shape_to_json(const ShapeDefinition& shape) { return std::visit(ShapeWriter{}, shape); }

}  // namespace embody::scene
