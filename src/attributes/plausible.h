// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "attributes/check.h"
#include "math/bounds.h"

namespace embody::attributes {

/// What decides, beside a thing's attributes, whether these make sense.
struct Circumstances {
    Bounds box;                  ///< of the thing, in its frame, m; empty: not known
    double substep = 1.0 / 240;  ///< of the simulation, s
    double gravity = 9.81;       ///< magnitude, m/s²
    bool has_joint = true;       ///< a joint holds the thing
};

/// Finds values that no real thing has, or that the simulation can't show. `automatic` is the set without what a person
/// set: a value that is as in it is no issue, so that a set without manual entries has none.
///
/// | attribute | issue |
/// |---|---|
/// | mass | ten times outside the 80 % interval of such things; denser than osmium; lighter than aerogel |
/// | density | three times outside the interval of its material; lighter than aerogel |
/// | friction_static, friction_dynamic | above 1.5; three times outside the interval of its material |
/// | restitution | above 0.98: it never comes to rest |
/// | center_of_mass | outside the box |
/// | youngs_modulus | it vibrates far faster than the simulation's steps, or gives way under its own weight |
/// | collision_mask | what falls meets nothing |
/// | kind | articulated, without a joint |
std::vector<Issue> find_implausible(const AttributeSet& acting, const AttributeSet& automatic,
                                    const Circumstances& around);

/// The remedy of an issue with a value that a person set: take it back.
void offer_reset(Issue& issue, const AttributeSet& automatic);

/// The number with three digits, for people.
std::string readable_number(double value);

}  // namespace embody::attributes
