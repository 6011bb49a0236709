// SPDX-License-Identifier: MIT
#include "interchange/compact/glb_container.h"

#include <nlohmann/json.hpp>
#include <string>

namespace embody::interchange {
namespace {

constexpr std::uint32_t magic = 0x46546C67;       // "glTF"
constexpr std::uint32_t json_chunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t bin_chunk = 0x004E4942;   // "BIN\0"

/// Little endian on every machine.
std::uint32_t word_at(std::span<const std::uint8_t> bytes, std::size_t at) {
    return static_cast<std::uint32_t>(bytes[at]) | static_cast<std::uint32_t>(bytes[at + 1]) << 8 |
           static_cast<std::uint32_t>(bytes[at + 2]) << 16 | static_cast<std::uint32_t>(bytes[at + 3]) << 24;
}

void append_word(std::vector<std::uint8_t>& out, std::size_t word) {
    for (int shift = 0; shift < 32; shift += 8) out.push_back(static_cast<std::uint8_t>(word >> shift));
}

}  // namespace

Result<GlbView> split_glb(std::span<const std::uint8_t> bytes) {
    const Error damaged{"compact geometry", "is damaged or no binary glTF"};
    if (bytes.size() < 20 || word_at(bytes, 0) != magic || word_at(bytes, 4) != 2 ||
        word_at(bytes, 8) != bytes.size()) {
        return damaged;
    }
    GlbView view;
    for (std::size_t at = 12; at < bytes.size();) {
        if (bytes.size() - at < 8) return damaged;
        const std::size_t length = word_at(bytes, at);
        const std::uint32_t kind = word_at(bytes, at + 4);
        if (length > bytes.size() - at - 8) return damaged;
        if (kind == json_chunk && view.json.empty()) view.json = bytes.subspan(at + 8, length);
        if (kind == bin_chunk && view.binary.empty()) view.binary = bytes.subspan(at + 8, length);
        at += 8 + length;
    }
    if (view.json.empty()) return damaged;
    return view;
}

std::vector<std::uint8_t> join_glb(const nlohmann::json& json, std::span<const std::uint8_t> binary) {
    // Names come from files and need not be UTF-8; other bytes are replaced.
    std::string text = json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    text.append((4 - text.size() % 4) % 4, ' ');
    const std::size_t padding = (4 - binary.size() % 4) % 4;

    std::vector<std::uint8_t> out;
    out.reserve(28 + text.size() + binary.size() + padding);
    append_word(out, magic);
    append_word(out, 2);
    append_word(out, 28 + text.size() + binary.size() + padding);
    append_word(out, text.size());
    append_word(out, json_chunk);
    out.insert(out.end(), text.begin(), text.end());
    append_word(out, binary.size() + padding);
    append_word(out, bin_chunk);
    out.insert(out.end(), binary.begin(), binary.end());
    out.insert(out.end(), padding, 0);
    return out;
}

}  // namespace embody::interchange
