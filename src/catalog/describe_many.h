// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "attributes/resolver.h"
#include "catalog/catalog.h"
#include "database/model_table.h"
#include "foundation/task_pool.h"

namespace embody::catalog {

/// A model that is to be described anew, and the result.
struct Description {
    database::ModelRow row;  ///< its words are changed
    database::ModelKnowledge knowledge;
    std::vector<attributes::AttributeEntry> manual;
    const ModelVariant* variant = nullptr;  ///< changes row and facts first
    bool row_is_new = false;                ///< `row` has changed
    std::optional<Error> problem;           ///< the stored facts can't be read
};

/// Resolves the attributes of all models, on all workers.
void describe_all(std::span<Description> models, const attributes::Taxonomy& taxonomy, TaskPool& workers);

}  // namespace embody::catalog
