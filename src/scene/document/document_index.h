// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <unordered_map>

#include "scene/document/history.h"
#include "scene/document/hold_index.h"

namespace embody::scene {

/// The names that entities have, to find one that is free.
class NamesInUse {
public:
    void add(const std::string& name) { ++count_[name]; }
    void remove(const std::string& name);
    void clear();
    /// `wanted`, with the least number behind it that nobody has, where somebody has it.
    std::string free_name(const std::string& wanted);

private:
    std::unordered_map<std::string, std::size_t> count_;
    /// Of a wanted name the first number that may be free: all before it are taken.
    std::unordered_map<std::string, int> next_number_;
};

/// What is looked up of a document that would take a walk over all of it otherwise. Follows its changes.
struct DocumentIndex {
    NamesInUse names;
    HoldIndex holds;  ///< pins and joints of the document

    void assign(const Document& document);
    void apply(const std::vector<Change>& changes);
};

}  // namespace embody::scene
