// SPDX-License-Identifier: MIT
// Calls of a world in any order, with valid and invalid values and with handles that are stale or were never issued: a
// refusal says where and why and changes nothing, and after each step the state is valid and all results of the
// interface are finite. Half of the inputs run again with another width of the solver, which must compute the same
// bits.
#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "../target.h"
#include "../world/byte_reader.h"
#include "../world/world_definitions.h"
#include "../world/world_promises.h"
#include "physics/inter/debug_draw.h"
#include "physics/inter/world.h"

using namespace embody;
using namespace embody::physics;
using fuzz::ByteReader;
using fuzz::require;

namespace {

// Limits by which an input takes milliseconds.
constexpr std::size_t most_bodies = 24, most_deformables = 3, most_fluids = 2, most_joints = 12, most_steps = 60;

/// Handles that were issued, stale ones too.
template <class Handle>
class Handles {
public:
    void add(Handle handle) { given_.push_back(handle); }
    /// Mostly a handle that was issued; else null, or one that never was.
    Handle pick(ByteReader& bytes) const {
        const std::uint8_t chosen = bytes.byte();
        if (chosen >= 250 || given_.empty()) return chosen % 2 == 0 ? Handle{} : Handle{chosen, 77};
        return given_[given_.size() - 1 - chosen % given_.size()];
    }

private:
    std::vector<Handle> given_;
};

class NoDraw : public DebugDraw {
public:
    void line(Vec3 from, Vec3 to, DebugColor) override { ends_.push_back(from), ends_.push_back(to); }
    void point(Vec3 at, DebugColor) override { ends_.push_back(at); }
    [[nodiscard]] std::size_t count() const { return ends_.size(); }

private:
    std::vector<Vec3> ends_;
};

/// One world, and the calls that the bytes choose.
class Calls {
public:
    Calls(ByteReader bytes, const WorldSettings& settings) : bytes_(bytes) {
        auto made = World::create(settings);
        require(made.ok(), "a world can be made");
        world_ = std::move(made).value();
    }

    std::uint64_t run() {
        while (!bytes_.is_at_end() && steps_ < most_steps) call();
        // After any calls everything can be destroyed.
        for (const FluidHandle fluid : world_->fluids()) require(world_->destroy_fluid(fluid).ok(), "fluids can go");
        for (const DeformableHandle deformable : world_->deformables())
            require(world_->destroy_deformable(deformable).ok(), "deformables can go");
        const std::uint64_t end = world_->state_hash();
        require(world_->destroy_bodies(world_->bodies()).ok(), "bodies can go");
        step();
        require(world_->joints().empty() && world_->contacts().empty(), "nothing is left of bodies that went");
        return end;
    }

private:
    using Call = void (Calls::*)();

    void call() {
        static constexpr std::array<Call, 24> calls{&Calls::step,
                                                    &Calls::create_shape,
                                                    &Calls::create_body,
                                                    &Calls::create_body,
                                                    &Calls::create_joint,
                                                    &Calls::deform,
                                                    &Calls::pour,
                                                    &Calls::step,
                                                    &Calls::place_body,
                                                    &Calls::push_body,
                                                    &Calls::change_body,
                                                    &Calls::change_bodies,
                                                    &Calls::switch_body,
                                                    &Calls::destroy_bodies,
                                                    &Calls::destroy_else,
                                                    &Calls::change_joint,
                                                    &Calls::change_deformable,
                                                    &Calls::hold_deformable,
                                                    &Calls::place_nodes,
                                                    &Calls::change_fluid,
                                                    &Calls::move_fluid,
                                                    &Calls::change_settings,
                                                    &Calls::ask,
                                                    &Calls::stand_on_ground};
        (this->*calls[bytes_.below(calls.size())])();
    }

    // Runs a call that may be refused.
    template <class Action>
    auto allow(const Action& action) {
        const std::uint64_t before = fuzz::fingerprint(*world_);
        auto result = action();
        if (!result.ok()) {
            fuzz::require_reasons(result.error());
            require(fuzz::fingerprint(*world_) == before, "what is refused changes nothing");
        }
        return result;
    }
    template <class Handle, class Action>
    void allow_new(Handles<Handle>& handles, const Action& action) {
        if (const auto made = allow(action)) handles.add(*made);
    }

