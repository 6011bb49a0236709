// SPDX-License-Identifier: MIT
#include "geometry/tetrahedra/separation.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace embody::geometry {
namespace {

constexpr std::uint32_t not_numbered = std::numeric_limits<std::uint32_t>::max();

// Disjoint sets, each known by its smallest member, so that the order of joining does not matter.
class Sets {
public:
    explicit Sets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0U); }
    std::uint32_t find(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(std::uint32_t a, std::uint32_t b) {
        a = find(a);
        b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<std::uint32_t> parent_;
};

std::uint32_t corner_of(const Tetrahedron& t, std::uint32_t node) {
    return static_cast<std::uint32_t>(std::find(t.begin(), t.end(), node) - t.begin());
}

// A node of its own for each group of tetrahedra that is connected through faces at that node.
void separate_nodes(TetrahedralMesh& mesh, const TetrahedralTopology& topology) {
    Sets uses(4 * mesh.tetrahedra.size());  // corner k of tetrahedron t is 4 t + k
    for (const auto& [a, b] : topology.neighbours) {
        for (std::uint32_t k = 0; k < 4; ++k) {
            const std::uint32_t other = corner_of(mesh.tetrahedra[b], mesh.tetrahedra[a][k]);
            if (other < 4) uses.join(4 * a + k, 4 * b + other);
        }
    }
    std::vector<Vec3> nodes;
    std::vector<std::uint32_t> number(4 * mesh.tetrahedra.size(), not_numbered);
    for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t) {
        for (std::uint32_t k = 0; k < 4; ++k) {
            std::uint32_t& given = number[uses.find(4 * t + k)];
            if (given == not_numbered) {
                given = static_cast<std::uint32_t>(nodes.size());
                nodes.push_back(mesh.nodes[mesh.tetrahedra[t][k]]);
            }
            mesh.tetrahedra[t][k] = given;
        }
    }
    mesh.nodes = std::move(nodes);
}

// Edges with more than two outer faces, in ascending order.
std::vector<std::array<std::uint32_t, 2>> find_crowded_edges(const TetrahedralTopology& topology) {
    std::vector<std::array<std::uint32_t, 2>> edges, crowded;
    for (const TetrahedronFace& face : topology.outer_faces) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = face.corners[i], b = face.corners[(i + 1) % 3];
            edges.push_back({std::min(a, b), std::max(a, b)});
        }
    }
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 2; i < edges.size(); ++i) {
        if (edges[i] == edges[i - 2] && (crowded.empty() || crowded.back() != edges[i])) crowded.push_back(edges[i]);
    }
    return crowded;
}

// Leaves out all tetrahedra at the edge but the group of the largest volume.
void thin_out(const TetrahedralMesh& mesh, const TetrahedralTopology& topology, std::array<std::uint32_t, 2> edge,
              std::vector<bool>& left_out) {
    const auto is_at_edge = [&](std::uint32_t t) {
        return corner_of(mesh.tetrahedra[t], edge[0]) < 4 && corner_of(mesh.tetrahedra[t], edge[1]) < 4;
    };
    std::vector<std::uint32_t> around;
    for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t) {
        if (is_at_edge(t)) around.push_back(t);
    }
    const auto index = [&](std::uint32_t t) {
        return static_cast<std::uint32_t>(std::find(around.begin(), around.end(), t) - around.begin());
    };
    Sets groups(around.size());
    for (const auto& [a, b] : topology.neighbours) {
        if (is_at_edge(a) && is_at_edge(b)) groups.join(index(a), index(b));
    }
    std::vector<double> volumes(around.size(), 0);
    for (std::uint32_t i = 0; i < around.size(); ++i) {
        volumes[groups.find(i)] += signed_volume(mesh, mesh.tetrahedra[around[i]]);
    }
    const auto largest = static_cast<std::uint32_t>(std::max_element(volumes.begin(), volumes.end()) - volumes.begin());
    for (std::uint32_t i = 0; i < around.size(); ++i) {
        if (groups.find(i) != largest) left_out[around[i]] = true;
    }
}

void drop(TetrahedralMesh& mesh, const std::vector<bool>& left_out) {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
        if (!left_out[t]) mesh.tetrahedra[kept++] = mesh.tetrahedra[t];
    }
    mesh.tetrahedra.resize(kept);
}

void drop_unused_nodes(TetrahedralMesh& mesh) {
    std::vector<std::uint32_t> number(mesh.nodes.size(), not_numbered);
    std::vector<Vec3> nodes;
    for (Tetrahedron& t : mesh.tetrahedra) {
        for (std::uint32_t& corner : t) {
            if (number[corner] == not_numbered) {
                number[corner] = static_cast<std::uint32_t>(nodes.size());
                nodes.push_back(mesh.nodes[corner]);
            }
            corner = number[corner];
        }
    }
    mesh.nodes = std::move(nodes);
}

}  // namespace

void separate(TetrahedralMesh& mesh) {
    // Each iteration drops at least one tetrahedron, so the loop ends.
    for (;;) {
        separate_nodes(mesh, find_tetrahedral_topology(mesh.tetrahedra));
        const TetrahedralTopology topology = find_tetrahedral_topology(mesh.tetrahedra);
        const auto crowded = find_crowded_edges(topology);
        if (crowded.empty()) return;
        std::vector<bool> left_out(mesh.tetrahedra.size(), false);
        for (const auto& edge : crowded) thin_out(mesh, topology, edge, left_out);
        drop(mesh, left_out);
    }
}

TetrahedralComponents find_components(const TetrahedralMesh& mesh) {
    Sets sets(mesh.tetrahedra.size());
    for (const auto& [a, b] : find_tetrahedral_topology(mesh.tetrahedra).neighbours) sets.join(a, b);
    struct Part {
        std::uint32_t first = 0;
        double volume = 0;
    };
    std::vector<Part> parts(mesh.tetrahedra.size());
    for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t) {
        parts[t].first = t;
        parts[sets.find(t)].volume += signed_volume(mesh, mesh.tetrahedra[t]);
    }
    std::erase_if(parts, [&](const Part& part) { return sets.find(part.first) != part.first; });
    std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) {
        return a.volume != b.volume ? a.volume > b.volume : a.first < b.first;
    });
    TetrahedralComponents components;
    std::vector<std::uint32_t> rank(mesh.tetrahedra.size(), not_numbered);
    for (const Part& part : parts) {
        rank[part.first] = static_cast<std::uint32_t>(components.volumes.size());
        components.volumes.push_back(part.volume);
    }
    for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t) components.component_of.push_back(rank[sets.find(t)]);
    return components;
}

void keep_components(TetrahedralMesh& mesh, TetrahedralComponents& components, std::size_t count) {
    if (count >= components.volumes.size()) return;
    std::vector<bool> left_out(mesh.tetrahedra.size());
    for (std::size_t t = 0; t < left_out.size(); ++t) left_out[t] = components.component_of[t] >= count;
    drop(mesh, left_out);
    drop_unused_nodes(mesh);
    std::erase_if(components.component_of, [&](std::uint32_t c) { return c >= count; });
    components.volumes.resize(count);
}

void find_surface(TetrahedralMesh& mesh) {
    mesh.surface.clear();
    mesh.surface_tetrahedra.clear();
    for (const TetrahedronFace& face : find_tetrahedral_topology(mesh.tetrahedra).outer_faces) {
        mesh.surface.push_back(face.corners);
        mesh.surface_tetrahedra.push_back(face.tetrahedron);
    }
}

}  // namespace embody::geometry
