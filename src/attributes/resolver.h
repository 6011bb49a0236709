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
    /// wordnet-nouns.table, or from the one that the build wrote. `user_folder`: categories of the
    /// user's own, laid over these; empty: none. The error names file, entry, field and remedy.
    static Result<std::unique_ptr<Taxonomy>> load(const std::filesystem::path& folder,
                                                  const std::filesystem::path& user_folder = {});
    ~Taxonomy();

    struct Data;
    [[nodiscard]] const Data& data() const { return *data_; }
    /// A copy that does not know this category, its subcategories and their words, for asking how well it does with
    /// words that it has never seen.
    [[nodiscard]] std::unique_ptr<Taxonomy> without(std::string_view category) const;

    /// Friction and restitution by pair of materials.
    [[nodiscard]] const Surfaces& surfaces() const { return *surfaces_; }

private:
    Taxonomy();
    std::unique_ptr<Data> data_;
    std::shared_ptr<const Surfaces> surfaces_;
};

/// All attributes of a model from what is known of it, each with source and level: category → kind → attribute set,
/// then what geometry tells. Deterministic; never fails: what nothing tells gets the default.
AttributeSet resolve(const Taxonomy& taxonomy, const ModelFacts& facts);

/// The same of a primitive, whose form `facts` tells, by the category that a person gave it: an entry of the taxonomy
/// or one of its words ("honey"), which means the stuff itself, not what it comes in. Nothing where no entry is called
/// so, and where things of it are rigid or static: these are what their shape says.
std::optional<AttributeSet> resolve_primitive(const Taxonomy& taxonomy, std::string_view category,
                                              const ModelFacts& facts);

/// What the parts of a model weigh by their volumes and materials, walls as thick as usual, kg: a second opinion on its
/// mass that asks neither its category's mass nor its box. Nothing where the parts are not known.
std::optional<double> density_sum(const Taxonomy& taxonomy, const ModelFacts& facts);

/// Metres per unit that would make a model without stated size as large as things of its category usually are; nothing
/// where it is that already, or where no usual unit does. The importer asks before it stores the geometry.
std::optional<double> suggested_scale(const Taxonomy& taxonomy, const ModelFacts& facts);

/// The first usual unit (mm, cm, inch, foot …) that brings the largest extent into its usual range, m.
std::optional<double> likely_unit(double largest, double usual_low, double usual_high);

/// A value that a person gives, in the taxonomy's terms: a surface_material is a material of materials.json, named so
/// or by one of its words ("oak" is wood); the error names them all. Other values are passed through, valid or not.
Result<AttributeValue> known_value(const Taxonomy& taxonomy, std::string_view name, AttributeValue value);

/// `automatic` with the manual entries laid over it and what depends on them computed again (mass from density, …).
/// Entries that validate() refuses are left out; contradictions between manual entries stay, and check() names them.
/// With a taxonomy, a manual surface_material brings that material's density, friction and bounciness.
AttributeSet with_manual(const AttributeSet& automatic, const std::vector<AttributeEntry>& manual,
                         const ModelFacts& facts);
AttributeSet with_manual(const Taxonomy& taxonomy, const AttributeSet& automatic,
                         const std::vector<AttributeEntry>& manual, const ModelFacts& facts);

}  // namespace embody::attributes
