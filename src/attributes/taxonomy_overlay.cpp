// SPDX-License-Identifier: MIT
#include "attributes/taxonomy_overlay.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "attributes/assemble.h"
#include "attributes/field_reader.h"
#include "attributes/json_text.h"
#include "attributes/phrase_match.h"
#include "attributes/physical_kind.h"

namespace embody::attributes {
namespace {

using nlohmann::json;
using UserWords = std::map<std::string, std::string, std::less<>>;

std::string text_of(const json& object, const char* field) {
    if (!object.is_object() || !object.contains(field) || !object[field].is_string()) return {};
    return object[field].get<std::string>();
}

/// The entry of this name, and its category.
struct Found {
    TaxonomyEntry* entry = nullptr;
    TaxonomyEntry* parent = nullptr;
};
Found find(std::vector<TaxonomyEntry>& entries, const std::string& name) {
    for (TaxonomyEntry& category : entries) {
        if (text_of((*category.object), "name") == name) return {&category, nullptr};
        for (TaxonomyEntry& inner : category.subcategories) {
            if (text_of((*inner.object), "name") == name) return {&inner, &category};
        }
    }
    return {};
}

// Removes a word from every entry but its new owner.
void take_word(TaxonomyEntry& entry, const TaxonomyEntry& owner, const std::string& stems) {
    if (&entry != &owner && (*entry.object).is_object() && (*entry.object).contains("words")) {
        json kept = json::array();
        for (const json& word : (*entry.object)["words"]) {
            if (!word.is_string() || stems_of(word.get<std::string>()) != stems) kept.push_back(word);
        }
        (*entry.object)["words"] = std::move(kept);
    }
    for (TaxonomyEntry& inner : entry.subcategories) take_word(inner, owner, stems);
}

Result<void> assign_words(std::vector<TaxonomyEntry>& entries, TaxonomyEntry& owner, const TaxonomyEntry& given,
                          const std::string& file, UserWords& user_words) {
    if (!(*given.object).contains("words") || !(*given.object)["words"].is_array()) return {};
    for (const json& word : (*given.object)["words"]) {
        if (!word.is_string()) continue;
        const std::string stems = stems_of(word.get<std::string>());
        if (!user_words.emplace(stems, file).second) {
            return Error{given.where + ".words",
                         "\"" + word.get<std::string>() + "\" is given in " + user_words[stems] + " already",
                         "give a word to one entry"};
        }
        for (TaxonomyEntry& entry : entries) take_word(entry, owner, stems);
    }
    return {};
}

// Marks every source as the user's.
void sign(json& object, const std::string& file) {
    if (!text_of(object, "source").empty()) object["source"] = "your " + file + ": " + text_of(object, "source");
    if (!object.contains("attributes") || !object["attributes"].is_object()) return;
    for (auto& [name, content] : object["attributes"].items()) {
        const std::string source = text_of(content, "source");
        if (!source.empty()) content["source"] = "your " + file + ": " + source;
    }
}

// Numbers of the old kind do not apply to the new one.
void drop_foreign_attributes(TaxonomyEntry& entry, PhysicalKind kind) {
    if ((*entry.object).contains("attributes") && (*entry.object)["attributes"].is_object()) {
        json kept = json::object();
        for (const auto& [name, content] : (*entry.object)["attributes"].items()) {
            if (applies_to(name, kind)) kept[name] = content;
        }
        (*entry.object)["attributes"] = std::move(kept);
    }
    for (TaxonomyEntry& inner : entry.subcategories) {
        if (!(*inner.object).contains("kind")) drop_foreign_attributes(inner, kind);
    }
}

Result<void> change_entry(TaxonomyEntry& entry, const TaxonomyEntry& given, const std::string& file) {
    const auto gives_any = [&](std::initializer_list<const char*> fields) {
        return std::ranges::any_of(fields, [&](const char* field) { return (*given.object).contains(field); });
    };
    const bool gives_mass = gives_any({"mass", "at_size", "exponent", "mass_grows_with", "fill_fraction", "solid"});
    if ((gives_mass || gives_any({"usual_size"})) && !(*given.object).contains("source")) {
        return Error{given.where + ".source", "is missing", "say where your numbers are from"};
    }
    if (const auto kind = kind_from_text(text_of((*given.object), "kind"))) drop_foreign_attributes(entry, *kind);
    json signed_object = (*given.object);
    sign(signed_object, file);
    for (const auto& [field, value] : signed_object.items()) {
        if (field == "name") continue;
        if (field == "source" && !gives_mass) continue;  // our source stays, since it describes our mass
        json& held = (*entry.object)[field];
        const bool joins_list = (field == "words" || field == "catalogue") && value.is_array() && held.is_array();
        if (joins_list) {
            for (const json& word : value) {
                if (std::ranges::find(held, word) == held.end()) held.push_back(word);
            }
        } else if (field == "attributes" && value.is_object() && held.is_object()) {
            held.update(value);
        } else {
            held = value;
            entry.users[field] = file;
        }
    }
    // Errors of the entry now name the user's file.
    entry.where = given.where;
    return {};
}

void sign_new(TaxonomyEntry& entry, const std::string& file) {
    if (!(*entry.object).is_object()) return;
    sign((*entry.object), file);
    for (const auto& [field, value] : (*entry.object).items()) entry.users[field] = file;
}

Result<void> apply_entry(std::vector<TaxonomyEntry>& entries, TaxonomyEntry given, const std::string& file,
                         TaxonomyEntry* parent, UserWords& user_words) {
    const std::string name = text_of((*given.object), "name");
    if (name.empty()) return Error{given.where + ".name", "is missing", "name an entry of ours, or a new one"};
    const Found known = find(entries, name);
    const std::vector<TaxonomyEntry> inner = std::exchange(given.subcategories, {});
    const std::string parent_name = parent != nullptr ? text_of(*parent->object, "name") : std::string();
    if (known.entry != nullptr && parent != nullptr && known.parent != parent) {
        return Error{given.where + ".name", "\"" + name + "\" is there already, not under " + parent_name,
                     "change it by an entry of its own in \"categories\""};
    }
    if (known.parent != nullptr && !inner.empty()) {
        return Error{given.where + ".subcategories", "\"" + name + "\" is a subcategory and has none"};
    }
    if (known.entry != nullptr) {
        if (auto changed = change_entry(*known.entry, given, file); !changed) return changed;
    } else {
        TaxonomyEntry added = given;
        sign_new(added, file);
        (parent != nullptr ? parent->subcategories : entries).push_back(std::move(added));
    }
    // The entry is searched again: adding may have moved the entries.
    if (auto words = assign_words(entries, *find(entries, name).entry, given, file, user_words); !words) return words;
    for (const TaxonomyEntry& one : inner) {
        TaxonomyEntry* owner = find(entries, name).entry;
        if (auto laid = apply_entry(entries, one, file, owner, user_words); !laid) return laid;
    }
    return {};
}

}  // namespace

Result<std::vector<TaxonomyEntry>> read_entries(const std::filesystem::path& file, const std::string& where) {
    const auto document = read_json(file);
    if (!document) return document.error();
    FieldReader reader(*document, where);
    std::string description;
    reader.require({"categories"});
    reader.word("description", description);
    const json* list = reader.list("categories");
    if (!reader.finish()) return *reader.error();
    std::vector<TaxonomyEntry> entries;
    const auto read = [&](const json& object, const std::string& place) {
        return TaxonomyEntry{std::make_shared<json>(object), place, file.stem().string(), {}, {}};
    };
    for (std::size_t i = 0; i < list->size(); ++i) {
        TaxonomyEntry entry = read((*list)[i], where + ": categories[" + std::to_string(i) + "]");
        if ((*entry.object).is_object() && (*entry.object).contains("subcategories") &&
            (*entry.object)["subcategories"].is_array()) {
            std::size_t number = 0;
            for (const json& inner : (*entry.object)["subcategories"])
                entry.subcategories.push_back(
                    read(inner, entry.where + ".subcategories[" + std::to_string(number++) + "]"));
            (*entry.object).erase("subcategories");
        }
        entries.push_back(std::move(entry));
    }
    return entries;
}

Result<void> apply_overlay(std::vector<TaxonomyEntry>& entries, const std::filesystem::path& folder,
                           UserWords& user_words) {
    std::error_code failure;
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder, failure)) {
        if (entry.path().extension() == ".json") files.push_back(entry.path());
    }
    if (failure) return Error{folder.string(), failure.message(), "name a folder of taxonomy files"};
    std::ranges::sort(files);
    for (const std::filesystem::path& file : files) {
        auto given = read_entries(file, file.string());
        if (!given) return given.error();
        for (TaxonomyEntry& one : *given) {
            if (auto laid = apply_entry(entries, std::move(one), file.filename().string(), nullptr, user_words); !laid)
                return laid;
        }
    }
    return {};
}

}  // namespace embody::attributes
