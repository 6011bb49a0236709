// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "attributes/attribute.h"

namespace embody::evaluation {

/// The category that a set names: its subcategory, else its category.
inline std::string found_category(const attributes::AttributeSet& set) {
    const std::string subcategory = set.word("subcategory", "");
    return subcategory.empty() ? set.word("category", "") : subcategory;
}

}  // namespace embody::evaluation
