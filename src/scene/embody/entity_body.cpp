// SPDX-License-Identifier: MIT
#include "scene/embody/entity_body.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "attributes/assemble.h"
#include "attributes/attribute_json.h"
#include "attributes/form.h"
#include "attributes/physical_kind.h"
#include "attributes/registry.h"
#include "attributes/resolver.h"
#include "attributes/to_physics.h"
#include "physics/definitions/mass_properties.h"
#include "physics/definitions/shape_bounds.h"
#include "scene/file/json/parts.h"

namespace embody::scene {

using attributes::AttributeEntry;
using attributes::AttributeLevel;
using attributes::AttributeSet;
using attributes::ModelFacts;
using attributes::PhysicalKind;

namespace {

/// Of one document few are different, unless each has its own numbers: then there is no use in keeping more.
constexpr std::size_t most_shared_sets = 4096;

Error at_field(Error error, const std::string& field) {
    error.where = error.where.empty() ? field : field + ": " + error.where;
    return error;
}

// The entity's own attributes, checked: a document made by a program has not been through the file's reader.
Result<std::vector<AttributeEntry>> own_entries(const Entity& entity) {
    std::vector<AttributeEntry> entries;
    for (const auto& [name, value] : entity.attributes) {
        if (const Result<void> valid = attributes::validate(name, value); !valid.ok())
            return Error{"attributes." + name, valid.error().why, valid.error().remedy};
        entries.push_back({name, value, {}, {}, "set for this entity", AttributeLevel::manual});
    }
    return entries;
}

// Attributes that grow with a power of the size; the others are the material's.
struct Power {
    const char* name;
    int power;
};
constexpr Power powers[] = {{"mass", 3},           {"volume", 3},    {"center_of_mass", 1}, {"inertia", 5},
                            {"wall_thickness", 1}, {"drag_area", 2}, {"hull_error", 1}};

attributes::AttributeValue multiplied(attributes::AttributeValue value, double factor) {
    if (auto* number = std::get_if<double>(&value)) *number *= factor;
    if (auto* vector = std::get_if<Vec3>(&value)) *vector *= factor;
    if (auto* tensor = std::get_if<Mat3>(&value)) *tensor = *tensor * factor;
    return value;
}

// The same material in another size.
AttributeSet scaled(const AttributeSet& set, double s) {
    AttributeSet out = set;
    for (const Power& row : powers) {
        const AttributeEntry* held = set.find(row.name);
        if (!held) continue;
        AttributeEntry entry = *held;
        const double factor = std::pow(s, row.power);
        entry.value = multiplied(std::move(entry.value), factor);
        if (entry.low) *entry.low *= factor;
        if (entry.high) *entry.high *= factor;
        entry.source += ", scaled";
        out.erase(row.name);
        out.put(std::move(entry));
    }
    return out;
}

void put_measured(AttributeSet& set, const char* name, attributes::AttributeValue value, std::string source) {
    if (attributes::validate(name, value).ok())
        set.put({name, std::move(value), {}, {}, std::move(source), AttributeLevel::measured});
}

// What a person says that a primitive is; empty: nothing.
std::string category_of(const Entity& entity) {
    const auto own = entity.attributes.find("category");
    const auto* word = own == entity.attributes.end() ? nullptr : std::get_if<std::string>(&own->second);
    return word ? *word : entity.category;
}

// That a person gave it.
std::optional<PhysicalKind> own_kind(const Entity& entity) {
    const auto own = entity.attributes.find("kind");
    return own == entity.attributes.end() ? std::nullopt : attributes::kind_from_value(own->second);
}

// What a person makes of triangles that would be static otherwise.
bool is_moved(const Entity& entity) {
    const auto own = own_kind(entity);
    return own ? *own != PhysicalKind::static_body : !category_of(entity).empty();
}

// A primitive that no category makes soft or the like is solid, of the default density, and its form is known exactly.
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
    // What collides is the primitive itself.
    set.erase("collision_shape");
    return set;
}

// How fine the grains or the liquid are, of this size of the thing.
void complete_fineness(AttributeSet& set, const attributes::GeometryFacts& geometry) {
    attributes::put_fineness(set, geometry, attributes::form_of(geometry, {0.5, 0.5, 0.5}));
}

physics::ShapeDefinition hull_of(const physics::MeshShape& mesh) {
    physics::HullShape hull;
    hull.points.reserve(mesh.positions.size());
    for (const Vec3f& position : mesh.positions) hull.points.push_back(to_vec3(position));
    return hull;
}

// Triangles have the volume that they enclose; none where they enclose nothing.
void put_enclosed(const physics::MeshShape& mesh, attributes::GeometryFacts& form) {
    const geometry::VolumeEstimate enclosed = physics::enclosed_by(mesh);
    form.closed = enclosed.method == geometry::VolumeMethod::closed_mesh;
    form.volume_method = geometry::name(enclosed.method);
    if (enclosed.method == geometry::VolumeMethod::no_volume) return;
    form.volume = enclosed.solid.volume;
    form.center_of_volume = enclosed.solid.center;
    form.unit_inertia = enclosed.solid.inertia;
    const auto hull = physics::mass_properties(hull_of(mesh));
    form.hull_volume = hull.ok() ? hull->volume : form.volume;
}

// Large shapes have no short name to be found by.
std::string short_text(const physics::ShapeDefinition& shape) {
    if (physics::is_static_only(shape) || std::holds_alternative<physics::CompoundShape>(shape)) return {};
    return shape_to_json(shape).dump();
}

// All that an entity's attributes follow from; empty: too much to be compared.
std::string attributes_key(const Entity& entity) {
    std::string key;
    if (const auto* model = std::get_if<ModelReference>(&entity.geometry)) {
        key = model->key + '\n' + nlohmann::json(entity.scale).dump();
    } else {
        key = short_text(std::get<physics::ShapeDefinition>(entity.geometry));
        if (key.empty()) return key;
    }
    key += '\n' + entity.category;
    for (const auto& [name, value] : entity.attributes) key += '\n' + name + '\t' + attributes::to_json(value).dump();
    return key;
}

// Hull and triangles of a model of the catalogue, scaled.
class CatalogGeometry final : public attributes::ModelGeometry {
public:
    CatalogGeometry(const catalog::Catalog& catalog, std::int64_t id, double scale)
        : catalog_(catalog), id_(id), scale_(scale) {}

