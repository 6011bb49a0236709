// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "catalog/catalog.h"
#include "foundation/result.h"
#include "scene/session/session_state.h"

// Acts of a session's clients on the catalogue's models: recorded under the client's name, one step of undo each, told
// to all clients, and taken up by what the open scene has of these models.

namespace embody::scene {

/// Through what the client whose command is in hand acts, for the audit: "studio: Ada", or "studio 3" without a name.
std::string acting_session(const SessionState& state);

/// Manual changes of many models as one act. A dry run tells what would happen.
Result<catalog::ChangeReport> change_models(SessionState& state, const catalog::Catalog::ModelChoice& models,
                                            const std::vector<catalog::AttributeChange>& changes,
                                            catalog::ChangeOptions options);
/// Takes a batch of the audit back; of an undo: does again what it took back.
Result<catalog::ChangeReport> undo_models(SessionState& state, std::int64_t batch);

/// edit.undo and edit.redo where the edit in turn is an act on the catalogue; the value is its label. What can't be
/// carried out any more is dropped, so that the edits before it can still be reached.
Result<std::string> undo_on_catalog(SessionState& state);
Result<std::string> redo_on_catalog(SessionState& state);

/// What other programs changed in the file since the last call is told and taken up; false where there was nothing.
bool follow_changes_of_others(SessionState& state);

/// What the act did, for people: "Set Mass of 46 models".
std::string label_of(const catalog::ChangeReport& report);

}  // namespace embody::scene
