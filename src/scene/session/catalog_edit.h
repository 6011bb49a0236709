// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "catalog/catalog.h"
#include "foundation/result.h"
#include "scene/session/session_state.h"

// Acts of a session's clients on the catalogue's models: recorded under the client's name, one undo step each, told to
// all clients, and applied to the open scene.

namespace embody::scene {

/// Name for the audit of the client whose command is being executed: "studio: Ada", or "studio 3" without a name.
std::string acting_session(const SessionState& state);

/// Manual changes of many models as one act. A dry run tells what would happen.
Result<catalog::ChangeReport> change_models(SessionState& state, const catalog::Catalog::ModelChoice& models,
                                            const std::vector<catalog::AttributeChange>& changes,
                                            catalog::ChangeOptions options);
/// Reverts a batch of the audit; reverting an undo applies the original batch again.
Result<catalog::ChangeReport> undo_models(SessionState& state, std::int64_t batch);

/// edit.undo and edit.redo where the next edit is an act on the catalogue; the value is its label. An edit that can't
/// be carried out any more is dropped, so that the edits before it can still be reached.
Result<std::string> undo_on_catalog(SessionState& state);
Result<std::string> redo_on_catalog(SessionState& state);

/// Applies changes of other programs in the file since the last call and tells clients; false where there were none.
bool follow_changes_of_others(SessionState& state);

/// Label of the act, for people: "Set Mass of 46 models".
std::string label_of(const catalog::ChangeReport& report);

}  // namespace embody::scene