    Result<std::vector<Vec3>> hull_points() override {
        Result<std::vector<Vec3>> points = catalog_.hull_points(id_);
        if (points.ok())
            for (Vec3& point : points.value()) point *= scale_;
        return points;
    }

    Result<physics::MeshShape> mesh() override {
        Result<geometry::TriangleMesh> read = catalog_.mesh(id_);
        if (!read.ok()) return read.error();
        physics::MeshShape shape;
        shape.positions.reserve(read.value().positions.size());
        for (const auto& position : read.value().positions)
            shape.positions.push_back(to_vec3f(to_vec3(position) * scale_));
        shape.triangles = read.value().triangles;
        return shape;
    }

    Result<std::vector<std::vector<Vec3>>> convex_parts(int max_hulls, double hull_error) override {
        Result<catalog::ConvexParts> parts = catalog_.convex_parts(id_, max_hulls, hull_error / scale_);
        if (!parts.ok()) return parts.error();
        std::vector<std::vector<Vec3>> scaled;
        for (const std::vector<Vec3f>& hull : parts.value().hulls) {
            scaled.emplace_back();
            for (const Vec3f& point : hull) scaled.back().push_back(to_vec3(point) * scale_);
        }
        return scaled;
    }

private:
    const catalog::Catalog& catalog_;
    std::int64_t id_;
    double scale_;
};

}  // namespace

