// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "interchange/sweethome/sweethome_home.h"
#include "scene/document/document.h"

namespace embody::scene {

/// The key that a model of a home has in the database once the home was imported.
std::string key_of_home_model(const std::string& id);

struct HomeDocument {
    Document document;
    std::vector<std::string> notes;  ///< what is not as in the home, for people
};

/// A home as a scene: walls with mitred corners, floors, levels, doors and windows that cut the walls they stand in,
/// and furniture. What `has_model` says has no model of that key is a box of its size. What hangs, with nothing below
/// it, is static.
HomeDocument document_of_home(const interchange::SweethomeHome& home, const std::string& title,
                              const std::function<bool(const std::string& key)>& has_model);

}  // namespace embody::scene
