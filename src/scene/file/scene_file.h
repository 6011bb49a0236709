// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "foundation/result.h"
#include "scene/document/document.h"

namespace embody::scene {

/// The format is docs/scene-format.md. Reading refuses unknown and wrong fields by name; the error's `where` is the
/// field's path, e.g. "entities[3].pose.position".
Result<Document> document_from_json(const nlohmann::json& json);
nlohmann::json document_to_json(const Document& document);

Result<Entity> entity_from_json(const nlohmann::json& json, const std::string& where);
nlohmann::json entity_to_json(const Entity& entity);

/// The error has the file's name, and line and column where it is not JSON at all.
Result<Document> load_document(const std::filesystem::path& file);
/// Writes the whole file or nothing: a new file is written beside the old one, synced and renamed over it.
Result<void> save_document(const Document& document, const std::filesystem::path& file);

}  // namespace embody::scene
