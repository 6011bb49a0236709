// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "attributes/attribute.h"
#include "attributes/model_facts.h"
#include "foundation/result.h"

namespace embody::attributes {

class Surfaces;

/// The mapping of the paper's Fig. 4: words → category → physical kind → predefined attribute set. Read from
/// data/taxonomy.
class Taxonomy {
public:
    /// `folder` holds materials.json, material_pairs.json and categories/*.json; WordNet's nouns are read from its
    /// wordnet-nouns.table, or from the one that the build wrote. `user_folder`: the user's own categories, which
    /// override these; empty: none. The error names file, entry, field and remedy.
    static Result<std::unique_ptr<Taxonomy>> load(const std::filesystem::path& folder,
                                                  const std::filesystem::path& user_folder = {});
    ~Taxonomy();

    struct Data;
    [[nodiscard]] const Data& data() const { return *data_; }
    /// A copy without this category, its subcategories and their words, to measure results on unknown words.
    [[nodiscard]] std::unique_ptr<Taxonomy> without(std::string_view category) const;

    /// Friction and restitution by pair of materials.
    [[nodiscard]] const Surfaces& surfaces() const { return *surfaces_; }

private:
    Taxonomy();
    std::unique_ptr<Data> data_;
    std::shared_ptr<const Surfaces> surfaces_;
};

/// All attributes of a model from its known facts, each with source and level: category → kind → attribute set, then
/// attributes from the geometry. Deterministic; never fails: an attribute that no fact determines gets the default.
AttributeSet resolve(const Taxonomy& taxonomy, const ModelFacts& facts);

/// All attributes of a primitive with the form in `facts`, by the category that a person named: an entry of the
/// taxonomy or one of its words ("honey"), which means the substance itself, not its container. Empty where no entry
/// has this name, and where things of the entry are rigid or static: these follow from their shape.
std::optional<AttributeSet> resolve_primitive(const Taxonomy& taxonomy, std::string_view category,
                                              const ModelFacts& facts);

/// Mass of a model's parts by their volumes and materials, walls as thick as usual, kg: a second opinion on its mass,
/// independent of its category's mass and of its box. Empty where the parts are not known.
std::optional<double> density_sum(const Taxonomy& taxonomy, const ModelFacts& facts);

/// Metres per unit that would bring a model without stated size to the usual size of its category; empty where it has
/// that size already, or where no usual unit does. The importer calls it before it stores the geometry.
std::optional<double> suggested_scale(const Taxonomy& taxonomy, const ModelFacts& facts);

/// The first usual unit (mm, cm, inch, foot …) that brings the largest extent into its usual range, m.
std::optional<double> likely_unit(double largest, double usual_low, double usual_high);

/// A value that a person entered, in the taxonomy's terms: a surface_material is the name of a material of
/// materials.json or one of its words ("oak" is wood); the error names them all. Other values are returned unchanged,
/// valid or not.
Result<AttributeValue> known_value(const Taxonomy& taxonomy, std::string_view name, AttributeValue value);

/// `automatic` overridden by the manual entries, with the values that depend on them computed again (mass from density,
/// …). Entries that validate() refuses are left out; contradictions between manual entries stay, and check() names
/// them. With a taxonomy, a manual surface_material also sets that material's density, friction and bounciness.
AttributeSet with_manual(const AttributeSet& automatic, const std::vector<AttributeEntry>& manual,
                         const ModelFacts& facts);
AttributeSet with_manual(const Taxonomy& taxonomy, const AttributeSet& automatic,
                         const std::vector<AttributeEntry>& manual, const ModelFacts& facts);

}  // namespace embody::attributes
