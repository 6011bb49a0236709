// SPDX-License-Identifier: MIT
#include "interchange/archive/archive.h"

#include <unistd.h>
#include <unzip.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <map>
#include <utility>

#include "interchange/regular_file.h"
#include "interchange/utf8.h"

namespace embody::interchange {
namespace {

constexpr std::uint64_t max_members = 1'000'000;

std::string in_lower_case(std::string_view text) {
    std::string lower(text);
    for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return lower;
}

/// The open function for minizip; the file is open already, in `file`.
voidpf open_given(voidpf file, const void*, int) {
    const int descriptor = static_cast<RegularFile*>(file)->release();
    FILE* stream = descriptor < 0 ? nullptr : fdopen(descriptor, "rb");
    if (stream == nullptr && descriptor >= 0) close(descriptor);
    return stream;
}

}  // namespace

struct Archive::State {
    std::filesystem::path file;
    unzFile zip = nullptr;
    std::vector<ArchiveMember> members;
    std::map<std::string, std::pair<unz64_file_pos, std::uint64_t>, std::less<>> places;  // by stored path; with size
    std::map<std::string, std::string, std::less<>> by_lower_case;

    ~State() {
        if (zip != nullptr) unzClose(zip);
    }
};

Archive::Archive(std::unique_ptr<State> state) : state_(std::move(state)) {}
Archive::Archive(Archive&&) noexcept = default;
Archive& Archive::operator=(Archive&&) noexcept = default;
Archive::~Archive() = default;

Result<Archive> Archive::open(const std::filesystem::path& file) {
    auto state = std::make_unique<State>();
    state->file = file;
    auto opened = RegularFile::open(file, max_file_bytes);
    if (!opened) return opened.error();
    zlib_filefunc64_def functions{};
    fill_fopen64_filefunc(&functions);
    functions.zopen64_file = open_given;
    functions.opaque = &*opened;
    state->zip = unzOpen2_64(file.c_str(), &functions);
    if (state->zip == nullptr)
        return Error{file.string(), "cannot be opened as a zip archive", "is the file complete?"};

    // The stated number of members bounds the loop: a damaged list may lead in circles.
    unz_global_info64 info{};
    if (unzGetGlobalInfo64(state->zip, &info) != UNZ_OK || info.number_entry > max_members) {
        return Error{file.string(), "the archive's list of members is damaged"};
    }
    for (std::uint64_t i = 0; i < info.number_entry; ++i) {
        if ((i == 0 ? unzGoToFirstFile(state->zip) : unzGoToNextFile(state->zip)) != UNZ_OK) {
            return Error{file.string(), "the archive's list of members breaks off after " + std::to_string(i)};
        }
        unz_file_info64 member{};
        std::array<char, 4096> name{};
        unz64_file_pos place{};
        if (unzGetCurrentFileInfo64(state->zip, &member, name.data(), name.size() - 1, nullptr, 0, nullptr, 0) !=
                UNZ_OK ||
            unzGetFilePos64(state->zip, &place) != UNZ_OK) {
            return Error{file.string(), "member " + std::to_string(i) + " of the archive is damaged"};
        }
        // Folders, names that lead out of the archive and entries that were refused are not members.
        const std::string_view stored(name.data());
        const std::string path = normalized_member_path(utf8_or_cp437(stored));
        if (path.empty() || stored.back() == '/' || member.size_filename >= name.size()) continue;
        if (!state->places.emplace(path, std::pair{place, member.uncompressed_size}).second) continue;
        state->by_lower_case.emplace(in_lower_case(path), path);
        state->members.push_back({path, member.uncompressed_size});
    }
    return Archive(std::move(state));
}

const std::vector<ArchiveMember>& Archive::members() const { return state_->members; }

std::string Archive::find(std::string_view path) const {
    const std::string wanted = normalized_member_path(utf8_or_cp437(path));
    if (state_->places.contains(wanted)) return wanted;
    const auto found = state_->by_lower_case.find(in_lower_case(wanted));
    return found == state_->by_lower_case.end() ? std::string() : found->second;
}

Result<std::vector<std::uint8_t>> Archive::read(std::string_view path, std::uint64_t limit) const {
    const std::string where = state_->file.string() + ": " + std::string(path);
    const auto found = state_->places.find(find(path));
    if (found == state_->places.end()) return Error{where, "is not in the archive"};
    unz64_file_pos place = found->second.first;
    if (unzGoToFilePos64(state_->zip, &place) != UNZ_OK || unzOpenCurrentFile(state_->zip) != UNZ_OK) {
        return Error{where, "cannot be unpacked: damaged, encrypted or packed by an unknown method"};
    }

    // The stated size is a hint only; what is unpacked counts.
    std::vector<std::uint8_t> bytes;
    bytes.reserve(static_cast<std::size_t>(std::min({found->second.second, limit, std::uint64_t{64} << 20})));
    std::vector<std::uint8_t> block(256 << 10);
    int got = 0;
    while ((got = unzReadCurrentFile(state_->zip, block.data(), static_cast<unsigned>(block.size()))) > 0) {
        if (bytes.size() + static_cast<std::size_t>(got) > limit) {
            unzCloseCurrentFile(state_->zip);
            return Error{where, "unpacks to more than " + std::to_string(limit) + " bytes"};
        }
        bytes.insert(bytes.end(), block.begin(), block.begin() + got);
    }
    // Closing verifies the checksum.
    const int closed = unzCloseCurrentFile(state_->zip);
    if (got < 0 || closed != UNZ_OK) return Error{where, "is damaged: unpacking or its checksum failed"};
    return bytes;
}

std::string normalized_member_path(std::string_view path) {
    std::string slashed(path);
    std::replace(slashed.begin(), slashed.end(), '\\', '/');
    if (slashed.size() > 1 && slashed[1] == ':') return {};

    // Part by part; ".." removes a part, never more than there are.
    std::vector<std::string_view> parts;
    const std::string_view all = slashed;
    for (std::size_t begin = 0; begin <= all.size();) {
        const std::size_t end = std::min(all.find('/', begin), all.size());
        const std::string_view part = all.substr(begin, end - begin);
        begin = end + 1;
        if (part.empty() || part == ".") continue;
        if (part != "..") {
            parts.push_back(part);
        } else if (parts.empty()) {
            return {};
        } else {
            parts.pop_back();
        }
    }
    std::string joined;
    for (const std::string_view part : parts) {
        if (!joined.empty()) joined += '/';
        joined += part;
    }
    return joined;
}

}  // namespace embody::interchange
