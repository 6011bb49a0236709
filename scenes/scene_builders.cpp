// SPDX-License-Identifier: MIT
#include "scenes/scene_builders.h"

#include <algorithm>

#include "scenes/end_state.h"
#include "scenes/paper_scenes.h"

namespace embody::scenes {
namespace {

using scene::Simulation;

std::string first_of(const std::string& a, const std::string& b) { return a.empty() ? b : a; }
std::string unless(bool right, const char* wrong) { return right ? std::string() : std::string(wrong); }

// The ball's momentum goes on, so it may be far away, and at least one cube has gone with it.
std::string check_table1_e(const Simulation& simulation) {
    return first_of(check_all_within(simulation, -0.1, 1e4),
                    unless(count_out_of_plane(simulation, 1) >= 2, "no cube left the pyramid: the ball missed it"));
}
std::string check_table1_f(const Simulation& simulation) {
    return first_of(
        check_all_within(simulation, 0.3, 200),
        unless(count_above(simulation, 4.4) >= 63, "most of the wall fell, though only three cubes were pushed"));
}
std::string check_table1_g(const Simulation& simulation) {
    return first_of(check_all_within(simulation, 0.2, 8.5),
                    unless(greatest_speed(simulation) < 1, "the heap in the pen has not come to rest"));
}
std::string check_figure_9(const Simulation& simulation) {
    return first_of(check_all_within(simulation, 0.4, 15),
                    unless(greatest_speed(simulation) < 0.5, "the stack with restitution 0.8 has not settled"));
}
std::string check_figure_10(const Simulation& simulation) { return check_all_within(simulation, -0.1, 1e4); }
std::string check_dog(const Simulation& simulation) {
    return first_of(check_all_within(simulation, -10, 40),
                    unless(greatest_speed(simulation) < 0.5, "the dog has not come to rest"));
}
std::string check_ten_boxes(const Simulation& simulation) {
    return first_of(check_all_within(simulation, 0.49, 0.01),
                    unless(count_above(simulation, 9.49) == 1, "the stack of ten boxes does not stand"));
}
std::string check_tall_stack(const Simulation& simulation) {
    return first_of(check_all_within(simulation, 0.49, 0.1),
                    unless(count_above(simulation, 29.4) == 1, "the column of 30 cubes does not stand"));
}

}  // namespace

const std::vector<SceneBuilder>& scene_builders() {
    static const std::vector<SceneBuilder> builders = {
        {"table1_e",
         "Ball hits stacked cubes",
         "Figure 8 (e)",
         {0.757, 0.013, 0.519},
         600,
         build_table1_e,
         check_table1_e},
        {"table1_f", "Wall of 210 cubes", "Figure 8 (f)", {28.184, 1.041, 16.501}, 600, build_table1_f, check_table1_f},
        {"table1_g",
         "343 primitives in the air",
         "Figure 8 (g)",
         {29.027, 3.354, 10.348},
         600,
         build_table1_g,
         check_table1_g},
        {"figure_9", "Box stack, restitution 0.8", "Figure 9", {}, 1200, build_figure_9, check_figure_9},
        {"figure_10", "Complicated stack", "Figure 10", {}, 600, build_figure_10, check_figure_10},
        {"dog_on_terrain",
         "Dog of 33,854 triangles on a terrain of 115,200",
         "Section V",
         {},
         600,
         build_dog_on_terrain,
         check_dog},
        {"ten_boxes", "Ten boxes", "", {}, 600, build_ten_boxes, check_ten_boxes},
        {"tall_stack", "Column of 30 cubes", "", {}, 1200, build_tall_stack, check_tall_stack},
    };
    return builders;
}

const SceneBuilder* find_scene_builder(std::string_view name) {
    const auto& builders = scene_builders();
    const auto found =
        std::find_if(builders.begin(), builders.end(), [&](const SceneBuilder& b) { return b.name == name; });
    return found == builders.end() ? nullptr : &*found;
}

}  // namespace embody::scenes