attributes::AttributeValue value_of_model(const std::string& name, const attributes::AttributeValue& value,
                                          double scale) {
    for (const Power& row : powers)
        if (name == row.name) return multiplied(value, std::pow(scale, -row.power));
    return value;
}

ModelFacts primitive_facts(const physics::ShapeDefinition& shape) {
    ModelFacts facts;
    attributes::GeometryFacts& form = facts.geometry;
    form.volume_method = "closed form";
    form.closed = true;
    const Bounds bounds = physics::bounds_of(shape);
    const bool has_extent = !bounds.is_empty() && !std::holds_alternative<physics::HeightfieldShape>(shape);
    if (physics::is_static_only(shape)) {
        if (has_extent) form.size = bounds.size();
        return facts;
    }
    const Result<geometry::MassProperties> solid = physics::mass_properties(shape);
    if (!solid.ok()) return facts;
    form.volume = form.hull_volume = solid->volume;
    form.center_of_volume = solid->center;
    form.unit_inertia = solid->inertia;
    form.size = bounds.size();
    return facts;
}

const ModelFacts& EntityBodies::primitive(const Entity& entity, const physics::ShapeDefinition& shape) {
    const auto* mesh = std::get_if<physics::MeshShape>(&shape);
    if (!mesh || !is_moved(entity)) return primitive(shape);
    if (last_mesh_.first.positions == mesh->positions && last_mesh_.first.triangles == mesh->triangles)
        return last_mesh_.second;
    ModelFacts facts = primitive_facts(shape);
    put_enclosed(*mesh, facts.geometry);
    last_mesh_ = {*mesh, std::move(facts)};
    return last_mesh_.second;
}

const ModelFacts& EntityBodies::primitive(const physics::ShapeDefinition& shape) {
    const std::string text = short_text(shape);
    if (text.empty()) return last_primitive_ = primitive_facts(shape);
    const auto found = primitives_.find(text);
    if (found != primitives_.end()) return found->second;
    return primitives_.emplace(text, primitive_facts(shape)).first->second;
}

Result<const EntityBodies::Model*> EntityBodies::find(const std::string& key) {
    if (const auto found = models_.find(key); found != models_.end()) return &found->second;
    if (!catalog_) return Error{"model", "\"" + key + "\" is in no database: none is open", "open one with --database"};
    Result<catalog::ModelSummary> summary = catalog_->model(key);
    if (!summary.ok()) return Error{"model", summary.error().message(), "import it, or take another key"};
    Result<ModelFacts> facts = catalog_->facts(summary.value().id);
    if (!facts.ok()) return at_field(facts.error(), "model");
    Result<AttributeSet> set = catalog_->attributes(summary.value().id);
    if (!set.ok()) return at_field(set.error(), "model");
    Model model{std::move(summary).value(), std::move(facts).value(), std::move(set).value()};
    return &models_.emplace(key, std::move(model)).first->second;
}

Result<catalog::ModelSummary> EntityBodies::model(const Entity& entity) {
    const auto* reference = std::get_if<ModelReference>(&entity.geometry);
    if (!reference) return Error{"model", "this entity is a primitive"};
    const Result<const Model*> found = find(reference->key);
    if (!found.ok()) return found.error();
    return found.value()->summary;
}

AttributeSet EntityBodies::primitive_attributes(const Entity& entity, const physics::ShapeDefinition& shape,
                                                const ModelFacts& facts) const {
    const std::string category = category_of(entity);
    const bool has_extent = facts.geometry.size != Vec3{};
    if (taxonomy() && has_extent && !category.empty()) {
        std::optional<AttributeSet> set = attributes::resolve_primitive(*taxonomy(), category, facts);
        if (set) return std::move(*set);
    }
    return solid_attributes(category, shape, facts);
}

