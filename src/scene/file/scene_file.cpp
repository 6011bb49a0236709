// SPDX-License-Identifier: MIT
#include "scene/file/scene_file.h"

#include <fstream>
#include <nlohmann/json.hpp>

#include "scene/document/document_field.h"
#include "scene/file/json/print.h"
#include "scene/file/json/text.h"
#include "scene/file/whole_file.h"

namespace embody::scene {

using nlohmann::json;

namespace {

constexpr std::uintmax_t max_file_bytes = std::uintmax_t{512} << 20;

Result<std::string> read_text(const std::filesystem::path& file) {
    std::error_code problem;
    if (std::filesystem::is_directory(file, problem)) return Error{file.string(), "is a folder, not a scene"};
    const std::uintmax_t size = std::filesystem::file_size(file, problem);
    if (problem) return Error{file.string(), "can't be read: " + problem.message()};
    if (size > max_file_bytes) return Error{file.string(), "is larger than 512 MiB"};
    std::string text(static_cast<std::size_t>(size), '\0');
    std::ifstream in(file, std::ios::binary);
    in.read(text.data(), static_cast<std::streamsize>(size));
    if (!in || static_cast<std::uintmax_t>(in.gcount()) != size) return Error{file.string(), "can't be read"};
    return text;
}

}  // namespace

Result<Document> load_document(const std::filesystem::path& file) {
    Result<std::string> text = read_text(file);
    if (!text.ok()) return text.error();
    Result<json> parsed = parse_json(text.value(), file.string());
    if (!parsed.ok()) return parsed.error();
    Result<Document> document = document_from_json(parsed.value());
    if (document.ok()) return document;
    return in_place(file.string(), document.error());
}

Result<void> save_document(const Document& document, const std::filesystem::path& file) {
    return write_whole_file(file, print_json(document_to_json(document)));
}

}  // namespace embody::scene
