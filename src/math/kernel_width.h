// SPDX-License-Identifier: MIT
#pragma once

namespace embody {

/// Whether this processor can run kernels for 4, 8 or 16 floats side by side, as math/wide.h makes them.
bool has_lanes(int lanes);

/// Those of that many floats; nothing where this processor cannot run them.
template <class Kernels>
const Kernels* of_width(int lanes, const Kernels& four, const Kernels& eight, const Kernels& sixteen) {
    if (!has_lanes(lanes)) return nullptr;
    return lanes == 4 ? &four : lanes == 8 ? &eight : &sixteen;
}

/// The widest that this processor can run.
template <class Kernels>
const Kernels& widest(const Kernels& four, const Kernels& eight, const Kernels& sixteen) {
    return has_lanes(16) ? sixteen : has_lanes(8) ? eight : four;
}

}  // namespace embody
