// SPDX-License-Identifier: MIT
// Reads data/taxonomy.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "attributes/assemble.h"
#include "attributes/field_reader.h"
#include "attributes/interval_field.h"
#include "attributes/json_text.h"
#include "attributes/phrase_match.h"
#include "attributes/physical_kind.h"
#include "attributes/registry.h"
#include "attributes/surfaces.h"
#include "attributes/taxonomy_data.h"
#include "attributes/taxonomy_overlay.h"

namespace embody::attributes {
namespace {

using nlohmann::json;

Result<MaterialData> read_material(const json& object, const std::string& where) {
    MaterialData material;
    FieldReader reader(object, where);
    reader.require({"name", "words", "density", "friction_static", "friction_dynamic", "friction_rolling",
                    "restitution", "source"});
    reader.word("name", material.name);
    reader.words("words", material.words);
    read_interval(reader, "density", material.density, {0.1, 22600});
    read_interval(reader, "friction_static", material.friction_static, {0, 2});
    read_interval(reader, "friction_dynamic", material.friction_dynamic, {0, 2});
    reader.number("friction_rolling", material.friction_rolling, {0, 0.05});
    read_interval(reader, "restitution", material.restitution, {0, 1});
    read_interval(reader, "wall", material.wall, {1e-4, 0.5});
    reader.word("core", material.core);
    reader.word("source", material.source);
    if (material.friction_dynamic.typical > material.friction_static.typical) {
        reader.refuse("friction_dynamic", "must not exceed friction_static");
    }
    if (!reader.finish()) return *reader.error();
    return material;
}

// Refuses a value that is no choice of the registry's attribute of the same name.
void check_choice(FieldReader& reader, const char* attribute, const std::string& value) {
    const auto valid = validate(attribute, value);
    if (!value.empty() && !valid) reader.refuse(attribute, valid.error().why);
}

// Reads {"youngs_modulus": {"value": [low, typical, high], "source": "…"}}: numbers of the registry that the entry's
// kind has.
void read_attributes(FieldReader& reader, CategoryData& category) {
    const json* object = reader.object("attributes");
    if (object == nullptr) return;
    for (const auto& [name, content] : object->items()) {
        const std::string field = "attributes." + name;
        const AttributeDescription* description = describe(name);
        if (description == nullptr || description->type != ValueType::number) {
            return reader.refuse(field, "the registry has no number of this name");
        }
        if (!applies_to(name, category.kind)) {
            return reader.refuse(field, "is no attribute of the kind " + to_text(category.kind));
        }
        CategoryAttribute attribute{name, {}, {}};
        FieldReader inner(content, reader.path(field), reader.error());
        inner.require({"value", "source"});
        read_interval(inner, "value", attribute.value,
                      {description->low.value_or(any_number.low), description->high.value_or(any_number.high)});
        inner.word("source", attribute.source);
        if (!inner.finish()) return;
        std::erase_if(category.attributes,
                      [&](const CategoryAttribute& of_parent) { return of_parent.name == attribute.name; });
        category.attributes.push_back(std::move(attribute));
    }
}

// Whether things of the category have no form of their own, so that a model shows a container, a roll or one piece.
bool is_substance(const CategoryData& category) { return flows(category.kind) || is_thin(category.kind); }

// The kind of the entry where it moves.
void take_kind(FieldReader& reader, const std::string& text, PhysicalKind& kind) {
    check_choice(reader, "kind", text);
    kind = kind_from_text(text).value_or(kind);
    if (is_static(kind)) reader.refuse("kind", "must say what it is when it moves; static is \"movable\": false");
}

// Extents of the usual box and range of the largest extent, m.
void read_lengths(FieldReader& reader, CategoryData& category) {
    constexpr NumberRange length{1e-5, 1e4};
    std::array<double, 3> size{category.at_size.x, category.at_size.y, category.at_size.z};
    if (reader.numbers("at_size", size, length)) category.at_size = {size[0], size[1], size[2]};
    std::array<double, 2> usual{category.usual_low, category.usual_high};
    if (!reader.numbers("usual_size", usual, length)) return;
    if (usual[0] > usual[1]) reader.refuse("usual_size", "must be [low, high], ascending");
    category.usual_low = usual[0];
    category.usual_high = usual[1];
}

Result<CategoryData> read_category(const json& object, const std::string& where, const CategoryData* parent) {
    // A subcategory starts as a copy of its category, without the words; numbers that it changes need a source of their
    // own.
    CategoryData category = parent != nullptr ? *parent : CategoryData{};
    const bool top = parent == nullptr;
    category.words.clear();
    category.catalogue.clear();
    category.synset.clear();
    category.modelled_as.clear();
    if (!top) category.parent = parent->name;

    FieldReader reader(object, where);
    std::string kind;
    std::string scaling = category.scaling == MassScaling::area ? "area" : "volume";
    const bool has_numbers = object.is_object() && (object.contains("mass") || object.contains("at_size") ||
                                                    object.contains("fill_fraction") || object.contains("usual_size"));
    reader.require({"name", "words"});
    if (top) reader.require({"kind", "placement", "movable", "mass", "at_size", "usual_size", "material", "source"});
    if (object.is_object() && object.contains("mass")) reader.require({"at_size"});
    if (has_numbers) reader.require({"source"});
    reader.word("name", category.name);
    reader.word("synset", category.synset);
    reader.words("words", category.words);
    reader.words("catalogue", category.catalogue);
    reader.word("modelled_as", category.modelled_as);
    reader.word("kind", kind);
    reader.word("placement", category.placement);
    reader.truth("movable", category.movable);
    read_interval(reader, "mass", category.mass, {1e-5, 1e6});
    read_lengths(reader, category);
    reader.word("mass_grows_with", scaling);
    reader.number("exponent", category.exponent, {0, 1.5});
    reader.truth("solid", category.solid);
    if (category.solid && category.fill_fraction.typical == 0) reader.require({"fill_fraction"});
    read_interval(reader, "fill_fraction", category.fill_fraction, {1e-4, 1});
    reader.word("material", category.material);
    reader.word("source", category.source);
    if (top) reader.list("subcategories");
    take_kind(reader, kind, category.kind);
    check_choice(reader, "placement", category.placement);
    if (!category.modelled_as.empty() && !is_substance(category)) {
        reader.refuse("modelled_as",
                      "is for the kinds fluid, granular, cloth and rope; this is " + to_text(category.kind));
    }
    if (scaling != "volume" && scaling != "area") reader.refuse("mass_grows_with", "must be volume or area");
    category.scaling = scaling == "area" ? MassScaling::area : MassScaling::volume;
    // Attributes of a parent of another kind do not apply to this one.
    std::erase_if(category.attributes, [&](const CategoryAttribute& a) { return !applies_to(a.name, category.kind); });
    read_attributes(reader, category);
    if (!reader.finish()) return *reader.error();
    return category;
}

// Names are unique, and every phrase belongs to only one entry: else the answer would depend on the order in the file.
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

// Of two entries with one meaning the more general is a category before a subcategory, then the wider interval of mass.
bool is_more_general(const CategoryData& a, const CategoryData& b) {
    if (a.parent.empty() != b.parent.empty()) return a.parent.empty();
    return a.mass.high * b.mass.low > b.mass.high * a.mass.low;
}

// Registers the entry's meaning, so that hypernyms lead to it.
Result<void> index_synset(Taxonomy::Data& data, const std::string& where) {
    const CategoryData& added = data.categories.back();
    if (added.synset.empty()) return {};
    const auto synset = data.nouns->find_synset(added.synset);
    if (!synset) {
        return Error{where + ".synset", "WordNet 3.0 has no noun \"" + added.synset + "\"",
                     "write lemma.n.NN with the number of the lemma's sense, as `embody classify LEMMA` shows it, or "
                     "leave it out"};
    }
    const auto [held, is_new] = data.by_synset.emplace(*synset, data.categories.size() - 1);
    if (!is_new && is_more_general(added, data.categories[held->second])) held->second = data.categories.size() - 1;
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
    if (auto indexed = index_synset(data, where); !indexed) return indexed;
    return index_entry(data.category_phrases, data.longest_phrase, data.categories, where);
}

// The table is read from the taxonomy's folder where it has one, else from the place where the build wrote it.
Result<void> load_nouns(Taxonomy::Data& data, const std::filesystem::path& folder) {
    const std::filesystem::path own = folder / "wordnet-nouns.table";
    auto nouns = wordnet::NounTable::load(std::filesystem::exists(own) ? own : EMBODY_WORDNET_TABLE);
    if (!nouns) return nouns.error();
    data.nouns = std::make_shared<const wordnet::NounTable>(std::move(*nouns));
    return {};
}

Result<void> load_materials(Taxonomy::Data& data, const std::filesystem::path& file) {
    const auto document = read_json(file);
    if (!document) return document.error();
    FieldReader reader(*document, file.filename().string());
    std::string description;
    reader.require({"materials"});
    reader.word("description", description);
    const json* list = reader.list("materials");
    if (!reader.finish()) return *reader.error();
    for (std::size_t i = 0; i < list->size(); ++i) {
        const std::string where = file.filename().string() + ": materials[" + std::to_string(i) + "]";
        auto material = read_material((*list)[i], where);
        if (!material) return material.error();
        data.materials.push_back(std::move(*material));
        if (auto added = index_entry(data.material_phrases, data.longest_phrase, data.materials, where); !added)
            return added;
    }
    for (const MaterialData& material : data.materials) {
        const std::string where = file.filename().string() + ": \"" + material.name + "\".core";
        if (material.core.empty()) continue;
        if (data.material(material.core) == nullptr)
            return Error{where, "there is no material \"" + material.core + "\"", "name one, or leave core out"};
        if (!(material.wall.typical > 0))
            return Error{where, "needs walls to be behind", "give wall too, or leave core out"};
    }
    if (data.material("generic") == nullptr) return Error{file.filename().string(), "has no material \"generic\""};
    return {};
}

// Notes which values are the user's: those in the user's file, and those inherited from a category that it changed.
void note_users(CategoryData& category, const TaxonomyEntry& entry) {
    for (const auto& [field, value] : (*entry.object).items()) {
        const auto file = entry.users.find(field);
        if (file != entry.users.end()) {
            category.set_by_file[field] = file->second;
        } else {
            category.set_by_file.erase(field);
        }
    }
}

Result<void> load_category_tree(Taxonomy::Data& data, const TaxonomyEntry& entry) {
    auto category = read_category((*entry.object), entry.where, nullptr);
    if (!category) return category.error();
    category->domain = entry.domain;
    note_users(*category, entry);
    if (auto added = add_category(data, *category, entry.where); !added) return added;
    for (const TaxonomyEntry& inner : entry.subcategories) {
        auto subcategory = read_category((*inner.object), inner.where, &*category);
        if (!subcategory) return subcategory.error();
        note_users(*subcategory, inner);
        if (auto added = add_category(data, std::move(*subcategory), inner.where); !added) return added;
    }
    return {};
}

// The entry that shows a substance as a model may be in any file: all entries are known only now.
Result<void> find_model_entries(Taxonomy::Data& data) {
    for (CategoryData& substance : data.categories) {
        if (substance.modelled_as.empty()) continue;
        const std::string where = substance.domain + ".json: \"" + substance.name + "\".modelled_as";
        const CategoryData* model = data.category(substance.modelled_as);
        if (model == nullptr) {
            return Error{where, "there is no entry \"" + substance.modelled_as + "\"",
                         "give the name of a category or subcategory"};
        }
        if (is_substance(*model)) {
            return Error{where, "\"" + substance.modelled_as + "\" has no form of its own either",
                         "name what holds it, such as a bottle or a roll, or leave modelled_as out"};
        }
        substance.model_entry = static_cast<std::size_t>(model - data.categories.data());
    }
    return {};
}

// Reads all files of the folder, in the order of their names.
Result<void> load_categories_of(Taxonomy::Data& data, const std::filesystem::path& folder,
                                const std::filesystem::path& user_folder) {
    std::error_code failure;
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder, failure)) {
        if (entry.path().extension() == ".json") files.push_back(entry.path());
    }
    if (failure) return Error{folder.string(), failure.message()};
    std::ranges::sort(files);
    std::vector<TaxonomyEntry> entries;
    for (const std::filesystem::path& file : files) {
        auto read = read_entries(file, file.filename().string());
        if (!read) return read.error();
        std::ranges::move(*read, std::back_inserter(entries));
    }
    if (!user_folder.empty()) {
        if (auto laid = apply_overlay(entries, user_folder, data.user_words); !laid) return laid;
    }
    for (const TaxonomyEntry& entry : entries) {
        if (auto loaded = load_category_tree(data, entry); !loaded) return loaded;
    }
    const CategoryData* unknown = data.category("object");
    if (unknown == nullptr) return Error{folder.string(), "has no category \"object\" for what nothing tells"};
    data.unknown = static_cast<std::size_t>(unknown - data.categories.data());
    return find_model_entries(data);
}

}  // namespace