    void step() {
        for (std::size_t times = 1 + bytes_.below(8); times > 0; --times, ++steps_) {
            world_->step();
            fuzz::require_sound(*world_);
        }
    }

    void create_shape() {
        const ShapeDefinition shape = fuzz::read_shape(bytes_);
        allow_new(shapes_, [&] { return world_->create_shape(shape); });
    }

    BodyDefinition read_body() {
        BodyDefinition body{.shape = shapes_.pick(bytes_), .position = {0, 1, 0}};
        fuzz::change_body(bytes_, body);
        return body;
    }
    void create_body() {
        const BodyDefinition body = read_body();
        if (world_->bodies().size() < most_bodies) allow_new(bodies_, [&] { return world_->create_body(body); });
    }
    // Ground and a column of bodies on it: random calls seldom build one.
    void stand_on_ground() {
        const auto ground = world_->create_shape(PlaneShape{});
        if (world_->bodies().size() + 4 > most_bodies) return;
        bodies_.add(*world_->create_body({.kind = BodyKind::static_body, .shape = *ground}));
        const auto box = world_->create_shape(BoxShape{{0.2, 0.1, 0.2}});
        shapes_.add(*box);
        for (std::size_t i = bytes_.below(4); i > 0; --i)
            bodies_.add(*world_->create_body({.shape = *box, .position = {0, 0.2 * static_cast<double>(i) - 0.1, 0}}));
    }

    void create_joint() {
        JointDefinition joint{.joint = BallJoint{}, .body_a = bodies_.pick(bytes_), .body_b = bodies_.pick(bytes_)};
        fuzz::change_joint(bytes_, joint);
        if (world_->joints().size() < most_joints) allow_new(joints_, [&] { return world_->create_joint(joint); });
    }
    void change_joint() {
        const JointHandle handle = joints_.pick(bytes_);
        JointDefinition joint = world_->joint(handle).value_or(JointDefinition{});
        if (bytes_.is_one_of(4)) joint.body_a = bodies_.pick(bytes_);
        if (bytes_.is_one_of(4)) joint.body_b = bodies_.pick(bytes_);
        fuzz::change_joint(bytes_, joint);
        (void)allow([&] { return world_->set_joint(handle, joint); });
    }

    void place_body() {
        const BodyHandle body = bodies_.pick(bytes_);
        const Vec3 place = bytes_.vector(-2, 2);
        const Quat rotation = bytes_.rotation();
        (void)allow([&] { return world_->set_pose(body, {place, rotation}); });
    }
    void push_body() {
        const BodyHandle body = bodies_.pick(bytes_);
        const std::size_t how = bytes_.below(5);
        const Vec3 first = bytes_.vector(-20, 20), second = bytes_.vector(-2, 2);
        const auto at = bytes_.is_one_of(2) ? std::optional(second) : std::nullopt;
        (void)allow([&]() -> Result<void> {
            if (how == 0) return world_->set_velocity(body, first, second);
            if (how == 1) return world_->set_force(body, first, second);
            if (how == 2) return world_->apply_impulse(body, first, at);
            if (how == 3) return world_->apply_angular_impulse(body, first);
            return world_->apply_force(body, first, at);
        });
    }
    void change_body() {
        const BodyHandle body = bodies_.pick(bytes_);
        BodyDefinition definition = world_->body(body).value_or(BodyDefinition{});
        if (bytes_.is_one_of(4)) definition.shape = shapes_.pick(bytes_);
        fuzz::change_body(bytes_, definition);
        (void)allow([&] { return world_->set_body(body, definition); });
    }
    std::vector<BodyHandle> pick_bodies() {
        std::vector<BodyHandle> picked;
        for (std::size_t times = bytes_.below(5); times > 0; --times) picked.push_back(bodies_.pick(bytes_));
        // Each body may be named only once.
        std::ranges::sort(picked);
        const auto twice = std::ranges::unique(picked);
        picked.erase(twice.begin(), twice.end());
        return picked;
    }
    void change_bodies() {
        const std::vector<BodyHandle> picked = pick_bodies();
        (void)allow([&] {
            return world_->change_bodies(picked, [&](BodyDefinition& body) { fuzz::change_body(bytes_, body); });
        });
    }
    void switch_body() {
        const BodyHandle body = bodies_.pick(bytes_);
        const std::size_t how = bytes_.below(3);
        (void)allow([&] { return how == 2 ? world_->wake(body) : world_->set_enabled(body, how == 0); });
    }
    void destroy_bodies() {
        const std::vector<BodyHandle> picked = pick_bodies();
        (void)allow([&] { return world_->destroy_bodies(picked); });
    }
    void destroy_else() {
        const std::size_t what = bytes_.below(4);
        (void)allow([&]() -> Result<void> {
            if (what == 0) return world_->destroy_shape(shapes_.pick(bytes_));
            if (what == 1) return world_->destroy_joint(joints_.pick(bytes_));
            if (what == 2) return world_->destroy_deformable(deformables_.pick(bytes_));
            return world_->destroy_fluid(fluids_.pick(bytes_));
        });
    }

