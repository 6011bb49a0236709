// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "physics/fracture/fracture_rule.h"
#include "physics/stages/access.h"
#include "physics/stages/namespace.h"

namespace embody::physics::stages {

/// What a contact did to its bodies in the step, as one impulse on b at one place of the world.
struct ContactImpulse {
    std::uint32_t a = 0, b = 0;  ///< body slots
    Vec3 impulse;                ///< N s
    Vec3 position;               ///< m
};

/// The blows that brittle bodies were given in the step, by slot.
struct BlowOnBody {
    Blow blow;
    std::vector<ContactImpulse> contacts;  ///< all that pressed it
};
std::map<std::uint32_t, BlowOnBody> find_blows(const FractureAccess& world);

/// Bodies that pressed or held each other in the step, and the energy that went into heat and cracks.
class StepLosses {
public:
    explicit StepLosses(const FractureAccess& world);
    /// Energy that the bodies connected to `body` lost in the step, as they move now: kinetic energy before it, the
    /// work of gravity and constant forces, and that of bodies moved by command, less the kinetic energy now, J.
    [[nodiscard]] double of(std::uint32_t body) const;
    [[nodiscard]] bool are_connected(std::uint32_t a, std::uint32_t b) const { return roots_[a] == roots_[b]; }

private:
    const FractureAccess& world_;
    std::vector<std::uint32_t> roots_;  // by slot
    std::vector<double> driven_;        // by slot: work of bodies moved by command on it, J
};

/// The work that bodies moved by command did by these impulses on `body`, J.
double driven_work(const FractureAccess& world, const ContactImpulse& contact, std::uint32_t body);

}  // namespace embody::physics::stages
