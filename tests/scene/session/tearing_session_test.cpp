// SPDX-License-Identifier: MIT
// A sheet that tears in a session: what is told, time that goes back, *Keep*, undo and files (docs/physics/tearing.md).
#include <algorithm>

#include "attributes/physical_kind.h"
#include "scene/file/scene_file.h"
#include "scene/live_scene.h"
#include "scene/sample_documents.h"

namespace embody::scene {
namespace {

using nlohmann::json;

class TearingSession : public samples::LiveSession {
protected:
    // Paper between two bars, on which a ball falls.
    void begin() {
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
        open(document);
        whole_ = points();
        run("simulation.step", {{"count", 90}});
    }
    std::size_t points() {
        std::vector<Vec3> places;
        if (const ShownPoints* shown = state(paper_).points) shown->read(places);
        return places.size();
    }
    json mesh() { return run("entity.simulation_mesh", {{"index", paper_}}).at("mesh"); }
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

    // Half torn, and on from there.
    double half = 0;
    for (double time = 0.05; time < 1.4 && half == 0; time += 1.0 / 60) {
        run("time.seek", {{"time", time}});
        if (points() > whole_ + 2 && points() < torn) half = time;
    }
    ASSERT_GT(half, 0);
    const std::size_t then = points();
    const json notes = run("time.branch").at("notes");
    EXPECT_TRUE(notes.empty()) << notes;
    EXPECT_EQ(points(), then);
    expect_mesh_fits();
    run("simulation.step", {{"count", 60}});
    EXPECT_GT(points(), then);
    expect_mesh_fits();

    run("simulation.reset");
    EXPECT_EQ(points(), whole_);
    expect_mesh_fits();
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
