// SPDX-License-Identifier: MIT
//
// Quality of the attributes of a database's models, compared with what their catalogue says of them.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "attributes/check.h"
#include "attributes/resolver.h"
#include "catalog/catalog.h"
#include "foundation/result.h"

namespace embody::evaluation {

/// A model whose movability differs from its catalogue's.
struct MovableDisagreement {
    std::string key, name, category;
    bool catalogue_says_movable = false;
};

/// A model whose attributes contradict each other.
struct BrokenModel {
    std::string key;
    std::vector<attributes::Issue> issues;
};

struct CatalogueEvaluation {
    std::size_t models = 0;
    std::map<std::string, std::size_t> by_level;  ///< models by level_name() of their category
    std::size_t flagged = 0;                      ///< models whose catalogue says whether they are movable
    std::vector<MovableDisagreement> disagreements;
    std::vector<BrokenModel> broken;
    std::vector<std::string> unknown;  ///< names of the models at level default
    std::vector<double> density_sums;  ///< density_sum() of its parts / mass, of each model that has both; ascending

    [[nodiscard]] double above_default() const;      ///< fraction of all models
    [[nodiscard]] double movable_agreement() const;  ///< fraction of the flagged models
    [[nodiscard]] double median_density_sum() const;
    [[nodiscard]] double density_sums_within_factor_2() const;  ///< fraction of `density_sums`
};

/// Resolves every model of the database again. The catalogue's flag for movability is hidden for the comparison with
/// it; the rules of check() are applied to the attributes as they are used.
Result<CatalogueEvaluation> evaluate_catalogue(const attributes::Taxonomy& taxonomy, const catalog::Catalog& catalog);

}  // namespace embody::evaluation
