// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/document/field_list.h"

namespace embody::scene {

/// Many numbers; in files as base64 (RFC 4648, section 4) of their little-endian IEEE 754 doubles, on lines.
struct PackedNumbers {
    std::vector<double> values;
    friend bool operator==(const PackedNumbers&, const PackedNumbers&) = default;
};
/// Maximum of one list: the places of two million points.
inline constexpr std::size_t max_packed_numbers = 6'000'000;

/// The form that a run had brought an entity that is not one body into, with which the next one begins (docs/time.md).
struct KeptForm {
    std::string fingerprint;
    PackedNumbers places;
    PackedNumbers plastic_strain;
    std::vector<std::uint32_t> broken;
    PackedNumbers bend;
    std::vector<std::uint32_t> torn;
    double cell_size = 0;
    friend bool operator==(const KeptForm&, const KeptForm&) = default;
};

/// Numbers of plastic strain that a tetrahedron or node has: xx, yy, xy, xz and yz.
inline constexpr std::size_t numbers_per_strain = 5;
/// Numbers of what bending leaves that a triangle has: xx, yy and √2 xy of what friction holds, then of folds that
/// stay.
inline constexpr std::size_t numbers_per_bend = 6;
/// Numbers of a corner that has torn off: corner, node before, node.
inline constexpr std::size_t numbers_per_tear = 3;
/// m: farthest place from the entity's origin, in each coordinate.
inline constexpr double max_kept_distance = 1e6;

template <>
inline constexpr auto fields_of<KeptForm> = std::tuple{
    always_needed(
        "fingerprint", &KeptForm::fingerprint,
        "of what the points were made from: 16 hexadecimal digits. Where the entity's is another one, the run "
        "begins as modelled"),
    always_needed("places", &KeptForm::places, "x, y, z of each node, grain or drop, in the entity's frame",
                  {.unit = "m"}),
    saved_when_set(
        "plastic_strain", &KeptForm::plastic_strain,
        "of a soft solid: xx, yy, xy, xz, yz of each tetrahedron, then of each node, in the axes at rest; zz is "
        "-(xx + yy)"),
    saved_when_set("broken", &KeptForm::broken,
                   "of a rope: its broken segments, ascending; segment k is between the nodes "
                   "k and k + 1"),
    saved_when_set(
        "bend", &KeptForm::bend,
        "of a sheet: the curvature (1/m) that friction holds, xx, yy and √2 xy of each triangle, x along the warp, "
        "then that of folds that stay. Of a wire: of each node the changes of direction that stay at it, before its "
        "clamp and after it, each as two parts across the wire"),
    saved_when_set("torn", &KeptForm::torn,
                   "of a sheet: where it has torn, in the order of time. Three numbers each: a corner, 3 t + k of "
                   "triangle t, the node that it had, and the one that it has"),
    saved_when_set("cell_size", &KeptForm::cell_size,
                   "of a liquid: twice the cube root of a drop's volume; 0: no liquid", {0, 1, "m"}),
};
static_assert(lists_all_members<KeptForm>(), "a member of KeptForm is in no list, or one is there twice");

}  // namespace embody::scene
