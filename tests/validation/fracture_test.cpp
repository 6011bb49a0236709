// SPDX-License-Identifier: MIT
// Brittle bodies break by blows that are hard enough, and nothing comes of nothing: mass, momenta and energy.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "foundation/random.h"
#include "make_world.h"

namespace embody::physics {
namespace {

Vec3 random_vector(Random& random, double size) {
    return {random.between(-size, size), random.between(-size, size), random.between(-size, size)};
}

ShapeDefinition random_solid(Random& random) {
    const double size = random.between(0.05, 0.5), thin = size * random.between(0.1, 1);
    switch (random.below(5)) {
        case 0:
            return BoxShape{{size, thin, size * 0.8}};
        case 1:
            return CylinderShape{size, thin};
        case 2:
            return SphereShape{size};
        case 3:
            return CompoundShape{{{BoxShape{{size, thin / 2, thin / 2}}, {}},
                                  {BoxShape{{thin / 2, size, thin / 2}}, {{size - thin / 2, size + thin / 2, 0}, {}}}}};
        default: {
            HullShape hull;
            for (int i = 0; i < 20; ++i) hull.points.push_back(random_vector(random, size));
            return hull;
        }
    }
}

BodyHandle add(World& world, const ShapeDefinition& shape, BodyDefinition body) {
    body.shape = world.create_shape(shape).value();
    const auto made = world.create_body(body);
    EXPECT_TRUE(made.ok()) << (made.ok() ? "" : made.error().message());
    return made.value();
}

/// Two bodies in empty space that fly at each other; the first is brittle, the second in half of the scenes.
struct Collision {
    std::unique_ptr<World> world;
    std::vector<BodyBreakEvent> breaks;

    /// `limit`: of the blow's energy, J.
    Collision(std::uint64_t seed, double limit, int workers = 1, int lanes = 0) {
        Random random(seed);
        world = make_world({.gravity = {}, .workers = workers, .lanes = lanes});
        const double speed = std::pow(10, random.between(-0.5, 1.3));
        const double restitution = random.below(2) == 0 ? 0 : random.between(0, 0.8);
        for (int i = 0; i < 2; ++i) {
            BodyDefinition body{.position = {i * 2.5, random.between(-0.1, 0.1), 0},
                                .rotation = normalized(Quat{random.unit(), random.unit(), random.unit(), 1}),
                                .linear_velocity = {(i == 0 ? 1 : -1) * speed, 0, 0},
                                .angular_velocity = random_vector(random, 3),
                                .mass = {.density = random.between(500, 3000)},
                                .material = {.restitution = restitution}};
            const double fracture_energy = random.between(1, 50);
            if (i == 0 || random.below(2) == 0)
                body.brittleness = Brittleness{.break_energy = limit, .fracture_energy = fracture_energy};
            add(*world, random_solid(random), body);
        }
    }

