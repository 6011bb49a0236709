// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "catalog/prepare/prepared_model.h"

namespace embody::catalog {

/// Makes models ready for the database, one after another, in this process: what the confined worker runs. Keeps the
/// last archive open, as catalogues come in sequence.
class Preparation {
public:
    Preparation();
    ~Preparation();

    /// Reads the file, turns and scales it as the catalogue states, moves the origin to the centre of the base,
    /// measures it, packs it and makes its thumbnail. The error says file and reason.
    Result<PreparedModel> prepare(const ImportItem& item);

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// What the item itself says of the model: everything in ModelFacts but the geometry and the material names.
attributes::ModelFacts stated_facts(const ImportItem& item);

}  // namespace embody::catalog
