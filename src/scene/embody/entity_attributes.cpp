// SPDX-License-Identifier: MIT
#include "scene/embody/entity_attributes.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "attributes/assemble.h"
#include "attributes/attribute_json.h"
#include "attributes/form.h"
#include "attributes/physical_kind.h"
#include "attributes/registry.h"
#include "attributes/resolver.h"
#include "physics/definitions/shape_bounds.h"

namespace embody::scene {

using attributes::AttributeEntry;
using attributes::AttributeLevel;
using attributes::AttributeSet;
using attributes::Matter;
using attributes::ModelFacts;
using attributes::PhysicalKind;

namespace {

/// Sets that are kept though no entity holds them: few sets of a document are different, and each takes about 13 kB.
constexpr std::size_t min_kept_sets = 1024;

// The entity's own attributes, checked: a document that a program made was not checked by the file's reader.
Result<std::vector<AttributeEntry>> own_entries(const Entity& entity) {
    std::vector<AttributeEntry> entries;
    for (const auto& [name, value] : entity.attributes) {
        if (const Result<void> valid = attributes::validate(name, value); !valid.ok())
            return Error{"attributes." + name, valid.error().why, valid.error().remedy};
        entries.push_back({name, value, {}, {}, "set for this entity", AttributeLevel::manual});
    }
    return entries;
}

attributes::AttributeValue multiplied(attributes::AttributeValue value, double factor) {
    if (auto* number = std::get_if<double>(&value)) *number *= factor;
    if (auto* vector = std::get_if<Vec3>(&value)) *vector *= factor;
    if (auto* tensor = std::get_if<Mat3>(&value)) *tensor = *tensor * factor;
    return value;
}

// Power of the size for an attribute; 0 for a name that is not in the registry.
int size_power(const std::string& name) {
    const attributes::AttributeDescription* description = attributes::describe(name);
    return description ? description->size_power : 0;
}

// The attributes of the same material at another size.
AttributeSet scaled(const AttributeSet& set, double s) {
    AttributeSet out = set;
    for (const AttributeEntry& held : set.entries()) {
        const int power = size_power(held.name);
        if (power == 0) continue;
        AttributeEntry entry = held;
        const double factor = std::pow(s, power);
        entry.value = multiplied(std::move(entry.value), factor);
        if (entry.low) *entry.low *= factor;
        if (entry.high) *entry.high *= factor;
        entry.source += ", scaled";
        out.erase(entry.name);
        out.put(std::move(entry));
    }
    return out;
}

void put_measured(AttributeSet& set, const char* name, attributes::AttributeValue value, std::string source) {
    if (attributes::validate(name, value).ok())
        set.put({name, std::move(value), {}, {}, std::move(source), AttributeLevel::measured});
}

// The category that a person set for a primitive; empty: none.
std::string category_of(const Entity& entity) {
    const auto own = entity.attributes.find("category");
    const auto* word = own == entity.attributes.end() ? nullptr : std::get_if<std::string>(&own->second);
    return word ? *word : entity.category;
}

// The kind that a person set.
std::optional<PhysicalKind> own_kind(const Entity& entity) {
    const auto own = entity.attributes.find("kind");
    return own == entity.attributes.end() ? std::nullopt : attributes::kind_from_value(own->second);
}

// Whether a person made a triangle mesh movable, which would be static otherwise.
bool is_moved(const Entity& entity) {
    const auto own = own_kind(entity);
    return own ? !is_static(*own) : !category_of(entity).empty();
}

// A primitive without a category, or with the category of a rigid thing, is solid, of the default density, and its form
// is exact.
AttributeSet solid_attributes(const std::string& category, const physics::ShapeDefinition& shape,
                              const ModelFacts& facts) {
    AttributeSet set;
    const std::string name = physics::shape_name(shape);
    if (!category.empty()) set.put({"category", category, {}, {}, "the entity's category", AttributeLevel::category});
    if (physics::is_static_only(shape) && !(facts.geometry.volume > 0)) {
        set.put(
            {"kind", to_value(PhysicalKind::static_body), {}, {}, "a " + name + " can't move", AttributeLevel::kind});
    } else {
        const double density = std::get<double>(attributes::describe("density")->standard);
        const std::string solid = "homogeneous " + name;
        const attributes::GeometryFacts& form = facts.geometry;
        put_measured(set, "volume", form.volume, "volume of the " + name);
        put_measured(set, "fill_fraction", 1.0, solid);
        put_measured(set, "mass", density * form.volume, "density × volume of the " + name);
        put_measured(set, "center_of_mass", form.center_of_volume, solid);
        put_measured(set, "inertia", form.unit_inertia * density, solid);
        const Vec3 s = form.size;
        put_measured(set, "drag_area", (s.x * s.y + s.y * s.z + s.z * s.x) / 2, "mean projected area of its box");
    }
    attributes::complete_for_kind(set);
    // The collision shape is the primitive itself.
    set.erase("collision_shape");
    return set;
}

// Adds the resolution of grains or liquid for the size of this thing.
void complete_resolution(AttributeSet& set, const attributes::GeometryFacts& geometry) {
    attributes::put_resolution(set, geometry, attributes::form_of(geometry, {0.5, 0.5, 0.5}));
}

// Key of everything that an entity's attributes follow from.
GeometryKey attributes_key(const Entity& entity) {
    GeometryKey key = key_of(entity.geometry);
    if (!key.is_shared()) return key;
    if (key.of == GeometryKey::Of::model) key.numbers.push_back(entity.scale);
    key.words.push_back(entity.category);
    for (const auto& [name, value] : entity.attributes) {
        key.words.push_back(name);
        key.words.push_back(attributes::to_json(value).dump());
    }
    return key;
}

}  // namespace

attributes::AttributeValue value_of_model(const std::string& name, const attributes::AttributeValue& value,
                                          double scale) {
    const int power = size_power(name);
    return power == 0 ? value : multiplied(value, std::pow(scale, -power));
}

const ModelFacts& EntityAttributes::facts_of(const Entity& entity, const physics::ShapeDefinition& shape) {
    const auto* mesh = std::get_if<physics::MeshShape>(&shape);
    return mesh && is_moved(entity) ? primitives_.of_enclosed(*mesh) : primitives_.of(shape);
}

AttributeSet EntityAttributes::primitive_attributes(const Entity& entity, const physics::ShapeDefinition& shape,
                                                    const ModelFacts& facts) const {
    const std::string category = category_of(entity);
    const bool has_extent = facts.geometry.size != Vec3{};
    if (models_.taxonomy() && has_extent && !category.empty()) {
        std::optional<AttributeSet> set = attributes::resolve_primitive(*models_.taxonomy(), category, facts);
        if (set) return std::move(*set);
    }
    return solid_attributes(category, shape, facts);
}

Result<AttributeSet> EntityAttributes::automatic(const Entity& entity) {
    if (const auto* shape = std::get_if<physics::ShapeDefinition>(&entity.geometry)) {
        const ModelFacts& facts = primitives_.of(*shape);
        AttributeSet set = primitive_attributes(entity, *shape, facts);
        attributes::put_mass_of_primitive(set, facts.geometry);
        return set;
    }
    const Result<const KnownModel*> model = models_.find(std::get<ModelReference>(entity.geometry).key);
    if (!model.ok()) return model.error();
    return entity.scale == 1 ? model.value()->attributes : scaled(model.value()->attributes, entity.scale);
}

Result<AttributeSet> EntityAttributes::acting(const Entity& entity) {
    Result<std::vector<AttributeEntry>> own = own_entries(entity);
    if (!own.ok()) return own.error();
    if (const auto* shape = std::get_if<physics::ShapeDefinition>(&entity.geometry)) {
        const ModelFacts& facts = facts_of(entity, *shape);
        AttributeSet set = override_by(primitive_attributes(entity, *shape, facts), own.value(), facts);
        set.erase("collision_shape");
        complete_resolution(set, facts.geometry);
        attributes::put_mass_of_primitive(set, facts.geometry);
        return set;
    }
    Result<AttributeSet> automatic = this->automatic(entity);
    if (!automatic.ok()) return automatic;
    const KnownModel& model = *models_.find(std::get<ModelReference>(entity.geometry).key).value();
    ModelFacts facts = model.facts;
    facts.geometry = attributes::scaled(model.facts.geometry, entity.scale);
    AttributeSet set =
        own.value().empty() ? std::move(automatic).value() : override_by(automatic.value(), own.value(), facts);
    complete_resolution(set, facts.geometry);
    return set;
}

Result<SharedAttributes> EntityAttributes::shared(const Entity& entity) {
    GeometryKey key = attributes_key(entity);
    if (const auto known = sets_.find(key); key.is_shared() && known != sets_.end()) return known->second;
    Result<AttributeSet> made = acting(entity);
    if (!made.ok()) return made.error();
    SharedAttributes set = std::make_shared<const AttributeSet>(std::move(made).value());
    if (!key.is_shared()) return set;
    keep(std::move(key), set);
    return set;
}

// Where a slider is dragged each edit makes a set that nobody holds after the next one. Twice what is held, so that the
// walk costs each new set little.
void EntityAttributes::keep(GeometryKey key, SharedAttributes set) {
    if (sets_.size() >= std::max(max_kept_, min_kept_sets)) {
        std::erase_if(sets_, [](const auto& item) { return item.second.use_count() == 1; });
        max_kept_ = 2 * sets_.size();
    }
    sets_.emplace(std::move(key), std::move(set));
}

bool EntityAttributes::is_liquid(const Entity& entity) {
    if (const auto own = own_kind(entity)) return traits_of(*own).matter == Matter::liquid;
    const bool is_primitive = std::holds_alternative<physics::ShapeDefinition>(entity.geometry);
    if (is_primitive && category_of(entity).empty()) return false;
    const Result<AttributeSet> automatic = this->automatic(entity);
    return automatic.ok() && matter_of(automatic.value()) == Matter::liquid;
}

attributes::Circumstances circumstances_of(const physics::WorldSettings& settings, bool has_joint) {
    return {{}, settings.time_step / settings.substeps, length(settings.gravity), has_joint};
}

Bounds EntityAttributes::box_of(const Entity& entity) {
    if (const auto* shape = std::get_if<physics::ShapeDefinition>(&entity.geometry)) return physics::bounds_of(*shape);
    const Result<const KnownModel*> model = models_.find(std::get<ModelReference>(entity.geometry).key);
    const Vec3 size = model.ok() ? entity.scale * model.value()->facts.geometry.size : Vec3{};
    if (!is_finite(size) || size == Vec3{}) return {};
    return {{-size.x / 2, 0, -size.z / 2}, {size.x / 2, size.y, size.z / 2}};
}

Result<std::vector<attributes::Issue>> EntityAttributes::contradictions(const Entity& entity,
                                                                        attributes::Circumstances around) {
    const Result<SharedAttributes> shared = this->shared(entity);
    if (!shared.ok()) return shared.error();
    const AttributeSet& acting = *shared.value();
    const bool is_changed = std::ranges::any_of(
        acting.entries(), [](const AttributeEntry& entry) { return entry.level == AttributeLevel::manual; });
    // Without manual entries the set is as it was resolved.
    std::vector<attributes::Issue> issues;
    if (!is_changed) return issues;
    const Result<AttributeSet> automatic = this->automatic(entity);
    if (!automatic.ok()) return automatic.error();
    around.box = box_of(entity);
    issues = attributes::find_implausible(acting, automatic.value(), around);

    // The physics knows the form of a primitive itself.
    if (const auto* model = std::get_if<ModelReference>(&entity.geometry)) {
        ModelFacts facts = models_.find(model->key).value()->facts;
        facts.geometry = attributes::scaled(facts.geometry, entity.scale);
        for (attributes::Issue& issue : attributes::check(acting, facts)) {
            const bool is_told = std::ranges::any_of(
                issues, [&issue](const attributes::Issue& told) { return told.attribute == issue.attribute; });
            if (!is_told) issues.push_back(std::move(issue));
        }
    }
    const AttributeEntry* material = acting.find("surface_material");
    if (material && models_.taxonomy() && attributes::is_manual(acting, "surface_material")) {
        const auto known = attributes::known_value(*models_.taxonomy(), material->name, material->value);
        if (!known) issues.push_back({material->name, known.error().why});
    }
    for (attributes::Issue& issue : issues)
        if (entity.attributes.contains(issue.attribute)) attributes::offer_reset(issue, automatic.value());
    return issues;
}

AttributeSet EntityAttributes::override_by(const AttributeSet& automatic, const std::vector<AttributeEntry>& own,
                                           const ModelFacts& facts) const {
    return models_.taxonomy() ? attributes::with_manual(*models_.taxonomy(), automatic, own, facts)
                              : attributes::with_manual(automatic, own, facts);
}

}  // namespace embody::scene