    void step() {
        world->step();
        breaks.assign(world->body_break_events().begin(), world->body_break_events().end());
    }
};

// Beside a twin in which nothing breaks: of the same step, so that it is the break alone that is measured.
TEST(Fracture, KeepsMomentaAndPaysForItsCracks) {
    int broken = 0;
    double momentum_error = 0, angular_error = 0, least_left = 1;
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        Collision collision(seed, 0.01), twin(seed, 1e9);
        const double energy = collision.world->conserved().kinetic_energy;
        for (int i = 0; i < 240 && collision.breaks.empty(); ++i) {
            collision.step();
            twin.step();
        }
        if (collision.breaks.empty()) continue;
        ++broken;
        double paid = 0;
        for (const BodyBreakEvent& event : collision.breaks) {
            EXPECT_GE(event.pieces.size(), 2u);
            EXPECT_FALSE(collision.world->contains(event.body));
            EXPECT_GT(event.crack_area, 0);
            const double fracture_energy = twin.world->body(event.body)->brittleness->fracture_energy;
            paid += event.crack_area * fracture_energy;
        }
        const Conserved now = collision.world->conserved(), whole = twin.world->conserved();
        EXPECT_LE(now.kinetic_energy, energy * (1 + 1e-9) - paid) << seed;
        least_left = std::min(least_left, (energy - paid - now.kinetic_energy) / energy);
        // The sum of the momenta is small beside that of each body.
        double momentum = 0;
        for (const BodyHandle body : twin.world->bodies())
            momentum += twin.world->mass(body) * length(twin.world->linear_velocity(body));
        momentum_error = std::max(momentum_error, length(now.linear_momentum - whole.linear_momentum) / momentum);
        angular_error = std::max(angular_error, length(now.angular_momentum - whole.angular_momentum) / momentum);
    }
    RecordProperty("broken", broken);
    RecordProperty("momentum_error", std::to_string(momentum_error * 1e12) + "e-12");
    RecordProperty("angular_error", std::to_string(angular_error * 1e12) + "e-12");
    RecordProperty("least_energy_left", std::to_string(least_left));
    EXPECT_GT(broken, 50);
    EXPECT_LT(momentum_error, 1e-12);
    EXPECT_LT(angular_error, 1e-12);
}

// The break alone: what the pieces are beside the body that they were, by a twin of the world in which nothing breaks.
TEST(Fracture, PiecesHaveMassMomentumAndSpinOfTheBody) {
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        Random random(seed);
        const auto world = make_world({.gravity = {}});
        const ShapeDefinition shape = random_solid(random);
        const BodyHandle body = add(*world, shape,
                                    {.position = {0, 1, 0},
                                     .angular_velocity = random_vector(random, 2),
                                     .brittleness = Brittleness{.break_energy = 1e-3, .fracture_energy = 0.1}});
        const double mass = world->mass(body);
        add(*world, SphereShape{0.1}, {.position = {-2, 1, 0}, .linear_velocity = {20, 0, 0}, .mass = {.mass = mass}});
        std::vector<BodyBreakEvent> events;
        for (int i = 0; i < 60 && events.empty(); ++i) {
            world->step();
            events.assign(world->body_break_events().begin(), world->body_break_events().end());
        }
        if (events.empty()) continue;  // missed
        double sum = 0;
        Vec3 momentum;
        for (const BodyHandle piece : events[0].pieces) {
            sum += world->mass(piece);
            momentum += world->mass(piece) * world->linear_velocity(piece);
        }
        EXPECT_NEAR(sum, mass, 1e-12 * mass) << seed;
        // All turn as one: no piece moves against the others at the break.
        const Vec3 spin = world->angular_velocity(events[0].pieces[0]);
        const Vec3 center = world->center_of_mass(events[0].pieces[0]);
        const Vec3 velocity = world->linear_velocity(events[0].pieces[0]);
        for (const BodyHandle piece : events[0].pieces) {
            EXPECT_LT(length(world->angular_velocity(piece) - spin), 1e-9);
            const Vec3 carried = velocity + cross(spin, world->center_of_mass(piece) - center);
            EXPECT_LT(length(world->linear_velocity(piece) - carried), 1e-9);
        }
    }
}

TEST(Fracture, HasEqualBitsForAnyWorkersAndLanes) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        std::optional<std::uint64_t> hash;
        for (const auto& [workers, lanes] : {std::pair{1, 0}, {2, 0}, {4, 0}, {3, 4}}) {
            Collision collision(seed, 0.01, workers, lanes);
            for (int i = 0; i < 120; ++i) collision.step();
            if (!hash) hash = collision.world->state_hash();
            EXPECT_EQ(collision.world->state_hash(), *hash) << seed << ", " << workers << " workers, " << lanes;
        }
    }
}

/// A plate of 0.4 m and 10 mm that falls flat on stone with `speed`; its breaks.
std::vector<BodyBreakEvent> dropped_plate(double speed, const Brittleness& brittleness, double restitution = 0.3) {
    const auto world = make_world();
    add(*world, PlaneShape{}, {.kind = BodyKind::static_body, .material = {.restitution = restitution}});
    add(*world, BoxShape{{0.2, 0.005, 0.2}},
        {.position = {0, 0.1, 0}, .linear_velocity = {0, -speed, 0}, .mass = {.mass = 1}, .brittleness = brittleness});
    std::vector<BodyBreakEvent> breaks;
    for (int i = 0; i < 120; ++i) {
        world->step();
        for (const BodyBreakEvent& event : world->body_break_events()) breaks.push_back(event);
        if (!breaks.empty()) break;
    }
    return breaks;
}

