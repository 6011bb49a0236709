// SPDX-License-Identifier: MIT
// Reads data/taxonomy/*.json. The only file of this layer besides attribute_json.cpp that sees the JSON library.
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "attributes/phrase_match.h"
#include "attributes/registry.h"
#include "attributes/taxonomy_data.h"

namespace embody::attributes {
namespace {

using nlohmann::json;

// Reads the fields of one object; remembers the first thing that is wrong and which fields were asked for.
class FieldReader {
public:
    FieldReader(const json& object, std::string where) : object_(object), where_(std::move(where)) {
        if (!object.is_object()) fail("", "must be an object");
    }

    void word(const char* field, std::string& value, bool required) {
        if (const json* found = find(field, required)) {
            if (found->is_string() && !found->get_ref<const std::string&>().empty())
                value = found->get<std::string>();
            else
                fail(field, "must be a non-empty string");
        }
    }
    void words(const char* field, std::vector<std::string>& value, bool required) {
        if (const json* found = find(field, required)) {
            value.clear();
            if (!found->is_array()) return fail(field, "must be a list of strings");
            for (const json& item : *found) {
                if (!item.is_string()) return fail(field, "must be a list of strings");
                value.push_back(item.get<std::string>());
            }
        }
    }
    void truth(const char* field, bool& value, bool required) {
        if (const json* found = find(field, required)) {
            if (found->is_boolean())
                value = found->get<bool>();
            else
                fail(field, "must be true or false");
        }
    }
    void number(const char* field, double& value, std::pair<double, double> range, bool required) {
        if (const json* found = find(field, required)) {
            if (found->is_number() && in(found->get<double>(), range))
                value = found->get<double>();
            else
                fail(field, "must be a number from " + text(range.first) + " to " + text(range.second));
        }
    }
    /// [low, typical, high], ascending.
    void interval(const char* field, Interval& value, std::pair<double, double> range, bool required) {
        if (const auto n = numbers(field, 3, range, required)) {
            if ((*n)[0] <= (*n)[1] && (*n)[1] <= (*n)[2])
                value = {(*n)[0], (*n)[1], (*n)[2]};
            else
                fail(field, "must be [low, typical, high], ascending");
        }
    }
    void size(const char* field, Vec3& value, bool required) {
        if (const auto n = numbers(field, 3, {1e-5, 1e4}, required)) value = {(*n)[0], (*n)[1], (*n)[2]};
    }
    void range(const char* field, double& low, double& high, bool required) {
        if (const auto n = numbers(field, 2, {1e-5, 1e4}, required)) {
            low = (*n)[0];
            high = (*n)[1];
            if (low > high) fail(field, "must be [low, high], ascending");
        }
    }
    const json* list(const char* field, bool required) {
        const json* found = find(field, required);
        if (found != nullptr && !found->is_array()) fail(field, "must be a list");
        return error_ ? nullptr : found;
    }
    void fail(const std::string& field, const std::string& why) {
        if (!error_) error_ = Error{field.empty() ? where_ : where_ + "." + field, why};
    }
    /// The first error; else the first field that nobody asked for.
    std::optional<Error> finish() {
        if (error_) return error_;
        for (const auto& [field, value] : object_.items()) {
            if (!known_.contains(field)) return Error{where_ + "." + field, "there is no field of this name"};
        }
        return std::nullopt;
    }

private:
    static bool in(double value, std::pair<double, double> range) {
        return std::isfinite(value) && value >= range.first && value <= range.second;
    }
    static std::string text(double value) { return json(value).dump(); }

    const json* find(const char* field, bool required) {
        known_.insert(field);
        if (error_ || !object_.is_object()) return nullptr;
        const auto found = object_.find(field);
        if (found != object_.end()) return &*found;
        if (required) fail(field, "is missing");
        return nullptr;
    }
    std::optional<std::vector<double>> numbers(const char* field, std::size_t count, std::pair<double, double> range,
                                               bool required) {
        const json* found = find(field, required);
        if (found == nullptr) return std::nullopt;
        std::vector<double> values;
        if (found->is_array() && found->size() == count) {
            for (const json& item : *found) {
                if (item.is_number() && in(item.get<double>(), range)) values.push_back(item.get<double>());
            }
        }
        if (values.size() == count) return values;
        fail(field,
             "must be " + std::to_string(count) + " numbers from " + text(range.first) + " to " + text(range.second));
        return std::nullopt;
    }

