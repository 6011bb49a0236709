// SPDX-License-Identifier: MIT
#include "attributes/attribute.h"

#include <algorithm>
#include <array>
#include <limits>

#include "attributes/registry.h"

namespace embody::attributes {
namespace {

constexpr std::array level_names{"default", "kind", "category", "subcategory", "model", "measured", "manual"};

// Index of a name in the registry; names that are not in it come last.
std::size_t rank_of(std::string_view name) {
    const AttributeDescription* description = describe(name);
    if (description == nullptr) return std::numeric_limits<std::size_t>::max();
    return static_cast<std::size_t>(description - registry().data());
}

}  // namespace

const char* level_name(AttributeLevel level) { return level_names[static_cast<std::size_t>(level)]; }

std::optional<AttributeLevel> level_from_name(std::string_view name) {
    for (std::size_t i = 0; i < level_names.size(); ++i) {
        if (name == level_names[i]) return static_cast<AttributeLevel>(i);
    }
    return std::nullopt;
}

const AttributeEntry* AttributeSet::find(std::string_view name) const {
    for (const AttributeEntry& entry : entries_) {
        if (entry.name == name) return &entry;
    }
    return nullptr;
}

bool AttributeSet::put(AttributeEntry entry) {
    // An entry of the same name is replaced only by an equal or higher level.
    for (AttributeEntry& held : entries_) {
        if (held.name != entry.name) continue;
        if (held.level > entry.level) return false;
        held = std::move(entry);
        return true;
    }
    // A new entry goes to its place in the registry's order.
    const std::size_t rank = rank_of(entry.name);
    const auto place = std::find_if(entries_.begin(), entries_.end(),
                                    [&](const AttributeEntry& held) { return rank_of(held.name) > rank; });
    entries_.insert(place, std::move(entry));
    return true;
}

void AttributeSet::erase(std::string_view name) {
    std::erase_if(entries_, [&](const AttributeEntry& entry) { return entry.name == name; });
}

double AttributeSet::number(std::string_view name, double fallback) const {
    const AttributeEntry* entry = find(name);
    const double* value = entry != nullptr ? std::get_if<double>(&entry->value) : nullptr;
    return value != nullptr ? *value : fallback;
}

std::string AttributeSet::word(std::string_view name, std::string_view fallback) const {
    const AttributeEntry* entry = find(name);
    const std::string* value = entry != nullptr ? std::get_if<std::string>(&entry->value) : nullptr;
    return value != nullptr ? *value : std::string(fallback);
}

bool AttributeSet::truth(std::string_view name, bool fallback) const {
    const AttributeEntry* entry = find(name);
    const bool* value = entry != nullptr ? std::get_if<bool>(&entry->value) : nullptr;
    return value != nullptr ? *value : fallback;
}

}  // namespace embody::attributes
