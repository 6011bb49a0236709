// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "physics/deformable/solid_contact.h"
#include "physics/deformable/solid_deformable.h"

namespace embody::physics {

/// Appends a contact for every surface node of `one` that may come to the surface of `two` within a step, with the
/// nearest triangle there. `reach` (m) is what the two may come closer in the step, `radius` the distance that they
/// keep. `point` and `other` are of the solids with these numbers.
void find_surface_contacts(const SolidDeformable& one, std::uint32_t one_number, const SolidDeformable& two,
                           std::uint32_t two_number, double reach, double radius, double friction,
                           std::vector<SolidContact>& contacts);

}  // namespace embody::physics
