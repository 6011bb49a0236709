// SPDX-License-Identifier: MIT
#include "evaluation/behaviour_evaluation.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "attributes/physical_kind.h"
#include "attributes/surfaces.h"
#include "evaluation/found_category.h"
#include "scene/simulation/simulation.h"

namespace embody::evaluation {
namespace {

using attributes::AttributeSet;
using attributes::PhysicalKind;

constexpr double gravity = 9.81;
constexpr double push_speed = 1;     // m/s
constexpr double drop_height = 0.1;  // m
constexpr double degrees = 180 / std::numbers::pi;
constexpr const char* floor_material = "concrete";

// A simulation with one model on a wide slab.
struct Stage {
    std::unique_ptr<scene::Simulation> simulation;
    physics::BodyHandle body;

    [[nodiscard]] const physics::World& world() const { return simulation->world(); }
    [[nodiscard]] Vec3 center() const { return world().center_of_mass(body); }
    /// Angle between its own up and the world's, degrees.
    [[nodiscard]] double tilt() const {
        const Vec3 up = rotate(world().pose(body).rotation, {0, 1, 0});
        return std::acos(std::clamp(up.y, -1.0, 1.0)) * degrees;
    }
    void run(double seconds) const {
        for (double t = 0; t < seconds; t += world().settings().time_step) simulation->step();
    }
};

Result<Stage> stage_of(catalog::Catalog& catalog, const std::string& key, double height, Vec3 velocity) {
    scene::Document document;
    document.settings.workers = 1;
    scene::Entity floor{
        .index = 1, .name = "Floor", .geometry = physics::ShapeDefinition{physics::BoxShape{{50, 1, 50}}}};
    floor.attributes = {{"kind", to_value(PhysicalKind::static_body)},
                        {"surface_material", std::string(floor_material)}};
    floor.pose.position = {0, -1, 0};
    scene::Entity model{.index = 2, .name = "Model", .geometry = scene::ModelReference{key}};
    model.pose.position = {0, height, 0};
    model.linear_velocity = velocity;
    document.entities = {floor, model};
    document.next_index = 3;
    auto simulation = scene::Simulation::create(document, &catalog);
    if (!simulation) return simulation.error();
    const physics::BodyHandle body = (*simulation)->body(2);
    return Stage{std::move(*simulation), body};
}

// Expected friction and restitution of the model on the floor: from the pair table where both values are the materials'
// own, else from the fallback rules.
struct OnFloor {
    double friction = 0, restitution = 0;
};

OnFloor on_floor(const attributes::Taxonomy& taxonomy, const AttributeSet& model, const AttributeSet& floor) {
    const attributes::SurfacePairData* pair =
        taxonomy.surfaces().pair(model.word("surface_material", ""), floor.word("surface_material", ""));
    const attributes::AttributeEntry* friction = model.find("friction_dynamic");
    const attributes::AttributeEntry* bounce = model.find("restitution");
    // The resolver's source of a value from the material begins with the material's name.
    const auto is_materials = [&](const attributes::AttributeEntry* entry) {
        return entry == nullptr || entry->source.starts_with(model.word("surface_material", "") + " (");
    };
    OnFloor result;
    result.friction = pair != nullptr && is_materials(friction)
                          ? pair->friction_dynamic.typical
                          : std::sqrt(model.number("friction_dynamic", 0) * floor.number("friction_dynamic", 0));
    result.restitution = !is_materials(bounce) ? model.number("restitution", 0)
                         : pair != nullptr     ? pair->restitution.typical
                                           : std::max(model.number("restitution", 0), floor.number("restitution", 0));
    return result;
}

// Whether the model lies flat at its usual pose, so that it slides instead of rolling and lands on all its feet at
// once.
bool is_upright(const Stage& stage) { return stage.tilt() < 1; }

// Vertical speed of the ends above which the model rocks: then the formulas of a sliding or bouncing block do not
// apply.
constexpr double rocking = 0.05;  // m/s

bool rocks(const Stage& stage, double extent) {
    const Vec3 spin = stage.world().angular_velocity(stage.body);
    return std::hypot(spin.x, spin.z) * extent > rocking;
}

// Friction and air drag, v' = -μ g - k v² with k = ρ c A/2m, stop it after a distance of ln(1 + k v²/μ g)/2k.
std::optional<Compared> slide_of(const Stage& stage, double extent, double friction, const AttributeSet& attributes) {
    const Vec3 start = stage.center();
    const double seconds = push_speed / (friction * gravity) + 1;
    for (double t = 0; t < seconds; t += stage.world().settings().time_step) {
        stage.simulation->step();
        if (rocks(stage, extent)) return std::nullopt;
    }
    if (length(stage.world().linear_velocity(stage.body)) > 0.01) return std::nullopt;
    const Vec3 displacement = stage.center() - start;
    const double drag_area = attributes.number("drag_coefficient", 1) * attributes.number("drag_area", 0);
    const double k = stage.world().settings().air_density * drag_area / (2 * attributes.number("mass", 1));
    const double energy = push_speed * push_speed / (2 * friction * gravity);
    return Compared{k > 0 ? std::log1p(2 * k * energy) / (2 * k) : energy, std::hypot(displacement.x, displacement.z)};
}

// Restitution from the height of the rebound: `ground` is the height of its centre at rest.
std::optional<Compared> rebound_of(const Stage& stage, double extent, double ground, double restitution) {
    const double fall = stage.center().y - ground;
    double top = ground;
    bool has_bounced = false;
    for (int i = 0; i < 120; ++i) {
        stage.simulation->step();
        const double speed = stage.world().linear_velocity(stage.body).y;
        if (rocks(stage, extent)) return std::nullopt;
        has_bounced = has_bounced || speed > 0;
        if (has_bounced) top = std::max(top, stage.center().y);
        if (has_bounced && speed <= 0) break;
    }
    return Compared{restitution, std::sqrt((top - ground) / fall)};
}

bool is_round(const std::string& shape) { return shape == "sphere" || shape == "capsule" || shape == "cylinder"; }

// Mass of everything that can move: things that bend or pour are not one body.
double moving_mass(const physics::World& world) {
    double sum = 0;
    for (const physics::DeformableHandle deformable : world.deformables()) sum += world.mass(deformable);
    for (const physics::BodyHandle body : world.bodies()) {
        if (std::isfinite(world.mass(body))) sum += world.mass(body);
    }
    return sum;
}

Result<Behaviour> behaviour_of(catalog::Catalog& catalog, const catalog::ModelSummary& model,
                               const AttributeSet& attributes) {
    Behaviour behaviour{.key = model.key, .name = model.name, .category = found_category(attributes)};
    behaviour.is_furniture = attributes.word("placement", "") == "floor";

    // At rest.
    const auto standing = stage_of(catalog, model.key, 0, {});
    if (!standing) return standing.error();
    behaviour.mass = {attributes.number("mass", 0), moving_mass(standing->world())};
    if (standing->body.is_null()) {  // neither slides nor bounces as a block does
        standing->run(5);
        behaviour.speed = length(standing->world().conserved().linear_momentum) / behaviour.mass.measured;
        return behaviour;
    }
    const double placed = standing->center().y;
    standing->run(5);
    behaviour.tilt = standing->tilt();
    behaviour.speed = length(standing->world().linear_velocity(standing->body));
    if (!is_upright(*standing) || is_round(attributes.word("collision_shape", ""))) return behaviour;

    // One model is pushed, another dropped.
    const double extent = std::max({model.size.x, model.size.y, model.size.z});
    const auto floor = standing->simulation->attributes(1);
    if (!floor) return floor.error();
    const OnFloor expected = on_floor(catalog.taxonomy(), attributes, *floor);
    const auto pushed = stage_of(catalog, model.key, 0, {push_speed, 0, 0});
    if (!pushed) return pushed.error();
    behaviour.slide = slide_of(*pushed, extent, expected.friction, attributes);
    // A bottom that is not flat touches the floor before the model is at rest: then the height of the rebound says
    // little.
    if (std::abs(standing->center().y - placed) > 2e-4 || standing->tilt() > 0.05) return behaviour;
    const auto dropped = stage_of(catalog, model.key, drop_height, {});
    if (!dropped) return dropped.error();
    behaviour.rebound = rebound_of(*dropped, extent, standing->center().y, expected.restitution);
    return behaviour;
}

template <class Judged, class Wrong>
BehaviourEvaluation::Verdict verdict(const std::vector<Behaviour>& models, Judged judged, Wrong wrong) {
    BehaviourEvaluation::Verdict result;
    for (const Behaviour& model : models) {
        if (!judged(model)) continue;
        ++result.judged;
        if (wrong(model)) result.wrong.push_back(&model);
    }
    return result;
}

bool always(const Behaviour& /*model*/) { return true; }

}  // namespace

BehaviourEvaluation::Verdict BehaviourEvaluation::masses() const {
    return verdict(models, always, [](const Behaviour& m) {
        return std::abs(m.mass.measured - m.mass.expected) > 1e-9 * m.mass.expected;
    });
}

BehaviourEvaluation::Verdict BehaviourEvaluation::resting() const {
    return verdict(models, always, [](const Behaviour& m) { return m.speed > 0.01; });
}

BehaviourEvaluation::Verdict BehaviourEvaluation::furniture() const {
    return verdict(
        models, [](const Behaviour& m) { return m.is_furniture; }, [](const Behaviour& m) { return m.tilt > 5; });
}

BehaviourEvaluation::Verdict BehaviourEvaluation::slides() const {
    return verdict(
        models, [](const Behaviour& m) { return m.slide.has_value(); },
        [](const Behaviour& m) { return std::abs(m.slide->measured / m.slide->expected - 1) > 0.05; });
}

BehaviourEvaluation::Verdict BehaviourEvaluation::rebounds() const {
    return verdict(
        models, [](const Behaviour& m) { return m.rebound.has_value(); },
        [](const Behaviour& m) { return std::abs(m.rebound->measured - m.rebound->expected) > 0.03; });
}

Result<BehaviourEvaluation> evaluate_behaviour(catalog::Catalog& catalog, std::size_t limit,
                                               const std::function<void(std::size_t, std::size_t)>& progress) {
    BehaviourEvaluation evaluation;
    catalog::SearchQuery query{.limit = 1000};
    for (std::size_t done = 0;; query.offset += query.limit) {
        const auto page = catalog.search(query);
        if (!page) return page.error();
        const std::size_t total =
            limit > 0 ? std::min(limit, static_cast<std::size_t>(page->total)) : static_cast<std::size_t>(page->total);
        for (const catalog::ModelSummary& model : page->models) {
            if (done == total) return evaluation;
            if (progress) progress(++done, total);
            const auto attributes = catalog.attributes(model.id);
            if (!attributes) return attributes.error();
            const PhysicalKind kind = kind_of(*attributes);
            if (is_static(kind) || traits_of(kind).matter == attributes::Matter::none) continue;
            auto behaviour = behaviour_of(catalog, model, *attributes);
            if (behaviour)
                evaluation.models.push_back(std::move(*behaviour));
            else
                evaluation.failures.emplace_back(model.key, behaviour.error());
        }
        if (page->models.empty()) return evaluation;
    }
}

}  // namespace embody::evaluation
