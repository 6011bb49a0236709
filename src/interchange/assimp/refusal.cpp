// SPDX-License-Identifier: MIT
#include "interchange/assimp/refusal.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string_view>

#include "interchange/one_line.h"
#include "interchange/read_model.h"

namespace embody::interchange {
namespace {

using nlohmann::json;

/// The reason; empty where none was found.
using Reason = std::optional<std::string>;

std::string bytes_text(std::uint64_t count) { return std::to_string(count) + (count == 1 ? " byte" : " bytes"); }

std::uint32_t little_endian(std::string_view bytes, std::size_t at) {
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < 4; ++i) number |= std::uint32_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
    return number;
}

bool leaves_folder(const std::string& uri) {
    return uri.starts_with('/') || uri.starts_with("file:") || uri.find(':') == 1 ||
           normalized_member_path(uri).empty();
}

/// The format of a file, where its first bytes show it.
Reason another_format(std::string_view content, const std::string& extension) {
    struct Mark {
        std::string_view begin;
        const char* what;
        const char* extensions;
    };
    static constexpr std::array<Mark, 12> marks = {{{"\x89PNG", "a PNG picture", ""},
                                                    {"\xff\xd8\xff", "a JPEG picture", ""},
                                                    {"PK\3\4", "a zip archive", ""},
                                                    {"\x1f\x8b", "a gzip archive", ""},
                                                    {"<!DOCTYPE html", "a web page", ""},
                                                    {"<html", "a web page", ""},
                                                    {"glTF", "a binary glTF", ".glb"},
                                                    {"AC3D", "an AC3D file", ".ac"},
                                                    {"#VRML", "a VRML file", ".wrl"},
                                                    {"ply\n", "a PLY file", ".ply"},
                                                    {"solid ", "an STL text", ".stl"},
                                                    {"<?xml", "an XML text", ".dae"}}};
    for (const Mark& mark : marks)
        if (content.starts_with(mark.begin) && extension != mark.extensions)
            return "is " + std::string(mark.what) + ", not what its name says";
    const bool is_blank = std::all_of(content.begin(), content.end(), [](char c) { return c == '\0'; });
    if (is_blank) return "holds nothing but zeros: its download or copy was not finished";
    return std::nullopt;
}

/// The size in bytes of what buffers[`i`] of a glTF refers to, or the reason why it has none.
struct Buffer {
    std::uint64_t bytes = 0;
    Reason missing;
};

Buffer buffer_of(const FileSource& source, const std::string& path, const json& buffer, std::uint64_t chunk) {
    if (!buffer.is_object() || !buffer.contains("uri")) {
        if (chunk > 0) return {chunk, std::nullopt};
        return {0, ": has no uri, and the file has no binary chunk"};
    }
    if (!buffer["uri"].is_string()) return {0, ".uri: is no text"};
    const std::string uri = buffer["uri"];
    if (uri.starts_with("data:")) {
        const std::size_t comma = uri.find(',');
        if (comma == std::string::npos) return {0, ".uri: is no data URI: it has no comma"};
        return {(uri.size() - comma - 1) * 3 / 4, std::nullopt};
    }
    const std::string shown = ".uri: \"" + one_line(uri) + "\" ";
    if (leaves_folder(uri)) return {0, shown + "lies outside of the model's folder"};
    const std::size_t slash = path.rfind('/');
    const std::string beside = (slash == std::string::npos ? "" : path.substr(0, slash + 1)) + uri;
    if (source.find(beside).empty()) return {0, shown + "is not in the model's folder"};
    const auto read = source.read(beside);
    if (!read) return {0, shown + read.error().why};
    return {read->size(), std::nullopt};
}

std::uint64_t whole(const json& object, const char* field) {
    const auto found = object.is_object() ? object.find(field) : object.end();
    return object.is_object() && found != object.end() && found->is_number_unsigned() ? found->get<std::uint64_t>() : 0;
}

/// A buffer that is missing or too short, or a part of one that does not exist.
Reason broken_reference(const FileSource& source, const std::string& path, const json& document, std::uint64_t chunk) {
    const json none = json::array();
    const auto list = [&](const char* name) -> const json& {
        const auto found = document.find(name);
        return found != document.end() && found->is_array() ? *found : none;
    };
    const json& buffers = list("buffers");
    for (std::size_t i = 0; i < buffers.size(); ++i) {
        const std::string name = "buffers[" + std::to_string(i) + "]";
        const Buffer buffer = buffer_of(source, path, buffers[i], i == 0 ? chunk : 0);
        if (buffer.missing) return name + *buffer.missing;
        const std::uint64_t stated = whole(buffers[i], "byteLength");
        if (stated > buffer.bytes) {
            const bool is_named =
                buffers[i].contains("uri") && !buffers[i]["uri"].get<std::string>().starts_with("data:");
            return name + ".byteLength: is " + std::to_string(stated) + ", but " +
                   (is_named ? "\"" + one_line(buffers[i]["uri"].get<std::string>()) + "\"" : "its data") + " has " +
                   bytes_text(buffer.bytes);
        }
    }
    const json& views = list("bufferViews");
    for (std::size_t i = 0; i < views.size(); ++i) {
        const std::string name = "bufferViews[" + std::to_string(i) + "]";
        const std::uint64_t index = whole(views[i], "buffer"), offset = whole(views[i], "byteOffset");
        if (index >= buffers.size()) return name + ".buffer: there is no buffer " + std::to_string(index);
        const std::uint64_t length = whole(views[i], "byteLength"), all = whole(buffers[index], "byteLength");
        if (offset > all || length > all - offset) return name + ": reaches beyond the end of its buffer";
    }
    const json& accessors = list("accessors");
    for (std::size_t i = 0; i < accessors.size(); ++i) {
        const std::uint64_t view = whole(accessors[i], "bufferView");
        if (accessors[i].contains("bufferView") && view >= views.size())
            return "accessors[" + std::to_string(i) + "].bufferView: there is no buffer view " + std::to_string(view);
    }
    return std::nullopt;
}

Reason reason_of_gltf(const FileSource& source, const std::string& path, std::string_view text, std::uint64_t chunk) {
    json document;
    try {
        document = json::parse(text);
    } catch (const json::exception& problem) {
        // After the parser's own number of the error.
        const std::string what = problem.what();
        const std::size_t at = what.find("at line");
        return "is not JSON" + (at == std::string::npos ? std::string() : ", " + what.substr(at));
    }
    if (!document.is_object()) return "is JSON, but no object: a glTF is {\"asset\": …}";
    const auto asset = document.find("asset");
    if (asset == document.end() || !asset->is_object() || !asset->contains("version") ||
        !(*asset)["version"].is_string())
        return "asset.version: is missing, so this is no glTF";
    const std::string version = (*asset)["version"];
    if (!version.starts_with("1.") && !version.starts_with("2."))
        return "asset.version: \"" + one_line(version) + "\" is not read: 1.0 and 2.0 are";
    if (auto broken = broken_reference(source, path, document, chunk)) return broken;
    if (!document.contains("meshes") || document["meshes"].empty()) return "meshes: are none";
    if (!document.contains("scenes") && !document.contains("nodes")) return "scenes: are none";
    return std::nullopt;
}

Reason reason_of_glb(const FileSource& source, const std::string& path, std::string_view content) {
    constexpr std::size_t header = 12, chunk_header = 8;
    if (!content.starts_with("glTF")) return "does not begin with \"glTF\", so it is no GLB";
    if (content.size() < header) return "breaks off in its header, after " + bytes_text(content.size());
    const std::uint32_t version = little_endian(content, 4), length = little_endian(content, 8);
    if (version != 1 && version != 2) return "is of version " + std::to_string(version) + ": 1 and 2 are read";
    if (length > content.size())
        return "breaks off: it says " + bytes_text(length) + ", and has " + std::to_string(content.size());
    if (version == 1) return std::nullopt;
    if (content.size() < header + chunk_header) return "has no chunks";
    const std::uint32_t json_size = little_endian(content, header);
    if (content.substr(header + 4, 4) != "JSON") return "its first chunk is no JSON";
    if (json_size > content.size() - header - chunk_header) return "its JSON chunk reaches beyond the end of the file";
    const std::size_t next = header + chunk_header + json_size;
    const bool has_binary = content.size() >= next + chunk_header;
    const std::uint64_t binary = has_binary ? little_endian(content, next) : 0;
    if (has_binary && binary > content.size() - next - chunk_header)
        return "its binary chunk reaches beyond the end of the file";
    return reason_of_gltf(source, path, content.substr(header + chunk_header, json_size), binary);
}

Reason reason_of_stl(std::string_view content) {
    constexpr std::uint64_t header = 84, triangle = 50;
    const std::size_t text = content.find_first_not_of(" \t\r\n");
    const bool is_text = text != std::string_view::npos && content.substr(text, 5) == "solid" &&
                         content.find('\0') == std::string_view::npos;
    if (is_text) {
        if (content.find("facet") == std::string_view::npos) return "is an STL text without facets";
        if (content.find("endsolid") == std::string_view::npos) return "breaks off: its \"endsolid\" is missing";
        return std::nullopt;
    }
    if (content.size() < header)
        return "is too short for an STL: it has " + bytes_text(content.size()) + ", a binary header alone has 84";
    const std::uint64_t triangles = little_endian(content, 80), needed = header + triangle * triangles;
    if (content.size() < needed)
        return "breaks off, or is no STL: its header says " + std::to_string(triangles) + " triangles, which are " +
               bytes_text(needed) + ", and it has " + std::to_string(content.size());
    return std::nullopt;
}

/// Counts the lines that are missing: a file that breaks off lacks the rest of its format.
Reason reason_of_ac3d(std::string_view content) {
    if (!content.starts_with("AC3D")) return "does not begin with \"AC3D\", so it is no AC3D file";
    std::istringstream lines{std::string(content)};
    std::string line, word;
    for (std::size_t number = 1; std::getline(lines, line); ++number) {
        std::istringstream words(line);
        std::uint64_t count = 0;
        if (!(words >> word >> count) || (word != "numvert" && word != "refs")) continue;
        const std::string what = "line " + std::to_string(number) + ": " + word + " is " + std::to_string(count);
        for (std::uint64_t i = 0; i < count; ++i, ++number) {
            if (!std::getline(lines, line)) return what + ", but the file breaks off after " + std::to_string(i);
        }
    }
    if (content.find("OBJECT") == std::string_view::npos) return "has no OBJECT";
    return std::nullopt;
}

Reason reason_of_collada(std::string_view content) {
    if (content.find("<COLLADA") == std::string_view::npos) return "has no <COLLADA> element, so it is no COLLADA file";
    if (content.find("</COLLADA>") == std::string_view::npos) return "breaks off: its </COLLADA> is missing";
    return std::nullopt;
}

Reason reason_of_obj(std::string_view content) {
    std::size_t vertices = 0, faces = 0;
    char before = '\n';
    for (std::size_t i = 0; i + 1 < content.size(); before = content[i++]) {
        if (before != '\n' && before != '\r') continue;
        const bool is_word = content[i + 1] == ' ' || content[i + 1] == '\t';
        if (is_word && content[i] == 'v') ++vertices;
        if (is_word && content[i] == 'f') ++faces;
    }
    if (vertices == 0) return "has no vertices: no line begins with \"v\"";
    if (faces == 0) return "has no faces: no line begins with \"f\"";
    return std::nullopt;
}

Reason reason_of_format(const FileSource& source, const std::string& path, std::string_view content,
                        const std::string& extension) {
    if (auto other = another_format(content, extension)) return other;
    if (extension == ".gltf") return reason_of_gltf(source, path, content, 0);
    if (extension == ".glb") return reason_of_glb(source, path, content);
    if (extension == ".stl") return reason_of_stl(content);
    if (extension == ".ac") return reason_of_ac3d(content);
    if (extension == ".dae") return reason_of_collada(content);
    if (extension == ".obj") return reason_of_obj(content);
    return std::nullopt;
}

/// Whether a message of the library says only that it gives up.
bool says_nothing(const std::string& told) {
    static constexpr std::array<std::string_view, 6> phrases = {"No suitable reader", "nknown error", "Failed to open",
                                                                "Unable to open",     "std::",        "exception"};
    return told.empty() ||
           std::any_of(phrases.begin(), phrases.end(), [&](auto phrase) { return told.find(phrase) != told.npos; });
}

}  // namespace

std::string reason_of_refusal(const FileSource& source, const std::string& path, std::span<const std::uint8_t> bytes,
                              const std::string& told) {
    const std::string_view content(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::string extension = extension_of(path);
    if (const Reason reason = reason_of_format(source, path, content, extension)) return one_line(*reason);
    if (!says_nothing(told)) return one_line(told);
    return "is damaged: its " + bytes_text(bytes.size()) + " begin as a " + extension +
           " file should, but make no model";
}

}  // namespace embody::interchange
