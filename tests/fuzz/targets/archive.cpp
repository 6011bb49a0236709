// SPDX-License-Identifier: MIT
// Zip archives, and the catalogue of a Sweet Home 3D library in them.
#include "interchange/archive/archive.h"

#include <zlib.h>

#include <algorithm>

#include "../scratch_file.h"
#include "../target.h"
#include "interchange/sweethome/properties_file.h"
#include "interchange/sweethome/sweethome_catalogue.h"
#include "interchange/utf8.h"

using namespace embody;

namespace {

void check_member(const interchange::Archive& archive, const interchange::ArchiveMember& member) {
    const std::string& path = member.path;
    fuzz::require(!path.empty() && path.front() != '/' && path.find('\\') == std::string::npos, "members are relative");
    fuzz::require(("/" + path + "/").find("/../") == std::string::npos, "members stay in their archive");
    fuzz::require(path.size() < 2 || path[1] != ':', "members are on no drive");
    fuzz::require(archive.find(path) == path, "every member is found");
    const auto bytes = archive.read(path, 1 << 20);
    if (!bytes) return fuzz::require_reasons(bytes.error());
    fuzz::require(bytes->size() <= 1 << 20, "no more is unpacked than is allowed");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::span bytes(data, size);
    const auto file = fuzz::scratch_file("archive.sh3f", bytes);
    const auto archive = interchange::Archive::open(file);
    if (!archive) {
        fuzz::require_reasons(archive.error());
    } else {
        std::size_t members = 0;
        for (const auto& member : archive->members()) {
            if (++members <= 64) check_member(*archive, member);
        }
        (void)archive->find("../secret");
        (void)archive->read("nothing", 1 << 20);
    }
    const auto catalogue = interchange::read_sweethome_catalogue(file);
    if (!catalogue) {
        fuzz::require_reasons(catalogue.error());
    } else {
        for (const auto& piece : catalogue->pieces) {
            fuzz::require(std::ranges::all_of(piece.size, [](double side) { return side > 0; }), "a piece has a size");
        }
    }
    (void)interchange::parse_properties({reinterpret_cast<const char*>(data), size});
    return 0;
}

/// Corrects the checksums of stored members and the offset of the central directory.
extern "C" std::size_t embody_fuzz_repair(std::uint8_t* data, std::size_t size, std::size_t /*capacity*/) {
    const std::span bytes(data, size);
    std::size_t list = size;
    for (std::size_t at = 0; at + 46 <= size; ++at) {
        if (fuzz::word_at(bytes, at) == 0x02014B50) list = std::min(list, at);
    }
    for (std::size_t at = 0; at + 22 <= size; ++at) {
        if (fuzz::word_at(bytes, at) == 0x06054B50 && list < size) {
            fuzz::set_word(bytes, at + 12, at - std::min(at, list));
            fuzz::set_word(bytes, at + 16, list);
        }
    }
    return size;
}
