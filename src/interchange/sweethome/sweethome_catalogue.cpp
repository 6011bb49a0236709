// SPDX-License-Identifier: MIT
// Keys: Sweet Home 3D, com.eteks.sweethome3d.io.DefaultFurnitureCatalog, enum PropertyKey.
#include "interchange/sweethome/sweethome_catalogue.h"

#include <charconv>
#include <cmath>
#include <map>

#include "interchange/archive/archive.h"
#include "interchange/sweethome/properties_file.h"

namespace embody::interchange {
namespace {

using Properties = std::map<std::string, std::string, std::less<>>;
constexpr std::uint64_t max_list_bytes = 32 << 20;  // bytes; the longest known is 0.15 MB
constexpr int max_pieces = 100'000;

std::string trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(" \t\r\n");
    if (begin == std::string_view::npos) return {};
    return std::string(text.substr(begin, text.find_last_not_of(" \t\r\n") - begin + 1));
}

std::string text_of(const Properties& properties, const std::string& key) {
    const auto found = properties.find(key);
    return found == properties.end() ? std::string() : trimmed(found->second);
}

std::optional<double> number_in(std::string_view text) {
    double value = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (problem != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
    return value;
}

std::vector<std::string> split(std::string_view text, char separator) {
    std::vector<std::string> parts;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find(separator), text.size());
        if (std::string part = trimmed(text.substr(0, end)); !part.empty()) parts.push_back(std::move(part));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return parts;
}

/// Nine numbers by rows, a rotation up to the file's rounding; else nothing.
std::optional<std::array<double, 9>> rotation_in(const std::string& text) {
    const std::vector<std::string> words = split(text, ' ');
    if (words.size() != 9) return std::nullopt;
    std::array<double, 9> m{};
    for (std::size_t i = 0; i < 9; ++i) {
        const auto number = number_in(words[i]);
        if (!number) return std::nullopt;
        m[i] = *number;
    }
    for (std::size_t r = 0; r < 3; ++r) {
        const double squared = m[3 * r] * m[3 * r] + m[3 * r + 1] * m[3 * r + 1] + m[3 * r + 2] * m[3 * r + 2];
        if (std::fabs(squared - 1) > 0.01) return std::nullopt;
    }
    return m;
}

/// Piece number `n` of the list; why it is left out where it is.
Result<SweethomePiece> piece_of(const Properties& properties, const std::string& n) {
    SweethomePiece piece;
    piece.name = text_of(properties, "name#" + n);
    piece.model_path = normalized_member_path(text_of(properties, "model#" + n));
    if (piece.model_path.empty()) return Error{"model#" + n, "names no file inside the archive"};
    piece.icon_path = normalized_member_path(text_of(properties, "icon#" + n));
    piece.id = text_of(properties, "id#" + n);
    if (piece.id.empty()) piece.id = piece.model_path;

    // Sizes are in centimetres.
    const std::array<std::string, 3> size_keys{"width#" + n, "height#" + n, "depth#" + n};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto centimetres = number_in(text_of(properties, size_keys[axis]));
        if (!centimetres || *centimetres <= 0 || *centimetres > 1e6) {
            return Error{size_keys[axis], "must be a length greater than 0 cm"};
        }
        piece.size[axis] = *centimetres / 100;
    }
    piece.elevation = number_in(text_of(properties, "elevation#" + n)).value_or(0) / 100;
    if (const std::string text = text_of(properties, "modelRotation#" + n); !text.empty()) {
        const auto rotation = rotation_in(text);
        if (!rotation) return Error{"modelRotation#" + n, "must be the nine numbers of a rotation matrix"};
        piece.rotation = *rotation;
    }

    piece.tags = split(text_of(properties, "tags#" + n), ',');
    piece.category = text_of(properties, "category#" + n);
    piece.creator = text_of(properties, "creator#" + n);
    piece.movable = text_of(properties, "movable#" + n) != "false";
    piece.door_or_window = text_of(properties, "doorOrWindow#" + n) == "true";
    piece.light_source = !text_of(properties, "lightSourceX#" + n).empty();
    return piece;
}

}  // namespace

bool is_sweethome_catalogue(const std::filesystem::path& file) {
    return file.extension() == ".sh3f" || file.extension() == ".jar";
}

Result<SweethomeCatalogue> read_sweethome_catalogue(const std::filesystem::path& file) {
    auto archive = Archive::open(file);
    if (!archive) return archive.error();
    std::string list_path = archive->find("PluginFurnitureCatalog.properties");
    if (list_path.empty()) list_path = archive->find("com/eteks/sweethome3d/io/DefaultFurnitureCatalog.properties");
    if (list_path.empty()) return Error{file.string(), "holds no Sweet Home 3D furniture catalogue"};
    const auto bytes = archive->read(list_path, max_list_bytes);
    if (!bytes) return bytes.error();
    const Properties properties = parse_properties(std::string(bytes->begin(), bytes->end()));

    SweethomeCatalogue catalogue;
    catalogue.id = text_of(properties, "id");
    catalogue.name = text_of(properties, "name");
    catalogue.licence = text_of(properties, "license");
    catalogue.provider = text_of(properties, "provider");
    catalogue.version = text_of(properties, "version");

    // Numbered from 1 without gaps, as the program itself reads them.
    for (int i = 1; i <= max_pieces && properties.contains("name#" + std::to_string(i)); ++i) {
        auto piece = piece_of(properties, std::to_string(i));
        if (piece && archive->find(piece->model_path).empty()) {
            piece = Error{"model#" + std::to_string(i), "is not in the archive: " + piece->model_path};
        }
        if (piece) {
            catalogue.pieces.push_back(std::move(*piece));
        } else {
            catalogue.warnings.push_back(piece.error().message());
        }
    }
    return catalogue;
}

}  // namespace embody::interchange
