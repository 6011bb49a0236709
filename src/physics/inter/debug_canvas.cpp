// SPDX-License-Identifier: MIT
#include "physics/inter/debug_canvas.h"

namespace embody::physics {

void DebugCanvas::box(const Bounds& box, DebugColor color) {
    if (box.is_empty()) return;
    const auto corner = [&](int bits) {
        return Vec3{(bits & 1) != 0 ? box.upper.x : box.lower.x, (bits & 2) != 0 ? box.upper.y : box.lower.y,
                    (bits & 4) != 0 ? box.upper.z : box.lower.z};
    };
    for (int bits = 0; bits < 8; ++bits) {
        for (const int axis : {1, 2, 4}) {
            if ((bits & axis) == 0) line(corner(bits), corner(bits | axis), color);
        }
    }
}

void DebugCanvas::arrow(Vec3 from, Vec3 to, DebugColor color) {
    constexpr double head = 0.15;  // of the length
    const Vec3 back = head * (from - to),
               side = head / 2 * length(to - from) * any_perpendicular(normalized(to - from));
    line(from, to, color);
    line(to, to + back + side, color);
    line(to, to + back - side, color);
}

}  // namespace embody::physics
