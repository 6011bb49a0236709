// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>
#include <vector>

#include "foundation/result.h"
#include "scene/document/kept_form.h"
#include "scene/embody/form_cache.h"
#include "scene/embody/points_definition.h"

namespace embody::scene {

/// What a kept form is like that belongs to an entity's points.
struct KeptFit {
    std::string fingerprint;  ///< hash of what the points are made from, 16 hexadecimal digits; empty: one body
    std::size_t min_points = 1, max_points = 0;
    std::size_t strains = 0;                              ///< tetrahedra and nodes of a soft solid; 0: another matter
    std::size_t segments = 0;                             ///< of a rope
    std::size_t bends = 0;                                ///< of a sheet's triangles, of a rope's nodes
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< of a sheet
    bool is_liquid = false;
};

/// Of grains or a liquid, from the key of their points and their geometry; at most `budget` points.
KeptFit fit_of_particles(const GeometryKey& key, const Geometry& geometry, std::size_t budget, bool is_liquid);
/// Of a deformable, with the elements of its mesh.
KeptFit fit_of_mesh(const GeometryKey& key, const Geometry& geometry, const catalog::SoftMesh& mesh);
KeptFit fit_of_mesh(const GeometryKey& key, const Geometry& geometry, const ThinForm& form);

/// Whether the kept form belongs to these points; the error's `where` is its field.
Result<void> check_kept(const KeptForm& kept, const KeptFit& fit);

// Between the numbers of a kept form and their meaning.
std::vector<Vec3> places_of(const KeptForm& kept);  ///< in the entity's frame, m
physics::LastingDeformation lasting_of(const KeptForm& kept);
PackedNumbers packed(const std::vector<Vec3>& places);
std::vector<std::uint32_t> packed(const std::vector<physics::TornCorner>& corners);
template <std::size_t n>
PackedNumbers packed(const std::vector<std::array<double, n>>& rows) {
    PackedNumbers numbers;
    numbers.values.reserve(n * rows.size());
    for (const auto& row : rows) numbers.values.insert(numbers.values.end(), row.begin(), row.end());
    return numbers;
}

}  // namespace embody::scene
