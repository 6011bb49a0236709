// SPDX-License-Identifier: MIT
#include "attributes/facts_json.h"

#include <nlohmann/json.hpp>

#include "attributes/field_reader.h"

namespace embody::attributes {
namespace {

using nlohmann::json;

json vector_json(Vec3 v) { return json::array({v.x, v.y, v.z}); }
json columns_json(const Mat3& m) { return json::array({vector_json(m.x), vector_json(m.y), vector_json(m.z)}); }

// Numbers of a body of unit density: [measure, centre, columns of the inertia].
json mass_properties_json(const geometry::MassProperties& p) {
    return json::array({p.volume, vector_json(p.center), columns_json(p.inertia)});
}

json parts_json(const std::vector<PartFacts>& parts) {
    json list = json::array();
    for (const PartFacts& part : parts) {
        list.push_back({{"material", part.material},
                        {"shell", mass_properties_json(part.form.shell)},
                        {"solid", mass_properties_json(part.form.solid)}});
    }
    return list;
}

json geometry_json(const GeometryFacts& g) {
    const Quat turn = g.fitted_pose.rotation;
    return {{"size", vector_json(g.size)},
            {"closed", g.closed},
            {"volume", g.volume},
            {"volume_method", g.volume_method},
            {"volume_relative_error", g.volume_relative_error},
            {"center_of_volume", vector_json(g.center_of_volume)},
            {"unit_inertia", columns_json(g.unit_inertia)},
            {"hull_volume", g.hull_volume},
            {"hull_concavity", g.hull_concavity},
            {"surface_area", g.surface_area},
            {"fitted_shape", g.fitted_shape},
            {"fitted_dimensions", vector_json(g.fitted_dimensions)},
            {"fitted_position", vector_json(g.fitted_pose.position)},
            {"fitted_rotation", json::array({turn.x, turn.y, turn.z, turn.w})},
            {"fitted_error", g.fitted_error},
            {"parts", parts_json(g.parts)}};
}

void read_columns(const json& list, const std::string& where, Mat3& value, std::optional<Error>& error) {
    if (!read_array(list, where, error)) return;
    Mat3 read;
    for (int k = 0; k < 3; ++k) {
        const auto at = static_cast<std::size_t>(k);
        const json column = at < list.size() ? list[at] : json();
        if (!read_vector(column, element_path(where, at), read.column(k), error)) return;
    }
    value = read;
}

void read_mass_properties(FieldReader& reader, const char* name, geometry::MassProperties& value) {
    const json* list = reader.list(name);
    if (list == nullptr) return;
    const std::string where = reader.path(name);
    if (list->size() != 3) return reader.fail(where, "must be [measure, centre, inertia]");
    if (!read_number((*list)[0], element_path(where, 0), value.volume, reader.error())) return;
    if (!read_vector((*list)[1], element_path(where, 1), value.center, reader.error())) return;
    read_columns((*list)[2], element_path(where, 2), value.inertia, reader.error());
}

void read_parts(FieldReader& reader, std::vector<PartFacts>& parts) {
    const json* list = reader.list("parts");
    if (list == nullptr) return;
    for (std::size_t i = 0; i < list->size(); ++i) {
        PartFacts part;
        FieldReader inner((*list)[i], element_path(reader.path("parts"), i), reader.error());
        inner.text("material", part.material);
        read_mass_properties(inner, "shell", part.form.shell);
        read_mass_properties(inner, "solid", part.form.solid);
        parts.push_back(std::move(part));
    }
}

void read_geometry(FieldReader reader, GeometryFacts& g) {
    reader.vector("size", g.size);
    reader.truth("closed", g.closed);
    reader.number("volume", g.volume);
    reader.text("volume_method", g.volume_method);
    reader.number("volume_relative_error", g.volume_relative_error);
    reader.vector("center_of_volume", g.center_of_volume);
    if (const json* inertia = reader.take("unit_inertia"))
        read_columns(*inertia, reader.path("unit_inertia"), g.unit_inertia, reader.error());
    reader.number("hull_volume", g.hull_volume);
    reader.number("hull_concavity", g.hull_concavity);
    reader.number("surface_area", g.surface_area);
    reader.text("fitted_shape", g.fitted_shape);
    reader.vector("fitted_dimensions", g.fitted_dimensions);
    reader.vector("fitted_position", g.fitted_pose.position);
    reader.rotation("fitted_rotation", g.fitted_pose.rotation);
    reader.number("fitted_error", g.fitted_error);
    read_parts(reader, g.parts);
}

}  // namespace

nlohmann::json to_json(const ModelFacts& facts) {
    json document{{"name", facts.name},
                  {"tags", facts.tags},
                  {"catalogue_category", facts.catalogue_category},
                  {"folder", facts.folder},
                  {"material_names", facts.material_names},
                  {"door_or_window", facts.door_or_window},
                  {"size_is_stated", facts.size_is_stated},
                  {"geometry", geometry_json(facts.geometry)}};
    if (!facts.stated_thing.empty()) document["stated_thing"] = facts.stated_thing;
    if (facts.movable) document["movable"] = *facts.movable;
    return document;
}

Result<ModelFacts> facts_from_json(const nlohmann::json& document) {
    ModelFacts facts;
    FieldReader reader(document, "facts");
    reader.text("name", facts.name);
    reader.words("tags", facts.tags);
    reader.text("catalogue_category", facts.catalogue_category);
    reader.text("folder", facts.folder);
    reader.text("stated_thing", facts.stated_thing);
    reader.words("material_names", facts.material_names);
    reader.truth("door_or_window", facts.door_or_window);
    reader.truth("size_is_stated", facts.size_is_stated);
    bool movable = false;
    const json* answer = reader.take("movable");
    if (answer != nullptr && !answer->is_null() && reader.truth("movable", movable)) facts.movable = movable;
    if (const json* geometry = reader.object("geometry"))
        read_geometry(FieldReader(*geometry, reader.path("geometry"), reader.error()), facts.geometry);
    if (!reader.ok()) return *reader.error();
    return facts;
}

}  // namespace embody::attributes
