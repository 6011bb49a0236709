// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include "catalog/catalog.h"

namespace embody::cli {

/// Adds seeded variants of the models that are there (other names, tags, sizes, materials; the same geometry) until the
/// catalogue holds `models`. The same catalogue and seed yield the same variants; an interrupted run can be continued.
Result<void> add_seeded_variants(catalog::Catalog& catalog, std::int64_t models, std::uint64_t seed,
                                 const std::function<void(std::int64_t done)>& progress);

/// Searches as people type them: words of names and tags, their first letters, two words, with and without a category,
/// pages far from the first; and the words that occur in most models.
std::vector<catalog::SearchQuery> seeded_queries(const std::vector<catalog::ModelSummary>& models,
                                                 const std::vector<catalog::CategoryCount>& categories,
                                                 std::uint64_t seed);

}  // namespace embody::cli
