// SPDX-License-Identifier: MIT
#include "catalog/describe_model.h"

#include <algorithm>
#include <array>
#include <ctime>
#include <fstream>
#include <sstream>
#include <system_error>

#include "attributes/physical_kind.h"
#include "catalog/knowledge_json.h"
#include "foundation/state_hash.h"

namespace embody::catalog {
namespace {

// Raise when resolve() gives other attributes from the same files and facts.
constexpr std::uint64_t resolver_revision = 3;

std::string day_of(std::int64_t seconds) {
    const std::time_t time = seconds;
    std::tm utc{};
    gmtime_r(&time, &utc);
    std::array<char, 16> day{};
    std::strftime(day.data(), day.size(), "%Y-%m-%d", &utc);
    return day.data();
}

/// A plane is no aircraft and a box no furniture, whatever the words may mean elsewhere.
void name_as_primitive(attributes::AttributeSet& set) {
    const std::string source = "analytical primitive";
    set.erase("subcategory");
    set.put({"category", std::string("primitives"), {}, {}, source, attributes::AttributeLevel::model});
}

}  // namespace

std::vector<attributes::AttributeEntry> manual_entries(const std::vector<database::ManualAttribute>& stored) {
    std::vector<attributes::AttributeEntry> entries;
    for (const database::ManualAttribute& one : stored) {
        auto value = value_from_json(one.value);
        if (!value) continue;
        attributes::AttributeEntry entry;
        entry.name = one.name;
        entry.value = std::move(*value);
        entry.source = "set by " + one.set_by + " on " + day_of(one.set_at);
        entry.level = attributes::AttributeLevel::manual;
        entries.push_back(std::move(entry));
    }
    return entries;
}

void apply_item(attributes::ModelFacts& facts, const ImportItem& item) {
    facts.name = valid_utf8(item.name);
    facts.tags = item.tags;
    for (std::string& tag : facts.tags) tag = valid_utf8(tag);
    facts.catalogue_category = valid_utf8(item.category);
    facts.stated_thing = valid_utf8(item.stated_thing);
    facts.movable = item.movable;
    facts.door_or_window = item.door_or_window;
    facts.size_is_stated = item.stated_size.has_value() || item.stated_unit.has_value();
}

void apply_item(database::ModelRow& row, const ImportItem& item) {
    row.name = valid_utf8(item.name);
    row.source = valid_utf8(item.source);
    row.licence = valid_utf8(item.licence);
    row.author = valid_utf8(item.author);

    // A tag is one line.
    row.tags.clear();
    std::vector<std::string> tags = item.tags;
    if (!item.category.empty()) tags.push_back(item.category);
    for (const std::string& tag : tags) {
        std::string line = valid_utf8(tag);
        std::replace(line.begin(), line.end(), '\n', ' ');
        if (std::find(row.tags.begin(), row.tags.end(), line) == row.tags.end()) row.tags.push_back(std::move(line));
    }
}

void classify(database::ModelRow& row, const attributes::ModelFacts& facts, const attributes::AttributeSet& automatic,
              const std::vector<attributes::AttributeEntry>& manual) {
    const attributes::AttributeSet all = manual.empty() ? automatic : attributes::with_manual(automatic, manual, facts);
    row.category = all.word("category", "");
    if (row.category.empty()) row.category = facts.catalogue_category;
    row.subcategory = all.word("subcategory", "");
    row.physical_kind = attributes::to_text(attributes::kind_of(all));
}

database::ModelKnowledge describe(database::ModelRow& row, const attributes::ModelFacts& facts,
                                  const attributes::Taxonomy& taxonomy,
                                  const std::vector<attributes::AttributeEntry>& manual) {
    attributes::AttributeSet automatic = attributes::resolve(taxonomy, facts);
    if (row.geometry_kind == "analytical") name_as_primitive(automatic);
    classify(row, facts, automatic, manual);
    return {to_json(facts), to_json(automatic)};
}

std::string taxonomy_hash(const std::filesystem::path& taxonomy_folder, const std::filesystem::path& user_folder) {
    // In the order of names, so that the folder's own order does not matter.
    std::error_code failure;
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(taxonomy_folder, failure)) {
        if (entry.path().extension() == ".json") files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    std::vector<std::filesystem::path> of_user;
    if (!user_folder.empty()) {
        for (const auto& entry : std::filesystem::directory_iterator(user_folder, failure)) {
            if (entry.path().extension() == ".json") of_user.push_back(entry.path());
        }
    }
    std::sort(of_user.begin(), of_user.end());
    files.insert(files.end(), of_user.begin(), of_user.end());

    StateHash hash;
    hash.add(resolver_revision);
    for (const std::filesystem::path& file : files) {
        std::ostringstream text;
        text << std::ifstream(file, std::ios::binary).rdbuf();
        const std::string bytes = std::move(text).str();
        hash.add(std::uint64_t{bytes.size()});
        hash.add_bytes(bytes.data(), bytes.size());
    }
    // Their names stand in the sources of values.
    for (const std::filesystem::path& file : of_user) {
        const std::string name = file.filename().string();
        hash.add_bytes(name.data(), name.size());
    }
    return std::to_string(hash.value());
}

}  // namespace embody::catalog
