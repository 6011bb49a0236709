// SPDX-License-Identifier: MIT
// Binary glTF.
#include "../glb.h"

#include "../model_target.h"

using namespace embody;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    fuzz::read_model_file("model.glb", {data, size});
    return 0;
}

extern "C" std::size_t embody_fuzz_repair(std::uint8_t* data, std::size_t size, std::size_t /*capacity*/) {
    return fuzz::with_glb_lengths(data, size);
}
