// SPDX-License-Identifier: MIT
#include "physics/collision/shapes/polytope_query.h"

#include "math/kernel_width.h"

namespace embody::physics::collision {

namespace {

const PolytopeKernels kernels = widest_kernels<PolytopeKernels>();

VectorLanes<double> view(const Lanes& lanes) { return {lanes.x.data(), lanes.y.data(), lanes.z.data(), lanes.size()}; }

}  // namespace

Extreme farthest(const Lanes& lanes, Vec3 direction) {
    const double d[3] = {direction.x, direction.y, direction.z};
    return kernels.farthest(view(lanes), d);
}

Extent extent(const Lanes& lanes, Vec3 direction) {
    const double d[3] = {direction.x, direction.y, direction.z};
    return kernels.extent(view(lanes), d);
}

std::uint32_t farthest_roughly(const RoughLanes& lanes, Vec3 direction) {
    const Vec3f rough = to_vec3f(direction);
    const float d[3] = {rough.x, rough.y, rough.z};
    return kernels.farthest_roughly({lanes.x.data(), lanes.y.data(), lanes.z.data(), lanes.x.size()}, d);
}

double heights_over_faces(const Polytope& polytope, Vec3 point, double* heights) {
    const double d[3] = {point.x, point.y, point.z};
    return kernels.heights_over_faces(view(polytope.normal_lanes), polytope.reach.data(), d, heights);
}

Extreme lower_bounds(const Polytope& polytope, Vec3 point, double* bounds) {
    const double d[3] = {point.x, point.y, point.z};
    return kernels.lower_bounds(view(polytope.normal_lanes), polytope.reach.data(), d, bounds);
}

std::uint32_t find_low(const Lanes& lanes, Vec3 direction, double limit, std::uint32_t* found) {
    const double d[3] = {direction.x, direction.y, direction.z};
    return kernels.find_low(view(lanes), d, limit, found);
}

}  // namespace embody::physics::collision
