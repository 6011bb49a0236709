// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "attributes/model_facts.h"
#include "interchange/raw_scene.h"

namespace embody::catalog {

/// Parts that a model is measured in, at most; what is smaller becomes one without a name.
inline constexpr std::size_t max_parts = 32;

/// The surfaces of each material of a scene in the model frame as solid and as shell, largest area first.
std::vector<attributes::PartFacts> measure_parts(const interchange::RawScene& scene);

}  // namespace embody::catalog
