// SPDX-License-Identifier: MIT
#pragma once

/// Shapes and what they do to each other in space: broad phase, contact regions of pairs, rays, distances and times of
/// impact. Reads poses, changes no velocity.
namespace embody::physics::collision {}  // namespace embody::physics::collision
