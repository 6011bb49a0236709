// SPDX-License-Identifier: MIT
// Vessels of a random family hold what is poured into them: as closed meshes and single sheets that stand fast, and as
// pieces that move freely. docs/physics/fluids.md, "Vessels".
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "foundation/random.h"
#include "validation/fluid_scenes.h"

namespace embody::physics {
namespace {

constexpr int sides = 24;

/// A round vessel, from a bowl to a bucket: a truncated cone that is open at its top, and stands on the XZ plane about
/// the Y axis. Its inside has `sides` flat sides.
struct Vessel {
    double bottom_radius = 0, top_radius = 0;  // of its inside, m
    double height = 0;                         // of its inside, m
    double wall = 0;                           // thickness of wall and floor, m

    [[nodiscard]] double radius_at(double y) const {
        return bottom_radius + (top_radius - bottom_radius) * (y - wall) / height;
    }
    /// Volume of its inside up to a depth, and the height of that volume's middle.
    struct Filled {
        double volume = 0, middle = 0;
    };
    [[nodiscard]] Filled filled(double depth) const {
        constexpr int slices = 200;
        const double area = sides / 2.0 * std::sin(2 * pi / sides), slice = depth / slices;
        Filled sum;
        for (int i = 0; i < slices; ++i) {
            const double y = wall + (i + 0.5) * slice, radius = radius_at(y);
            const double volume = area * radius * radius * slice;
            sum.volume += volume;
            sum.middle += volume * y;
        }
        sum.middle /= sum.volume;
        return sum;
    }
    [[nodiscard]] double depth_of(double volume) const {
        double low = 0, high = height;
        for (int i = 0; i < 60; ++i) {
            const double middle = (low + high) / 2;
            (filled(middle).volume < volume ? low : high) = middle;
        }
        return low;
    }
};

Vec3 on_circle(double radius, double y, int i) {
    const double angle = 2 * pi * i / sides;
    return {radius * std::cos(angle), y, radius * std::sin(angle)};
}

/// Rings of points from the first to the last as one surface; a ring of radius 0 is a point.
MeshShape revolve(const std::vector<std::pair<double, double>>& profile) {
    MeshShape mesh;
    for (const auto& [radius, y] : profile) {
        for (int i = 0; i < sides; ++i) mesh.positions.push_back(to_vec3f(on_circle(radius, y, i)));
    }
    for (std::uint32_t ring = 0; ring + 1 < profile.size(); ++ring) {
        for (std::uint32_t i = 0; i < sides; ++i) {
            const std::uint32_t a = ring * sides + i, b = ring * sides + (i + 1) % sides, c = a + sides, d = b + sides;
            if (profile[ring].first > 0) mesh.triangles.push_back({a, c, b});
            if (profile[ring + 1].first > 0) mesh.triangles.push_back({b, c, d});
        }
    }
    return mesh;
}

MeshShape closed_mesh(const Vessel& vessel) {
    const double top = vessel.wall + vessel.height, t = vessel.wall;
    return revolve({{0, 0},
                    {vessel.bottom_radius + t, 0},
                    {vessel.top_radius + t, top},
                    {vessel.top_radius, top},
                    {vessel.bottom_radius, t},
                    {0, t}});
}

/// The inside alone, without thickness, its front inwards.
MeshShape single_sheet(const Vessel& vessel) {
    return revolve(
        {{vessel.top_radius, vessel.wall + vessel.height}, {vessel.bottom_radius, vessel.wall}, {0, vessel.wall}});
}

/// A floor and a wall of hulls, as the import makes them of hollow models.
CompoundShape pieces(const Vessel& vessel) {
    const double top = vessel.wall + vessel.height, t = vessel.wall;
    CompoundShape shape;
    HullShape floor;
    for (int i = 0; i < sides; ++i) {
        for (const double y : {0.0, t}) floor.points.push_back(on_circle(vessel.bottom_radius + t, y, i));
    }
    shape.children.push_back({std::move(floor), {}});
    for (int i = 0; i < sides; ++i) {
        HullShape plank;
        for (const int corner : {i, i + 1}) {
            for (const double out : {0.0, t}) {
                plank.points.push_back(on_circle(vessel.bottom_radius + out, t, corner));
                plank.points.push_back(on_circle(vessel.top_radius + out, top, corner));
            }
        }
        shape.children.push_back({std::move(plank), {}});
    }
    return shape;
}

enum class Make { closed_mesh, single_sheet, pieces };
const char* name_of(Make make) {
    return make == Make::closed_mesh ? "closed mesh" : make == Make::single_sheet ? "single sheet" : "pieces";
}

/// What a vessel has of its particles: those nowhere deeper than half a cell in its walls.
struct Held {
    double count = 0;
    double excess = 0;  ///< their mean height beyond that of their volume at rest, m
};
Held held_by(const World& world, FluidHandle water, const Vessel& vessel, const Transform& pose) {
    const FluidParticles particles = world.fluid_particles(water);
    const double slack = particles.cell_size / 2;
    double heights = 0, count = 0;
    for (const Vec3f p : particles.positions) {
        const Vec3 local = inverse_transform_point(pose, particles.origin + Vec3(p));
        const bool is_over_floor = local.y > vessel.wall - slack && local.y < vessel.wall + vessel.height;
        if (!is_over_floor || std::hypot(local.x, local.z) > vessel.radius_at(local.y) + slack) continue;
        count += 1;
        heights += local.y;
    }
    const double at_rest = vessel.filled(vessel.depth_of(count * particles.particle_volume)).middle;
    return {count, heights / count - at_rest};
}

class FluidVessels : public testing::TestWithParam<int> {};

TEST_P(FluidVessels, HoldWhatTheyWereFilledWith) {
    Random random(static_cast<std::uint64_t>(GetParam()) + 1);
    const auto make = static_cast<Make>(GetParam() % 3);
    Vessel vessel;
    vessel.bottom_radius = random.between(0.06, 0.2);
    vessel.top_radius = vessel.bottom_radius * random.between(1, 1.8);
    vessel.height = random.between(0.1, 0.35);
    const double cell = vessel.bottom_radius / random.between(3, 6);
    vessel.wall = cell * random.between(0.1, 3);
    const double level = random.between(0.3, 0.8) * vessel.height;

    auto world = make_world({});
    add_box(*world, {2, 0.25, 2}, {.kind = BodyKind::static_body, .position = {0, -0.25, 0}});
    BodyDefinition definition{.kind = make == Make::pieces ? BodyKind::dynamic_body : BodyKind::static_body};
    const ShapeDefinition shape = make == Make::closed_mesh    ? ShapeDefinition{closed_mesh(vessel)}
                                  : make == Make::single_sheet ? ShapeDefinition{single_sheet(vessel)}
                                                               : ShapeDefinition{pieces(vessel)};
    definition.shape = world->create_shape(shape).value();
    const BodyHandle body = world->create_body(definition).value();
    FluidDefinition water{.cell_size = cell};
    // What is laid over a vessel is left out of its walls.
    std::vector<Vec3> hull;
    for (int i = 0; i < sides; ++i) {
        for (const double y : {vessel.wall * 0.9, vessel.wall + level})
            hull.push_back(
                on_circle(vessel.radius_at(y) + (make == Make::single_sheet ? 0.0 : 0.9 * vessel.wall), y, i));
    }
    water.hulls.push_back(std::move(hull));
    const FluidHandle fluid = world->create_fluid(water).value();

    const auto count = static_cast<double>(world->fluid_particles(fluid).positions.size());
    run(*world, 3);
    const Held held = held_by(*world, fluid, vessel, world->pose(body));
    RecordProperty("form", name_of(make));
    RecordProperty("wall_cells", std::to_string(vessel.wall / cell));
    RecordProperty("share", std::to_string(held.count / count));
    RecordProperty("excess_cells", std::to_string(held.excess / cell));
    EXPECT_GT(held.count, 0.99 * count) << name_of(make);
    EXPECT_GT(held.excess, -0.2 * cell) << name_of(make);
    EXPECT_LT(held.excess, 0.5 * cell) << name_of(make);
}

INSTANTIATE_TEST_SUITE_P(Seeds, FluidVessels, testing::Range(0, 24));

}  // namespace
}  // namespace embody::physics
