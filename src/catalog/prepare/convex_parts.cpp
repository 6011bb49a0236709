// SPDX-License-Identifier: MIT
#include "catalog/prepare/convex_parts.h"

#include <bit>
#include <cmath>

#include "geometry/decomposition/decomposition.h"

namespace embody::catalog {
namespace {

void put(std::vector<std::uint8_t>& bytes, std::uint32_t number) {
    for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(number >> shift));
}

std::uint32_t take(std::span<const std::uint8_t>& bytes) {
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < 4; ++i) number |= std::uint32_t{bytes[i]} << (8 * i);
    bytes = bytes.subspan(4);
    return number;
}

}  // namespace

Result<ConvexParts> make_convex_parts(const geometry::TriangleMesh& mesh, int max_hulls, double hull_error,
                                      double keep_below) {
    geometry::DecompositionParameters parameters;
    parameters.max_hulls = max_hulls;
    parameters.hull_error = hull_error;
    parameters.keep_below = keep_below;
    parameters.max_vertices = static_cast<int>(max_part_vertices);
    const auto made = geometry::decompose(mesh, parameters);
    if (!made) return made.error();
    ConvexParts parts{max_hulls, hull_error, made->concavity, made->hull_concavity, {}};
    for (const geometry::ConvexHull& hull : made->hulls) {
        parts.hulls.emplace_back();
        for (const Vec3 v : hull.vertices) parts.hulls.back().push_back(to_vec3f(v));
    }
    return parts;
}

std::vector<std::uint8_t> pack_hulls(const std::vector<std::vector<Vec3f>>& hulls) {
    std::vector<std::uint8_t> bytes;
    put(bytes, static_cast<std::uint32_t>(hulls.size()));
    for (const std::vector<Vec3f>& hull : hulls) {
        put(bytes, static_cast<std::uint32_t>(hull.size()));
        for (const Vec3f& p : hull) {
            for (const float number : {p.x, p.y, p.z}) put(bytes, std::bit_cast<std::uint32_t>(number));
        }
    }
    return bytes;
}

Result<std::vector<std::vector<Vec3f>>> unpack_hulls(std::span<const std::uint8_t> bytes) {
    const Error damaged{"convex parts", "are damaged", "import the model again"};
    if (bytes.size() < 4) return damaged;
    const std::uint32_t count = take(bytes);
    if (count > geometry::max_decomposition_hulls) return damaged;
    std::vector<std::vector<Vec3f>> hulls(count);
    for (std::vector<Vec3f>& hull : hulls) {
        if (bytes.size() < 4) return damaged;
        const std::uint32_t vertices = take(bytes);
        if (vertices > max_part_vertices || bytes.size() < 12 * std::size_t{vertices}) return damaged;
        hull.resize(vertices);
        for (Vec3f& p : hull) {
            for (float* number : {&p.x, &p.y, &p.z}) {
                *number = std::bit_cast<float>(take(bytes));
                if (!std::isfinite(*number)) return damaged;
            }
        }
    }
    if (!bytes.empty()) return damaged;
    return hulls;
}

}  // namespace embody::catalog
