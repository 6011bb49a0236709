// SPDX-License-Identifier: MIT
#include "interchange/file_source.h"

#include <algorithm>
#include <cctype>

#include "interchange/regular_file.h"

namespace embody::interchange {
namespace {

bool same_but_for_case(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

/// Whether `path` lies in `folder`; both canonical.
bool lies_in(const std::filesystem::path& path, const std::filesystem::path& folder) {
    return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

}  // namespace

FolderSource::FolderSource(std::filesystem::path folder) {
    std::error_code problem;
    folder_ = std::filesystem::canonical(folder.empty() ? "." : folder, problem);
    if (problem) folder_ = std::move(folder);
}

std::string FolderSource::find(std::string_view path) const {
    const std::string inside = normalized_member_path(path);
    if (inside.empty()) return {};
    std::error_code problem;
    std::filesystem::path found = folder_ / inside;

    // Files made on other systems often differ in case from what refers to them.
    if (!std::filesystem::is_regular_file(found, problem)) {
        const std::string name = found.filename().string();
        const auto parent = found.parent_path();
        found.clear();
        for (std::filesystem::directory_iterator entry(parent, problem), end; !problem && entry != end;
             entry.increment(problem)) {
            if (same_but_for_case(entry->path().filename().string(), name)) {
                found = entry->path();
                break;
            }
        }
        if (found.empty() || !std::filesystem::is_regular_file(found, problem)) return {};
    }
    const auto real = std::filesystem::canonical(found, problem);
    if (problem || !lies_in(real, folder_)) return {};
    return found.lexically_relative(folder_).generic_string();
}

Result<std::vector<std::uint8_t>> FolderSource::read(std::string_view path) const {
    const std::string found = find(path);
    if (found.empty()) return Error{describe(path), "no such file in the model's folder"};
    // A link may have replaced it since find(): the file that the links lead to now is opened by its own name.
    std::error_code problem;
    const auto file = std::filesystem::canonical(folder_ / found, problem);
    if (problem || !lies_in(file, folder_)) return Error{describe(path), "is no longer in the model's folder"};
    auto opened = RegularFile::open(file, Archive::default_limit);
    if (!opened) return opened.error();
    return opened->read_all();
}

std::string FolderSource::describe(std::string_view path) const {
    return (folder_ / std::filesystem::path(path)).string();
}

}  // namespace embody::interchange
