// SPDX-License-Identifier: MIT
#pragma once

#include "attributes/physical_kind.h"
#include "scene/live_scene.h"
#include "scene/sample_documents.h"

namespace embody::scene::samples {

inline Entity& add_box(Document& document, const char* name, Vec3 half, Vec3 position, attributes::PhysicalKind kind) {
    Entity& box = add(document, name, physics::BoxShape{half}, position);
    box.attributes["kind"] = to_value(kind);
    return box;
}

/// A tub without lid, inside 40 × 30 × 40 cm above height 0, on ground that what splashes over falls on.
inline Document tub() {
    Document document;
    add(document, "Ground", physics::PlaneShape{}, {0, -0.1, 0});
    add_box(document, "Bottom", {0.25, 0.05, 0.25}, {0, -0.05, 0}, attributes::PhysicalKind::static_body);
    for (const double side : {-1.0, 1.0}) {
        add_box(document, "Wall", {0.05, 0.2, 0.3}, {side * 0.25, 0.15, 0}, attributes::PhysicalKind::static_body);
        add_box(document, "Wall", {0.2, 0.2, 0.05}, {0, 0.15, side * 0.25}, attributes::PhysicalKind::static_body);
    }
    return document;
}

/// Water for a layer of this depth on the tub's bottom.
inline Entity& add_water(Document& document, double depth, bool starts_empty, double budget = 3000) {
    Entity& water =
        add_box(document, "Water", {0.2, depth / 2, 0.2}, {0, depth / 2, 0}, attributes::PhysicalKind::fluid);
    water.attributes["particle_budget"] = budget;
    water.starts_empty = starts_empty;
    return water;
}

inline Entity& add_tap(Document& document, Vec3 position, double litres_per_minute) {
    Entity& tap = add(document, "Tap", physics::CylinderShape{0.02, 0.02}, position);
    tap.attributes["kind"] = to_value(attributes::PhysicalKind::static_body);
    tap.tap = {.litres_per_minute = litres_per_minute, .radius = 0.02, .position = {0, -0.04, 0}};
    return tap;
}

inline Entity& add_drain(Document& document, Vec3 position, double radius) {
    Entity& drain = add(document, "Drain", physics::CylinderShape{0.02, 0.002}, position);
    drain.attributes["kind"] = to_value(attributes::PhysicalKind::static_body);
    drain.drain.radius = radius;
    return drain;
}

}  // namespace embody::scene::samples
