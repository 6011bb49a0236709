// SPDX-License-Identifier: MIT
//
// Which width of the processor's registers kernels run on. A family of kernels is a struct of functions that says which
// widths it was compiled for:
//
//   struct SumKernels {
//       float (*sum)(const float* from, std::size_t count);
//       static const SumKernels lanes_4, lanes_8, lanes_16;
//   };
//
// Each is defined by the family's code, compiled once a width (math/wide.h, src/CMakeLists.txt):
//
//   constinit const SumKernels SumKernels::EMBODY_WIDE = EMBODY_WIDE::kernels;
//
// Here one of them is chosen while the program runs: widest_kernels<SumKernels>().sum(…).
#pragma once

namespace embody {

/// Whether this processor can run kernels for 4, 8 or 16 floats side by side, as math/wide.h makes them.
bool has_lanes(int lanes);

/// The kernels of 4, 8 or 16 floats; none where this processor cannot run them.
template <class Kernels>
const Kernels* kernels_of(int lanes) {
    if (!has_lanes(lanes)) return nullptr;
    return lanes == 4 ? &Kernels::lanes_4 : lanes == 8 ? &Kernels::lanes_8 : &Kernels::lanes_16;
}

/// The widest kernels that this processor can run.
template <class Kernels>
const Kernels& widest_kernels() {
    return has_lanes(16) ? Kernels::lanes_16 : has_lanes(8) ? Kernels::lanes_8 : Kernels::lanes_4;
}

}  // namespace embody
