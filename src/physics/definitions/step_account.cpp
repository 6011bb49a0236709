// SPDX-License-Identifier: MIT
#include "physics/definitions/step_account.h"

namespace embody::physics {

const char* name_of(StepCause cause) {
    constexpr std::array<const char*, static_cast<std::size_t>(StepCause::count)> names{
        "gravity", "forces", "air",     "impacts",       "contacts",
        "joints",  "motors", "damping", "moving bodies", "position correction",
        "limits",  "sleep",  "coupling"};
    return cause < StepCause::count ? names[static_cast<std::size_t>(cause)] : "";
}

}  // namespace embody::physics
