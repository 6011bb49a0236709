// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "attributes/attribute.h"
#include "attributes/form.h"
#include "attributes/physical_kind.h"
#include "attributes/taxonomy_data.h"

namespace embody::attributes {

/// Whether the attribute of this name concerns the kind; false for a name that is not in the registry.
bool applies_to(std::string_view attribute, PhysicalKind kind);

/// Adds the defaults of attributes that concern the set's kind and are missing. Removes attributes that do not concern
/// it, unless a person set them. A rope's twist rigidity that is only a default follows from its bend rigidity.
void complete_for_kind(AttributeSet& set);

/// Friction, rolling and bounciness of the material. Replaces the entries that are there, unless a person set them.
void put_surface(AttributeSet& set, const MaterialData& material, const std::string& source, AttributeLevel level);

/// Attributes that follow from mass, density and volume: fill, bulk density, wall thickness, area and line density.
void put_mass_dependents(AttributeSet& set, const GeometryFacts& facts, const Form& form);

/// Fraction of a loosely poured bulk that is grain (random loose packing).
inline constexpr double loose_packing = 0.55;

/// Resolution of a thing that is simulated by many points: the diameter of the balls that stand for the grains of a
/// granular thing (docs/physics/grains.md), the cell size of a liquid (docs/physics/fluids.md). Other kinds stay
/// unchanged.
void put_resolution(AttributeSet& set, const GeometryFacts& facts, const Form& form);

/// Mass of a primitive (whose volume and size `facts` has) that is no rigid thing, and the attributes that follow:
/// cloth by its area, a rope of a category by its length, liquids and bulk by their own density. A mass that a person
/// set stays.
void put_mass_of_primitive(AttributeSet& set, const GeometryFacts& facts);

/// Replaces the entry unless a person set it.
void replace(AttributeSet& set, AttributeEntry entry);

/// Whether a person set it.
bool is_manual(const AttributeSet& set, std::string_view name);

}  // namespace embody::attributes
