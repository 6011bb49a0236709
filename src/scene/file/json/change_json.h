// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "foundation/result.h"
#include "scene/document/history.h"

namespace embody::scene {

/// A change as document events and journals tell it (docs/protocol.md): what it changed, as it is in `document` after
/// it.
nlohmann::json change_to_json(const Change& change, const Document& document);

/// Applies the changes of one edit, as change_to_json() wrote them. On an error those before the wrong one are applied.
Result<void> apply_changes(Document& document, const nlohmann::json& changes);

}  // namespace embody::scene
