// SPDX-License-Identifier: MIT
#include "scene/session/groups.h"

#include <algorithm>

namespace embody::scene {

namespace {

std::string joined(const std::string& parent, const std::string& rest) {
    return parent.empty() ? rest : rest.empty() ? parent : parent + "/" + rest;
}

}  // namespace

std::string outermost_group(const std::string& path) { return path.substr(0, path.find('/')); }

std::string parent_group(const std::string& path) {
    const auto slash = path.rfind('/');
    return slash == std::string::npos ? std::string() : path.substr(0, slash);
}

bool is_in_group(const std::string& path, const std::string& group) {
    return group.empty() || path == group || path.starts_with(group + "/");
}

std::string common_group(const std::string& a, const std::string& b) {
    std::string common = a;
    while (!is_in_group(b, common)) common = parent_group(common);
    return common;
}

std::string moved_group(const std::string& path, const std::string& from, const std::string& to) {
    const std::string rest = from.empty() ? path : path == from ? std::string() : path.substr(from.size() + 1);
    return joined(to, rest);
}

std::string free_group(const Document& document, const std::string& parent, const std::string& name,
                       const std::set<std::string>& taken) {
    const auto is_taken = [&](const std::string& path) {
        if (taken.contains(path)) return true;
        return std::any_of(document.entities.begin(), document.entities.end(),
                           [&](const Entity& entity) { return is_in_group(entity.group, path); });
    };
    std::string path = joined(parent, name);
    for (int number = 2; is_taken(path); ++number) path = joined(parent, name + " " + std::to_string(number));
    return path;
}

bool is_group_path(const std::string& path) {
    return path.empty() || (path.front() != '/' && path.back() != '/' && path.find("//") == std::string::npos);
}

}  // namespace embody::scene
