// SPDX-License-Identifier: MIT
// What *Keep* keeps: the next run begins with the form that was shown (docs/time.md). Random cloths, ropes, soft
// solids, piles of grains and liquids that have come to rest.
#include <algorithm>
#include <cmath>

#include "attributes/physical_kind.h"
#include "foundation/random.h"
#include "scene/document/document.h"
#include "scene/live_scene.h"
#include "scene/matter/soft_nodes.h"
#include "scene/sample_documents.h"
#include "scene/session/session_fixture.h"

namespace embody::scene {
namespace {

using attributes::PhysicalKind;
using nlohmann::json;
using physics::BoxShape;
using physics::CapsuleShape;

using Words = std::map<std::string, attributes::AttributeValue>;

Entity& add(Document& document, const std::string& name, const physics::ShapeDefinition& shape, Vec3 position,
            PhysicalKind kind, const Words& words = {}) {
    Entity& entity = samples::add(document, name, shape, position);
    entity.attributes = words;
    entity.attributes["kind"] = to_value(kind);
    return entity;
}

/// A scene in which something comes to rest in another form than it is modelled in.
struct Family {
    const char* name;
    /// Returns the thing.
    EntityIndex (*make)(Document&, Random&);
    int steps;  ///< until it has come to rest
    /// m: how much farther its points go in a second than without *Keep*, in the mean; and where all of it was turned,
    /// which the grid of a liquid is not.
    double same_place, same_when_turned;
    double extent;  ///< m: so far is its form from that which is modelled, at least
};

EntityIndex draped_cloth(Document& document, Random& random) {
    const double half = random.between(0.15, 0.25);
    add(document, "Table", BoxShape{{half, 0.2, half}}, {0, 0.2, 0}, PhysicalKind::static_body);
    const BoxShape sheet{{random.between(0.4, 0.6), 0.001, random.between(0.4, 0.6)}};
    return add(document, "Cloth", sheet, {random.between(-0.05, 0.05), 0.45, 0}, PhysicalKind::cloth,
               {{"cloth_nodes", std::floor(random.between(150, 400))}, {"damping_rayleigh", 0.02}})
        .index;
}

EntityIndex fallen_rope(Document& document, Random& random) {
    const double half = random.between(0.4, 0.8);
    Entity& rope = add(document, "Rope", CapsuleShape{0.01, half}, {0, half + 0.03, 0}, PhysicalKind::rope,
                       {{"mass", random.between(0.2, 2)}, {"rope_segments", std::floor(random.between(15, 40))}});
    rope.pose.rotation = from_axis_angle(normalized(Vec3{random.between(-1, 1), 0, 1}), random.between(0.1, 0.4));
    return rope.index;
}

// Clamped in a wall it is bent by its weight.
EntityIndex bent_wire(Document& document, Random& random) {
    const double half = random.between(0.2, 0.3);
    Entity& wire = add(document, "Wire", CapsuleShape{0.002, half}, {0, 1, 0}, PhysicalKind::rope,
                       {{"mass", random.between(0.05, 0.15)},
                        {"bend_rigidity", 0.1},
                        {"bend_yield", random.between(0.5, 2)},
                        {"damping_rayleigh", 0.1},
                        {"rope_segments", std::floor(random.between(15, 30))}});
    wire.pose.rotation =
        from_axis_angle({0, 1, 0}, random.between(-3, 3)) * from_axis_angle({0, 0, 1}, random.between(1, 2));
    wire.pins = {{{0, half, 0}, 0.01, {}, true}};
    return wire.index;
}

EntityIndex pressed_cushion(Document& document, Random& random) {
    const Vec3 half{random.between(0.15, 0.25), random.between(0.08, 0.12), random.between(0.15, 0.25)};
    const EntityIndex cushion = add(document, "Cushion", BoxShape{half}, {0, half.y + 0.01, 0}, PhysicalKind::soft,
                                    {{"mass", random.between(0.5, 2)},
                                     {"youngs_modulus", random.between(8e3, 3e4)},
                                     {"damping_rayleigh", 0.05}})
                                    .index;
    add(document, "Brick", BoxShape{{0.08, 0.04, 0.08}}, {0, 2 * half.y + 0.06, 0}, PhysicalKind::rigid,
        {{"mass", random.between(2, 6)}});
    return cushion;
}

EntityIndex dented_clay(Document& document, Random& random) {
    const double side = random.between(0.08, 0.14);
    Entity& clay =
        add(document, "Clay", BoxShape{{side, side, side}}, {0, side + random.between(0.5, 1), 0}, PhysicalKind::soft,
            {{"density", random.between(1200, 1800)},
             {"youngs_modulus", random.between(2e5, 8e5)},
             {"yield_stress", random.between(3e3, 6e3)},
             {"damping_rayleigh", 0.01}});
    clay.pose.rotation = from_axis_angle(normalized(Vec3{1, 0, 1}), random.between(0.3, 0.9));
    return clay.index;
}

EntityIndex pile_of_sand(Document& document, Random& random) {
    return add(document, "Sand",
               BoxShape{{random.between(0.06, 0.1), random.between(0.06, 0.1), random.between(0.06, 0.1)}},
               {0, 0.11, 0}, PhysicalKind::granular, {{"grain_budget", std::floor(random.between(150, 300))}})
        .index;
}

EntityIndex settled_water(Document& document, Random& random) {
    for (const double side : {-1.0, 1.0}) {
        add(document, "Wall", BoxShape{{0.025, 0.15, 0.25}}, {side * 0.225, 0.15, 0}, PhysicalKind::static_body);
        add(document, "Wall", BoxShape{{0.2, 0.15, 0.025}}, {0, 0.15, side * 0.225}, PhysicalKind::static_body);
    }
    const double half = random.between(0.08, 0.12);
    return add(document, "Water", BoxShape{{half, random.between(0.06, 0.1), half}},
               {-0.08, 0.12, random.between(-0.05, 0.05)}, PhysicalKind::fluid,
               {{"particle_budget", std::floor(random.between(1000, 2500))},
                {"dynamic_viscosity", random.between(1, 4)}})
        .index;
}

const Family families[] = {
    {"cloth", draped_cloth, 600, 4e-3, 4e-3, 0.1},        {"rope", fallen_rope, 600, 3e-4, 3e-4, 0.1},
    {"cushion", pressed_cushion, 300, 5e-5, 5e-5, 0.005}, {"clay", dented_clay, 360, 2e-4, 2e-4, 0.001},
    {"wire", bent_wire, 600, 5e-3, 5e-3, 0.01},           {"sand", pile_of_sand, 600, 3e-4, 3e-4, 0.005},
    {"water", settled_water, 900, 1e-3, 5e-3, 0.02},
};

class KeptForms : public SessionTest, public testing::WithParamInterface<Family> {
protected:
    void open(Random& random, bool sleeping = true) {
        Document document = samples::floor_and_box();
        document.settings.sleeping = sleeping;
        document.entities.pop_back();
        thing_ = GetParam().make(document, random);
        run("scene.load", {{"scene", document_to_json(document)}});
    }
    void step(int count) { run("simulation.step", {{"count", count}}); }
    std::vector<Vec3> points(EntityIndex index) {
        std::vector<EntityState> states;
        session_->read_states(states);
        std::vector<Vec3> read;
        for (const EntityState& state : states)
            if (state.entity == index && state.points) state.points->read(read);
        return read;
    }
    std::vector<Vec3> points() { return points(thing_); }
    bool is_asleep() {
        std::vector<EntityState> states;
        session_->read_states(states);
        return std::ranges::all_of(states, [](const EntityState& state) { return state.state >= 2; });
    }
    const Entity& thing() { return *session_->document().find(thing_); }

