// SPDX-License-Identifier: MIT
#pragma once

#include <set>
#include <string>

#include "scene/document/document.h"

namespace embody::scene {

// Groups are written as paths (`Entity::group`): a group exists as long as something is in it.

/// The group within no other that `path` is in; empty for an empty path.
std::string outermost_group(const std::string& path);
/// The path without its last group.
std::string parent_group(const std::string& path);
/// Whether something of this path is in `group` or in a group of it. Everything is in the empty group.
bool is_in_group(const std::string& path, const std::string& group);
/// The innermost group that both are in.
std::string common_group(const std::string& a, const std::string& b);
/// `path` with `from` at its beginning replaced by `to`; it is in `from`.
std::string moved_group(const std::string& path, const std::string& from, const std::string& to);
/// `name`, with a number behind it where `parent` has a group of that name already, or it is taken.
std::string free_group(const Document& document, const std::string& parent, const std::string& name,
                       const std::set<std::string>& taken = {});
/// Whether it is a path of names that are not empty.
bool is_group_path(const std::string& path);

}  // namespace embody::scene
