// SPDX-License-Identifier: MIT
#include "interchange/read_model.h"

#include <algorithm>
#include <cctype>
#include <exception>
#include <new>
#include <string_view>
#include <utility>

#include "interchange/assimp/read_by_assimp.h"
#include "interchange/ply/read_ply.h"
#include "interchange/vrml/read_vrml.h"

namespace embody::interchange {

std::string extension_of(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

const std::vector<std::string>& model_extensions() {
    static const std::vector<std::string> extensions{".obj", ".stl", ".ply", ".dae", ".gltf", ".glb", ".ac", ".wrl"};
    return extensions;
}

bool is_model_file(const std::filesystem::path& file) {
    const auto& known = model_extensions();
    return std::find(known.begin(), known.end(), extension_of(file)) != known.end();
}

Result<void> can_read(const std::filesystem::path& file) {
    if (!is_model_file(file)) {
        return Error{file.string(), "is of a format that is not read",
                     "use glTF, OBJ, STL, PLY, COLLADA, AC3D or VRML 2.0"};
    }
    if (extension_of(file) == ".wrl") return can_read_vrml();
    return {};
}

namespace {
constexpr std::string_view out_of_memory_reason = "needs more memory than an import may use";
}  // namespace

Error out_of_memory(std::string where) { return {std::move(where), std::string(out_of_memory_reason), "simplify it"}; }

bool is_out_of_memory(const Error& error) { return error.why == out_of_memory_reason; }

Result<RawScene> read_model(const FileSource& source, const std::string& path) {
    const std::string where = source.describe(path);
    if (const auto able = can_read(path); !able) return Error{where, able.error().why, able.error().remedy};
    const std::string found = source.find(path);
    if (found.empty()) return Error{where, "no such file"};
    try {
        const std::string extension = extension_of(path);
        if (extension == ".wrl") return read_vrml(source, found);
        if (extension == ".ply") return read_ply(source, found);
        return read_by_assimp(source, found);
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
