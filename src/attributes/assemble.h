// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "attributes/attribute.h"
#include "attributes/form.h"
#include "attributes/physical_kind.h"
#include "attributes/taxonomy_data.h"

namespace embody::attributes {

/// Of the attribute of this name; no attribute of another name concerns anything.
bool applies_to(std::string_view attribute, PhysicalKind kind);

/// Defaults for what concerns the set's kind and is missing; what does not concern it goes, unless a person set it. A
/// rope's twist rigidity follows from its bend rigidity where it is no more than a default.
void complete_for_kind(AttributeSet& set);

/// Friction, rolling and bounciness of the material. Replaces what is there unless a person set it.
void put_surface(AttributeSet& set, const MaterialData& material, const std::string& source, AttributeLevel level);

/// What follows from mass, density and volume: fill, bulk density, wall thickness, area and line density.
void put_mass_dependents(AttributeSet& set, const GeometryFacts& facts, const Form& form);

/// Of bulk that lies as loose as it is poured, the share that is grain (random loose packing).
inline constexpr double loose_packing = 0.55;

/// How fine what is simulated by many points is: the size of the balls that stand for the grains of a granular thing
/// (docs/physics/grains.md), the cells of a liquid (docs/physics/fluids.md). Nothing else is touched.
void put_fineness(AttributeSet& set, const GeometryFacts& facts, const Form& form);

/// What a primitive (whose volume and size `facts` has) weighs that is no rigid thing, and what goes with that: cloth
/// by its area, a rope of a category by its length, liquids and bulk by their own density. A mass that a person set
/// stays.
void put_mass_of_primitive(AttributeSet& set, const GeometryFacts& facts);

/// Replaces the entry unless a person set it.
void replace(AttributeSet& set, AttributeEntry entry);

/// Whether a person set it.
bool is_manual(const AttributeSet& set, std::string_view name);

}  // namespace embody::attributes
