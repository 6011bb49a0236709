// SPDX-License-Identifier: MIT
#pragma once

#include "geometry/mass_properties.h"
#include "geometry/triangle_mesh.h"

namespace embody::geometry {

/// The source of an enclosed volume, from the most to the least certain.
enum class VolumeMethod {
    closed_mesh,     ///< polyhedral integrals of a closed mesh, or of closed parts that do not overlap
    closed_parts,    ///< the same, less the volume that overlapping closed parts count twice (measured on a grid)
    winding_number,  ///< closed parts as before, and grid cells that open parts wind around
    no_volume,       ///< no triangles, or nothing is enclosed: sheets, lines
};
/// "closed mesh", "closed parts", "winding number" or "no volume".
const char* name(VolumeMethod method);

/// The volume that a mesh encloses, as a solid of density 1.
struct VolumeEstimate {
    MassProperties solid;
    VolumeMethod method = VolumeMethod::no_volume;
    double relative_error = 1;       ///< expected error of the volume: a rule of thumb fitted to measured cases
    std::size_t boundary_edges = 0;  ///< after welding, of the whole mesh
    std::uint32_t component_count = 0;
};

/// The volume that `mesh` encloses, also where it is open, turned inside out or made of overlapping parts. Closed parts
/// are integrated exactly. Where they overlap or parts are open, the generalised winding number (A. Jacobson et al.
/// 2013) says for each of about `cells` grid cells whether it is inside, and only the difference from the exact sum is
/// taken from the grid: thin boards far below a cell keep their volume. Sheets without thickness enclose nothing. Costs
/// well below 1 s for 100,000 triangles.
VolumeEstimate estimate_volume(const TriangleMesh& mesh, int cells = 32768);

/// The winding number of the oriented surface around points: 1 inside a closed mesh, 0 outside, in between near holes.
/// Far triangles count as dipoles, together (G. Barill et al., "Fast winding numbers for soups and clouds", 2018).
class WindingNumber {
public:
    explicit WindingNumber(const TriangleMesh& mesh);
    [[nodiscard]] double at(Vec3 point) const;

private:
    // A range of triangles as one dipole, and the next cluster if it is far enough to count as a dipole.
    struct Cluster {
        Vec3 center;
        Vec3 area_vector;
        double radius = 0;
        std::uint32_t first = 0, count = 0;  // triangles; count 0 for inner nodes, whose children follow
        std::uint32_t next = 0;              // cluster after the last descendant
    };
    void build(std::uint32_t first, std::uint32_t last);

    std::vector<std::array<Vec3, 3>> triangles_;
    std::vector<Cluster> clusters_;  // depth first
};

}  // namespace embody::geometry
