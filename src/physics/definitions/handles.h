// SPDX-License-Identifier: MIT
#pragma once

#include "foundation/handle.h"

namespace embody::physics {

using ShapeHandle = Handle<struct ShapeTag>;
using BodyHandle = Handle<struct BodyTag>;
using JointHandle = Handle<struct JointTag>;
using DeformableHandle = Handle<struct DeformableTag>;
using FluidHandle = Handle<struct FluidTag>;
using FluidPortHandle = Handle<struct FluidPortTag>;

}  // namespace embody::physics
