// SPDX-License-Identifier: MIT
// Definitions of everything that a world holds, read from bytes. Most are valid; each number may be invalid.
#pragma once

#include "byte_reader.h"
#include "physics/definitions/body_definition.h"
#include "physics/definitions/deformable_definition.h"
#include "physics/definitions/fluid_definition.h"
#include "physics/definitions/joint_definition.h"
#include "physics/definitions/shape_definition.h"
#include "physics/definitions/world_settings.h"

namespace embody::fuzz {

physics::ShapeDefinition read_shape(ByteReader& bytes);

/// Changes up to three fields of the definition, but no handles: the caller knows these.
void change_body(ByteReader& bytes, physics::BodyDefinition& body);
void change_joint(ByteReader& bytes, physics::JointDefinition& joint);
void change_deformable(ByteReader& bytes, physics::DeformableDefinition& deformable);
void change_settings(ByteReader& bytes, physics::WorldSettings& settings);

/// A sheet, rope or solid of at most some dozen nodes.
physics::DeformableDefinition read_deformable(ByteReader& bytes);

/// Of some hundred particles, or of so many that it must be refused: numbers between take too long.
physics::FluidDefinition read_fluid(ByteReader& bytes);
void change_fluid_matter(ByteReader& bytes, physics::FluidDefinition& fluid);

}  // namespace embody::fuzz
