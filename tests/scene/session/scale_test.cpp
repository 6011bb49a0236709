// SPDX-License-Identifier: MIT
// Scenes of very many entities: four times as many may take four times as long, not sixteen times.
#include <malloc.h>

#include <algorithm>
#include <ctime>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>

#include "scene/document/document_index.h"
#include "scene/file/scene_file.h"
#include "scene/live_scene.h"

namespace embody::scene {
namespace {

using nlohmann::json;

constexpr int few = 2500, many = 4 * few;
/// Bound on the ratio of processor times; quadratic growth has a ratio of sixteen.
constexpr double max_growth = 10;

json sphere_at(int number) {
    const double x = 0.5 * (number % 100), z = 0.5 * (number / 100);
    return {{"shape", {{"type", "sphere"}, {"radius", 0.1}}}, {"pose", {{"position", {x, 1, z}}}}, {"name", "Ball"}};
}

json scene_of(int count) {
    json entities = json::array();
    for (int i = 0; i < count; ++i) {
        json entity = sphere_at(i);
        entity["index"] = i + 1;
        entity["name"] = "Ball " + std::to_string(i);
        entities.push_back(std::move(entity));
    }
    return {{"embody_scene", 1}, {"entities", std::move(entities)}};
}

json first_indices(int count) {
    json indices = json::array();
    for (int i = 0; i < count; ++i) indices.push_back(i + 1);
    return indices;
}

/// A session on a scene with `count` entities; the processor time (s) of `work` is measured, that of `prepare` is not.
class Scale : public samples::LiveSession {
protected:
    using Part = std::function<void(int count)>;

    // What is measured is the session. Blocks of some size the C library gives back to the system at once, and each of
    // their pages costs a fault when it is used again: from 6,000 to 24,000 things that made 10 of a growth by 6.
    static void SetUpTestSuite() {
        mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
        mallopt(M_MMAP_MAX, 0);
    }

