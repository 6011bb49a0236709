// SPDX-License-Identifier: MIT
#pragma once

/// The paper's Dynamic module: a body's state, Lagrange's equations of motion (eq. 2) and their integration, mass,
/// energy and momenta, wind. It knows no contacts.
namespace embody::physics::dynamic {}  // namespace embody::physics::dynamic
