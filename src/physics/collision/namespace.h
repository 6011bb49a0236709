// SPDX-License-Identifier: MIT
#pragma once

/// Shapes and their geometry in space: broad phase, contact regions of pairs, rays, distances and times of
/// impact. It reads poses and changes no velocity.
namespace embody::physics::collision {}  // namespace embody::physics::collision
