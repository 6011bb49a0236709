// SPDX-License-Identifier: MIT
#include "scene/session/model_json.h"

#include <nlohmann/json.hpp>
#include <string>

namespace embody::scene {

nlohmann::json model_to_json(const catalog::ModelSummary& model) {
    return {{"id", model.id},
            {"key", model.key},
            {"name", model.name},
            {"source", model.source},
            {"licence", model.licence},
            {"author", model.author},
            {"category", model.category},
            {"subcategory", model.subcategory},
            {"kind", to_text(model.physical_kind)},
            {"tags", model.tags},
            {"size", {model.size.x, model.size.y, model.size.z}},
            {"vertices", model.vertices},
            {"triangles", model.triangles},
            {"parts", model.parts},
            {"quality", model.quality},
            {"geometry_kind", catalog::name_of(model.geometry_kind)},
            // A decimal string: a JavaScript number would lose digits.
            {"content_hash", std::to_string(model.content_hash)}};
}

}  // namespace embody::scene