double outside_usual_size(const CategoryData& category, double largest) {
    const double too_small = is_thin(category.kind) ? 0 : std::log(category.usual_low / largest);
    return std::max({too_small, std::log(largest / category.usual_high), 0.0});
}

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

std::unique_ptr<Taxonomy> Taxonomy::without(std::string_view category) const {
    std::unique_ptr<Taxonomy> rest(new Taxonomy);
    *rest->data_ = *data_;
    rest->surfaces_ = surfaces_;
    // The entries keep their indices; nothing leads to the hidden ones any more.
    const auto hidden = [&](std::size_t entry) {
        const CategoryData& held = data_->categories[entry];
        return held.name == category || held.parent == category;
    };
    std::erase_if(rest->data_->category_phrases, [&](const auto& item) { return hidden(item.second.entry); });
    std::erase_if(rest->data_->by_catalogue, [&](const auto& item) { return hidden(item.second); });
    std::erase_if(rest->data_->by_synset, [&](const auto& item) { return hidden(item.second); });
    return rest;
}

Result<std::unique_ptr<Taxonomy>> Taxonomy::load(const std::filesystem::path& folder,
                                                 const std::filesystem::path& user_folder) {
    std::unique_ptr<Taxonomy> taxonomy(new Taxonomy);
    if (auto loaded = load_materials(*taxonomy->data_, folder / "materials.json"); !loaded) return loaded.error();
    auto surfaces = Surfaces::load(folder / "material_pairs.json", taxonomy->data_->materials);
    if (!surfaces) return surfaces.error();
    taxonomy->surfaces_ = std::make_shared<const Surfaces>(std::move(*surfaces));
    if (auto loaded = load_nouns(*taxonomy->data_, folder); !loaded) return loaded.error();
    if (auto loaded = load_categories_of(*taxonomy->data_, folder / "categories", user_folder); !loaded) {
        return loaded.error();
    }
    return taxonomy;
}

}  // namespace embody::attributes
