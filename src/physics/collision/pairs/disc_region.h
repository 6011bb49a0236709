// SPDX-License-Identifier: MIT
#pragma once

#include "physics/collision/namespace.h"
#include "physics/collision/pairs/contact_region.h"

namespace embody::physics::collision {

/// A cap that faces another one, or a polygon's face, nearly squarely: corners of the common part and points of its
/// rims, exact where a polygon of many corners is a little too small. False, and nothing added, where they are too
/// oblique for it or the incident is no cap.
bool add_disc_region(const ContactFeature& reference, const ContactFeature& incident, bool reference_is_a,
                     double margin, ContactRegion& region);

/// Leaves a cap only four of its corners where all of it lies over the face `reference`.
void thin_out_cap(const ContactFeature& reference, ContactFeature& cap);

}  // namespace embody::physics::collision
