// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "scene/session/session_state.h"

namespace embody::scene {

// Forms of a run that the document keeps (docs/time.md).

/// An edit that gives everything in the document that is not locked the pose and form that is shown, now or of a moment
/// of the take.
Edit edit_of_shown(SessionState& state);

/// Takes a kept form away where the edit changes what its points are made from, in the same step of undo. Returns what
/// begins as modelled again, in words for people.
std::vector<std::string> drop_unfit_forms(SessionState& state, Edit& edit);

/// Whether one of the changes sets a kept form or takes it away, of an entity that stays.
bool change_kept_forms(const std::vector<Change>& changes);

/// What clients are told of an entity, of changes or of a scene: of its kept form the number of points alone.
void tell_in_short(nlohmann::json& entity);
void tell_changes_in_short(nlohmann::json& changes, const Document& document);
void tell_scene_in_short(nlohmann::json& scene);

}  // namespace embody::scene
