// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "catalog/catalog.h"
#include "cli/arguments.h"

namespace embody::cli {

/// The model that `arguments.scene` names; else the models that match each word best and are meshes, without
/// duplicates. An error where there are none.
Result<std::vector<catalog::ModelSummary>> choose_bench_models(const catalog::Catalog& catalog,
                                                               std::span<const char* const> words, int models_a_word,
                                                               const BenchArguments& arguments);

/// Processor time of this process so far, s.
double processor_time();

}  // namespace embody::cli
