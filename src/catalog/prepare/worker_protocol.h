// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "catalog/prepare/prepared_model.h"

namespace embody::catalog {

/// The messages between the importing program and a worker, each as one frame:
///   word "EMBW", version, kind, payload length (32 bit each), payload, its 64-bit hash.
/// The program sends items; the worker says `ready` once it is confined, then answers each item with `prepared`,
/// `failed` or, an error as well, `out_of_memory`.
enum class FrameKind : std::uint32_t { ready = 1, item = 2, prepared = 3, failed = 4, out_of_memory = 5 };

inline constexpr std::uint32_t protocol_version = 5;
inline constexpr std::size_t frame_header_size = 16;
inline constexpr std::size_t frame_hash_size = 8;
inline constexpr std::size_t max_payload_bytes = std::size_t{256} << 20;  ///< bytes; more is refused on both ends

struct FrameHeader {
    FrameKind kind = FrameKind::failed;
    std::size_t payload_size = 0;
};

std::vector<std::uint8_t> frame(FrameKind kind, std::span<const std::uint8_t> payload);
/// Reads the first frame_header_size bytes of a frame.
Result<FrameHeader> read_frame_header(std::span<const std::uint8_t> bytes);
/// The payload of a whole frame whose header was read, its hash checked.
Result<std::span<const std::uint8_t>> payload_of(std::span<const std::uint8_t> whole_frame);

std::vector<std::uint8_t> to_bytes(const ImportItem& item);
std::vector<std::uint8_t> to_bytes(const PreparedModel& model);
std::vector<std::uint8_t> to_bytes(const Error& error);

/// Messages of the worker. The other end may have been taken over by a hostile file, so every count, length and number
/// is checked: lists and texts bounded, numbers finite, choices known, hull points at most 256, convex parts at most
/// 256 of 64 vertices each.
Result<ImportItem> item_from_bytes(std::span<const std::uint8_t> payload);
Result<PreparedModel> model_from_bytes(std::span<const std::uint8_t> payload);
/// What the other end reports, or that it reports nothing readable.
Error error_from_bytes(std::span<const std::uint8_t> payload);

}  // namespace embody::catalog
