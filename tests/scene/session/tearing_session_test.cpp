// SPDX-License-Identifier: MIT
// A sheet that tears in a session: what is told, time that goes back, *Keep*, undo and files (docs/physics/tearing.md).
#include <algorithm>
#include <functional>
#include <map>
#include <utility>

#include "attributes/physical_kind.h"
#include "foundation/random.h"
#include "scene/embody/kept_fit.h"
#include "scene/file/scene_file.h"
#include "scene/live_scene.h"
#include "scene/sample_documents.h"
#include "scene/session/past.h"

namespace embody::scene {
namespace {

using nlohmann::json;

class TearingSession : public samples::LiveSession {
protected:
    // Paper between two bars, on which a ball falls.
    void begin(const std::function<void(Document&)>& change = {}) {
        Document document = samples::floor_and_box();
        document.entities.pop_back();
        Entity& paper = samples::add(document, "Paper", physics::BoxShape{{0.3, 0.0004, 0.2}}, {0, 1, 0});
        paper.attributes = {{"kind", to_value(attributes::PhysicalKind::cloth)},
                            {"area_density", 0.05},
                            {"stretch_stiffness", 5e3},
                            {"shear_stiffness", 2e3},
                            {"cloth_nodes", 150.0},
                            {"tear_strength", 200.0},
                            {"tear_energy", 1.0}};
        for (const double side : {-1.0, 1.0}) {
            for (double z = -0.2; z < 0.21; z += 0.05)
                paper.pins.push_back({.position = {side * 0.3, 0, z}, .radius = 0.04});
        }
        paper_ = paper.index;
        Entity& ball = samples::add(document, "Ball", physics::SphereShape{0.08}, {0, 1.2, 0});
        ball.attributes["mass"] = 5.0;
        ball_ = ball.index;
        if (change) change(document);
        open(document);
        whole_ = points();
        run("simulation.step", {{"count", 90}});
    }
    std::vector<Vec3> places() {
        std::vector<Vec3> places;
        if (const ShownPoints* shown = state(paper_).points) shown->read(places);
        return places;
    }
    std::size_t points() { return places().size(); }
    json mesh() { return run("entity.simulation_mesh", {{"index", paper_}}).at("mesh"); }
    // Shows a moment at which it has torn, and tears on later.
    void seek_half_torn() {
        run("time.seek", {{"time", 1}});
        const std::size_t torn = points();
        for (double time = 0.05; time < 1; time += 1.0 / 60) {
            run("time.seek", {{"time", time}});
            if (points() > whole_ + 2 && points() < torn) return;
        }
        FAIL() << "has torn at once";
    }
    void expect_goes_on_from_here() {
        const std::size_t then = points();
        const json notes = run("time.branch").at("notes");
        EXPECT_TRUE(notes.empty()) << notes;
        EXPECT_EQ(points(), then);
        expect_mesh_fits();
        run("simulation.step", {{"count", 30}});
        EXPECT_GT(points(), then);
        expect_mesh_fits();
    }
    void expect_mesh_fits() {
        const json told = mesh();
        EXPECT_EQ(told.at("nodes").size(), 3 * points());
        for (const json& node : told.at("triangles")) EXPECT_LT(node.get<std::size_t>(), points());
    }

