// SPDX-License-Identifier: MIT
// Models in formats without lengths to correct; CMake defines the format.
#include "../model_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    embody::fuzz::read_model_file(EMBODY_FUZZ_MODEL, {data, size});
    return 0;
}
