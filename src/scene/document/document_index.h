// SPDX-License-Identifier: MIT
#pragma once

#include <set>
#include <string>
#include <unordered_map>

#include "scene/document/history.h"
#include "scene/document/hold_index.h"

namespace embody::scene {

/// The names of all entities, to find a free one.
class NamesInUse {
public:
    void add(const std::string& name) { ++count_[name]; }
    void remove(const std::string& name);
    void clear();
    /// `wanted` where no entity has it, else `wanted` with the lowest number behind it that is free.
    std::string free_name(const std::string& wanted);

private:
    std::unordered_map<std::string, std::size_t> count_;
    /// By wanted name the first number that may be free: all before it are taken.
    std::unordered_map<std::string, int> next_number_;
};

/// Lookups that would otherwise search all of a document. Follows the document's changes.
struct DocumentIndex {
    NamesInUse names;
    HoldIndex holds;              ///< pins and joints of the document
    std::set<EntityIndex> walls;  ///< entities of the shape wall

    void assign(const Document& document);
    void apply(const std::vector<Change>& changes);
};

}  // namespace embody::scene