    void hold(DeformableDefinition& deformable) {
        const auto node = [&] { return static_cast<std::uint32_t>(bytes_.below(deformable.nodes.size())); };
        switch (bytes_.below(4)) {
            case 0:
                deformable.attachments.push_back({node(), bodies_.pick(bytes_), bytes_.vector(-1, 1)});
                break;
            case 1:
                if (!deformable.pinned.empty()) deformable.clamps.push_back({deformable.pinned[0], {1, 0, 0}});
                break;
            case 2: {
                const Vec3 place = bytes_.vector(-1, 1);
                const DeformableHandle other = deformables_.pick(bytes_);
                const auto tie = world_->nearest_tie(node(), other, place);
                deformable.ties.push_back(tie.value_or(Tie{node(), other}));
                break;
            }
            default:
                deformable.attachments.clear(), deformable.ties.clear(), deformable.clamps.clear();
        }
    }
    void deform() {
        DeformableDefinition deformable = fuzz::read_deformable(bytes_);
        if (bytes_.is_one_of(2)) hold(deformable);
        if (world_->deformables().size() < most_deformables)
            allow_new(deformables_, [&] { return world_->create_deformable(deformable); });
    }
    void change_deformable() {
        const DeformableHandle handle = deformables_.pick(bytes_);
        if (bytes_.is_one_of(4)) return (void)allow([&] { return world_->wake(handle); });
        const DeformableDefinition* present = world_->deformable(handle);
        DeformableDefinition deformable = present ? *present : fuzz::read_deformable(bytes_);
        fuzz::change_deformable(bytes_, deformable);
        (void)allow([&] { return world_->set_deformable(handle, deformable); });
    }
    void hold_deformable() {
        const DeformableHandle handle = deformables_.pick(bytes_);
        const DeformableDefinition* present = world_->deformable(handle);
        if (present == nullptr) return;
        DeformableDefinition held = *present;
        hold(held);
        (void)allow([&] { return world_->set_attachments(handle, held.attachments, held.clamps, held.ties); });
    }
    void place_nodes() {
        const DeformableHandle handle = deformables_.pick(bytes_);
        const auto present = world_->node_positions(handle);
        std::vector<Vec3> places(present.begin(), present.end()), velocities(places.size());
        if (places.empty() || bytes_.is_one_of(16)) places.emplace_back();
        for (std::size_t times = bytes_.below(4); times > 0; --times)
            places[bytes_.below(places.size())] = bytes_.vector(-1, 1);
        if (!velocities.empty()) velocities[0] = bytes_.vector(-5, 5);
        (void)allow([&] { return world_->set_nodes(handle, places, velocities); });
    }

