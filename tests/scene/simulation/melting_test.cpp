// SPDX-License-Identifier: MIT
// Things that melt and liquids that freeze (docs/physics/melting.md): what the change keeps, over random things.
#include <algorithm>
#include <bit>

#include "scene/simulation/melting.h"

namespace embody::scene {
namespace {

using namespace samples;

// A thing in free flight along +X.
Entity& add_flying(Document& document, Random& random, int run) {
    Entity& thing = samples::add(document, "Thing", any_shape(random, run), any_vector(random, 2));
    thing.pose.rotation = any_rotation(random);
    thing.linear_velocity = any_vector(random, 3);
    thing.linear_velocity.x = random.between(0.5, 3);
    thing.angular_velocity = any_vector(random, 8);
    thing.attributes["density"] = random.between(200, 3000);
    document.settings.gravity = {};
    return thing;
}

// The least kinetic energy of particles there with these momenta: that of one rigid body.
double least_energy(const Drops& drops, const Momenta& momenta) {
    const ParticleMoments moments = moments_of(drops.places, drops.mass);
    const Vec3 angular = angular_about(momenta, moments.mean);
    const double mass = drops.mass * static_cast<double>(drops.places.size());
    return (dot(momenta.linear, momenta.linear) / mass + dot(angular, solve(moments.inertia, angular))) / 2;
}

// To rounding: 1e-9, or where the drops are few that of a single one's velocity.
void expect_same_momenta(const Momenta& before, const Momenta& after, const Drops& drops, int run) {
    double fastest = 0, farthest = 0;
    for (std::size_t i = 0; i < drops.places.size(); ++i) {
        fastest = std::max(fastest, length(drops.velocities[i]));
        farthest = std::max(farthest, distance(drops.places[i], before.center));
    }
    const double rounding = std::exp2(-24) * drops.mass * fastest;
    EXPECT_LT(distance(after.linear, before.linear), 1e-9 * length(before.linear) + rounding) << run;
    EXPECT_LT(distance(angular_about(after, before.center), before.angular),
              1e-9 * length(before.angular) + rounding * farthest)
        << run;
}

TEST(Melting, AloneKeepsMassAndMomentaAndNoMoreEnergyThanThatTakes) {
    Random random(1);
    for (int run = 0; run < 30; ++run) {
        Document document;
        const EntityIndex thing = add_flying(document, random, run).index;
        const auto stays = make(document);
        document.actions = {at_third_step(document, thing, Melt{})};
        const auto melts = make(document);
        ASSERT_TRUE(melts && stays);
        step(*melts, 3);
        step(*stays, 3);
        ASSERT_TRUE(melts->problems().empty()) << run << melts->problems().front().message();
        ASSERT_EQ(melts->spawned().size(), 1u) << run;
        EXPECT_EQ(melts->despawned(), std::vector<EntityIndex>{thing});
        const Momenta before = momenta_of_body(*stays, thing);
        const Drops drops = drops_of(*melts, melts->spawned()[0]);
        const Momenta after = drops.momenta();
        EXPECT_NEAR(after.mass / before.mass, 1, 1e-12) << run;
        expect_same_momenta(before, after, drops, run);
        EXPECT_LT(drops.energy(), least_energy(drops, before) * (1 + 1e-6)) << run;
        // Drops at the surface are nearer to the axis than the matter that they stand for.
        EXPECT_NEAR(drops.energy() / energy_of_body(*stays, thing), 1, 3e-3) << run;
        EXPECT_LT(distance(after.center, before.center), 1e-3) << run;
    }
}

TEST(Melting, SoftThingsKeepTheirsWithTheirDeformation) {
    Random random(2);
    for (int run = 0; run < 6; ++run) {
        Document document;
        Entity& thing = add_flying(document, random, run % 2);
        thing.attributes = {{"kind", to_value(attributes::PhysicalKind::soft)},
                            {"mass", random.between(0.5, 2)},
                            {"youngs_modulus", random.between(1e4, 1e5)}};
        const EntityIndex index = thing.index;
        const auto stays = make(document);
        document.actions = {at_third_step(document, index, Melt{})};
        const auto melts = make(document);
        ASSERT_TRUE(melts && stays);
        step(*melts, 3);
        step(*stays, 3);
        ASSERT_TRUE(melts->problems().empty()) << run << melts->problems().front().message();
        ASSERT_EQ(melts->spawned().size(), 1u) << run;
        const MovingPoints& soft = *stays->points(index);
        const Momenta after = drops_of(*melts, melts->spawned()[0]).momenta();
        EXPECT_NEAR(after.mass / soft.mass(), 1, 1e-12) << run;
        EXPECT_LT(distance(after.linear, soft.mass() * soft.linear_velocity()), 1e-9 * length(after.linear)) << run;
        EXPECT_LT(distance(after.center, soft.center_of_mass()), 2e-3) << run;
    }
}

// A tub of water with a thing in the air over it that melts at once into the water.
Document over_water(Random& random, int run, Vec3 thing_at) {
    Document document = tub();
    add_water(document, 0.1, false, 4000);
    Entity& thing = samples::add(document, "Thing", any_shape(random, run), thing_at);
    thing.pose.rotation = any_rotation(random);
    thing.linear_velocity = {random.between(0.3, 0.6), random.between(-0.5, 0.5), random.between(-0.5, 0.5)};
    thing.angular_velocity = any_vector(random, 8);
    thing.attributes["density"] = random.between(500, 1200);
    return document;
}
constexpr EntityIndex water_index = 7, thing_index = 8;

TEST(Melting, IntoALiquidKeepsMomentaAndMassToADrop) {
    Random random(3);
    for (int run = 0; run < 12; ++run) {
        Document document = over_water(random, run, {0, 0.5, 0});
        const auto stays = make(document);
        document.actions = {at_third_step(document, thing_index, Melt{water_index})};
        const auto melts = make(document);
        ASSERT_TRUE(melts && stays);
        step(*melts, 3);
        step(*stays, 3);
        ASSERT_TRUE(melts->problems().empty()) << run << melts->problems().front().message();
        EXPECT_TRUE(melts->spawned().empty());
        const Momenta before = momenta_of_body(*stays, thing_index);
        const Drops drops = drops_of(*melts, water_index, points_of(*stays, water_index).size());
        EXPECT_NEAR(drops.momenta().mass, before.mass, drops.mass / 2 * (1 + 1e-9)) << run;
        expect_same_momenta(before, drops.momenta(), drops, run);
        EXPECT_LT(drops.energy(), least_energy(drops, before) * (1 + 1e-6)) << run;
    }
}

// What each lacks of whole drops is owed to the next.
TEST(Melting, ManyThingsIntoALiquidAreItsMassToADrop) {
    Random random(4);
    Document document = tub();
    add_water(document, 0.05, false, 6000);
    for (int i = 0; i < 20; ++i) {
        const Vec3 at{0.07 * (i % 5) - 0.14, 0.2 + 0.1 * (i / 10), 0.08 * (i / 5 % 2) - 0.04};
        samples::add(document, "Ice", physics::BoxShape{{0.02, 0.02, random.between(0.015, 0.025)}}, at);
    }
    document.actions.push_back(
        {.id = 1, .receiver = {Target::By::name, 0, "Ice"}, .trigger = AtTime{0.05, {}}, .effect = Melt{water_index}});
    const auto simulation = make(document);
    ASSERT_TRUE(simulation);
    const double at_first = simulation->points(water_index)->mass();
    const double drop = at_first / static_cast<double>(points_of(*simulation, water_index).size());
    double mass = 0;
    for (EntityIndex index = water_index + 1; index <= water_index + 20; ++index)
        mass += momenta_of_body(*simulation, index).mass;
    step(*simulation, 10);
    EXPECT_TRUE(simulation->problems().empty());
    EXPECT_EQ(simulation->entities().size(), 7u);
    EXPECT_NEAR(simulation->points(water_index)->mass(), at_first + mass, drop / 2 * (1 + 1e-9));
}

// Kinetic and potential, J.
double energy_of_all(const Simulation& simulation) {
    double energy = 0;
    for (const EntityIndex index : simulation.entities()) {
        if (simulation.points(index)) {
            const Drops drops = drops_of(simulation, index);
            energy += drops.energy();
            for (const Vec3 at : drops.places) energy += drops.mass * 9.81 * at.y;
        } else if (index == thing_index) {
            const Momenta momenta = momenta_of_body(simulation, index);
            energy += energy_of_body(simulation, index) + momenta.mass * 9.81 * momenta.center.y;
        }
    }
    return energy;
}

// Things that stand in the corner of a tub, dry or in water: no drop comes into being in a wall, none goes through one,
// and the energy never rises.
TEST(Melting, LeavesDropsWithinWallsAndGivesNoEnergy) {
    Random random(5);
    for (int run = 0; run < 6; ++run) {
        const bool in_water = run % 2 == 1;
        Document document = over_water(random, 0, {0, 0.2, 0});
        Entity& thing = *document.find(thing_index);
        const Vec3 half{random.between(0.03, 0.1), random.between(0.03, 0.1), random.between(0.03, 0.1)};
        thing.geometry = physics::ShapeDefinition{physics::BoxShape{half}};
        thing.pose = {{0.2 - half.x - 1e-4, half.y + 1e-4, 0.2 - half.z - 1e-4}, {}};
        thing.linear_velocity = thing.angular_velocity = {};
        thing.attributes["density"] = random.between(500, 998);
        if (!in_water) document.entities.erase(document.entities.begin() + (water_index - 1));
        document.actions = {{.id = 1,
                             .receiver = {Target::By::index, thing_index, {}},
                             .trigger = AtTime{0.5, {}},
                             .effect = Melt{in_water ? water_index : 0}}};
        const auto simulation = make(document);
        ASSERT_TRUE(simulation);
        double before = 0, farthest = 0, highest = 0;
        for (int i = 0; i < 70; ++i) {
            if (simulation->contains(thing_index)) before = energy_of_all(*simulation);
            simulation->step();
            ASSERT_TRUE(simulation->problems().empty()) << simulation->problems().front().message();
            if (simulation->contains(thing_index)) continue;
            highest = std::max(highest, energy_of_all(*simulation));
            for (const EntityIndex index : simulation->entities())
                for (const Vec3 at : points_of(*simulation, index))
                    farthest = std::max({farthest, std::fabs(at.x) - 0.2, std::fabs(at.z) - 0.2, -at.y});
        }
        // What moves at a wall is taken out of it in the next part of a step.
        EXPECT_LT(farthest, 3e-3) << run;
        EXPECT_LT(highest, before) << run;
    }
}

TEST(Melting, GivesTheSameBitsWithAnyWorkers) {
    std::vector<Vec3> first;
    for (const int workers : {1, 2, 3}) {
        Random random(6);
        Document document = over_water(random, 5, {0, 0.25, 0});
        document.settings.workers = workers;
        document.actions = {{.id = 1,
                             .receiver = {Target::By::index, thing_index, {}},
                             .trigger = AtTime{0.1, {}},
                             .effect = Melt{water_index}},
                            {.id = 2,
                             .receiver = {Target::By::index, water_index, {}},
                             .trigger = AtTime{0.4, {}},
                             .effect = Freeze{}}};
        const auto simulation = make(document);
        ASSERT_TRUE(simulation);
        step(*simulation, 20);
        std::vector<Vec3> places = points_of(*simulation, water_index);
        EXPECT_GT(places.size(), 3000u);
        step(*simulation, 20);
        for (const EntityIndex index : simulation->entities()) places.push_back(simulation->pose(index).position);
        if (first.empty()) first = places;
        EXPECT_TRUE(places == first) << workers;
    }
}

TEST(Melting, TellsWhatCannotMeltOrFreezeByItsField) {
    const auto problem = [](auto change, Effect effect) {
        Random random(7);
        Document document = over_water(random, 0, {0, 0.5, 0});
        document.actions = {{.id = 1,
                             .name = "a",
                             .receiver = {Target::By::index, thing_index, {}},
                             .trigger = AtTime{0, {}},
                             .effect = effect}};
        change(document, *document.find(thing_index));
        const auto simulation = make(document);
        if (!simulation) return std::string("not made");
        simulation->step();
        const std::size_t there = document.entities.size();
        if (simulation->problems().empty()) return std::string();
        EXPECT_EQ(simulation->entities().size(), there);
        return simulation->problems().front().message();
    };
    const auto contains = [](const std::string& text, const std::string& part) {
        EXPECT_NE(text.find(part), std::string::npos) << text;
    };
    const auto as = [](attributes::PhysicalKind kind) {
        return [kind](Document&, Entity& thing) { thing.attributes["kind"] = to_value(kind); };
    };
    const auto nothing = [](Document&, Entity&) {};
    EXPECT_EQ(problem(nothing, Melt{}), "");
    EXPECT_EQ(problem(nothing, Melt{water_index}), "");
    contains(problem(nothing, Melt{99}), "effect.into: is entity 99, which is not there");
    contains(problem(nothing, Melt{1}), "effect.into: is entity 1 (Ground), which is no liquid");
    contains(problem([](Document& all, Entity&) { all.find(water_index)->enabled = false; }, Melt{water_index}),
             "which is not enabled");
    contains(problem(as(attributes::PhysicalKind::static_body), Melt{}),
             "entity 8 (Thing): attributes.kind: is static");
    contains(problem(as(attributes::PhysicalKind::granular), Melt{}), "attributes.kind: is granular");
    contains(problem(as(attributes::PhysicalKind::fluid), Melt{water_index}), "attributes.kind: is fluid");
    contains(problem([](Document&, Entity& thing) { thing.enabled = false; }, Melt{}), "(Thing): enabled: is false");
    contains(
        problem([](Document& all, Entity&) { all.joints.push_back({.index = 1, .entity_b = thing_index}); }, Melt{}),
        "(Thing): joints: hold it, such as joint 1");
    const auto pin_to_it = [](Document& all, Entity&) {
        Entity& cloth = samples::add(all, "Cloth", physics::BoxShape{{0.1, 0.001, 0.1}}, {0, 0.7, 0});
        cloth.attributes["kind"] = to_value(attributes::PhysicalKind::cloth);
        cloth.pins = {{.position = {}, .to = thing_index}};
    };
    contains(problem(pin_to_it, Melt{}), "(Thing): pins: of entity 9 (Cloth) hold on to it");
    const auto tiny = [](Document&, Entity& thing) {
        thing.geometry = physics::ShapeDefinition{physics::BoxShape{{0.2, 0.002, 0.002}}};
    };
    contains(problem(tiny, Melt{water_index}), "entity 7 (Water): attributes.fluid_cell_size: is too large");
    const auto huge = [](Document&, Entity& thing) {
        thing.geometry = physics::ShapeDefinition{physics::BoxShape{{0.19, 0.6, 0.19}}};
    };
    contains(problem(huge, Melt{water_index}), "entity 7 (Water): attributes.particle_budget: is too small");
    contains(problem([](Document&, Entity& thing) { thing.attributes["mass"] = 1e-5; }, Melt{}),
             "(Thing): attributes.mass: is wrong for a liquid");
    contains(problem(nothing, Freeze{}), "(Thing): attributes.kind: is rigid, and only liquids freeze");
}

// A liquid that flies as one or more drops, thrown and turning.
TEST(Freezing, KeepsMassAndMomentaAndNeverGainsEnergy) {
    Random random(8);
    for (int run = 0; run < 24; ++run) {
        Document document;
        Entity& liquid = add_flying(document, random, run);
        liquid.attributes = {{"kind", to_value(attributes::PhysicalKind::fluid)},
                             {"particle_budget", std::floor(random.between(300, 3000))}};
        const EntityIndex index = liquid.index;
        const auto stays = make(document);
        document.actions = {at_third_step(document, index, Freeze{})};
        const auto freezes = make(document);
        ASSERT_TRUE(freezes && stays);
        step(*freezes, 3);
        step(*stays, 3);
        ASSERT_TRUE(freezes->problems().empty()) << run << freezes->problems().front().message();
        ASSERT_FALSE(freezes->spawned().empty()) << run;
        EXPECT_FALSE(freezes->contains(index));
        const Drops drops = drops_of(*stays, index);
        Momenta before = drops.momenta(), after;
        after.center = before.center;
        double energy = 0;
        for (const EntityIndex piece : freezes->spawned()) {
            const Momenta own = momenta_of_body(*freezes, piece);
            after.mass += own.mass;
            after.linear += own.linear;
            after.angular += angular_about(own, before.center);
            energy += energy_of_body(*freezes, piece);
        }
        EXPECT_NEAR(after.mass / before.mass, 1, 1e-12) << run;
        expect_same_momenta(before, after, drops, run);
        EXPECT_LT(energy, drops.energy() * (1 + 1e-9)) << run;
    }
}

TEST(Freezing, MakesABodyOfEachPuddleWithinTheVessel) {
    Random random(9);
    for (int run = 0; run < 8; ++run) {
        Document document = tub();
        // Two puddles with a wall between them.
        add_box(document, "Middle", {0.03, 0.2, 0.2}, {0, 0.2, 0}, attributes::PhysicalKind::static_body);
        Entity& water = add_water(document, random.between(0.05, 0.12), false, 3000);
        const EntityIndex index = water.index;
        document.actions = {{.id = 1,
                             .receiver = {Target::By::index, index, {}},
                             .trigger = AtTime{random.between(0.1, 0.5), {}},
                             .effect = Freeze{}}};
        const auto simulation = make(document);
        ASSERT_TRUE(simulation);
        const double mass = simulation->points(index)->mass();
        while (simulation->contains(index)) simulation->step();
        ASSERT_TRUE(simulation->problems().empty()) << simulation->problems().front().message();
        std::vector<EntityIndex> ice = simulation->spawned();
        double frozen = 0, heaviest = 0, second = 0;
        for (const EntityIndex piece : ice) {
            const double own = momenta_of_body(*simulation, piece).mass;
            frozen += own;
            second = std::max(second, std::min(own, heaviest));
            heaviest = std::max(heaviest, own);
        }
        EXPECT_NEAR(frozen, mass, 1e-12 * mass) << run;
        EXPECT_GT(second, 0.4 * mass) << run;
        double fastest = 0;
        for (int i = 0; i < 90; ++i) {
            simulation->step();
            for (const EntityIndex piece : ice)
                fastest = std::max(fastest, length(simulation->world().linear_velocity(simulation->body(piece))));
        }
        EXPECT_LT(fastest, 0.5) << run;
        // To a tenth of a cell: drops that move are as far in walls at times, and so is their hull.
        for (const EntityIndex piece : ice) {
            const Bounds bounds = simulation->bounds(piece);
            EXPECT_GT(bounds.lower.y, -4e-3) << run;
            EXPECT_LT(std::max({-bounds.lower.x, bounds.upper.x, -bounds.lower.z, bounds.upper.z}), 0.204) << run;
        }
    }
}

}  // namespace
}  // namespace embody::scene
