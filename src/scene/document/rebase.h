// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/document/document_index.h"
#include "scene/document/history.h"

namespace embody::scene {

/// Why changes can't be made in the document as it is.
struct Conflict {
    ChangedThing thing;  ///< whose state another edit has changed
    std::string why;     ///< "its position was changed since"
};

struct Rebased {
    std::vector<Change> changes;       ///< from the document as it is; empty where there is a conflict
    std::optional<Conflict> conflict;  ///< the first
};

/// The recorded changes for a document that other people have changed since: every field that they change gets its
/// value after them, all other fields stay as they are. Possible where each of these fields still has its value before
/// them, a thing that goes has changed in nothing and holds nothing, and what a thing that comes hangs on is there.
Rebased rebased(const std::vector<Change>& changes, const Document& document, const DocumentIndex& lookup);

}  // namespace embody::scene