    void pour() {
        const FluidDefinition fluid = fuzz::read_fluid(bytes_);
        if (world_->fluids().size() < most_fluids) allow_new(fluids_, [&] { return world_->create_fluid(fluid); });
    }
    void change_fluid() {
        const FluidHandle handle = fluids_.pick(bytes_);
        const FluidDefinition* present = world_->fluid(handle);
        FluidDefinition fluid = present ? *present : FluidDefinition{};
        fuzz::change_fluid_matter(bytes_, fluid);
        if (bytes_.is_one_of(32)) fluid.cell_size *= 2;
        (void)allow([&] { return world_->set_fluid(handle, fluid); });
    }
    FluidIds pick_ids() {
        const auto first = static_cast<std::uint32_t>(bytes_.byte());
        return {first, first + bytes_.byte()};
    }
    void move_fluid() {
        const FluidHandle handle = fluids_.pick(bytes_);
        switch (bytes_.below(3)) {
            case 0: {
                std::vector<Vec3> places;
                for (std::size_t times = bytes_.below(10); times > 0; --times) places.push_back(bytes_.vector(-1, 1));
                (void)allow([&] { return world_->add_to_fluid(handle, places); });
                break;
            }
            case 1: {
                const FluidIds ids = pick_ids();
                const Vec3 way = bytes_.vector(-1, 1), velocity = bytes_.vector(-5, 5);
                const std::size_t taken = 2 + bytes_.below(10);
                (void)allow([&] {
                    return world_->change_fluid(handle, ids, [&](std::uint32_t id, Vec3& at, Vec3& moves) {
                        at += way;
                        moves = velocity;
                        return id % taken != 0;
                    });
                });
                break;
            }
            default: {
                const FluidHandle to = fluids_.pick(bytes_);
                const FluidIds ids = pick_ids();
                if (to.is_null() && world_->fluids().size() >= most_fluids) return;
                if (const auto part = allow([&] { return world_->move_between_fluids(handle, ids, to); }))
                    fluids_.add(part->fluid);
            }
        }
    }

    void change_settings() {
        WorldSettings settings = world_->settings();
        fuzz::change_settings(bytes_, settings);
        (void)allow([&] { return world_->set_settings(settings); });
        world_->keep_account(bytes_.is_one_of(2));
    }

    // Queries change nothing, and their results are finite.
    void ask() {
        const std::uint64_t before = fuzz::fingerprint(*world_);
        const Vec3 from = bytes_.vector(-3, 3), along = bytes_.vector(-1, 1);
        const BodyHandle body = bodies_.pick(bytes_);
        if (const auto hit = world_->cast_ray(from, along, bytes_.number(0, 10), body)) {
            require(hit->body != body && world_->contains(hit->body), "a ray hits a body that it may");
            require(is_finite(hit->position) && is_finite(hit->normal) && hit->distance >= 0, "a hit is finite");
        }
        for (const BodyHandle found : world_->overlap_box({from, from + along}))
            require(world_->contains(found), "what overlaps is there");
        if (const auto drop = world_->drop_distance(body, bytes_.number(0, 10)))
            require(*drop >= 0 && std::isfinite(*drop), "a drop is finite");
        for (const FluidHandle fluid : world_->fluids())
            require(std::isfinite(world_->fluid_pressure(fluid, from)), "pressures are finite");
        NoDraw draw;
        const DebugDrawOptions options{
            .flags = 0x3FFu, .mark_length = bytes_.number(0, 1), .max_lines = 500, .max_points = 100};
        const DebugDrawCount drawn = world_->debug_draw(draw, options);
        require(draw.count() == 2 * drawn.lines + drawn.points && drawn.lines <= options.max_lines &&
                    drawn.points <= options.max_points,
                "no more is drawn than is allowed");
        require(fuzz::fingerprint(*world_) == before, "questions change nothing");
    }

    ByteReader bytes_;
    std::unique_ptr<World> world_;
    std::size_t steps_ = 0;
    Handles<ShapeHandle> shapes_;
    Handles<BodyHandle> bodies_;
    Handles<JointHandle> joints_;
    Handles<DeformableHandle> deformables_;
    Handles<FluidHandle> fluids_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr std::size_t longest = 2000;  // bytes; an input of this length takes less than a second
    ByteReader bytes({data, std::min(size, longest)});
    const bool twice = bytes.is_one_of(2);
    const std::uint64_t end = Calls(bytes, {.lanes = 4}).run();
    if (twice) require(Calls(bytes, {}).run() == end, "the width of the solver changes no bit");
    return 0;
}