Result<AttributeSet> EntityBodies::automatic_attributes(const Entity& entity) {
    if (const auto* shape = std::get_if<physics::ShapeDefinition>(&entity.geometry)) {
        const ModelFacts& facts = primitive(*shape);
        AttributeSet set = primitive_attributes(entity, *shape, facts);
        attributes::put_mass_of_primitive(set, facts.geometry);
        return set;
    }
    const Result<const Model*> model = find(std::get<ModelReference>(entity.geometry).key);
    if (!model.ok()) return model.error();
    return entity.scale == 1 ? model.value()->attributes : scaled(model.value()->attributes, entity.scale);
}

Result<AttributeSet> EntityBodies::attributes(const Entity& entity) {
    Result<std::vector<AttributeEntry>> own = own_entries(entity);
    if (!own.ok()) return own.error();
    if (const auto* shape = std::get_if<physics::ShapeDefinition>(&entity.geometry)) {
        const ModelFacts& facts = primitive(entity, *shape);
        AttributeSet set = lay_over(primitive_attributes(entity, *shape, facts), own.value(), facts);
        set.erase("collision_shape");
        complete_fineness(set, facts.geometry);
        attributes::put_mass_of_primitive(set, facts.geometry);
        return set;
    }
    Result<AttributeSet> automatic = automatic_attributes(entity);
    if (!automatic.ok()) return automatic;
    const Model& model = *find(std::get<ModelReference>(entity.geometry).key).value();
    ModelFacts facts = model.facts;
    facts.geometry = attributes::scaled(model.facts.geometry, entity.scale);
    AttributeSet set =
        own.value().empty() ? std::move(automatic).value() : lay_over(automatic.value(), own.value(), facts);
    complete_fineness(set, facts.geometry);
    return set;
}

Result<SharedAttributes> EntityBodies::shared_attributes(const Entity& entity) {
    const std::string key = attributes_key(entity);
    if (const auto known = sets_.find(key); known != sets_.end() && !key.empty()) return known->second;
    Result<AttributeSet> made = attributes(entity);
    if (!made.ok()) return made.error();
    SharedAttributes set = std::make_shared<const AttributeSet>(std::move(made).value());
    if (key.empty()) return set;
    // Who has one keeps it.
    if (sets_.size() >= most_shared_sets) sets_.clear();
    sets_.emplace(key, set);
    return set;
}

bool EntityBodies::is_liquid(const Entity& entity) {
    if (const auto own = own_kind(entity)) return *own == PhysicalKind::fluid;
    const bool is_primitive = std::holds_alternative<physics::ShapeDefinition>(entity.geometry);
    if (is_primitive && category_of(entity).empty()) return false;
    const Result<AttributeSet> automatic = automatic_attributes(entity);
    return automatic.ok() && kind_of(automatic.value()) == PhysicalKind::fluid;
}

Result<std::vector<attributes::Issue>> EntityBodies::contradictions(const Entity& entity) {
    const Result<SharedAttributes> shared = shared_attributes(entity);
    if (!shared.ok()) return shared.error();
    const AttributeSet& acting = *shared.value();
    const bool is_changed = std::ranges::any_of(
        acting.entries(), [](const AttributeEntry& entry) { return entry.level == AttributeLevel::manual; });
    // What nobody set is as it was resolved; of primitives the physics knows the form itself.
    const auto* model = std::get_if<ModelReference>(&entity.geometry);
    std::vector<attributes::Issue> issues;
    if (!is_changed) return issues;
    if (model) {
        ModelFacts facts = find(model->key).value()->facts;
        facts.geometry = attributes::scaled(facts.geometry, entity.scale);
        issues = attributes::check(acting, facts);
    }
    const AttributeEntry* material = acting.find("surface_material");
    if (material && taxonomy() && attributes::is_manual(acting, "surface_material")) {
        const auto known = attributes::known_value(*taxonomy(), material->name, material->value);
        if (!known) issues.push_back({material->name, known.error().why});
    }
    return issues;
}

const attributes::Taxonomy* EntityBodies::taxonomy() const { return catalog_ ? &catalog_->taxonomy() : nullptr; }