    EntityIndex thing_ = 0;
};

/// How far points moved, in the mean: of a liquid the drops change places while its surface stays.
double mean_distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) sum += distance(a[i], b[i]);
    return sum / static_cast<double>(a.size());
}
double max_distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double most = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) most = std::max(most, distance(a[i], b[i]));
    return most;
}
std::vector<Vec3> moved(std::vector<Vec3> points, const Transform& motion) {
    for (Vec3& point : points) point = transform_point(motion, point);
    return points;
}

TEST_P(KeptForms, AreWhatALaterRunBeginsWith) {
    const Family& family = GetParam();
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        SCOPED_TRACE(std::string(family.name) + " " + std::to_string(seed));
        Random random(seed);
        open(random, false);
        const std::vector<Vec3> modelled = points();
        step(family.steps);
        const std::vector<Vec3> rest = points();
        step(60);
        const double travel = mean_distance(points(), rest);  // without *Keep*
        run("simulation.reset");
        step(family.steps);
        const Transform frame = session_->document().find(thing_)->pose;
        run("simulation.keep");
        ASSERT_TRUE(thing().kept);
        EXPECT_EQ(points().size(), rest.size());
        EXPECT_LT(max_distance(points(), rest), 1e-6) << "shown before play";
        EXPECT_GT(max_distance(rest, moved(modelled, thing().pose * inverse(frame))), family.extent)
            << "else the test shows nothing";

        // Saved, read by another session, run: it stays where it was.
        run("scene.save", {{"name", "kept"}});
        session_ = make();
        run("scene.load", {{"name", "kept"}});
        ASSERT_TRUE(thing().kept);
        EXPECT_EQ(points().size(), rest.size());
        EXPECT_LT(max_distance(points(), rest), 1e-6);
        step(60);
        EXPECT_EQ(points().size(), rest.size());
        EXPECT_LT(mean_distance(points(), rest), 2 * travel + family.same_place);
        // All of it moved and turned: the same there.
        run("simulation.reset");
        const Transform motion{{random.between(-3, 3), 0, random.between(-3, 3)},
                               from_axis_angle({0, 1, 0}, random.between(-3, 3))};
        json poses = json::array();
        for (const Entity& entity : session_->document().entities) {
            const Transform to = motion * entity.pose;
            poses.push_back({{"index", entity.index},
                             {"position", {to.position.x, to.position.y, to.position.z}},
                             {"rotation", {to.rotation.x, to.rotation.y, to.rotation.z, to.rotation.w}}});
        }
        run("entity.transform", {{"poses", poses}});
        EXPECT_LT(max_distance(points(), moved(rest, motion)), 1e-6) << "shown before play";
        step(60);
        EXPECT_EQ(points().size(), rest.size());
        EXPECT_LT(mean_distance(points(), moved(rest, motion)), 2 * travel + family.same_when_turned);
        run("simulation.reset");
        EXPECT_LT(max_distance(points(), moved(rest, motion)), 1e-6);
    }
}