// The impulse of the blow is m v (1 + e), its energy m v²/2.
TEST(Fracture, ComesAtItsLimitsOfImpulseAndEnergy) {
    const double landing = std::sqrt(4 + 2 * 9.81 * 0.095);  // m/s, of one that starts with 2 m/s
    for (const double fraction : {0.9, 1.1}) {
        const double impulse = landing * 1.3 / fraction, energy = landing * landing / 2 / fraction;
        EXPECT_EQ(dropped_plate(2, {.break_impulse = impulse}).empty(), fraction < 1) << fraction;
        EXPECT_EQ(dropped_plate(2, {.break_energy = energy}).empty(), fraction < 1) << fraction;
    }
    const auto breaks = dropped_plate(2, {.break_impulse = 1});
    ASSERT_EQ(breaks.size(), 1u);
    EXPECT_NEAR(breaks[0].impulse, landing * 1.3, 1.01 * 9.81 / 60) << "the speed is that at the start of the step";
    EXPECT_NEAR(breaks[0].energy, landing * landing / 2, 0.05 * landing * landing);
}

TEST(Fracture, NeedsTheEnergyOfItsCracks) {
    EXPECT_FALSE(dropped_plate(2, {.break_impulse = 1, .fracture_energy = 100}).empty());
    EXPECT_TRUE(dropped_plate(2, {.break_impulse = 1, .fracture_energy = 1e5}).empty()) << "2 J for 0.004 m² at least";
    EXPECT_TRUE(dropped_plate(2, {.break_impulse = 1}, 1).empty()) << "an elastic bounce loses nothing";
}

TEST(Fracture, ALoadIsNoBlow) {
    const auto world = make_world();
    add(*world, PlaneShape{}, {.kind = BodyKind::static_body});
    const BodyHandle plate = add(*world, BoxShape{{0.2, 0.005, 0.2}},
                                 {.position = {0, 0.005, 0}, .brittleness = Brittleness{.break_impulse = 0.5}});
    add(*world, BoxShape{{0.2, 0.2, 0.2}}, {.position = {0, 0.2101, 0}, .mass = {.mass = 100}});
    for (int i = 0; i < 300; ++i) world->step();
    EXPECT_TRUE(world->contains(plate)) << "100 kg are 16 N s a step";
}

// A ball of 2 kg flies through a pane that breaks at 1 N s: it loses little more than that.
TEST(Fracture, TakesNoMoreThanItBearsFromWhatFliesThrough) {
    const auto world = make_world({.gravity = {}});
    add(*world, BoxShape{{0.4, 0.4, 0.003}},
        {.mass = {.density = 2500}, .brittleness = Brittleness{.break_impulse = 1, .max_pieces = 24}});
    const BodyHandle ball = add(*world, SphereShape{0.06},
                                {.position = {0.05, 0.03, -0.5}, .linear_velocity = {0, 0, 10}, .mass = {.mass = 2}});
    std::size_t breaks = 0;
    for (int i = 0; i < 30; ++i) {
        world->step();
        breaks += world->body_break_events().size();
    }
    EXPECT_GE(breaks, 1u);
    EXPECT_GT(world->linear_velocity(ball).z, 7) << "as one body the pane of 2.4 kg would leave it 4.5 m/s";
}

TEST(Fracture, EndsWithABoundedNumberOfPieces) {
    for (const int max_pieces : {2, 8, 40}) {
        const auto world = make_world();
        add(*world, PlaneShape{}, {.kind = BodyKind::static_body});
        add(*world, BoxShape{{0.1, 0.1, 0.1}},
            {.position = {0, 0.5, 0},
             .linear_velocity = {0, -30, 0},
             .brittleness = Brittleness{.break_energy = 0.01, .fracture_energy = 0.1, .max_pieces = max_pieces}});
        double energy = world->conserved().kinetic_energy + world->conserved().potential_energy;
        const double allowed = 1e-5 * energy;
        for (int i = 0; i < 240; ++i) {
            world->step();
            const Conserved sum = world->conserved();
            const double now = sum.kinetic_energy + sum.potential_energy;
            EXPECT_LE(now, energy + allowed) << i;
            energy = now;
        }
        EXPECT_LE(world->bodies().size(), static_cast<std::size_t>(2 * max_pieces + 1));
        EXPECT_GE(world->bodies().size(), 3u);
        for (const BodyHandle body : world->bodies()) EXPECT_GT(world->center_of_mass(body).y, -0.01);
    }
}

