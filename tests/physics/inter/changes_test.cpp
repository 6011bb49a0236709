// SPDX-License-Identifier: MIT
// Users create, delete, teleport and change bodies, shapes and joints while the world runs, with stale handles among
// them: nothing breaks, and what was not touched stays sound.
#include <gtest/gtest.h>

#include "foundation/random.h"
#include "make_world.h"
#include "physics/inter/world.h"

namespace embody::physics {
namespace {

class Meddler {
public:
    explicit Meddler(std::uint64_t seed, int workers) : random_(seed) {
        world_ = make_world({.workers = workers});
        const auto plane = world_->create_shape(PlaneShape{}).value();
        ground_ = world_->create_body({.kind = BodyKind::static_body, .shape = plane}).value();
        for (const ShapeDefinition& definition : definitions())
            shapes_.push_back(world_->create_shape(definition).value());
    }

    World& world() { return *world_; }

    /// Does one thing at random; refusals are fine, what they refuse is not looked at.
    void act() {
        const BodyHandle body = pick(bodies_);
        const JointHandle joint = pick(joints_);
        Result<void> done;
        switch (random_.below(16)) {
            case 0:
            case 1:
            case 2:
                create_body();
                break;
            case 3:
                done = world_->destroy_body(body);
                break;
            case 4:
                done = world_->set_pose(body, {place(), turn()});
                break;
            case 5:
                done = world_->set_velocity(body, direction() * 20, direction() * 20);
                break;
            case 6:
                done = world_->set_force(body, direction() * 1e4, direction() * 1e3);
                break;
            case 7:
                done = world_->apply_impulse(body, direction() * 500, place());
                break;
            case 8:
                done = world_->set_enabled(body, random_.below(2) == 0);
                break;
            case 9:
                change_definition(body);
                break;
            case 10:
                create_joint(body, pick(bodies_));
                break;
            case 11:
                done = world_->destroy_joint(joint);
                break;
            case 12:
                done = world_->destroy_shape(pick(shapes_));
                break;
            case 13:
                shapes_.push_back(world_->create_shape(definitions()[random_.below(definitions().size())]).value());
                break;
            case 14:
                done = world_->wake(body);
                break;
            default:
                query(body);
        }
    }

    /// All that can be read is sound.
    void check() {
        EXPECT_TRUE(world_->contains(ground_));
        for (const BodyHandle body : world_->bodies()) {
            ASSERT_TRUE(is_finite(world_->pose(body)));
            ASSERT_TRUE(is_finite(world_->linear_velocity(body)));
            ASSERT_TRUE(is_finite(world_->angular_velocity(body)));
            ASSERT_GT(world_->mass(body), 0);
        }
        for (const ContactView& contact : world_->contacts()) {
            ASSERT_TRUE(world_->contains(contact.a) && world_->contains(contact.b));
            ASSERT_NEAR(length(contact.normal), 1, 1e-6);
            ASSERT_TRUE(is_finite(contact.impulse));
        }
        for (const ContactEvent& event : world_->contact_events()) {
            ASSERT_TRUE(event.kind == ContactEvent::Kind::end || world_->contains(event.a));
        }
    }

private:
    static const std::vector<ShapeDefinition>& definitions() {
        static const std::vector<ShapeDefinition> all{
            SphereShape{0.3},
            BoxShape{{0.3, 0.2, 0.4}},
            CapsuleShape{0.2, 0.3},
            CylinderShape{0.3, 0.2},
            ConeShape{0.3, 0.3},
            HullShape{{{0, 0, 0}, {0.6, 0, 0}, {0, 0.6, 0}, {0, 0, 0.6}}},
            BoxShape{{1.5, 0.1, 1}},
            CompoundShape{{{SphereShape{0.2}, {{0.3, 0, 0}, {}}}, {BoxShape{{0.3, 0.1, 0.1}}, {}}}}};
        return all;
    }

