// SPDX-License-Identifier: MIT
#include "catalog/prepare/placement.h"

#include <algorithm>

#include "math/bounds.h"
#include "math/mat3.h"

namespace embody::catalog {
namespace {

constexpr double largest_extent = 10'000;  // m
constexpr double flat = 1e-6;              // fraction of the largest extent below which an axis is flat

Bounds bounds_of(const interchange::RawScene& scene, const Mat3& rotation) {
    Bounds bounds;
    for (const auto& mesh : scene.meshes) {
        for (const auto& t : mesh.triangles) {
            for (const std::uint32_t i : t) bounds.add(rotation * to_vec3(mesh.positions[i]));
        }
    }
    return bounds;
}

Mat3 matrix_of_rows(const std::array<double, 9>& m) {
    return {{m[0], m[3], m[6]}, {m[1], m[4], m[7]}, {m[2], m[5], m[8]}};
}

Vec3 scale_to(const Vec3& size, const ImportItem& item) {
    const double unit = item.stated_unit.value_or(1);
    Vec3 factors{unit, unit, unit};
    if (!item.stated_size) return factors;
    const double largest = std::max({size.x, size.y, size.z});
    for (int axis = 0; axis < 3; ++axis) {
        if (size[axis] > flat * largest) {
            factors[axis] = (*item.stated_size)[static_cast<std::size_t>(axis)] / size[axis];
        }
    }
    return factors;
}

}  // namespace

Result<void> place(interchange::RawScene& scene, const ImportItem& item) {
    const Mat3 rotation = matrix_of_rows(item.stated_rotation);
    const Bounds turned = bounds_of(scene, rotation);
    const Vec3 factors = scale_to(turned.size(), item);
    const Mat3 linear = Mat3::diagonal(factors) * rotation;
    const Vec3 c = turned.center();
    const Vec3 base = scale(factors, {c.x, turned.lower.y, c.z});

    // Bounds that are empty, not finite or absurd.
    const Vec3 size = scale(factors, turned.size());
    const double largest = std::max({size.x, size.y, size.z});
    if (!is_finite(size) || !(largest > 0)) return Error{item.path, "has no extent"};
    if (largest > largest_extent) {
        return Error{item.path, "is " + std::to_string(largest) + " m large", "is the file in metres?"};
    }

    const Mat3 for_normals = transpose(inverse_or_zero(linear));
    const bool mirrored = determinant(linear) < 0;
    for (auto& mesh : scene.meshes) {
        for (Vec3f& p : mesh.positions) p = to_vec3f(linear * to_vec3(p) - base);
        for (Vec3f& n : mesh.normals) n = to_vec3f(normalized(for_normals * to_vec3(n), {0, 1, 0}));
        if (!mirrored) continue;
        for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
    }
    return {};
}

}  // namespace embody::catalog
