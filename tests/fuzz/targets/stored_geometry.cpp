// SPDX-License-Identifier: MIT
// The compact geometry that the database keeps.
#include "../glb.h"
#include "interchange/compact/compact_geometry.h"

using namespace embody;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::span bytes(data, size);
    const auto mesh = interchange::decode_mesh(bytes);
    if (!mesh) {
        fuzz::require_reasons(mesh.error());
        (void)interchange::to_glb(bytes);
        return 0;
    }
    fuzz::require(!mesh->triangles.empty(), "a mesh has triangles");
    fuzz::require(geometry::validate(*mesh).ok(), "a mesh is valid");
    fuzz::require(interchange::to_glb(bytes).ok(), "what can be decoded can be shown");
    return 0;
}

extern "C" std::size_t embody_fuzz_repair(std::uint8_t* data, std::size_t size, std::size_t /*capacity*/) {
    return fuzz::with_glb_lengths(data, size);
}
