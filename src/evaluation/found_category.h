// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "attributes/attribute.h"

namespace embody::evaluation {

/// What a set says that the thing is: its subcategory, else its category.
inline std::string found_category(const attributes::AttributeSet& set) {
    const std::string subcategory = set.word("subcategory", "");
    return subcategory.empty() ? set.word("category", "") : subcategory;
}

}  // namespace embody::evaluation
