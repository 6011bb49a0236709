// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "attributes/classify.h"
#include "attributes/form.h"
#include "attributes/material_parts.h"
#include "attributes/taxonomy_data.h"

namespace embody::attributes {

/// What a thing weighs, and what says so.
struct MassEstimate {
    Interval mass;  ///< kg
    std::string source;
    AttributeLevel level = AttributeLevel::standard;
};

/// Exponent by which the mass of single things of a category grows with their box. The taxonomy's exponents say how the
/// ideal thing grows. Boxes of real ones also differ by what weighs little (handles, legs, packs, poses, how they were
/// measured), so that mass grows with 0.8 of that; not where things are nearly solid (0.95 and more), nor where a
/// user's own file says it.
double mass_exponent(const CategoryData& category);

/// The mass of a thing of this category, form and substance: density × filled share × volume where the category is
/// solid and `closed` says that the surface is; else the category's mass carried over to the box. The more doubtful the
/// category is, or the less the size and the proportions are those of such things, the more the estimate is what any
/// thing of this size weighs (the taxonomy's "object"), and the wider its interval.
MassEstimate estimate_mass(const Taxonomy::Data& data, const Classification& what, const Substance& substance,
                           const Form& form, bool closed);

}  // namespace embody::attributes