// Its slivers would be lighter than a body can be.
TEST(Fracture, ALightThingBreaksOrKeepsItsBounce) {
    for (const double mass : {0.001, 0.02}) {
        for (std::uint64_t seed = 0; seed < 4; ++seed) {
            Random random(seed);
            const auto world = make_world();
            add(*world, PlaneShape{}, {.kind = BodyKind::static_body});
            const BodyHandle body =
                add(*world, SphereShape{0.02},
                    {.position = {0, 0.05, 0},
                     .linear_velocity = {random.between(-1, 1), -5, 0},
                     .mass = {.mass = mass},
                     .brittleness = Brittleness{.break_energy = 1e-6, .fracture_energy = 0.1, .max_pieces = 100}});
            for (int i = 0; i < 30; ++i) world->step();
            EXPECT_FALSE(world->body(body)) << mass << " " << seed;
            for (const BodyHandle each : world->bodies()) EXPECT_GT(world->center_of_mass(each).y, -0.02);
        }
    }
}

// Across its teeth a comb falls apart into more pieces than are allowed.
TEST(Fracture, ACombHasNoMorePiecesThanAllowed) {
    CompoundShape comb{{{BoxShape{{0.5, 0.02, 0.01}}, {{0, 0.1, 0}, {}}}}};
    for (int tooth = 0; tooth < 40; ++tooth)
        comb.children.push_back({BoxShape{{0.005, 0.09, 0.01}}, {{-0.49 + 0.025 * tooth, 0, 0}, {}}});
    const auto world = make_world();
    add(*world, PlaneShape{}, {.kind = BodyKind::static_body});
    add(*world, comb,
        {.position = {0, 0.5, 0},
         .rotation = from_axis_angle({1, 0, 0}, 1.5),
         .linear_velocity = {0, -10, 0},
         .brittleness = Brittleness{.break_energy = 0.01, .fracture_energy = 0.1, .max_pieces = 4}});
    for (int i = 0; i < 60; ++i) {
        world->step();
        for (const BodyBreakEvent& event : world->body_break_events()) EXPECT_LE(event.pieces.size(), 4u);
    }
}

TEST(Fracture, ShapesOfPiecesThatBreakAgainAreGone) {
    const auto world = make_world();
    add(*world, PlaneShape{}, {.kind = BodyKind::static_body});
    add(*world, BoxShape{{0.1, 0.1, 0.1}},
        {.position = {0, 0.5, 0},
         .linear_velocity = {0, -30, 0},
         .brittleness = Brittleness{.break_energy = 0.01, .fracture_energy = 0.1, .max_pieces = 40}});
    std::map<std::uint32_t, ShapeHandle> shapes;  // of pieces, by slot
    int again = 0;
    for (int i = 0; i < 120; ++i) {
        world->step();
        for (const BodyBreakEvent& event : world->body_break_events()) {
            if (const auto known = shapes.find(event.body.index); known != shapes.end()) {
                ++again;
                EXPECT_EQ(world->shape(known->second), nullptr);
                shapes.erase(known);
            }
        }
        for (const BodyBreakEvent& event : world->body_break_events())
            for (const BodyHandle piece : event.pieces)
                if (const auto body = world->body(piece)) shapes[piece.index] = body->shape;
    }
    EXPECT_GT(again, 0);
}

TEST(Fracture, TheShapeOfAPieceIsTold) {
    const auto world = make_world();
    add(*world, PlaneShape{}, {.kind = BodyKind::static_body});
    add(*world, BoxShape{{0.1, 0.1, 0.1}},
        {.position = {0, 0.3, 0},
         .linear_velocity = {0, -10, 0},
         .brittleness = Brittleness{.break_energy = 1},
         .user_data = 9});
    for (int i = 0; i < 60 && world->body_break_events().empty(); ++i) world->step();
    ASSERT_EQ(world->body_break_events().size(), 1u);
    const BodyBreakEvent event = world->body_break_events()[0];
    EXPECT_EQ(event.user_data, 9u);
    for (const BodyHandle piece : event.pieces) {
        const BodyDefinition body = world->body(piece).value();
        EXPECT_EQ(body.user_data, 9u);
        const ShapeDefinition* shape = world->shape(body.shape);
        ASSERT_NE(shape, nullptr);
        EXPECT_TRUE(std::holds_alternative<HullShape>(*shape));
        ASSERT_TRUE(world->destroy_body(piece));
        EXPECT_TRUE(world->destroy_shape(body.shape));
        EXPECT_EQ(world->shape(body.shape), nullptr);
    }
    world->step();
    EXPECT_TRUE(world->body_break_events().empty());
}

}  // namespace
}  // namespace embody::physics