    // Mostly living handles, sometimes dead or null ones.
    template <class Handle>
    Handle pick(const std::vector<Handle>& handles) {
        if (handles.empty() || random_.below(20) == 0) return {};
        return handles[handles.size() - 1 - random_.below(std::min<std::uint64_t>(handles.size(), 60))];
    }
    Vec3 direction() { return {random_.between(-1, 1), random_.between(-1, 1), random_.between(-1, 1)}; }
    Vec3 place() { return {random_.between(-3, 3), random_.between(0.2, 6), random_.between(-3, 3)}; }
    Quat turn() { return normalized({random_.between(-1, 1), random_.between(-1, 1), random_.between(-1, 1), 1.1}); }

    void create_body() {
        const auto made = world_->create_body({.kind = static_cast<BodyKind>(random_.below(10) < 8 ? 2 : 1),
                                               .shape = pick(shapes_),
                                               .position = place(),
                                               .rotation = turn(),
                                               .linear_velocity = direction(),
                                               .material = {.restitution = random_.unit()},
                                               .start_asleep = random_.below(5) == 0,
                                               .continuous = random_.below(5) == 0});
        if (made) bodies_.push_back(made.value());
    }

    void change_definition(BodyHandle body) {
        auto definition = world_->body(body);
        if (!definition) return;
        definition->kind = static_cast<BodyKind>(random_.below(3));
        definition->shape = pick(shapes_);
        definition->mass.mass = random_.below(2) == 0 ? std::optional<double>() : random_.between(0.1, 1000);
        const Result<void> done = world_->set_body(body, *definition);
        EXPECT_TRUE(!done || world_->body(body)->shape == definition->shape);
    }

    void create_joint(BodyHandle a, BodyHandle b) {
        JointDefinition definition{
            .body_a = a, .body_b = b, .frame_a = {direction(), turn()}, .frame_b = {direction(), {}}};
        switch (random_.below(4)) {
            case 0:
                definition.joint = BallJoint{};
                break;
            case 1:
                definition.joint = HingeJoint{.limit = JointLimit{-1, 1}, .motor = JointMotor{2, 100}};
                break;
            case 2:
                definition.joint = SliderJoint{.limit = JointLimit{-1, 1}};
                break;
            default:
                break;
        }
        const auto made = world_->create_joint(definition);
        if (made) joints_.push_back(made.value());
    }

    void query(BodyHandle body) {
        const auto hit = world_->cast_ray(place(), direction(), 10, body);
        EXPECT_TRUE(!hit || world_->contains(hit->body));
        for (const BodyHandle found : world_->overlap_box({{-1, 0, -1}, {1, 2, 1}}))
            EXPECT_TRUE(world_->contains(found));
        EXPECT_GE(world_->drop_distance(body, 5).value_or(0), 0);
    }

    Random random_;
    std::unique_ptr<World> world_;
    BodyHandle ground_;
    std::vector<ShapeHandle> shapes_;
    std::vector<BodyHandle> bodies_;
    std::vector<JointHandle> joints_;
};

TEST(Changes, WhileItRunsBreakNothing) {
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Meddler meddler(seed, seed % 3 == 0 ? 2 : 1);
        for (int step = 0; step < 250; ++step) {
            for (std::uint64_t i = 0; i < 1 + seed % 4; ++i) meddler.act();
            meddler.world().step();
            meddler.check();
            if (::testing::Test::HasFatalFailure()) return;
        }
    }
}

// The same seed gives the same bits, so nothing reads what was freed or never written.
TEST(Changes, GiveTheSameBitsAgain) {
    Meddler first(99, 1), second(99, 2);
    for (int step = 0; step < 200; ++step) {
        for (int i = 0; i < 3; ++i) {
            first.act();
            second.act();
        }
        first.world().step();
        second.world().step();
        ASSERT_EQ(first.world().state_hash(), second.world().state_hash()) << "step " << step;
    }
}

}  // namespace
}  // namespace embody::physics
