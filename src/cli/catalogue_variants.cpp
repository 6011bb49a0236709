// SPDX-License-Identifier: MIT
#include "cli/catalogue_variants.h"

#include <fmt/core.h>

#include <array>
#include <cmath>

#include "foundation/random.h"

namespace embody::cli {
namespace {

constexpr const char* variant_prefix = "variant:";

// Words that distinguish articles of one catalogue: looks, material, size.
constexpr std::array looks{"red",     "blue",    "green",  "white",   "black",   "grey",   "beige",
                           "yellow",  "brown",   "modern", "old",     "classic", "rustic", "antique",
                           "simple",  "elegant", "folded", "painted", "worn",    "glossy", "matt",
                           "striped", "plain",   "round",  "curved",  "narrow",  "wide"};
constexpr std::array materials{"oak",    "pine",  "walnut",  "beech",   "birch",  "steel",   "aluminium",
                               "brass",  "glass", "plastic", "leather", "cotton", "marble",  "concrete",
                               "bamboo", "cork",  "rubber",  "ceramic", "linen",  "plywood", "granite"};
struct Size {
    const char* word;
    double scale;
};
constexpr std::array sizes{Size{"small", 0.8}, Size{"", 1.0}, Size{"large", 1.2}, Size{"extra large", 1.4}};

template <class List>
const auto& pick(const List& list, Random& random) {
    return list[random.below(list.size())];
}

catalog::ModelVariant make_variant(const catalog::ModelSummary& model, std::int64_t number, std::uint64_t seed) {
    // The seed depends on the variant's number alone, so that a variant is the same wherever an interrupted run goes
    // on.
    Random random(seed + 0x9E3779B97F4A7C15ull * static_cast<std::uint64_t>(number));
    const Size size = pick(sizes, random);
    const std::string look = pick(looks, random), material = pick(materials, random);
    catalog::ModelVariant variant;
    variant.like = model.id;
    variant.key = variant_prefix + std::to_string(number);
    variant.name = fmt::format("{}{}{} {} {} {}", size.word, *size.word ? " " : "", look, material, model.name,
                               100 + random.below(900));
    variant.tags = model.tags;
    variant.tags.insert(variant.tags.end(), {look, material, "variant"});
    variant.material_names = {material};
    variant.scale = size.scale * random.between(0.97, 1.03);
    return variant;
}

/// All models that are not variants, in the order of their ids.
Result<std::vector<catalog::ModelSummary>> real_models(const catalog::Catalog& catalog) {
    std::vector<catalog::ModelSummary> models;
    for (catalog::SearchQuery query{.limit = 1000};; query.offset += query.limit) {
        auto page = catalog.search(query);
        if (!page) return page.error();
        for (catalog::ModelSummary& model : page->models) {
            if (!model.key.starts_with(variant_prefix)) models.push_back(std::move(model));
        }
        if (query.offset + query.limit >= page->total) break;
    }
    std::sort(models.begin(), models.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
    return models;
}

std::string first_letters(const std::string& word, std::size_t count) {
    return word.substr(0, std::min(count, word.size()));
}

std::string word_of(const catalog::ModelSummary& model, Random& random) {
    std::vector<std::string> words(1);
    for (const char c : model.name) {
        if (std::isalpha(static_cast<unsigned char>(c))) {
            words.back() += c;
        } else if (!words.back().empty()) {
            words.emplace_back();
        }
    }
    if (words.back().empty()) words.pop_back();
    return words.empty() ? "model" : pick(words, random);
}

}  // namespace

Result<void> add_seeded_variants(catalog::Catalog& catalog, std::int64_t models, std::uint64_t seed,
                                 const std::function<void(std::int64_t done)>& progress) {
    const auto real = real_models(catalog);
    if (!real) return real.error();
    std::int64_t there = catalog.model_count();
    if (there >= models) return {};
    if (real->size() < 10)
        return Error{"bench catalogue", "the database holds hardly any models", "embody import first"};
    constexpr std::size_t batch = 500;
    for (std::int64_t number = there - static_cast<std::int64_t>(real->size()); there < models;) {
        std::vector<catalog::ModelVariant> variants;
        for (; variants.size() < batch && there < models; ++number, ++there)
            variants.push_back(make_variant((*real)[static_cast<std::size_t>(number) % real->size()], number, seed));
        if (auto added = catalog.add_variants(variants); !added) return added;
        progress(there);
    }
    return {};
}

std::vector<catalog::SearchQuery> seeded_queries(const std::vector<catalog::ModelSummary>& models,
                                                 const std::vector<catalog::CategoryCount>& categories,
                                                 std::uint64_t seed) {
    Random random(seed);
    constexpr int page = 60;  // page size of the Studio
    std::vector<catalog::SearchQuery> queries;
    const auto add = [&](std::string words, std::string category = {}, int offset = 0) {
        queries.push_back({std::move(words), std::move(category), page, offset});
    };
    const auto word = [&] { return word_of(pick(models, random), random); };
    for (int i = 0; i < 60; ++i) add(word());
    for (const std::size_t letters : {1, 2, 3}) {
        for (int i = 0; i < 20; ++i) add(first_letters(word(), letters));
    }
    for (int i = 0; i < 30; ++i) add(word() + " " + word());
    for (int i = 0; i < 20; ++i) add(pick(materials, random) + (" " + first_letters(word(), 3)));
    for (int i = 0; i < 20; ++i) add(pick(looks, random) + (" " + word()), pick(categories, random).category);
    for (int i = 0; i < 15; ++i) add("", pick(categories, random).category);
    for (int i = 0; i < 10; ++i) add("v", pick(categories, random).category);
    for (const int offset : {0, 600, 6'000, 30'000, 50'000}) {
        for (const char* words : {"", "variant", "v", "va", "var", "variant v", "a", "variant o", "1 v"}) {
            add(words, {}, offset);
        }
    }
    return queries;
}

}  // namespace embody::cli
