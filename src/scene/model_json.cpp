// SPDX-License-Identifier: MIT
#include "scene/model_json.h"

#include <nlohmann/json.hpp>
#include <string>

namespace embody::scene {
namespace {

const char* name_of(catalog::GeometryKind kind) {
    switch (kind) {
        case catalog::GeometryKind::mesh:
            return "mesh";
        case catalog::GeometryKind::point_cloud:
            return "point_cloud";
        case catalog::GeometryKind::voxel:
            return "voxel";
        case catalog::GeometryKind::analytical:
            return "analytical";
    }
    return "mesh";
}

}  // namespace

nlohmann::json model_to_json(const catalog::ModelSummary& model) {
    return {{"id", model.id},
            {"key", model.key},
            {"name", model.name},
            {"source", model.source},
            {"licence", model.licence},
            {"author", model.author},
            {"category", model.category},
            {"subcategory", model.subcategory},
            {"kind", model.physical_kind},
            {"tags", model.tags},
            {"size", {model.size.x, model.size.y, model.size.z}},
            {"vertices", model.vertices},
            {"triangles", model.triangles},
            {"parts", model.parts},
            {"quality", model.quality},
            {"geometry_kind", name_of(model.geometry_kind)},
            // A decimal string: a JavaScript number would lose digits.
            {"content_hash", std::to_string(model.content_hash)}};
}

}  // namespace embody::scene
