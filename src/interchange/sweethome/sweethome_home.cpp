// SPDX-License-Identifier: MIT
// Elements and attributes: Sweet Home 3D, com.eteks.sweethome3d.io.HomeXMLHandler. Lengths are in centimetres.
#include "interchange/sweethome/sweethome_home.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <pugixml.hpp>
#include <set>
#include <string_view>

#include "foundation/state_hash.h"
#include "interchange/archive/archive.h"
#include "interchange/read_model.h"
#include "interchange/screen_color.h"

namespace embody::interchange {
namespace {

constexpr std::uint64_t max_plan_bytes = std::uint64_t{64} << 20;
constexpr std::uint64_t max_model_bytes = std::uint64_t{256} << 20;
constexpr std::uint64_t max_bytes_of_models = std::uint64_t{2} << 30;
constexpr std::size_t max_things = 100'000;
constexpr int max_group_depth = 32;
constexpr double largest = 1e4;       // m, of any length or coordinate
constexpr double max_sagitta = 0.02;  // m between a curved wall and the straight ones that stand for it
constexpr int max_arc_pieces = 64;
constexpr std::size_t max_recolors = 256;

std::optional<double> plan_number(std::string_view text) {
    double value = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (problem != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
    return value;
}

std::optional<double> number_of(const pugi::xml_node& node, const char* name) {
    return plan_number(node.attribute(name).value());
}

/// In metres; none where it is missing, no number or absurd.
std::optional<double> length_of(const pugi::xml_node& node, const char* name) {
    const auto centimetres = number_of(node, name);
    if (!centimetres || std::fabs(*centimetres) > 100 * largest) return std::nullopt;
    return *centimetres / 100;
}

std::optional<double> size_of(const pugi::xml_node& node, const char* name) {
    const auto length = length_of(node, name);
    return length && *length > 1e-4 ? length : std::nullopt;
}

bool is_true(const pugi::xml_node& node, const char* name, bool otherwise) {
    const std::string_view text = node.attribute(name).value();
    return text.empty() ? otherwise : text == "true";
}

/// "FFRRGGBB" or "RRGGBB" of the screen, made linear.
std::optional<HomeColor> color_of(const pugi::xml_node& node, const char* name) {
    std::string_view text = node.attribute(name).value();
    if (text.size() == 8) text.remove_prefix(2);
    unsigned value = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
    if (text.size() != 6 || problem != std::errc() || end != text.data() + text.size()) return std::nullopt;
    HomeColor color{};
    for (std::size_t k = 0; k < 3; ++k)
        color[k] = static_cast<double>(linear_from_srgb(static_cast<float>((value >> (16 - 8 * k)) & 255U) / 255.0F));
    return color;
}

/// The product of nine numbers by rows and a mirroring of X, where the home says so.
std::array<double, 9> model_rotation_of(const pugi::xml_node& node) {
    std::array<double, 9> m{1, 0, 0, 0, 1, 0, 0, 0, 1};
    std::string_view text = node.attribute("modelRotation").value();
    std::array<double, 9> read{};
    std::size_t count = 0;
    while (!text.empty() && count < 9) {
        const std::size_t begin = text.find_first_not_of(' ');
        if (begin == std::string_view::npos) break;
        text.remove_prefix(begin);
        const std::size_t end = std::min(text.find(' '), text.size());
        const auto number = plan_number(text.substr(0, end));
        if (!number || std::fabs(*number) > 1.01) break;
        read[count++] = *number;
        text.remove_prefix(end);
    }
    if (count == 9) m = read;
    if (is_true(node, "modelMirrored", false))
        for (std::size_t k = 0; k < 3; ++k) m[k] = -m[k];
    return m;
}

/// Reads the elements of Home.xml.
class PlanReader {
public:
    PlanReader(const Archive& archive, std::string name) : archive_(archive) { home_.furniture.name = std::move(name); }

    SweethomeHome read(const pugi::xml_node& root) {
        wall_height_ = size_of(root, "wallHeight").value_or(2.5);
        for (const pugi::xml_node& node : root.children()) {
            if (count_++ > max_things) {
                note("it has more than 100000 parts: what follows is left out");
                break;
            }
            const std::string_view kind = node.name();
            if (kind == "level") read_level(node);
            if (kind == "wall") read_wall(node);
            if (kind == "room") read_room(node);
            read_furniture(node, "", "", 0);
        }
        tell_counts();
        return std::move(home_);
    }

private:
    void note(std::string text) { home_.notes.push_back(std::move(text)); }
    void read_level(const pugi::xml_node& node);
    void read_wall(const pugi::xml_node& node);
    /// Straight walls along an arc, `arc` in radians.
    void add_curved_wall(const HomeWall& wall, double arc);
    void read_room(const pugi::xml_node& node);
    void read_furniture(const pugi::xml_node& node, const std::string& group, const std::string& level, int depth);
    void read_piece(const pugi::xml_node& node, const std::string& group, const std::string& level);
    std::vector<Recolor> recolors_of(const pugi::xml_node& node);
    /// The path in the archive of a model that can be read, else empty.
    [[nodiscard]] std::string model_path_of(const pugi::xml_node& node) const;
    /// The hash of a model's bytes; none where they cannot be read, or where neither they nor `path` tell a format.
    std::optional<std::uint64_t> content_of(const std::string& path);
    void tell_counts();

    const Archive& archive_;
    SweethomeHome home_;
    double wall_height_ = 2.5;
    std::size_t count_ = 0;
    std::map<std::string, std::optional<std::uint64_t>> contents_;
    std::uint64_t bytes_read_ = 0;
    std::set<std::string> known_;
    std::size_t bad_walls_ = 0, bad_rooms_ = 0, bad_pieces_ = 0, textured_ = 0;
};

void PlanReader::read_level(const pugi::xml_node& node) {
    HomeLevel level;
    level.id = node.attribute("id").value();
    level.name = node.attribute("name").value();
    level.elevation = length_of(node, "elevation").value_or(0);
    level.height = size_of(node, "height").value_or(wall_height_);
    level.floor_thickness = size_of(node, "floorThickness").value_or(0.12);
    home_.levels.push_back(std::move(level));
}

void PlanReader::read_wall(const pugi::xml_node& node) {
    const auto x0 = length_of(node, "xStart"), z0 = length_of(node, "yStart"), x1 = length_of(node, "xEnd"),
               z1 = length_of(node, "yEnd"), thickness = size_of(node, "thickness");
    if (!x0 || !z0 || !x1 || !z1 || !thickness || std::hypot(*x1 - *x0, *z1 - *z0) < 1e-3) {
        ++bad_walls_;
        return;
    }
    HomeWall wall;
    wall.start = {*x0, *z0};
    wall.end = {*x1, *z1};
    wall.thickness = *thickness;
    wall.height = size_of(node, "height").value_or(wall_height_);
    wall.end_height = size_of(node, "heightAtEnd").value_or(wall.height);
    wall.color = color_of(node, "leftSideColor");
    if (!wall.color) wall.color = color_of(node, "rightSideColor");
    wall.level = node.attribute("level").value();
    const double arc = number_of(node, "arcExtent").value_or(0);
    if (std::fabs(arc) < 1e-3 || std::fabs(arc) > 2 * std::numbers::pi - 1e-3) {
        home_.walls.push_back(std::move(wall));
        return;
    }
    if (std::hypot(*x1 - *x0, *z1 - *z0) / 2 > largest * std::fabs(std::sin(arc / 2))) {
        ++bad_walls_;
        return;
    }
    add_curved_wall(wall, arc);
}

// The centre is where start and end are seen at the angle of the arc; the wall goes about it from start to end by
// `arc`.
void PlanReader::add_curved_wall(const HomeWall& wall, double arc) {
    const double x = wall.end[0] - wall.start[0], z = wall.end[1] - wall.start[1];
    const double beside = 0.5 / std::tan(arc / 2);
    const HomePoint center{wall.start[0] + x / 2 - beside * z, wall.start[1] + z / 2 + beside * x};
    const double radius = std::hypot(wall.start[0] - center[0], wall.start[1] - center[1]);
    const double step = 2 * std::acos(std::max(1 - max_sagitta / radius, 0.7));
    const int count = std::clamp(static_cast<int>(std::ceil(std::fabs(arc) / step)), 2, max_arc_pieces);
    HomeWall piece = wall;
    count_ += static_cast<std::size_t>(count - 1);
    for (int i = 1; i <= count; ++i) {
        const double part = static_cast<double>(i) / count, c = std::cos(part * arc), s = std::sin(part * arc);
        const double rx = wall.start[0] - center[0], rz = wall.start[1] - center[1];
        piece.end = i == count ? wall.end : HomePoint{center[0] + c * rx - s * rz, center[1] + s * rx + c * rz};
        piece.end_height = wall.height + part * (wall.end_height - wall.height);
        home_.walls.push_back(piece);
        piece.start = piece.end;
        piece.height = piece.end_height;
    }
}

void PlanReader::read_room(const pugi::xml_node& node) {
    if (!is_true(node, "floorVisible", true)) return;
    HomeRoom room;
    room.name = node.attribute("name").value();
    room.level = node.attribute("level").value();
    room.color = color_of(node, "floorColor");
    for (const pugi::xml_node& point : node.children("point")) {
        const auto x = length_of(point, "x"), z = length_of(point, "y");
        if (!x || !z) continue;
        const HomePoint corner{*x, *z};
        if (room.points.empty() || room.points.back() != corner) room.points.push_back(corner);
    }
    if (room.points.size() > 1 && room.points.front() == room.points.back()) room.points.pop_back();
    if (room.points.size() < 3) {
        ++bad_rooms_;
        return;
    }
    home_.rooms.push_back(std::move(room));
}

void PlanReader::read_furniture(const pugi::xml_node& node, const std::string& group, const std::string& level,
                                int depth) {
    const std::string_view kind = node.name();
    if (!is_true(node, "visible", true)) return;
    const std::string own = node.attribute("level").value();
    const std::string& its_level = own.empty() ? level : own;
    if (kind == "furnitureGroup") {
        if (depth >= max_group_depth) return;
        std::string name = node.attribute("name").value();
        std::erase(name, '/');
        if (name.empty()) name = "Group";
        for (const pugi::xml_node& child : node.children()) {
            if (count_++ > max_things) return;
            read_furniture(child, group.empty() ? name : group + "/" + name, its_level, depth + 1);
        }
    } else if (kind == "pieceOfFurniture" || kind == "doorOrWindow" || kind == "light" || kind == "shelfUnit") {
        read_piece(node, group, its_level);
    }
}

// The model itself, which has a number for a name where it is one file, or the first model in the folder that it names.
std::string PlanReader::model_path_of(const pugi::xml_node& node) const {
    const std::string path = normalized_member_path(node.attribute("model").value());
    if (path.empty()) return {};
    if (std::string found = archive_.find(path); !found.empty())
        return is_model_file(found) || extension_of(found).empty() ? found : std::string();
    for (const ArchiveMember& member : archive_.members())
        if (member.path.starts_with(path + "/") && is_model_file(member.path)) return member.path;
    return {};
}

std::optional<std::uint64_t> PlanReader::content_of(const std::string& path) {
    const auto known = contents_.find(path);
    if (known != contents_.end()) return known->second;
    std::optional<std::uint64_t> content;
    if (bytes_read_ < max_bytes_of_models) {
        const auto bytes = archive_.read(path, max_model_bytes);
        bytes_read_ += bytes.ok() ? bytes->size() : max_model_bytes;
        if (bytes.ok() && (is_model_file(path) || !extension_by_content(*bytes).empty())) {
            StateHash hash;
            hash.add_bytes(bytes->data(), bytes->size());
            content = hash.value();
        }
    }
    contents_.emplace(path, content);
    return content;
}

// The piece's own colour, then those of its materials.
std::vector<Recolor> PlanReader::recolors_of(const pugi::xml_node& node) {
    std::vector<Recolor> recolors;
    if (const auto color = color_of(node, "color")) recolors.push_back({"", *color});
    bool has_texture = !node.child("texture").empty();
    for (const pugi::xml_node& material : node.children("material")) {
        if (recolors.size() >= max_recolors) break;
        has_texture |= !material.child("texture").empty();
        const std::string_view name = material.attribute("name").value();
        const auto color = color_of(material, "color");
        if (color && !name.empty()) recolors.push_back({std::string(name), *color});
    }
    textured_ += has_texture ? 1 : 0;
    return recolors;
}

void PlanReader::read_piece(const pugi::xml_node& node, const std::string& group, const std::string& level) {
    const auto x = length_of(node, "x"), z = length_of(node, "y"), width = size_of(node, "width"),
               height = size_of(node, "height"), depth = size_of(node, "depth");
    if (!x || !z || !width || !height || !depth) {
        ++bad_pieces_;
        return;
    }
    HomePiece piece;
    piece.name = node.attribute("name").value();
    piece.group = group;
    piece.level = level;
    piece.place = {*x, *z};
    piece.elevation = length_of(node, "elevation").value_or(0);
    piece.angle = -number_of(node, "angle").value_or(0);
    piece.pitch = -number_of(node, "pitch").value_or(0);
    piece.roll = -number_of(node, "roll").value_or(0);
    piece.size = {*width, *height, *depth};
    const bool is_tilted = piece.pitch != 0 || piece.roll != 0;
    piece.height = is_tilted ? size_of(node, "heightInPlan").value_or(0) : 0;
    piece.color = color_of(node, "color");
    piece.door_or_window = std::string_view(node.name()) == "doorOrWindow";
    piece.light_source = std::string_view(node.name()) == "light";
    piece.movable = is_true(node, "movable", !piece.door_or_window);

    const std::string path = model_path_of(node);
    const auto content = path.empty() ? std::nullopt : content_of(path);
    if (content) {
        SweethomePiece model;
        model.name = piece.name;
        model.model_path = path;
        model.icon_path = archive_.find(normalized_member_path(node.attribute("icon").value()));
        model.creator = node.attribute("creator").value();
        model.size = piece.size;
        model.rotation = model_rotation_of(node);
        model.recolors = recolors_of(node);
        model.movable = piece.movable;
        model.door_or_window = piece.door_or_window;
        model.light_source = piece.light_source;
        StateHash hash;
        hash.add(*content);
        for (const double each : model.size) hash.add(each);
        for (const double each : model.rotation) hash.add(each);
        for (const Recolor& recolor : model.recolors) {
            hash.add_bytes(recolor.material.data(), recolor.material.size());
            for (const double each : recolor.color) hash.add(each);
        }
        char text[24];
        std::snprintf(text, sizeof text, "home#%016llx", static_cast<unsigned long long>(hash.value()));
        model.id = piece.id = text;
        if (known_.insert(model.id).second) home_.furniture.pieces.push_back(std::move(model));
    }
    home_.pieces.push_back(std::move(piece));
}

void PlanReader::tell_counts() {
    const auto tell = [this](std::size_t count, const char* what) {
        if (count > 0) note(std::to_string(count) + " " + what);
    };
    tell(bad_walls_, "walls have no length or thickness and are left out");
    tell(bad_rooms_, "rooms have fewer than three corners and are left out");
    tell(bad_pieces_, "pieces of furniture have no place or size and are left out");
    tell(textured_, "pieces of furniture have textures of the home's own, which are left out");
    std::size_t without = 0;
    for (const HomePiece& piece : home_.pieces) without += piece.id.empty() ? 1 : 0;
    tell(without, "pieces of furniture have no model that can be read: boxes of their size stand for them");
}

}  // namespace

bool is_sweethome_home(const std::filesystem::path& file) { return extension_of(file) == ".sh3d"; }

Result<SweethomeHome> read_sweethome_home(const std::filesystem::path& file) {
    auto archive = Archive::open(file);
    if (!archive) return archive.error();
    const std::string plan = archive->find("Home.xml");
    if (plan.empty()) {
        if (archive->find("Home").empty())
            return Error{file.string(), "is no home of Sweet Home 3D: it holds no Home.xml"};
        return Error{file.string(), "holds its plan only in the form of old versions of Sweet Home 3D",
                     "open it in Sweet Home 3D 5.3 or newer and save it again"};
    }
    const auto bytes = archive->read(plan, max_plan_bytes);
    if (!bytes) return bytes.error();
    pugi::xml_document document;
    const pugi::xml_parse_result parsed = document.load_buffer(bytes->data(), bytes->size());
    if (!parsed)
        return Error{file.string() + ": Home.xml",
                     std::string("is no XML: ") + parsed.description() + " at byte " + std::to_string(parsed.offset)};
    const pugi::xml_node root = document.child("home");
    if (!root) return Error{file.string() + ": Home.xml", "has no element home"};
    return PlanReader(*archive, file.stem().string()).read(root);
}

}  // namespace embody::interchange