AttributeSet EntityBodies::lay_over(const AttributeSet& automatic, const std::vector<AttributeEntry>& own,
                                    const ModelFacts& facts) const {
    return taxonomy() ? attributes::with_manual(*taxonomy(), automatic, own, facts)
                      : attributes::with_manual(automatic, own, facts);
}

Result<physics::BodyDefinition> EntityBodies::body(const Entity& entity, const AttributeSet& attributes) {
    physics::BodyDefinition body;
    if (kind_of(attributes) == PhysicalKind::visual) {
        body.kind = physics::BodyKind::static_body;
        body.enabled = false;
    } else {
        Result<physics::BodyDefinition> made = attributes::body_from_attributes(attributes, taxonomy());
        if (!made.ok()) return at_field(made.error(), "attributes");
        body = std::move(made).value();
        body.enabled = entity.enabled;
    }

    // A primitive weighs what its attributes say; the physics knows where it has its centre, and its moments.
    if (std::holds_alternative<physics::ShapeDefinition>(entity.geometry)) {
        // It collides as its hull, but weighs by what its triangles enclose.
        const bool is_mesh =
            std::holds_alternative<physics::MeshShape>(std::get<physics::ShapeDefinition>(entity.geometry));
        const auto is_known = [&](const char* name) {
            const AttributeEntry* held = attributes.find(name);
            return held &&
                   (held->level == AttributeLevel::manual || (is_mesh && held->level != AttributeLevel::standard));
        };
        const AttributeEntry* mass = attributes.find("mass");
        if (mass && mass->level == AttributeLevel::standard) body.mass.mass.reset();
        if (!is_known("center_of_mass")) body.mass.center_of_mass.reset();
        if (!is_known("inertia")) body.mass.inertia.reset();
        body.mass.density *= attributes.number("fill_fraction", 1);
    }

    // Where it is and how it starts.
    body.position = entity.pose.position;
    body.rotation = entity.pose.rotation;
    body.linear_velocity = entity.linear_velocity;
    body.angular_velocity = entity.angular_velocity;
    body.force = entity.force;
    body.torque = entity.torque;
    body.start_asleep = entity.start_asleep;
    body.allow_sleep = entity.allow_sleep;
    body.continuous = body.continuous || entity.continuous;
    body.user_data = entity.index;
    return body;
}

Result<physics::ShapeDefinition> EntityBodies::shape(const Entity& entity, const AttributeSet& attributes) {
    if (const auto* shape = std::get_if<physics::ShapeDefinition>(&entity.geometry)) {
        // Triangles have no inside that could move; a mesh that is made movable collides as its convex hull.
        const auto* mesh = std::get_if<physics::MeshShape>(shape);
        if (!mesh || kind_of(attributes) == PhysicalKind::static_body) return *shape;
        return hull_of(*mesh);
    }
    const Result<const Model*> model = find(std::get<ModelReference>(entity.geometry).key);
    if (!model.ok()) return model.error();
    CatalogGeometry geometry(*catalog_, model.value()->summary.id, entity.scale);
    Result<physics::ShapeDefinition> shape = attributes::shape_from_attributes(
        attributes, attributes::scaled(model.value()->facts.geometry, entity.scale), geometry);
    if (!shape.ok()) return at_field(shape.error(), "model");
    return shape;
}

std::string EntityBodies::shape_key(const Entity& entity, const AttributeSet& attributes) {
    if (const auto* model = std::get_if<ModelReference>(&entity.geometry)) {
        const std::string shape = attributes.word("collision_shape", "");
        std::string key = model->key + '\n' + shape + '\n' + nlohmann::json(entity.scale).dump();
        if (shape != "decomposition") return key;
        for (const char* limit : {"max_hulls", "hull_error"})
            key += '\n' + nlohmann::json(attributes.number(limit, 0)).dump();
        return key;
    }
    return short_text(std::get<physics::ShapeDefinition>(entity.geometry));
}

}  // namespace embody::scene
