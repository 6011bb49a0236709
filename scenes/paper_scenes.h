// SPDX-License-Identifier: MIT
#pragma once

#include "scene/document/document.h"

namespace embody::scenes {

// The paper's scenes (section V). It gives pictures, not sizes; the sizes here are those its later readers race on:
// cubes of 1 m, friction 0.5, 1000 kg/m³.

/// Figure 8 (e): a pyramid of 55 cubes hit at 2 s by a ball of 10 t at 20 m/s.
scene::Document build_table1_e();
/// Figure 8 (f): a wall of 210 cubes in running bond; three of the lowest row are pushed out at 2 s.
scene::Document build_table1_f();
/// Figure 8 (g): 343 spheres, cubes and columns released in the air over a pen.
scene::Document build_table1_g();
/// Figure 9: ten boxes with restitution 0.8 dropped with gaps on one another.
scene::Document build_figure_9();
/// Figure 10: walls, pyramids, columns and a tower of beams together, hit by two balls.
scene::Document build_figure_10();
/// Section V: a model of the dog's 33,854 triangles on a terrain of 115,200 triangles.
scene::Document build_dog_on_terrain();

// Ours, for tests and demos.

/// Ten boxes of 1 m on one another.
scene::Document build_ten_boxes();
/// A column of 30 cubes.
scene::Document build_tall_stack();

}  // namespace embody::scenes
