// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "interchange/file_source.h"
#include "interchange/raw_scene.h"

namespace embody::interchange {

/// Lower case, with the dot: ".obj" of "Chair.OBJ".
std::string extension_of(const std::filesystem::path& file);
/// File name extensions of the formats that are read, with the dot.
const std::vector<std::string>& model_extensions();
/// Whether the file's extension, in any case, is one of model_extensions().
bool is_model_file(const std::filesystem::path& file);
/// The extension that the content asks for where a file's name says nothing, as of models in homes of Sweet Home 3D;
/// `head`: its first bytes, 4096 are enough. Empty where they are of no format that is known by them.
std::string_view extension_by_content(std::span<const std::uint8_t> head);
/// Why files of this name cannot be read: another format, or one (VRML) that this build was made without.
Result<void> can_read(const std::filesystem::path& file);

/// Why a file could not be read where memory ran out: another try with more may succeed.
Error out_of_memory(std::string where);
bool is_out_of_memory(const Error& error);
/// The error of a file that is read and holds nothing to draw.
Error without_triangles(std::string where);
bool is_without_triangles(const Error& error);

/// Reads a model file and what it refers to in its own folder and below. Every position is finite, every index in
/// range, every mesh has triangles and every image is PNG or JPEG; else an error with file and reason. What can be left
/// out (a texture that is missing or lies outside the folder, points and lines) is left out with a warning. glTF is in
/// metres and Y up; COLLADA is turned and scaled as its <asset> says; OBJ, STL, PLY and AC3D are taken as they are;
/// VRML's unit is the metre, Y up.
Result<RawScene> read_model(const std::filesystem::path& file);

/// As above from any source, e.g. an archive; `path` is inside the source. A file whose name has no extension is of the
/// format that its content tells.
Result<RawScene> read_model(const FileSource& source, const std::string& path);

}  // namespace embody::interchange
