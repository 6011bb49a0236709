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

}  // namespace

Result<std::unique_ptr<MovingPoints>> make_points(physics::World& world, Liquids& liquids,
                                                  const PointsDefinition& definition) {
    if (const auto* grains = std::get_if<GrainDefinition>(&definition))
        return made(GrainBodies::create(world, *grains));
    if (const auto* liquid = std::get_if<LiquidDefinition>(&definition))
        return made(FluidBody::create(world, liquids, *liquid));
    return made(SoftNodes::create(world, std::get<physics::DeformableDefinition>(definition)));
}

}  // namespace embody::scene
