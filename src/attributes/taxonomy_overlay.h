// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "foundation/result.h"

namespace embody::attributes {

/// An entry of a taxonomy file as it is written, before it is checked.
struct TaxonomyEntry {
    std::shared_ptr<nlohmann::json> object;                 ///< without its subcategories; never null
    std::string where;                                      ///< for errors, such as "furniture.json: categories[3]"
    std::string domain;                                     ///< its file without ".json"
    std::map<std::string, std::string, std::less<>> users;  ///< field → the user's file that set it
    std::vector<TaxonomyEntry> subcategories;
};

/// The entries of a file of categories. `where` names the file in errors.
Result<std::vector<TaxonomyEntry>> read_entries(const std::filesystem::path& file, const std::string& where);

/// Applies a user's files, in the order of their names, to our entries. An entry with a known name changes the fields
/// that it sets and adds its words; an entry with another name is new. A word that belonged to another entry moves.
/// `user_words` gets the stems of all words in the user's files, with the file. Errors name file, entry and field.
Result<void> apply_overlay(std::vector<TaxonomyEntry>& entries, const std::filesystem::path& folder,
                           std::map<std::string, std::string, std::less<>>& user_words);

}  // namespace embody::attributes
