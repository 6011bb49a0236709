// SPDX-License-Identifier: MIT
// All that a worker does with a model, here a PLY file: pose, surfaces, measures, hull, convex parts, the stored form,
// the picture.
#include "catalog/prepare/prepare.h"

#include "../scratch_file.h"
#include "../target.h"
#include "catalog/prepare/worker_protocol.h"
#include "interchange/compact/compact_geometry.h"

using namespace embody;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static catalog::Preparation preparation;
    const auto file = fuzz::scratch_file("model.ply", {data, size});
    const auto model = preparation.prepare({.path = file.string()});
    if (!model) {
        fuzz::require_reasons(model.error());
        return 0;
    }
    fuzz::require(catalog::model_from_bytes(catalog::to_bytes(*model)).ok(),
                  "the importing process takes what a worker prepared");
    fuzz::require(interchange::decode_mesh(model->geometry).ok(), "what is stored can be read again");
    return 0;
}