TEST_P(KeptForms, OfWhatSleptFallAsleepAgain) {
    int slept = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        SCOPED_TRACE(std::string(GetParam().name) + " " + std::to_string(seed));
        Random random(seed);
        open(random);
        for (int i = 0; i < 30 && !is_asleep(); ++i) step(60);
        if (!is_asleep()) continue;  // a liquid may creep for long
        ++slept;
        run("simulation.keep");
        int steps = 0;
        while (steps < 600 && !is_asleep()) {
            step(10);
            steps += 10;
        }
        EXPECT_LE(steps, 240) << "time_to_sleep is 30 steps; contacts begin without forces";
    }
    EXPECT_GE(slept, 2);
}

TEST_P(KeptForms, AreOneStepOfUndoCopiedAndForgotten) {
    Random random(7);
    open(random);
    const std::vector<Vec3> modelled = points();
    step(GetParam().steps / 2);
    const std::vector<Vec3> shown = points();
    run("simulation.keep");
    const SharedOptional<KeptForm> kept = thing().kept;
    ASSERT_TRUE(kept);

    EXPECT_EQ(run("edit.undo")["undone"], "Keep poses and forms");
    EXPECT_FALSE(thing().kept);
    EXPECT_EQ(points().size(), modelled.size());
    EXPECT_LT(max_distance(points(), modelled), 1e-9);
    run("edit.redo");
    EXPECT_TRUE(thing().kept.is_copy_of(kept)) << "one in memory";
    EXPECT_LT(max_distance(points(), shown), 1e-6);

    // A copy beside it, by number and by text.
    const EntityIndex copy = run("entity.duplicate", {{"indices", {thing_}}, {"offset", {5, 0, 0}}})["indices"][0];
    EXPECT_TRUE(session_->document().find(copy)->kept.is_copy_of(kept));
    EXPECT_LT(max_distance(points(copy), moved(shown, {{5, 0, 0}, {}})), 1e-6);
    const json part = run("entity.copy", {{"indices", {thing_}}})["part"];
    const EntityIndex pasted = run("entity.paste", {{"part", part}, {"offset", {-5, 0, 0}}})["indices"][0];
    EXPECT_EQ(session_->document().find(pasted)->kept, kept);
    EXPECT_LT(max_distance(points(pasted), moved(shown, {{-5, 0, 0}, {}})), 1e-6);

    // A version has it, too.
    run("scene.save", {{"name", "versioned"}, {"version", "first"}});

    // As modelled again, where it lies.
    run("entity.update", {{"index", thing_}, {"entity", {{"kept", nullptr}}}});
    EXPECT_FALSE(thing().kept);
    const std::vector<Vec3> again = points();
    step(1);
    run("simulation.keep");
    run("edit.undo");
    run("edit.undo");
    EXPECT_TRUE(thing().kept.is_copy_of(kept));
    EXPECT_LT(max_distance(points(), shown), 1e-6);

    run("scene.load", {{"name", "versioned"}, {"version", "first"}});
    EXPECT_EQ(thing().kept, kept);
}

