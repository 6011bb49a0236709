// SPDX-License-Identifier: MIT
// Possible answers of a hijacked worker. The first byte chooses: a payload of each kind, or whole frames.
#include "catalog/prepare/worker_protocol.h"

#include <cmath>

#include "../target.h"

using namespace embody;

namespace {

void read_model_payload(std::span<const std::uint8_t> payload) {
    const auto model = catalog::model_from_bytes(payload);
    if (!model) return fuzz::require(!model.error().why.empty(), "a refusal says the reason");
    fuzz::require(model->hull_points.size() <= 256, "a hull has at most 256 points");
    fuzz::require(model->quality >= 0 && model->quality <= 3, "a grade is one of four");
    fuzz::require(!model->geometry.empty(), "a model has geometry");
    for (const Vec3f& point : model->hull_points) {
        fuzz::require(std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z), "hulls are finite");
    }
    const auto bytes = catalog::to_bytes(*model);
    const auto again = catalog::model_from_bytes(bytes);
    fuzz::require(again.ok() && catalog::to_bytes(*again) == bytes, "what was read can be written and read again");
}

void read_item_payload(std::span<const std::uint8_t> payload) {
    const auto item = catalog::item_from_bytes(payload);
    if (!item) return fuzz::require(!item.error().why.empty(), "a refusal says the reason");
    const auto bytes = catalog::to_bytes(*item);
    const auto again = catalog::item_from_bytes(bytes);
    fuzz::require(again.ok() && catalog::to_bytes(*again) == bytes, "what was read can be written and read again");
}

/// Reads frames as the parent does from a pipe.
void read_frames(std::span<const std::uint8_t> bytes) {
    while (bytes.size() >= catalog::frame_header_size) {
        const auto header = catalog::read_frame_header(bytes);
        if (!header) return fuzz::require(!header.error().why.empty(), "a refusal says the reason");
        fuzz::require(header->payload_size <= catalog::max_payload_bytes, "no frame is larger than is allowed");
        const std::size_t whole = catalog::frame_header_size + header->payload_size + catalog::frame_hash_size;
        if (whole > bytes.size()) {
            (void)catalog::payload_of(bytes);
            return;
        }
        const auto payload = catalog::payload_of(bytes.first(whole));
        if (!payload) return;
        if (header->kind == catalog::FrameKind::prepared) read_model_payload(*payload);
        if (header->kind == catalog::FrameKind::item) read_item_payload(*payload);
        (void)catalog::error_from_bytes(*payload);
        bytes = bytes.subspan(whole);
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const std::span rest(data + 1, size - 1);
    switch (data[0] % 4) {
        case 0:
            read_model_payload(rest);
            break;
        case 1:
            read_item_payload(rest);
            break;
        case 2:
            fuzz::require(!catalog::error_from_bytes(rest).why.empty(), "what a worker reports is said");
            break;
        default:
            read_frames(rest);
            break;
    }
    return 0;
}
