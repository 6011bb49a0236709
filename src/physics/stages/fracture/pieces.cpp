// SPDX-License-Identifier: MIT
#include "physics/stages/fracture/pieces.h"

#include <cmath>
#include <utility>

#include "physics/dynamic/conserved.h"
#include "physics/dynamic/mass.h"
#include "physics/fracture/fracture_rule.h"
#include "physics/stages/rigid/body_setup.h"
#include "physics/state/activity_state.h"
#include "physics/state/rigid_state.h"

namespace embody::physics::stages {

namespace {

// About its centre of mass, so that the frames of bodies and their centres are one.
ShapeDefinition shape_of(const Piece& piece) {
    CompoundShape compound;
    for (const std::vector<Vec3>& hull : piece.hulls) {
        HullShape shape;
        for (const Vec3 corner : hull) shape.points.push_back(corner - piece.solid.center);
        compound.children.push_back({std::move(shape), {}});
    }
    if (compound.children.size() == 1) return std::get<HullShape>(std::move(compound.children.front().shape));
    return compound;
}

// The piece of `fraction` of the body's mass, at rest.
BodyDefinition body_of(const BodyDefinition& whole, const Piece& piece, double mass, double fraction) {
    BodyDefinition body = whole;
    body.shape = {};
    body.position = whole.position + rotate(whole.rotation, piece.solid.center);
    body.linear_velocity = body.angular_velocity = {};
    const double density = mass / piece.solid.volume;
    body.mass = {.mass = mass,
                 .density = whole.mass.density,
                 .center_of_mass = Vec3{},
                 .inertia = piece.solid.inertia * density};
    body.drag_area = whole.drag_area * std::cbrt(fraction * fraction);  // an area of similar things
    body.force = whole.force * fraction;
    body.torque = whole.torque * fraction;
    body.start_asleep = false;
    body.brittleness = brittleness_of_piece(*whole.brittleness, fraction);
    return body;
}

// The pieces as one rigid body: its mass properties in the body's frame.
geometry::MassProperties sum_of(const Split& split) {
    geometry::MassProperties sum = split.pieces.front().solid;
    for (std::size_t i = 1; i < split.pieces.size(); ++i) sum = geometry::combined(sum, split.pieces[i].solid);
    return sum;
}

}  // namespace

std::optional<MadePieces> make_pieces(const FractureAccess& world, std::uint32_t body, const Split& split) {
    const BodyDefinition whole = current_definition(world.rigid, world.activity, body);
    const BodyState& motion = world.rigid.motion[body];
    const BodyConstants& constants = world.rigid.constants[body];

    // Their common motion about their common centre of mass, by the momenta of the body.
    const geometry::MassProperties sum = sum_of(split);
    const double density = constants.mass / sum.volume;
    const Vec3 center = whole.position + rotate(whole.rotation, sum.center);
    const Vec3 turning =
        spin_momentum(motion, constants) + cross(motion.center - center, constants.mass * motion.linear_velocity);
    const Vec3 spin = rotate(whole.rotation, solve(sum.inertia * density, rotate_inverse(whole.rotation, turning)));

    MadePieces made;
    made.energy_growth = -kinetic_energy(motion, constants);
    for (const Piece& piece : split.pieces) {
        const double fraction = piece.solid.volume / sum.volume;
        BodyDefinition definition = body_of(whole, piece, constants.mass * fraction, fraction);
        definition.linear_velocity = motion.linear_velocity + cross(spin, definition.position - center);
        definition.angular_velocity = spin;
        BodyConstants own;
        auto shape = CollisionShape::create(shape_of(piece));
        if (!shape || !validate(definition) || !resolve_mass(definition.mass, piece.solid, own)) return std::nullopt;
        BodyState state;
        state.rotation = whole.rotation;
        state.linear_velocity = definition.linear_velocity;
        state.angular_velocity = spin;
        made.energy_growth += kinetic_energy(state, own);
        made.pieces.push_back({std::move(shape).value(), std::move(definition)});
    }
    return made;
}

}  // namespace embody::physics::stages
