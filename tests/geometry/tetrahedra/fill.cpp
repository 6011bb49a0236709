// SPDX-License-Identifier: MIT
#include "geometry/tetrahedra/fill.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "foundation/random.h"
#include "geometry/sample_meshes.h"
#include "geometry/topology.h"

namespace embody::geometry {
namespace {

TetrahedralFilling filled(const TriangleMesh& surface, const TetrahedralParameters& parameters = {}) {
    auto made = fill_with_tetrahedra(surface, parameters);
    EXPECT_TRUE(made.ok()) << made.error().message();
    return made.ok() ? *std::move(made) : TetrahedralFilling{};
}

// Volume of the outer faces alone, as tetrahedra from the first node (theorem of Gauss).
double volume_within_surface(const TetrahedralMesh& mesh) {
    double sum = 0;
    const Vec3 from = mesh.nodes[0];
    for (const auto& [a, b, c] : mesh.surface) {
        sum += dot(mesh.nodes[a] - from, cross(mesh.nodes[b] - from, mesh.nodes[c] - from)) / 6;
    }
    return sum;
}

// Checks what holds for every filling of any surface.
void expect_sound(const TetrahedralFilling& filling) {
    const TetrahedralMesh& mesh = filling.mesh;
    ASSERT_FALSE(mesh.tetrahedra.empty());
    std::set<std::uint32_t> used;
    double sum = 0;
    for (const Tetrahedron& t : mesh.tetrahedra) {
        EXPECT_GT(signed_volume(mesh, t), 0);
        sum += signed_volume(mesh, t);
        for (const std::uint32_t corner : t) used.insert(corner);
    }
    EXPECT_EQ(used.size(), mesh.nodes.size());
    EXPECT_EQ(*used.rbegin() + 1, mesh.nodes.size());
    // No two tetrahedra overlap: the volume within the faces is the sum of the tetrahedra's.
    EXPECT_NEAR(volume_within_surface(mesh), sum, 1e-9 * sum);

    const DihedralAngles angles = measure_dihedral_angles(mesh);
    EXPECT_GT(angles.least, 9);
    EXPECT_LT(angles.largest, 165);

    TriangleMesh outside;
    for (const Vec3 node : mesh.nodes) outside.positions.push_back(to_vec3f(node));
    outside.triangles = mesh.surface;
    EXPECT_TRUE(find_topology(outside).is_closed());
    ASSERT_EQ(mesh.surface_tetrahedra.size(), mesh.surface.size());
    for (std::size_t i = 0; i < mesh.surface.size(); ++i) {
        const Tetrahedron& t = mesh.tetrahedra[mesh.surface_tetrahedra[i]];
        for (const std::uint32_t corner : mesh.surface[i]) EXPECT_NE(std::find(t.begin(), t.end(), corner), t.end());
    }

    ASSERT_EQ(filling.component_of.size(), mesh.tetrahedra.size());
    std::vector<double> volumes(filling.component_volumes.size(), 0);
    for (std::size_t i = 0; i < mesh.tetrahedra.size(); ++i) {
        ASSERT_LT(filling.component_of[i], volumes.size());
        volumes[filling.component_of[i]] += signed_volume(mesh, mesh.tetrahedra[i]);
    }
    for (std::size_t i = 0; i < volumes.size(); ++i) {
        EXPECT_NEAR(volumes[i], filling.component_volumes[i], 1e-9 * sum);
        if (i > 0) {
            EXPECT_LE(filling.component_volumes[i], filling.component_volumes[i - 1]);
        }
    }
}

void expect_volume(const TriangleMesh& surface, int tetrahedra, double expected, double tolerance) {
    const TetrahedralFilling filling = filled(surface, {.tetrahedra = tetrahedra});
    expect_sound(filling);
    EXPECT_NEAR(volume(filling.mesh), expected, tolerance * expected) << tetrahedra << " tetrahedra";
    EXPECT_EQ(filling.component_volumes.size(), 1u);
}

TEST(FillWithTetrahedra, VolumesConverge) {
    const double ball = 4 * pi / 3 * 0.008;
    expect_volume(make_sphere(0.2, 128, 64), 500, ball, 0.06);
    expect_volume(make_sphere(0.2, 128, 64), 5000, ball, 0.015);
    expect_volume(make_sphere(0.2, 128, 64), 40000, ball, 0.005);
    expect_volume(make_box({0.3, 0.2, 0.1}), 500, 0.048, 0.1);
    expect_volume(make_box({0.3, 0.2, 0.1}), 5000, 0.048, 0.025);
    expect_volume(make_box({0.3, 0.2, 0.1}), 40000, 0.048, 0.01);
    const double torus = 2 * pi * pi * 0.5 * 0.04;
    expect_volume(make_torus(0.5, 0.2, 128, 64), 1000, torus, 0.08);
    expect_volume(make_torus(0.5, 0.2, 128, 64), 20000, torus, 0.012);
}

TEST(FillWithTetrahedra, NodesOutsideLieOnTheSurface) {
    const TetrahedralFilling filling = filled(make_sphere(1, 128, 64), {.tetrahedra = 3000});
    std::set<std::uint32_t> outer;
    for (const auto& face : filling.mesh.surface) outer.insert(face.begin(), face.end());
    for (const std::uint32_t node : outer) EXPECT_NEAR(length(filling.mesh.nodes[node]), 1, 0.003);
}

TEST(FillWithTetrahedra, CountIsWithinAThirdOfTheRequestedOne) {
    for (const int wanted : {200, 1000, 5000, 20000}) {
        for (const TriangleMesh& mesh : {make_sphere(0.3), make_box({1, 0.1, 0.4}), make_torus(0.5, 0.15)}) {
            const auto count = static_cast<double>(filled(mesh, {.tetrahedra = wanted}).mesh.tetrahedra.size());
            EXPECT_NEAR(count / wanted, 1, wanted < 1000 ? 0.35 : 0.25);
        }
    }
}

TEST(FillWithTetrahedra, SizeAndPlaceDoNotMatter) {
    const Quat turn = normalized(Quat{1, 2, 3, 4});
    for (const double size : {1e-3, 1.0, 1e3}) {
        const TriangleMesh mesh = moved(make_box({0.5 * size, 0.3 * size, 0.2 * size}), {{}, turn});
        expect_volume(mesh, 3000, 0.24 * size * size * size, 0.05);
    }
    expect_volume(make_box({0.5, 0.25, 0.25}, {4096, -2048, 1024}), 3000, 0.25, 0.04);
    expect_volume(make_sphere(0.5, 64, 32, {5000, 0, 0}), 3000, pi / 6, 0.03);
}

TEST(FillWithTetrahedra, ManyPosesOfManyThingsAreSound) {
    Random random(7);
    for (int i = 0; i < 40; ++i) {
        const Vec3 half{random.between(0.05, 1), random.between(0.05, 1), random.between(0.05, 1)};
        const Quat turn = normalized(Quat{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), 0.5});
        TriangleMesh mesh = moved(make_box(half), {{}, turn});
        if (i % 2 == 1) append(mesh, make_torus(random.between(0.3, 1), random.between(0.05, 0.3)));
        if (i % 4 >= 2) append(mesh, make_sphere(random.between(0.1, 1), 24, 12, half));
        expect_sound(filled(mesh, {.tetrahedra = 200 + 100 * i}));
    }
}

TEST(FillWithTetrahedra, SameMeshSameTetrahedra) {
    const TriangleMesh mesh = moved(make_torus(0.5, 0.2), {{1, 2, 3}, normalized(Quat{1, 2, 3, 4})});
    const TetrahedralFilling a = filled(mesh), b = filled(mesh);
    EXPECT_EQ(a.mesh.nodes, b.mesh.nodes);
    EXPECT_EQ(a.mesh.tetrahedra, b.mesh.tetrahedra);
    EXPECT_EQ(a.mesh.surface, b.mesh.surface);
}

TEST(FillWithTetrahedra, OpenTurnedAndOverlappingSurfacesAreFilled) {
    // Without its bottom, inside out and with vertices for each triangle.
    TriangleMesh open = make_soup(make_box({0.5, 0.3, 0.3}));
    std::erase_if(open.triangles, [&](const auto& t) {
        return std::all_of(t.begin(), t.end(), [&](std::uint32_t v) { return open.positions[v].y < 0; });
    });
    for (auto& t : open.triangles) std::swap(t[1], t[2]);
    const TetrahedralFilling box = filled(open);
    expect_sound(box);
    EXPECT_EQ(box.method, VolumeMethod::winding_number);
    EXPECT_NEAR(volume(box.mesh), 0.36, 0.06);
    EXPECT_NEAR(box.volume_fraction, 1, 0.05);

    // Two boxes that overlap: the overlap counts once, and the walls inside it have no effect.
    TriangleMesh pair = make_box({0.3, 0.2, 0.2}, {-0.2, 0, 0});
    append(pair, make_box({0.3, 0.2, 0.2}, {0.2, 0, 0}));
    expect_volume(pair, 5000, 1.0 * 0.4 * 0.4, 0.03);
}

TEST(FillWithTetrahedra, SeparatePartsAreReported) {
    TriangleMesh mesh = make_sphere(0.2);
    append(mesh, make_sphere(0.3, 64, 32, {1, 0, 0}));
    append(mesh, make_sphere(0.05, 64, 32, {2, 0, 0}));
    TetrahedralFilling parts = filled(mesh, {.tetrahedra = 8000, .least_component = 0});
    expect_sound(parts);
    ASSERT_EQ(parts.component_volumes.size(), 3u);
    EXPECT_NEAR(parts.component_volumes[0], 4 * pi / 3 * 0.027, 0.03 * 0.113);
    EXPECT_NEAR(parts.component_volumes[1], 4 * pi / 3 * 0.008, 0.03 * 0.034);
    EXPECT_EQ(parts.left_out_components, 0u);
    parts = filled(mesh, {.tetrahedra = 8000});
    expect_sound(parts);
    EXPECT_EQ(parts.component_volumes.size(), 2u);
    EXPECT_EQ(parts.left_out_components, 1u);
}

TEST(FillWithTetrahedra, BoxesThatTouchAtAnEdgeComeApart) {
    TriangleMesh mesh = make_box({0.5, 0.5, 0.5});
    append(mesh, make_box({0.5, 0.5, 0.5}, {1, 1, 0}));
    append(mesh, make_box({0.5, 0.5, 0.5}, {-1, -1, -1}));
    for (const double cell : {0.5, 0.25, 0.2, 0.13}) expect_sound(filled(mesh, {.cell = cell}));
}

TEST(FillWithTetrahedra, OverlappingBoxesInCoarseCellsAreSound) {
    Random random(3);
    for (int i = 0; i < 12; ++i) {
        TriangleMesh mesh;
        for (int k = 0; k < 30; ++k) {
            const Vec3 center{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
            const Vec3 half{random.between(0.05, 0.4), random.between(0.05, 0.4), random.between(0.05, 0.4)};
            append(mesh, moved(make_box(half), {center, normalized(Quat{random.between(-1, 1), 0.3, -0.2, 0.5})}));
        }
        expect_sound(filled(mesh, {.cell = random.between(0.1, 0.3), .least_component = 0}));
    }
}

TEST(FillWithTetrahedra, TheVolumeThatCellsMissIsReported) {
    // A ball with a long, thin rod.
    TriangleMesh mesh = make_sphere(0.2);
    append(mesh, make_box({1.5, 0.02, 0.02}, {1.6, 0, 0}));
    const TetrahedralFilling coarse = filled(mesh, {.cell = 0.1});
    expect_sound(coarse);
    EXPECT_LT(coarse.volume_fraction, 0.95);
    const TetrahedralFilling fine = filled(mesh, {.cell = 0.02});
    expect_sound(fine);
    EXPECT_GT(fine.volume_fraction, 0.96);
}

TEST(FillWithTetrahedra, RefusesWhatCannotBeFilled) {
    const TriangleMesh box = make_box({1, 1, 1});
    const TriangleMesh sheet{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 3, 2}}};
    EXPECT_EQ(fill_with_tetrahedra({}).error().where, "tetrahedra: surface");
    const auto flat = fill_with_tetrahedra(sheet);
    ASSERT_FALSE(flat.ok());
    EXPECT_FALSE(flat.error().remedy.empty());
    EXPECT_FALSE(fill_with_tetrahedra({{{0, 0, 0}}, {{0, 1, 7}}}).ok());
    TriangleMesh broken = box;
    broken.positions[0].y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(fill_with_tetrahedra(broken).ok());
    EXPECT_EQ(fill_with_tetrahedra(box, {.tetrahedra = 3}).error().where, "tetrahedra: tetrahedra");
    EXPECT_EQ(fill_with_tetrahedra(box, {.cell = -1}).error().where, "tetrahedra: cell");
    EXPECT_FALSE(fill_with_tetrahedra(box, {.cell = std::numeric_limits<double>::quiet_NaN()}).ok());
    EXPECT_FALSE(fill_with_tetrahedra(box, {.cell = 1e-4}).ok());
    EXPECT_FALSE(fill_with_tetrahedra(box, {.least_component = 2}).ok());
    EXPECT_FALSE(fill_with_tetrahedra(make_box({1, 0.001, 1}, {0, 0.3, 0}), {.cell = 1e6}).ok());
}

}  // namespace
}  // namespace embody::geometry