    EntityIndex paper_ = 0, ball_ = 0;
    std::size_t whole_ = 0;  // points
};

TEST_F(TearingSession, TellsThatItTears) {
    begin();
    EXPECT_GT(points(), whole_ + 5);
    EXPECT_LT(state(ball_).pose.position.y, 0.5) << "the ball has come through";
    expect_mesh_fits();
    const json marks = run("time.marks", json::object()).at("marks");
    EXPECT_TRUE(std::ranges::any_of(
        marks, [&](const json& mark) { return mark.at("kind") == "sheet_tore" && mark.at("a") == paper_; }));
}

TEST_F(TearingSession, IsAsTornAsAtTheMomentThatIsShown) {
    begin();
    const std::size_t torn = points();
    run("time.seek", {{"time", 0.05}});
    EXPECT_EQ(points(), whole_);
    expect_mesh_fits();
    run("time.seek", {{"time", 1.4}});
    EXPECT_EQ(points(), torn);
    expect_mesh_fits();

    seek_half_torn();
    expect_goes_on_from_here();

    run("simulation.reset");
    EXPECT_EQ(points(), whole_);
    expect_mesh_fits();
}

TEST_F(TearingSession, IsTornAgainWhereItHasGoneSince) {
    begin([&](Document& document) {
        Action action;
        action.id = 1;
        action.name = "Remove";
        action.trigger = AtTime{1.2, {}};
        action.receiver = {Target::By::index, paper_, {}};
        action.effect = Remove{};
        document.actions.push_back(action);
    });
    ASSERT_EQ(points(), 0u);
    seek_half_torn();
    expect_goes_on_from_here();
    run("simulation.step", {{"count", 60}});
    EXPECT_EQ(points(), 0u) << "removed again";
    run("time.seek", {{"time", 0.05}});
    expect_goes_on_from_here();
}

TEST_F(TearingSession, IsTornAgainWhereItWasMadeAnewSince) {
    begin();
    run("entity.set_attribute", {{"indices", {paper_}}, {"name", "kind"}, {"value", "rigid"}});
    run("edit.undo");
    ASSERT_EQ(points(), whole_);
    seek_half_torn();
    expect_goes_on_from_here();
}

// What a film of a take asks for while something else is shown.
TEST_F(TearingSession, TellsTheMeshOfSoManyPoints) {
    begin();
    std::map<std::size_t, json> meshes;
    for (double time = 0; time < 1.4; time += 1.0 / 60) {
        run("time.seek", {{"time", time}});
        meshes[points()] = mesh();
    }
    EXPECT_GT(meshes.size(), 2u);
    const auto mesh_of = [&](std::size_t count) {
        return run("entity.simulation_mesh", {{"index", paper_}, {"points", count}}).at("mesh");
    };
    for (const double shown : {0.0, 5.0}) {
        run("time.seek", {{"time", shown}});
        for (const auto& [count, known] : meshes) EXPECT_EQ(mesh_of(count), known);
        EXPECT_EQ(mesh_of(1), meshes.begin()->second) << "it was never smaller";
        EXPECT_EQ(mesh_of(100'000), meshes.rbegin()->second);
    }
}

TEST_F(TearingSession, IsOneMarkWhileItTearsOn) {
    begin();
    std::vector<double> times;
    const json told = run("time.marks");
    for (const json& mark : told.at("marks"))
        if (mark.at("kind") == "sheet_tore") times.push_back(mark.at("time"));
    ASSERT_FALSE(times.empty());
    for (std::size_t i = 1; i < times.size(); ++i) EXPECT_GE(times[i] - times[i - 1], 0.25 - 1e-9);
    std::size_t changes = 0, before = whole_;
    for (double time = 0; time < 1.4; time += 1.0 / 60) {
        run("time.seek", {{"time", time}});
        changes += points() != std::exchange(before, points()) ? 1 : 0;
    }
    EXPECT_GT(changes, times.size());
}

// Its curves are of the nodes that it always had, so that they do not jump where it gets new ones.
// Moments keep places to some micrometres.
TEST_F(TearingSession, CurvesGoOnAtATear) {
    begin();
    json asked = json::array();
    for (const char* quantity : {"x", "height", "z"}) asked.push_back({{"index", paper_}, {"quantity", quantity}});
    const json told = run("time.curves", {{"curves", asked}});
    for (std::size_t i = 0; i < told.at("times").size(); ++i) {
        run("time.seek", {{"time", told.at("times").at(i)}});
        Vec3 mean;
        const std::vector<Vec3> all = places();
        for (std::size_t k = 0; k < whole_; ++k) mean += all.at(k) / static_cast<double>(whole_);
        for (const auto& [curve, expected] : {std::pair(0, mean.x), std::pair(1, mean.y), std::pair(2, mean.z)})
            EXPECT_NEAR(told.at("curves").at(curve).at("values").at(i).get<double>(), expected, 1e-5) << i;
    }
}

// A wire that its weight bends. Its moments do not have its bends.
TEST_F(TearingSession, ABranchTellsOfBentWires) {
    for (const bool is_bent : {true, false}) {
        Document document = samples::floor_and_box();
        Entity& wire = samples::add(document, "Wire", physics::CapsuleShape{0.002, 0.25}, {0, 1, 0});
        wire.attributes = {{"kind", to_value(attributes::PhysicalKind::rope)},
                           {"mass", 0.1},
                           {"bend_rigidity", 0.1},
                           {"bend_yield", is_bent ? 1.0 : 1e6},
                           {"damping_rayleigh", 0.1},
                           {"rope_segments", 20.0}};
        wire.pose.rotation = from_axis_angle({0, 0, 1}, 1.5);
        wire.pins = {{{0, 0.25, 0}, 0.01, {}, true}};
        open(document);
        run("simulation.step", {{"count", 90}});
        run("time.seek", {{"time", 1.0}});
        const json notes = run("time.branch").at("notes");
        if (is_bent)
            EXPECT_EQ(notes, json::array({"wires that had been bent are as at the start again"}));
        else
            EXPECT_TRUE(notes.empty()) << notes;
    }
}

// Sheets that tear, are made anew and tear again; then what was at any time is asked for.
TEST(TearingPast, KnowsWhatHadTornAtAnyTime) {
    Random random(12);
    for (int i = 0; i < 50; ++i) {
        constexpr EntityIndex sheet = 3;
        const std::uint32_t whole = 100;
        Past past;
        std::vector<physics::TornCorner> torn;
        std::vector<std::vector<physics::TornCorner>> were;
        std::uint32_t points = whole;
        for (int time = 0; time < 20; ++time) {
            if (random.unit() < 0.2) {
                torn.clear();
                points = whole;
            }
            for (std::uint64_t more = random.below(3); more > 0; --more, ++points) {
                for (std::uint64_t corners = random.below(3) + 1; corners > 0; --corners)
                    torn.push_back({static_cast<std::uint32_t>(random.next()), 0, points});
            }
            if (!torn.empty() && (were.empty() || torn != were.back())) past.add_torn(sheet, time, torn);
            were.push_back(torn);
        }
        for (std::size_t time = 0; time < were.size(); ++time) {
            const std::size_t then = were[time].empty() ? whole : were[time].back().node + 1;
            EXPECT_EQ(past.torn_at(sheet, static_cast<double>(time), then), were[time]) << i;
        }
        EXPECT_TRUE(past.torn_at(sheet + 1, 10, whole).empty());
    }
}

TEST(TearingPast, OnlySheetsHaveTornInAFile) {
    KeptForm kept;
    kept.fingerprint = "0123456789abcdef";
    kept.torn = {0, 0, 10};
    const KeptFit rope{.fingerprint = kept.fingerprint, .min_points = 10, .max_points = 10, .segments = 9, .bends = 10};
    const Result<void> checked = check_kept(kept, rope);
    ASSERT_FALSE(checked.ok());
    EXPECT_EQ(checked.error().where, "kept.torn");
    EXPECT_NE(checked.error().why.find("of a sheet"), std::string::npos) << checked.error().message();
}

TEST_F(TearingSession, KeepsItsTears) {
    begin();
    const std::size_t torn = points();
    const json triangles = mesh().at("triangles");
    run("simulation.keep");
    EXPECT_EQ(points(), torn);
    EXPECT_EQ(mesh().at("triangles"), triangles);
    const json file = document_to_json(session_->document());
    run("edit.undo");
    EXPECT_EQ(points(), whole_);

    run("scene.load", {{"scene", file}});
    EXPECT_EQ(points(), torn);
    EXPECT_EQ(mesh().at("triangles"), triangles);
    run("simulation.step", {{"count", 30}});
    EXPECT_GE(points(), torn);
    run("simulation.keep");
    EXPECT_GE(points(), torn);
    expect_mesh_fits();

    // A file with tears that the sheet cannot have: it begins as modelled, and a message says why.
    json wrong = file;
    for (json& entity : wrong.at("entities")) {
        if (entity.contains("kept")) entity.at("kept").at("torn").at(1) = 100'000;
    }
    run("scene.load", {{"scene", wrong}});
    EXPECT_EQ(points(), whole_);
}

}  // namespace
}  // namespace embody::scene
