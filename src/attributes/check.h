// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "attributes/attribute.h"
#include "attributes/model_facts.h"

namespace embody::attributes {

/// One contradiction in a set of attributes.
struct Issue {
    std::string attribute;
    std::string why;
    std::string remedy = {};  ///< what to do; empty: change or reset one of the values
    std::string reset = {};   ///< attribute whose own value is to be taken back; empty: that alone would not help
};

/// Checks rules that hold between attributes: every value in its range and interval, nothing missing, mass = density ×
/// fill × volume within 1 %, bulk density not above density, sliding friction not above static, centre of mass in the
/// box, moments of inertia of a body of that size. The result is empty for every set that resolve() makes; a person can
/// enter contradictions.
std::vector<Issue> check(const AttributeSet& set, const ModelFacts& facts);

}  // namespace embody::attributes
