// SPDX-License-Identifier: MIT
#include "physics/collision/polytope_query.h"

#include <cstring>

namespace embody::physics {

namespace {

// Two doubles in one register: what every 64-bit x86 and ARM machine has, without a choice at run time.
using Two = double __attribute__((vector_size(16)));
using TwoIndices = long long __attribute__((vector_size(16)));

Two load(const double* from) {
    Two two;
    std::memcpy(&two, from, sizeof two);
    return two;
}
void store(double* to, Two two) { std::memcpy(to, &two, sizeof two); }
Two both(double value) { return Two{value, value}; }

/// The highest values of four strands and where they were met first.
struct Strands {
    Two high_0 = both(-1e300), high_1 = both(-1e300);
    TwoIndices at_0{0, 1}, at_1{2, 3}, now_0{0, 1}, now_1{2, 3};

    void add(Two value_0, Two value_1) {
        const auto is_higher_0 = value_0 > high_0, is_higher_1 = value_1 > high_1;
        high_0 = is_higher_0 ? value_0 : high_0;
        high_1 = is_higher_1 ? value_1 : high_1;
        at_0 = is_higher_0 ? now_0 : at_0;
        at_1 = is_higher_1 ? now_1 : at_1;
        now_0 += 4;
        now_1 += 4;
    }
    [[nodiscard]] Extreme best() const {
        double along = high_0[0];
        long long index = at_0[0];
        const auto take = [&](double value, long long at) {
            const bool is_better = value > along || (value == along && at < index);
            along = is_better ? value : along;
            index = is_better ? at : index;
        };
        take(high_0[1], at_0[1]);
        take(high_1[0], at_1[0]);
        take(high_1[1], at_1[1]);
        return {along, static_cast<std::uint32_t>(index)};
    }
};

/// Dot products of lanes with one vector.
struct Products {
    const double *x, *y, *z;
    Two dx, dy, dz;

    Products(const Lanes& lanes, Vec3 d)
        : x(lanes.x.data()), y(lanes.y.data()), z(lanes.z.data()), dx(both(d.x)), dy(both(d.y)), dz(both(d.z)) {}
    [[nodiscard]] Two at(std::size_t i) const { return load(x + i) * dx + load(y + i) * dy + load(z + i) * dz; }
};

using Four = float __attribute__((vector_size(16)));
using FourIndices = int __attribute__((vector_size(16)));

/// The highest values of four lanes and where they were met first.
struct RoughStrand {
    Four high{-1e30F, -1e30F, -1e30F, -1e30F};
    FourIndices at, now;

    explicit RoughStrand(int first) : at{first, first + 1, first + 2, first + 3}, now(at) {}
    void add(Four value) {
        const auto is_higher = value > high;
        high = is_higher ? value : high;
        at = is_higher ? now : at;
        now += 8;
    }
};

}  // namespace

std::uint32_t farthest_roughly(const RoughLanes& lanes, Vec3 direction) {
    const Vec3f d = to_vec3f(direction);
    const Four dx{d.x, d.x, d.x, d.x}, dy{d.y, d.y, d.y, d.y}, dz{d.z, d.z, d.z, d.z};
    const auto product = [&](std::size_t i) {
        Four x, y, z;
        std::memcpy(&x, lanes.x.data() + i, sizeof x);
        std::memcpy(&y, lanes.y.data() + i, sizeof y);
        std::memcpy(&z, lanes.z.data() + i, sizeof z);
        return x * dx + y * dy + z * dz;
    };
    RoughStrand even(0), odd(4);
    for (std::size_t i = 0; i < lanes.x.size(); i += 8) {
        even.add(product(i));
        odd.add(product(i + 4));
    }

    // Of equal ones the first.
    float along = even.high[0];
    int index = even.at[0];
    for (const RoughStrand& strand : {even, odd}) {
        for (int lane = 0; lane < 4; ++lane) {
            const bool is_tie = strand.high[lane] == along && strand.at[lane] < index;
            if (!(strand.high[lane] > along) && !is_tie) continue;
            along = strand.high[lane];
            index = strand.at[lane];
        }
    }
    return static_cast<std::uint32_t>(index);
}

Extreme farthest(const Lanes& lanes, Vec3 direction) {
    const Products products(lanes, direction);
    Strands strands;
    const std::size_t count = lanes.size();
    for (std::size_t i = 0; i < count; i += 4) strands.add(products.at(i), products.at(i + 2));
    return strands.best();
}

double heights_over_faces(const Polytope& polytope, Vec3 point, double* heights) {
    const Products products(polytope.normal_lanes, point);
    const double* reach = polytope.reach.data();
    const std::size_t count = polytope.normal_lanes.size();
    Two high = both(-1e300);
    for (std::size_t i = 0; i < count; i += 2) {
        const Two height = products.at(i) - load(reach + i);
        store(heights + i, height);
        high = height > high ? height : high;
    }
    return high[0] > high[1] ? high[0] : high[1];
}

Extreme lower_bounds(const Polytope& polytope, Vec3 point, double* bounds) {
    const Products products(polytope.normal_lanes, point);
    const double* reach = polytope.reach.data();
    const std::size_t count = polytope.normal_lanes.size();
    Strands strands;
    const auto lowered = [&](std::size_t i) {
        const Two height = products.at(i) - load(reach + i), bound = load(bounds + i);
        const Two lower = height < bound ? height : bound;
        store(bounds + i, lower);
        return lower;
    };
    for (std::size_t i = 0; i < count; i += 4) {
        const Two first = lowered(i);
        strands.add(first, lowered(i + 2));
    }
    return strands.best();
}

}  // namespace embody::physics
