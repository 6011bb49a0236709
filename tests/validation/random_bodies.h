// SPDX-License-Identifier: MIT
#pragma once

#include <cstdlib>

#include "foundation/random.h"
#include "physics/inter/world.h"

namespace embody::physics {

/// How many random cases a law is tried on: `usual`, or what the environment variable says.
inline int wanted_cases(const char* variable, int usual) {
    const char* wish = std::getenv(variable);
    return wish != nullptr ? std::atoi(wish) : usual;
}

inline Vec3 random_vector(Random& random, double most) {
    return {random.between(-most, most), random.between(-most, most), random.between(-most, most)};
}

/// A unit vector, not evenly spread.
inline Vec3 random_direction(Random& random) { return normalized(random_vector(random, 1), {0, 1, 0}); }

inline Quat random_rotation(Random& random) {
    return normalized(Quat{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)});
}

/// One of all kinds of movable shapes, with half extents from a tenth of `size` to all of it, m.
inline ShapeDefinition random_shape(Random& random, double size) {
    const double a = size * random.between(0.1, 1), b = size * random.between(0.1, 1),
                 c = size * random.between(0.1, 1);
    HullShape hull;
    CompoundShape compound;
    switch (random.below(7)) {
        case 0:
            return SphereShape{a};
        case 1:
            return BoxShape{{a, b, c}};
        case 2:
            return CapsuleShape{a, b};
        case 3:
            return CylinderShape{a, b};
        case 4:
            return ConeShape{a, b};
        case 5:
            // A plate with a knob at its rim.
            compound.children.push_back({BoxShape{{a, 0.2 * b, c}}, {}});
            compound.children.push_back({SphereShape{0.3 * a}, {{a, 0.2 * b, 0}, {}}});
            return compound;
        default:
            for (int i = 0; i < 12; ++i) {
                hull.points.push_back({random.between(-a, a), random.between(-b, b), random.between(-c, c)});
            }
            return hull;
    }
}

/// Any restitution, and any friction up to 1.2; the extremes are frequent.
inline Material random_material(Random& random) {
    const double mu = random.below(4) == 0 ? 0 : random.between(0, 1.2);
    const double restitution = random.below(4) > 0 ? random.unit() : random.below(2) > 0 ? 1.0 : 0.0;
    return {.friction_static = mu,
            .friction_dynamic = mu,
            .restitution = restitution,
            .friction_combine = CombineRule::geometric_mean};
}

}  // namespace embody::physics
