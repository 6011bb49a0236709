// SPDX-License-Identifier: MIT
#include "scene/matter/moving_points.h"

#include "scene/matter/fluid_body.h"
#include "scene/matter/grain_bodies.h"
#include "scene/matter/soft_nodes.h"

namespace embody::scene {

namespace {

template <typename Points>
Result<std::unique_ptr<MovingPoints>> made(Result<std::unique_ptr<Points>> points) {
    if (!points.ok()) return points.error();
    return std::unique_ptr<MovingPoints>(std::move(points).value());
}

// One overload for each definition: a definition without one does not compile.
struct Maker {
    physics::World& world;
    Liquids& liquids;

    auto operator()(const GrainDefinition& grains) const { return made(GrainBodies::create(world, grains)); }
    auto operator()(const LiquidDefinition& liquid) const { return made(FluidBody::create(world, liquids, liquid)); }
    auto operator()(const physics::DeformableDefinition& soft) const { return made(SoftNodes::create(world, soft)); }
};

}  // namespace

Result<std::unique_ptr<MovingPoints>> make_points(physics::World& world, Liquids& liquids,
                                                  const PointsDefinition& definition) {
    return std::visit(Maker{world, liquids}, definition);
}

}  // namespace embody::scene