TEST_P(KeptForms, ComeBackFromTheJournal) {
    Random random(9);
    open(random);
    step(60);
    run("simulation.keep");
    const SharedOptional<KeptForm> kept = thing().kept;
    ASSERT_TRUE(kept);
    run("entity.update", {{"index", thing_}, {"entity", {{"name", "Renamed"}}}});
    for (int i = 0; i < 5; ++i) run("entity.transform", {{"poses", {{{"index", thing_}, {"position", {i, 1, 0}}}}}});
    std::uintmax_t bytes = 0;
    for (const auto& file : std::filesystem::directory_iterator(folder_ / "saved" / "autosave"))
        bytes += file.file_size();
    const std::size_t numbers =
        kept->places.values.size() + kept->plastic_strain.values.size() + kept->bend.values.size();
    EXPECT_LT(bytes, 2 * 4 * numbers * sizeof(double) / 3 + 20'000) << "in the line that sets it alone";
    session_ = make();
    const json found = run("hello")["recovered"];
    ASSERT_FALSE(found.empty());
    run("scene.load", {{"name", found[0]["name"]}});
    EXPECT_EQ(thing().name, "Renamed");
    EXPECT_EQ(thing().kept, kept);
}

TEST_P(KeptForms, AreToldInShort) {
    Random random(11);
    open(random);
    step(60);
    (void)session_->take_events();
    run("simulation.keep");
    const std::size_t count = thing().kept->places.values.size() / 3;
    json told;
    for (const json& event : session_->take_events().messages)
        if (event["event"] == "document")
            for (const json& change : event["changes"])
                if (change["op"] == "entity" && change["entity"]["index"] == thing_) told = change;
    EXPECT_EQ(told["entity"]["kept"], (json{{"points", count}}));
    run("entity.update", {{"index", thing_}, {"entity", {{"name", "Renamed"}}}});
    for (const json& event : session_->take_events().messages)
        if (event["event"] == "document") told = event["changes"][0];
    EXPECT_EQ(told["entity"]["kept"], (json{{"points", count}}));
    EXPECT_FALSE(told.contains("same_kept"));
    for (const json& entity : run("hello")["scene"]["entities"])
        if (entity["index"] == thing_) {
            EXPECT_EQ(entity["kept"], (json{{"points", count}}));
        }
}

// A take has no plastic strain: what is dented yields again, so that the dent is there but for the yield strain.
TEST_P(KeptForms, OfAMomentOfThePastAreThoseThatWereShown) {
    Random random(13);
    open(random);
    const int steps = GetParam().steps;
    step(steps / 3);
    const std::vector<Vec3> shown = points();
    const double time = session_->simulated_time();
    step(steps / 3);
    run("time.seek", {{"time", time}});
    run("simulation.keep");
    ASSERT_TRUE(thing().kept);
    constexpr double unit = 1e-4;  // m: quantisation of a take
    EXPECT_EQ(points().size(), shown.size());
    EXPECT_LT(max_distance(points(), shown), unit);
    step(2);
    EXPECT_LT(mean_distance(points(), shown), 0.02);
    run("simulation.reset");
    EXPECT_LT(max_distance(points(), shown), unit);
}

INSTANTIATE_TEST_SUITE_P(OfEachMatter, KeptForms, testing::ValuesIn(families),
                         [](const auto& family) { return std::string(family.param.name); });

class KeptFormOfEdits : public SessionTest {
protected:
    /// Of the thing of an edit: whether it is kept still, and that undo brings it back.
    void expect_dropped(const std::string& command, const json& params) {
        ASSERT_TRUE(session_->document().find(thing_)->kept);
        const SharedOptional<KeptForm> kept = session_->document().find(thing_)->kept;
        (void)session_->take_events();
        run(command, params);
        EXPECT_FALSE(session_->document().find(thing_)->kept) << command << params.dump();
        bool is_told = false;
        for (const json& event : session_->take_events().messages)
            if (event["event"] == "message")
                is_told =
                    is_told || event["text"].get<std::string>().find("begins as modelled again") != std::string::npos;
        EXPECT_TRUE(is_told) << command << params.dump();
        run("edit.undo");
        EXPECT_TRUE(session_->document().find(thing_)->kept.is_copy_of(kept)) << command << params.dump();
    }
    EntityIndex thing_ = 0;
};

TEST_F(KeptFormOfEdits, GoesWithWhatItsPointsAreMadeFromAndStaysOtherwise) {
    Random random(3);
    Document document = samples::floor_and_box();
    document.entities.pop_back();
    thing_ = draped_cloth(document, random);
    run("scene.load", {{"scene", document_to_json(document)}});
    run("simulation.step", {{"count", 60}});
    run("simulation.keep");
    const json indices{thing_};
    expect_dropped("entity.set_attribute", {{"indices", indices}, {"name", "cloth_nodes"}, {"value", 90}});
    expect_dropped("entity.set_attribute", {{"indices", indices}, {"name", "kind"}, {"value", "rigid"}});
    expect_dropped("entity.update", {{"index", thing_},
                                     {"entity", {{"shape", {{"type", "box"}, {"half_extents", {0.3, 0.001, 0.2}}}}}}});
    run("entity.set_attribute", {{"indices", indices}, {"name", "friction_dynamic"}, {"value", 0.2}});
    run("entity.update",
        {{"index", thing_}, {"entity", {{"name", "Towel"}, {"pins", json::array({{{"position", {0, 0, 0}}}})}}}});
    EXPECT_TRUE(session_->document().find(thing_)->kept);

    // In a run, too.
    run("simulation.step", {{"count", 5}});
    expect_dropped("entity.set_attribute", {{"indices", indices}, {"name", "cloth_nodes"}, {"value", 90}});
}

TEST_F(KeptFormOfEdits, OfABrokenRopeStaysBroken) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        Random random(seed);
        Document document = samples::floor_and_box();
        Entity& rope =
            add(document, "Rope", CapsuleShape{0.01, 0.5}, {0, 2, 0}, PhysicalKind::rope,
                {{"mass", random.between(1, 3)}, {"break_tension", random.between(3, 6)}, {"rope_segments", 20.0}});
        rope.pins = {{{0, 0.5, 0}, 0.0, {}}};
        thing_ = rope.index;
        run("scene.load", {{"scene", document_to_json(document)}});
        run("simulation.step", {{"count", 120}});
        run("simulation.keep");
        const SharedOptional<KeptForm> kept = session_->document().find(thing_)->kept;
        ASSERT_TRUE(kept);
        ASSERT_FALSE(kept->broken.empty());
        const auto begun = samples::make(session_->document());
        ASSERT_TRUE(begun);
        EXPECT_EQ(as_soft(begun->points(thing_))->broken_segments(), kept->broken);

        // At a moment of the past those are broken that were then: none at its start.
        run("edit.undo");
        run("simulation.step", {{"count", 120}});
        run("time.seek", {{"time", 0.0}});
        run("simulation.keep");
        const SharedOptional<KeptForm>& first = session_->document().find(thing_)->kept;
        EXPECT_TRUE(!first || first->broken.empty());
        if (first) run("edit.undo");
        run("simulation.step", {{"count", 140}});
        run("time.seek", {{"time", 2.1}});
        run("simulation.keep");
        ASSERT_TRUE(session_->document().find(thing_)->kept);
        EXPECT_EQ(session_->document().find(thing_)->kept->broken, kept->broken);
    }
}

TEST_F(KeptFormOfEdits, OfLockedThingsStays) {
    Random random(3);
    Document document = samples::floor_and_box();
    thing_ = draped_cloth(document, random);
    document.find(thing_)->locked = true;
    run("scene.load", {{"scene", document_to_json(document)}});
    run("simulation.step", {{"count", 60}});
    run("simulation.keep");
    EXPECT_FALSE(session_->document().find(thing_)->kept);
}

}  // namespace
}  // namespace embody::scene
