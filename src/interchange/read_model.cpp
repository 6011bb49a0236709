// SPDX-License-Identifier: MIT
#include "interchange/read_model.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <exception>
#include <new>
#include <string_view>
#include <utility>

#include "interchange/assimp/read_by_assimp.h"
#include "interchange/ply/read_ply.h"
#include "interchange/vrml/read_vrml.h"

namespace embody::interchange {

namespace {

/// A format that is read: a line a file name extension.
struct Format {
    std::string_view extension;
    std::string_view name;
    Result<RawScene> (*read)(const FileSource& source, const std::string& path);
};
constexpr std::array<Format, 8> formats{{{".glb", "glTF", read_by_assimp},
                                         {".gltf", "glTF", read_by_assimp},
                                         {".obj", "OBJ", read_by_assimp},
                                         {".stl", "STL", read_by_assimp},
                                         {".ply", "PLY", read_ply},
                                         {".dae", "COLLADA", read_by_assimp},
                                         {".ac", "AC3D", read_by_assimp},
                                         {".wrl", "VRML 2.0", read_vrml}}};

/// So many bytes tell the format of a file.
constexpr std::size_t content_head = 4096;

const Format* format_of(const std::filesystem::path& file) {
    const std::string extension = extension_of(file);
    const auto found = std::ranges::find(formats, extension, &Format::extension);
    return found == formats.end() ? nullptr : &*found;
}

/// Whether a text has lines of vertices, as every OBJ has soon after its comments.
bool is_obj(std::string_view text) {
    if (text.find('\0') != std::string_view::npos) return false;
    return text.starts_with("v ") || text.find("\nv ") != std::string_view::npos;
}

/// A source in which one file goes by another name.
class RenamedSource final : public FileSource {
public:
    RenamedSource(const FileSource& source, std::string path, std::string_view extension)
        : source_(source), path_(std::move(path)), alias_(path_ + std::string(extension)) {}
    [[nodiscard]] const std::string& alias() const { return alias_; }
    [[nodiscard]] std::string find(std::string_view path) const override {
        return path == alias_ ? alias_ : source_.find(path);
    }
    [[nodiscard]] Result<std::vector<std::uint8_t>> read(std::string_view path) const override {
        return source_.read(path == alias_ ? path_ : path);
    }
    [[nodiscard]] std::string describe(std::string_view path) const override {
        return source_.describe(path == alias_ ? path_ : path);
    }

private:
    const FileSource& source_;
    std::string path_, alias_;
};

// "glTF, OBJ … or VRML 2.0"
std::string names_of_formats() {
    std::string list;
    std::string_view last;
    for (const Format& format : formats) {
        if (format.name == last) continue;
        last = format.name;
        if (!list.empty()) list += last == formats.back().name ? " or " : ", ";
        list += last;
    }
    return list;
}

}  // namespace

std::string extension_of(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

const std::vector<std::string>& model_extensions() {
    static const std::vector<std::string> extensions = [] {
        std::vector<std::string> all;
        for (const Format& format : formats) all.emplace_back(format.extension);
        return all;
    }();
    return extensions;
}

bool is_model_file(const std::filesystem::path& file) { return format_of(file) != nullptr; }

Result<void> can_read(const std::filesystem::path& file) {
    if (!is_model_file(file)) {
        return Error{file.string(), "is of a format that is not read", "use " + names_of_formats()};
    }
    if (extension_of(file) == ".wrl") return can_read_vrml();
    return {};
}

namespace {
constexpr std::string_view out_of_memory_reason = "needs more memory than an import may use";
constexpr std::string_view without_triangles_reason = "holds no triangles";
}  // namespace

Error out_of_memory(std::string where) { return {std::move(where), std::string(out_of_memory_reason), "simplify it"}; }

bool is_out_of_memory(const Error& error) { return error.why == out_of_memory_reason; }

Error without_triangles(std::string where) { return {std::move(where), std::string(without_triangles_reason), ""}; }

bool is_without_triangles(const Error& error) { return error.why == without_triangles_reason; }

std::string_view extension_by_content(std::span<const std::uint8_t> head) {
    const std::string_view text(reinterpret_cast<const char*>(head.data()), std::min(head.size(), content_head));
    if (text.starts_with("glTF")) return ".glb";
    if (text.starts_with("ply")) return ".ply";
    if (text.starts_with("AC3D")) return ".ac";
    if (text.starts_with("#VRML V2.0")) return ".wrl";
    if (text.find("<COLLADA") != std::string_view::npos) return ".dae";
    return is_obj(text) ? ".obj" : std::string_view();
}

Result<RawScene> read_model(const FileSource& source, const std::string& path) {
    const std::string where = source.describe(path);
    if (extension_of(path).empty()) {
        const std::string stored = source.find(path);
        if (stored.empty()) return Error{where, "no such file"};
        std::string_view extension;
        {
            const auto bytes = source.read(stored);
            if (!bytes) return Error{where, bytes.error().why, bytes.error().remedy};
            extension = extension_by_content(*bytes);
        }
        if (!extension.empty()) {
            const RenamedSource renamed(source, stored, extension);
            return read_model(renamed, renamed.alias());
        }
    }
    if (const auto able = can_read(path); !able) return Error{where, able.error().why, able.error().remedy};
    const std::string found = source.find(path);
    if (found.empty()) return Error{where, "no such file"};
    try {
        return format_of(path)->read(source, found);
    } catch (const std::bad_alloc&) {
        return out_of_memory(where);
    } catch (const std::exception& problem) {
        return Error{where, problem.what()};
    }
}

Result<RawScene> read_model(const std::filesystem::path& file) {
    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored)) return Error{file.string(), "is a folder, not a file"};
    return read_model(FolderSource(file.parent_path()), file.filename().string());
}

}  // namespace embody::interchange
