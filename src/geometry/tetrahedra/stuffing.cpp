// SPDX-License-Identifier: MIT
//
// F. Labelle, J. R. Shewchuk, "Isosurface stuffing: fast tetrahedral meshes with good dihedral angles", ACM Trans. on
// Graphics 26(3), 2007, with a lattice of one size. Every edge of the lattice that leaves the solid has a cut point.
// Where one is close to a node, the node moves there; the tetrahedra that are still cut are replaced by up to three
// within. Their shapes cannot be bad, since no cut point is close to a node any more. Other than in the paper cut
// points come from the surface itself, not from values at the nodes: overlapping parts make a distance without meaning.
#include "geometry/tetrahedra/stuffing.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace embody::geometry {
namespace {

// Fractions of an edge's length within which a node moves to the cut point: of the lattice's axes and of its diagonals.
constexpr double close_on_axis = 0.24999;
constexpr double close_on_diagonal = 0.41189;

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

// In half cells. Nodes have three even coordinates (corners of cubes) or three odd ones (middles).
using Place = std::array<int, 3>;
constexpr Place operator+(const Place& a, const Place& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
constexpr Place operator-(const Place& a, const Place& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

constexpr std::size_t directions = 7;
constexpr std::array<Place, directions> ways{
    {{2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {1, 1, 1}, {1, 1, -1}, {1, -1, 1}, {1, -1, -1}}};
constexpr bool is_axis(std::size_t direction) { return direction < 3; }

Place count_cells(const Bounds& box, double cell) {
    Place count{};
    const Vec3 size = box.size();
    for (int k = 0; k < 3; ++k)
        count[static_cast<std::size_t>(k)] = static_cast<int>(std::ceil(size[k] / cell + 1e-9)) + 2;
    return count;
}

enum class Side : std::int8_t { outside = -1, on_surface = 0, inside = 1 };

class Stuffing {
public:
    Stuffing(const EnclosedSolid& solid, double cell);
    TetrahedralMesh run();

private:
    struct Node {
        Place place{};
        Vec3 position;
        Side side = Side::outside;
        std::array<float, directions> cut;  // fraction of the edge from here; negative where there is none
        std::uint32_t used = none;          // number in the result
        std::array<std::uint32_t, directions> used_cuts;
    };
    // A corner of a piece: a node, or the cut of the edge that starts at it. `ideal` gives its orientation.
    struct Corner {
        std::uint32_t* number = nullptr;
        Vec3 position;
        Place ideal{};  // in quarter cells
    };
    struct Edge {
        std::uint32_t from = 0;
        std::size_t direction = 0;
    };

    [[nodiscard]] std::uint32_t find(const Place& p) const;
    [[nodiscard]] Vec3 lattice_position(const Place& p) const {
        return lower_ + 0.5 * cell_ * Vec3{double(p[0]), double(p[1]), double(p[2])};
    }
    [[nodiscard]] Edge edge_between(std::uint32_t a, std::uint32_t b) const;
    [[nodiscard]] bool is_on_axis(std::uint32_t a, std::uint32_t b) const {
        return is_axis(edge_between(a, b).direction);
    }
    void make_nodes();
    void cut_edges();
    void move_nodes();
    void move_node(std::uint32_t index);
    void fill_between(std::uint32_t middle, std::size_t axis);
    void fill(const Tetrahedron& t);
    void fill_wedge(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d);
    void fill_truncated(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t out);
    [[nodiscard]] bool diagonal_from_first(std::uint32_t a, std::uint32_t b, std::uint32_t out) const;
    Corner node(std::uint32_t index);
    Corner cut(std::uint32_t a, std::uint32_t b);
    void add(std::array<Corner, 4> corners);

    const EnclosedSolid& solid_;
    double cell_;
    Place cells_;
    Vec3 lower_;
    std::vector<Node> nodes_;  // corners of cubes, then middles; x fastest
    TetrahedralMesh mesh_;
};

Stuffing::Stuffing(const EnclosedSolid& solid, double cell)
    : solid_(solid), cell_(cell), cells_(count_cells(solid.bounds(), cell)) {
    lower_ = solid.bounds().center() - 0.5 * cell * Vec3{double(cells_[0]), double(cells_[1]), double(cells_[2])};
}

TetrahedralMesh Stuffing::run() {
    make_nodes();
    cut_edges();
    move_nodes();
    for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
        if (nodes_[i].place[0] % 2 == 0) continue;
        for (std::size_t axis = 0; axis < 3; ++axis) fill_between(i, axis);
    }
    return std::move(mesh_);
}

std::uint32_t Stuffing::find(const Place& p) const {
    const int odd = p[0] & 1;
    const Place count{cells_[0] + 1 - odd, cells_[1] + 1 - odd, cells_[2] + 1 - odd};
    for (std::size_t k = 0; k < 3; ++k) {
        if (p[k] < odd || p[k] / 2 >= count[k]) return none;
    }
    const auto at = [](int i) { return static_cast<std::uint32_t>(i); };
    const std::uint32_t corners = at(cells_[0] + 1) * at(cells_[1] + 1) * at(cells_[2] + 1);
    return (odd != 0 ? corners : 0) + (at(p[2] / 2) * at(count[1]) + at(p[1] / 2)) * at(count[0]) + at(p[0] / 2);
}

Stuffing::Edge Stuffing::edge_between(std::uint32_t a, std::uint32_t b) const {
    const Place way = nodes_[b].place - nodes_[a].place;
    for (std::size_t d = 0; d < directions; ++d) {
        if (way == ways[d]) return {a, d};
        if (way == Place{} - ways[d]) return {b, d};
    }
    return {a, directions};
}

void Stuffing::make_nodes() {
    for (int odd = 0; odd < 2; ++odd) {
        for (int z = odd; z <= 2 * cells_[2]; z += 2) {
            for (int y = odd; y <= 2 * cells_[1]; y += 2) {
                for (int x = odd; x <= 2 * cells_[0]; x += 2) {
                    Node made;
                    made.place = {x, y, z};
                    made.position = lattice_position(made.place);
                    made.side = solid_.contains(made.position) ? Side::inside : Side::outside;
                    made.cut.fill(-1);
                    made.used_cuts.fill(none);
                    nodes_.push_back(made);
                }
            }
        }
    }
}

void Stuffing::cut_edges() {
    for (Node& from : nodes_) {
        for (std::size_t d = 0; d < directions; ++d) {
            const std::uint32_t other = find(from.place + ways[d]);
            if (other == none || nodes_[other].side == from.side) continue;
            const Node& to = nodes_[other];
            const bool leaves = from.side == Side::inside;
            const double share =
                leaves ? solid_.leave(from.position, to.position) : 1 - solid_.leave(to.position, from.position);
            from.cut[d] = static_cast<float>(share);
        }
    }
}

void Stuffing::move_nodes() {
    for (std::uint32_t i = 0; i < nodes_.size(); ++i) move_node(i);
}

// Moves the node to the nearest of the cut points that are too close; those of its edges are then gone.
void Stuffing::move_node(std::uint32_t index) {
    Node& node = nodes_[index];
    double least = std::numeric_limits<double>::infinity();
    Vec3 to;
    std::array<float*, 2 * directions> cuts{};
    std::size_t count = 0;
    for (std::size_t d = 0; d < directions; ++d) {
        const double length = cell_ * (is_axis(d) ? 1 : std::sqrt(0.75));
        for (const int sign : {1, -1}) {
            const std::uint32_t other = find(sign > 0 ? node.place + ways[d] : node.place - ways[d]);
            if (other == none) continue;
            float& cut = sign > 0 ? node.cut[d] : nodes_[other].cut[d];
            if (cut < 0) continue;
            cuts[count++] = &cut;
            const double share = sign > 0 ? double(cut) : 1 - double(cut);
            if (!(share < (is_axis(d) ? close_on_axis : close_on_diagonal)) || !(share * length < least)) continue;
            least = share * length;
            to = lattice_position(node.place) +
                 share * (lattice_position(nodes_[other].place) - lattice_position(node.place));
        }
    }
    if (!std::isfinite(least)) return;
    node.position = to;
    node.side = Side::on_surface;
    for (std::size_t i = 0; i < count; ++i) *cuts[i] = -1;
}

// ---------------------------------------------------------------------------------------- pieces

// The four tetrahedra around the line from the middle of one cube to the next: one for each side of the square between.
void Stuffing::fill_between(std::uint32_t middle, std::size_t axis) {
    const Place from = nodes_[middle].place;
    const std::uint32_t next = find(from + ways[axis]);
    if (next == none) return;
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::array<std::uint32_t, 4> square{};
    for (std::size_t i = 0; i < 4; ++i) {
        Place p = from;
        p[axis] += 1;
        p[u] += i == 0 || i == 3 ? -1 : 1;
        p[v] += i < 2 ? -1 : 1;
        square[i] = find(p);
    }
    for (std::size_t i = 0; i < 4; ++i) fill({middle, next, square[i], square[(i + 1) % 4]});
}

void Stuffing::fill(const Tetrahedron& t) {
    std::array<std::uint32_t, 4> in{}, out{}, on{};
    std::size_t ins = 0, outs = 0, ons = 0;
    for (const std::uint32_t corner : t) {
        switch (nodes_[corner].side) {
            case Side::inside:
                in[ins++] = corner;
                break;
            case Side::outside:
                out[outs++] = corner;
                break;
            case Side::on_surface:
                on[ons++] = corner;
        }
    }
    if (ins == 0) return;
    if (outs == 0) return add({node(t[0]), node(t[1]), node(t[2]), node(t[3])});
    if (ins == 3) return fill_truncated(in[0], in[1], in[2], out[0]);
    if (ins == 2 && outs == 2) return fill_wedge(in[0], in[1], out[0], out[1]);
    if (ins == 2) {
        // A pyramid over the quadrilateral of the face that is cut.
        const auto [a, b] = std::array{in[0], in[1]};
        const bool first = diagonal_from_first(a, b, out[0]);
        const Corner pa = cut(a, out[0]), pb = cut(b, out[0]), top = node(on[0]);
        add({node(a), node(b), first ? pb : pa, top});
        return add({first ? node(a) : node(b), pa, pb, top});
    }
    std::array<Corner, 4> corners{};
    for (std::size_t i = 0; i < 4; ++i) {
        corners[i] = nodes_[t[i]].side == Side::outside ? cut(in[0], t[i]) : node(t[i]);
    }
    add(corners);
}

// For the face a b out, whose cuts make a quadrilateral with a and b: whether its diagonal runs from a to the cut on
// b's edge, and not from b to that on a's. It runs to the cut on the long edge, which is the wider angle; else by
// order. Both tetrahedra at the face must agree.
bool Stuffing::diagonal_from_first(std::uint32_t a, std::uint32_t b, std::uint32_t out) const {
    if (is_on_axis(a, out)) return false;
    return is_on_axis(b, out) || a < b;
}

// a and b inside, c and d outside: a prism with the triangles a, ac, ad and b, bc, bd.
void Stuffing::fill_wedge(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    if (!diagonal_from_first(a, b, c)) std::swap(a, b);  // now a-bc
    const Corner ac = cut(a, c), ad = cut(a, d), bc = cut(b, c), bd = cut(b, d);
    if (diagonal_from_first(a, b, d)) {
        // a-bd as well: a is in all three, and the quadrilateral on the surface is free.
        add({node(a), node(b), bc, bd});
        if (distance(ac.position, bd.position) < distance(ad.position, bc.position)) {
            add({node(a), ac, bc, bd});
            return add({node(a), ac, bd, ad});
        }
        add({node(a), ac, bc, ad});
        return add({node(a), bc, bd, ad});
    }
    // b-ad: only ad-bc has no circle of diagonals.
    add({node(a), node(b), bc, ad});
    add({node(a), ac, bc, ad});
    add({node(b), bc, bd, ad});
}

// a, b, c inside: what is left when the corner `out` is cut off.
void Stuffing::fill_truncated(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t out) {
    // One of the edges to `out` is long; both quadrilaterals beside it are halved to its cut.
    if (is_on_axis(b, out)) std::swap(a, b);
    if (is_on_axis(c, out)) std::swap(a, c);
    const Corner pa = cut(a, out), pb = cut(b, out), pc = cut(c, out);
    add({node(a), node(b), node(c), pa});
    const bool first = diagonal_from_first(b, c, out);
    add({node(b), node(c), first ? pc : pb, pa});
    add({first ? node(b) : node(c), pb, pc, pa});
}

Stuffing::Corner Stuffing::node(std::uint32_t index) {
    Node& n = nodes_[index];
    return {&n.used, n.position, n.place + n.place};
}

Stuffing::Corner Stuffing::cut(std::uint32_t a, std::uint32_t b) {
    const Edge edge = edge_between(a, b);
    Node& from = nodes_[edge.from];
    const Vec3 start = lattice_position(from.place), end = lattice_position(from.place + ways[edge.direction]);
    return {&from.used_cuts[edge.direction], start + double(from.cut[edge.direction]) * (end - start),
            nodes_[a].place + nodes_[b].place};
}

void Stuffing::add(std::array<Corner, 4> corners) {
    const Place a = corners[1].ideal - corners[0].ideal, b = corners[2].ideal - corners[0].ideal,
                c = corners[3].ideal - corners[0].ideal;
    const int turned =
        a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
    if (turned < 0) std::swap(corners[2], corners[3]);
    Tetrahedron made{};
    for (std::size_t i = 0; i < 4; ++i) {
        std::uint32_t& number = *corners[i].number;
        if (number == none) {
            number = static_cast<std::uint32_t>(mesh_.nodes.size());
            mesh_.nodes.push_back(corners[i].position);
        }
        made[i] = number;
    }
    mesh_.tetrahedra.push_back(made);
}

}  // namespace

double count_lattice_nodes(const Bounds& box, double cell) {
    const Vec3 cells = box.size() / cell + Vec3{3, 3, 3};
    return 2 * cells.x * cells.y * cells.z;
}

TetrahedralMesh stuff(const EnclosedSolid& solid, double cell) { return Stuffing(solid, cell).run(); }

}  // namespace embody::geometry
