// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "attributes/classify.h"
#include "attributes/form.h"
#include "attributes/material_parts.h"
#include "attributes/taxonomy_data.h"

namespace embody::attributes {

/// Mass of a thing, and its source.
struct MassEstimate {
    Interval mass;  ///< kg
    std::string source;
    AttributeLevel level = AttributeLevel::standard;
};

/// Exponent by which the mass of single things of a category grows with their box. The taxonomy's exponents hold for
/// ideal things. Boxes of real things also differ by light parts (handles, legs, packs, poses, how they were measured),
/// so that the exponent is 0.8 of the taxonomy's. It stays the taxonomy's for things that are nearly solid (0.95 and
/// more), and where a user's own file sets it.
double mass_exponent(const CategoryData& category);

/// The mass of a thing of this category, form and substance: density × fill fraction × volume where the category is
/// solid and `closed` is true for the surface; else the category's mass scaled to the box. The more doubtful the
/// category is, or the less usual the size and the proportions are for it, the closer the estimate is to the mass of
/// any thing of this size (the taxonomy's "object"), and the wider its interval.
MassEstimate estimate_mass(const Taxonomy::Data& data, const Classification& what, const Substance& substance,
                           const Form& form, bool closed);

}  // namespace embody::attributes