    double seconds(int count, const Part& prepare, const Part& work) {
        double min_seconds = 1e300;
        for (int trial = 0; trial < 3; ++trial) {
            session_ = std::move(*Session::create(nullptr, {}));
            prepare(count);
            (void)session_->take_events();
            const std::clock_t began = std::clock();
            work(count);
            (void)session_->take_events();
            min_seconds = std::min(min_seconds, static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC);
        }
        return min_seconds;
    }
    void expect_linear(const Part& prepare, const Part& work) {
        const double small = seconds(few, prepare, work), large = seconds(many, prepare, work);
        std::printf("%d: %.0f ms, %d: %.0f ms, %.1f times\n", few, 1e3 * small, many, 1e3 * large, large / small);
        // Shorter times are below the resolution of the clock.
        EXPECT_LT(large, std::max(max_growth * small, 0.1));
    }
    void load(int count) { run("scene.load", {{"scene", scene_of(count)}}); }
};

TEST_F(Scale, Opening) {
    expect_linear([](int) {}, [this](int count) { load(count); });
}

TEST_F(Scale, OpeningWithJointsAndPins) {
    const auto work = [this](int count) {
        json scene = scene_of(count);
        json joints = json::array();
        for (int i = 1; i < count; ++i) {
            joints.push_back({{"type", "ball"},
                              {"entity_a", i},
                              {"entity_b", i + 1},
                              {"frame_a", {{"position", {0.25, 0, 0}}}},
                              {"frame_b", {{"position", {-0.25, 0, 0}}}}});
        }
        scene["joints"] = std::move(joints);
        run("scene.load", {{"scene", std::move(scene)}});
    };
    expect_linear([](int) {}, work);
}

TEST_F(Scale, AddingOneByOne) {
    expect_linear([](int) {},
                  [this](int count) {
                      for (int i = 0; i < count; ++i) {
                          json entity = sphere_at(i);
                          entity.erase("name");
                          run("entity.add", {{"entity", std::move(entity)}});
                      }
                  });
}

TEST_F(Scale, DeletingManyAndUndoingThat) {
    const auto work = [this](int count) {
        run("entity.remove", {{"indices", first_indices(count - 1)}});
        run("edit.undo");
        run("edit.redo");
        run("edit.undo");
    };
    expect_linear([this](int count) { load(count); }, work);
}

TEST_F(Scale, DeletingManyThatTouch) {
    const auto prepare = [this](int count) {
        json scene = scene_of(count);
        scene["entities"].push_back(
            {{"index", count + 1}, {"shape", {{"type", "plane"}}}, {"attributes", {{"kind", "static"}}}});
        for (json& entity : scene["entities"])
            if (entity["index"] != count + 1) entity["pose"]["position"][1] = 0.1;
        run("scene.load", {{"scene", std::move(scene)}});
        run("simulation.step", {{"count", 2}});
    };
    expect_linear(prepare, [this](int count) { run("entity.remove", {{"indices", first_indices(count)}}); });
}

TEST_F(Scale, DeletingOneByOne) {
    // Each command moves the entities behind it in the list, which is cheap; a search over all entities would show.
    expect_linear([this](int count) { load(count); },
                  [this](int count) {
                      for (int i = count; i > 0; --i) run("entity.remove", {{"indices", {i}}});
                  });
}

TEST_F(Scale, DuplicatingAll) {
    expect_linear([this](int count) { load(count); },
                  [this](int count) {
                      run("entity.duplicate", {{"indices", first_indices(count)}, {"offset", {0, 5, 0}}});
                      run("edit.undo");
                  });
}

TEST_F(Scale, DraggingAll) {
    expect_linear(
        [this](int count) { load(count); },
        [this](int count) {
            for (int drag = 1; drag <= 4; ++drag) {
                json poses = json::array();
                for (int i = 0; i < count; ++i)
                    poses.push_back({{"index", i + 1}, {"position", {0.5 * (i % 100), drag, 0.5 * (i / 100)}}});
                run("entity.transform", {{"poses", std::move(poses)}, {"merge", "drag"}});
            }
            run("edit.undo");
        });
}

TEST_F(Scale, SettingAnAttributeOfAll) {
    expect_linear([this](int count) { load(count); },
                  [this](int count) {
                      run("entity.set_attribute",
                          {{"indices", first_indices(count)}, {"name", "mass"}, {"value", 2}, {"merge", "slider"}});
                      run("entity.set_attribute",
                          {{"indices", first_indices(count)}, {"name", "mass"}, {"value", 3}, {"merge", "slider"}});
                      run("edit.undo");
                  });
}

TEST_F(Scale, StartingKeepingAndGoingBack) {
    expect_linear([this](int count) { load(count); },
                  [this](int) {
                      run("simulation.step");
                      run("simulation.keep");
                      run("simulation.reset");
                  });
}

TEST_F(Scale, WritingAndReading) {
    std::string text;
    const auto work = [&](int) {
        text = document_to_json(session_->document()).dump();
        const auto document = document_from_json(json::parse(text));
        ASSERT_TRUE(document.ok()) << document.error().message();
    };
    expect_linear([this](int count) { load(count); }, work);
}

TEST(LargestScene, AMillionEntitiesAreRefusedWithTheLimitNamed) {
    json scene = {{"embody_scene", 1}, {"entities", json::array()}};
    scene["entities"].get_ref<json::array_t&>().resize(1'000'000);
    const auto refused = document_from_json(scene);
    ASSERT_FALSE(refused.ok());
    EXPECT_NE(refused.error().message().find("300000"), std::string::npos) << refused.error().message();
}

TEST(NamesInUse, TheLeastFreeNumberIsTaken) {
    NamesInUse names;
    EXPECT_EQ(names.free_name("Box"), "Box");
    for (const char* name : {"Box", "Box 2", "Box 3", "Box 5"}) names.add(name);
    EXPECT_EQ(names.free_name("Box"), "Box 4");
    names.add("Box 4");
    EXPECT_EQ(names.free_name("Box"), "Box 6");
    names.add("Box 3");
    names.remove("Box 3");
    EXPECT_EQ(names.free_name("Box"), "Box 6") << "another still has it";
    names.remove("Box 3");
    EXPECT_EQ(names.free_name("Box"), "Box 3");
    names.remove("Box");
    EXPECT_EQ(names.free_name("Box"), "Box");
    EXPECT_EQ(names.free_name("Box 2"), "Box 2 2");
}

}  // namespace
}  // namespace embody::scene