    const json& object_;
    std::string where_;
    std::set<std::string, std::less<>> known_;
    std::optional<Error> error_;
};

Result<json> read_json(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) return Error{file.string(), "cannot be opened"};
    try {
        return json::parse(stream);
    } catch (const json::exception& problem) {
        return Error{file.string(), problem.what()};
    }
}

Result<MaterialData> read_material(const json& object, const std::string& where) {
    MaterialData material;
    FieldReader reader(object, where);
    reader.word("name", material.name, true);
    reader.words("words", material.words, true);
    reader.interval("density", material.density, {0.1, 22600}, true);
    reader.interval("friction_static", material.friction_static, {0, 2}, true);
    reader.interval("friction_dynamic", material.friction_dynamic, {0, 2}, true);
    reader.number("friction_rolling", material.friction_rolling, {0, 0.05}, true);
    reader.interval("restitution", material.restitution, {0, 1}, true);
    reader.word("source", material.source, true);
    if (material.friction_dynamic.typical > material.friction_static.typical) {
        reader.fail("friction_dynamic", "must not exceed friction_static");
    }
    if (auto error = reader.finish()) return *error;
    return material;
}

// A choice of the registry's attribute of the same name.
void check_choice(FieldReader& reader, const char* attribute, const std::string& value) {
    const auto valid = validate(attribute, value);
    if (!value.empty() && !valid) reader.fail(attribute, valid.error().why);
}

Result<CategoryData> read_category(const json& object, const std::string& where, const CategoryData* parent) {
    // A subcategory starts as its category; words are its own, and numbers that it changes need a source of their own.
    CategoryData category = parent != nullptr ? *parent : CategoryData{};
    const bool top = parent == nullptr;
    category.words.clear();
    category.catalogue.clear();
    if (!top) category.parent = parent->name;

    FieldReader reader(object, where);
    std::string scaling = category.scaling == MassScaling::area ? "area" : "volume";
    const bool has_numbers = object.is_object() && (object.contains("mass") || object.contains("at_size") ||
                                                    object.contains("fill_fraction") || object.contains("usual_size"));
    reader.word("name", category.name, true);
    reader.words("words", category.words, true);
    reader.words("catalogue", category.catalogue, false);
    reader.word("kind", category.kind, top);
    reader.word("placement", category.placement, top);
    reader.truth("movable", category.movable, top);
    reader.interval("mass", category.mass, {1e-5, 1e6}, top);
    reader.size("at_size", category.at_size, top || (object.is_object() && object.contains("mass")));
    reader.word("mass_grows_with", scaling, false);
    reader.number("exponent", category.exponent, {0, 1.5}, false);
    reader.range("usual_size", category.usual_low, category.usual_high, top);
    reader.truth("solid", category.solid, false);
    reader.interval("fill_fraction", category.fill_fraction, {1e-4, 1},
                    category.solid && category.fill_fraction.typical == 0);
    reader.word("material", category.material, top);
    reader.word("source", category.source, top || has_numbers);
    if (top) reader.list("subcategories", false);
    check_choice(reader, "kind", category.kind);
    check_choice(reader, "placement", category.placement);
    if (category.kind == "static")
        reader.fail("kind", "must say what it is when it moves; static is \"movable\": false");
    if (scaling != "volume" && scaling != "area") reader.fail("mass_grows_with", "must be volume or area");
    category.scaling = scaling == "area" ? MassScaling::area : MassScaling::volume;
    if (auto error = reader.finish()) return *error;
    return category;
}

// Names are unique, and every phrase belongs to one entry only: else the answer would depend on the order in the file.
template <class Entry>
Result<void> index_entry(PhraseIndex& index, std::size_t& longest, const std::vector<Entry>& entries,
                         const std::string& where) {
    const Entry& entry = entries.back();
    for (std::size_t i = 0; i + 1 < entries.size(); ++i) {
        if (entries[i].name == entry.name) return Error{where + ".name", "\"" + entry.name + "\" is there already"};
    }
    for (const std::string& words : entry.words) {
        if (!add_phrase(index, words, entries.size() - 1)) {
            return Error{where + ".words", "\"" + words + "\" is empty or belongs to another entry already"};
        }
        longest = std::max(longest, index.find(stems_of(words))->second.length);
    }
    return {};
}

Result<void> add_category(Taxonomy::Data& data, CategoryData category, const std::string& where) {
    if (data.material(category.material) == nullptr) {
        return Error{where + ".material", "materials.json has no \"" + category.material + "\""};
    }
    data.categories.push_back(std::move(category));
    for (const std::string& name : data.categories.back().catalogue) {
        if (!data.by_catalogue.emplace(stems_of(name), data.categories.size() - 1).second) {
            return Error{where + ".catalogue", "\"" + name + "\" belongs to another entry already"};
        }
    }
    return index_entry(data.category_phrases, data.longest_phrase, data.categories, where);
}

Result<void> load_materials(Taxonomy::Data& data, const std::filesystem::path& file) {
    const auto document = read_json(file);
    if (!document) return document.error();
    FieldReader reader(*document, file.filename().string());
    std::string description;
    reader.word("description", description, false);
    const json* list = reader.list("materials", true);
    if (auto error = reader.finish()) return *error;
    for (std::size_t i = 0; i < list->size(); ++i) {
        const std::string where = file.filename().string() + ": materials[" + std::to_string(i) + "]";
        auto material = read_material((*list)[i], where);
        if (!material) return material.error();
        data.materials.push_back(std::move(*material));
        if (auto added = index_entry(data.material_phrases, data.longest_phrase, data.materials, where); !added)
            return added;
    }
    if (data.material("generic") == nullptr) return Error{file.filename().string(), "has no material \"generic\""};
    return {};
}

Result<void> load_category_tree(Taxonomy::Data& data, const json& object, const std::string& where) {
    auto category = read_category(object, where, nullptr);
    if (!category) return category.error();
    if (auto added = add_category(data, *category, where); !added) return added;
    if (!object.contains("subcategories")) return {};
    const json& list = object["subcategories"];
    for (std::size_t i = 0; i < list.size(); ++i) {
        const std::string inner = where + ".subcategories[" + std::to_string(i) + "]";
        auto subcategory = read_category(list[i], inner, &*category);
        if (!subcategory) return subcategory.error();
        if (auto added = add_category(data, std::move(*subcategory), inner); !added) return added;
    }
    return {};
}

Result<void> load_categories(Taxonomy::Data& data, const std::filesystem::path& file) {
    const auto document = read_json(file);
    if (!document) return document.error();
    FieldReader reader(*document, file.filename().string());
    std::string description;
    reader.word("description", description, false);
    const json* list = reader.list("categories", true);
    if (auto error = reader.finish()) return *error;
    for (std::size_t i = 0; i < list->size(); ++i) {
        const std::string where = file.filename().string() + ": categories[" + std::to_string(i) + "]";
        if (auto loaded = load_category_tree(data, (*list)[i], where); !loaded) return loaded;
    }
    const CategoryData* unknown = data.category("object");
    if (unknown == nullptr) return Error{file.filename().string(), "has no category \"object\" for what nothing tells"};
    data.unknown = static_cast<std::size_t>(unknown - data.categories.data());
    return {};
}

}  // namespace

const MaterialData* Taxonomy::Data::material(std::string_view name) const {
    for (const MaterialData& entry : materials) {
        if (entry.name == name) return &entry;
    }
    return nullptr;
}

const CategoryData* Taxonomy::Data::category(std::string_view name) const {
    for (const CategoryData& entry : categories) {
        if (entry.name == name) return &entry;
    }
    return nullptr;
}

Taxonomy::Taxonomy() : data_(std::make_unique<Data>()) {}
Taxonomy::~Taxonomy() = default;

Result<std::unique_ptr<Taxonomy>> Taxonomy::load(const std::filesystem::path& folder) {
    std::unique_ptr<Taxonomy> taxonomy(new Taxonomy);
    if (auto loaded = load_materials(*taxonomy->data_, folder / "materials.json"); !loaded) return loaded.error();
    if (auto loaded = load_categories(*taxonomy->data_, folder / "taxonomy.json"); !loaded) return loaded.error();
    return taxonomy;
}

}  // namespace embody::attributes
