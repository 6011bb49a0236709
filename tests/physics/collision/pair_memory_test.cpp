// SPDX-License-Identifier: MIT
// What a pair remembers makes it faster and changes nothing: along random motions the contacts are those of an empty
// memory, and a memory of other poses, or of another pair altogether, hides none.
#include <gtest/gtest.h>

#include <string>

#include "physics/collision/collision_probe.h"

namespace embody::physics::collision {
namespace {

struct Solid {
    const char* name;
    ShapeDefinition definition;
};

std::vector<Solid> all_shapes() {
    Random random(21);
    HullShape hull, ball;
    for (int i = 0; i < 16; ++i) hull.points.push_back(scale(random_direction(random), {0.6, 0.4, 0.5}));
    for (int i = 0; i < 120; ++i) ball.points.push_back(random_direction(random) * 0.5);
    CompoundShape pair;
    pair.children.push_back({BoxShape{{0.2, 0.2, 0.2}}, {{0.3, 0, 0}, {}}});
    pair.children.push_back({SphereShape{0.2}, {{-0.3, 0, 0}, {}}});
    return {{"sphere", SphereShape{0.4}},
            {"box", BoxShape{{0.5, 0.3, 0.2}}},
            {"capsule", CapsuleShape{0.2, 0.4}},
            {"cylinder", CylinderShape{0.4, 0.3}},
            {"cone", ConeShape{0.5, 0.4}},
            {"hull", hull},
            {"ball hull", ball},
            {"compound", pair}};
}

/// A pose that drifts and turns at random around the other shape, nearer and farther, so that it comes and goes.
class RandomMotion {
public:
    explicit RandomMotion(std::uint64_t seed) : random_(seed) {
        pose_ = {random_direction(random_) * 0.8, random_rotation(random_)};
        renew();
    }
    const Transform& next() {
        if (++steps_ % 40 == 0) renew();
        const Vec3 out = normalized(pose_.position, {1, 0, 0});
        pose_.position += drift_ + out * (0.05 * (range_ - length(pose_.position)));
        pose_.rotation = normalized(turn_ * pose_.rotation);
        return pose_;
    }

private:
    void renew() {
        range_ = random_.between(0.2, 1.5);
        drift_ = random_direction(random_) * random_.between(0, 0.03);
        turn_ = from_axis_angle(random_direction(random_), random_.between(0, 0.05));
    }
    Random random_;
    Transform pose_;
    double range_ = 0;  ///< where it is drawn to
    Vec3 drift_;
    Quat turn_;
    int steps_ = 0;
};

void expect_same(const std::vector<Manifold>& known, const std::vector<Manifold>& fresh) {
    ASSERT_EQ(known.size(), fresh.size());
    for (std::size_t m = 0; m < known.size(); ++m) {
        ASSERT_EQ(known[m].count, fresh[m].count);
        ASSERT_LT(distance(known[m].normal, fresh[m].normal), 1e-6);
        for (std::size_t i = 0; i < static_cast<std::size_t>(known[m].count); ++i) {
            ASSERT_EQ(known[m].points[i].feature, fresh[m].points[i].feature);
            ASSERT_NEAR(known[m].points[i].separation, fresh[m].points[i].separation, 1e-6);
            ASSERT_LT(distance(known[m].points[i].position, fresh[m].points[i].position), 1e-5);
        }
    }
}

class PairMemoryOf : public testing::TestWithParam<int> {};

TEST_P(PairMemoryOf, changes_no_contact_along_a_motion) {
    const auto shapes = all_shapes();
    const auto a = make_shape(shapes[static_cast<std::size_t>(GetParam())].definition);
    for (std::size_t other = 0; other < shapes.size(); ++other) {
        const auto b = make_shape(shapes[other].definition);
        RandomMotion motion(40 + other);
        PairMemory memory;
        int met = 0, parted = 0;
        for (int step = 0; step < 600; ++step) {
            SCOPED_TRACE(std::string(shapes[other].name) + ", step " + std::to_string(step));
            const Transform pose = motion.next();
            std::vector<Manifold> known;
            collide(*a, {}, *b, pose, 0.02, memory, known);
            expect_same(known, contacts(*a, {}, *b, pose, 0.02));
            (known.empty() ? parted : met) += 1;
        }
        // The motion tells nothing unless the pair comes and goes.
        EXPECT_GT(met, 10) << shapes[other].name;
        EXPECT_GT(parted, 10) << shapes[other].name;
    }
}

TEST_P(PairMemoryOf, of_another_time_hides_no_contact) {
    const auto shapes = all_shapes();
    const auto a = make_shape(shapes[static_cast<std::size_t>(GetParam())].definition);
    Random random(5);
    for (const Solid& solid : shapes) {
        const auto b = make_shape(solid.definition);
        PairMemory memory;
        for (int trial = 0; trial < 300; ++trial) {
            SCOPED_TRACE(std::string(solid.name) + ", trial " + std::to_string(trial));
            const Transform pose{random_direction(random) * random.between(0.2, 1.2), random_rotation(random)};
            std::vector<Manifold> known;
            collide(*a, {}, *b, pose, 0.01, memory, known);
            expect_same(known, contacts(*a, {}, *b, pose, 0.01));
        }
    }
}

// Whatever bits a memory holds, even those of a pair with far more features.
TEST_P(PairMemoryOf, of_a_stranger_does_no_harm) {
    const auto shapes = all_shapes();
    const auto a = make_shape(shapes[static_cast<std::size_t>(GetParam())].definition);
    Random random(6);
    for (const Solid& solid : shapes) {
        const auto b = make_shape(solid.definition);
        for (int trial = 0; trial < 100; ++trial) {
            SCOPED_TRACE(std::string(solid.name) + ", trial " + std::to_string(trial));
            PairMemory memory;
            memory.axis = random_direction(random);
            memory.kind = static_cast<PairMemory::Kind>(random.below(5));
            memory.feature_a = static_cast<std::uint16_t>(random.below(65536));
            memory.feature_b = static_cast<std::uint16_t>(random.below(65536));
            const Transform pose{random_direction(random) * random.between(0.2, 1.2), random_rotation(random)};
            std::vector<Manifold> known;
            collide(*a, {}, *b, pose, 0.01, memory, known);
            expect_same(known, contacts(*a, {}, *b, pose, 0.01));
        }
    }
}

INSTANTIATE_TEST_SUITE_P(EachWithAll, PairMemoryOf, testing::Range(0, 8), [](const auto& chosen) {
    std::string name = all_shapes()[static_cast<std::size_t>(chosen.param)].name;
    std::erase(name, ' ');
    return name;
});

}  // namespace
}  // namespace embody::physics::collision
