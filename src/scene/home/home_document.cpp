// SPDX-License-Identifier: MIT
#include "scene/home/home_document.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "attributes/physical_kind.h"
#include "math/bounds.h"
#include "scene/embody/wall_joints.h"

namespace embody::scene {

namespace {

using attributes::PhysicalKind;
using interchange::HomeLevel;
using interchange::HomePiece;
using physics::ShapeDefinition;
using physics::WallShape;

constexpr double ground_depth = 0.005;                 // m: so much lower than floors the ground lies
constexpr double ground_thickness = 0.5, garden = 10;  // m; so far the ground reaches beyond the home
constexpr double near_below = 0.05;                    // m: what is nearer below a thing carries it
constexpr std::array<double, 3> wall_color{0.82, 0.8, 0.76}, floor_color{0.35, 0.27, 0.19},
    ground_color{0.18, 0.26, 0.12};

Transform placed(double x, double y, double z, double angle) { return {{x, y, z}, from_axis_angle({0, 1, 0}, angle)}; }

class HomeBuilder {
public:
    HomeBuilder(const interchange::SweethomeHome& home, const std::function<bool(const std::string&)>& has_model)
        : home_(home), has_model_(has_model) {
        for (const HomeLevel& level : home.levels) levels_[level.id] = &level;
        result_.notes = home.notes;
    }

    HomeDocument build(const std::string& title) {
        Document& document = result_.document;
        document.title = title;
        for (const HomeLevel& level : home_.levels)
            document.levels.push_back({level.name, level.elevation, std::max(0.1, level.height)});
        std::stable_sort(document.levels.begin(), document.levels.end(),
                         [](const Level& a, const Level& b) { return a.elevation < b.elevation; });
        add_walls();
        add_rooms();
        for (const HomePiece& piece : home_.pieces) add_piece(piece);
        join_walls();
        hang_pieces();
        add_ground();
        look_at_all();
        if (boxes_ > 0)
            result_.notes.push_back(std::to_string(boxes_) +
                                    " models of the home could not be read: boxes stand for them");
        if (shapeless_ > 0)
            result_.notes.push_back(std::to_string(shapeless_) +
                                    " light sources have no shape, or none that could be read, and are left out");
        return std::move(result_);
    }

private:
    [[nodiscard]] double elevation_of(const std::string& level) const {
        const auto found = levels_.find(level);
        return found == levels_.end() ? 0 : found->second->elevation;
    }
    Entity& add(std::string name, std::string category, const Transform& pose) {
        Entity entity;
        entity.index = result_.document.next_index++;
        entity.name = std::move(name);
        entity.category = std::move(category);
        entity.pose = pose;
        result_.document.entities.push_back(std::move(entity));
        return result_.document.entities.back();
    }
    Entity& add_part(const char* name, const char* category, ShapeDefinition shape, const Transform& pose,
                     const std::array<double, 3>& color) {
        Entity& entity = add(name, category, pose);
        entity.geometry = std::move(shape);
        entity.attributes["kind"] = to_value(PhysicalKind::static_body);
        entity.color = color;
        entity.locked = true;
        return entity;
    }
    /// Takes a point of a wall or floor, whose base is at `base`, into the extents.
    void reach(Vec3 point, double base) {
        extent_.add(point);
        if (base >= -near_below) return;
        cellar_.add(point);
        lowest_floor_ = std::min(lowest_floor_, base);
    }
    WallShape& wall_at(std::size_t entity) {
        return std::get<WallShape>(std::get<ShapeDefinition>(result_.document.entities[entity].geometry));
    }

    void add_walls();
    void add_rooms();
    void add_piece(const HomePiece& piece);
    void cut_wall(const HomePiece& piece, const Entity& entity);
    void join_walls();
    void hang_pieces();
    void add_ground();
    void look_at_all();

    const interchange::SweethomeHome& home_;
    const std::function<bool(const std::string&)>& has_model_;
    std::map<std::string, const HomeLevel*> levels_;
    HomeDocument result_;
    Bounds extent_;
    Bounds cellar_;  // of walls and floors below the ground
    double lowest_floor_ = 0;
    std::vector<std::size_t> walls_;  // places in the document's entities
    struct Placed {
        std::size_t entity;
        Bounds bounds;
    };
    std::vector<Placed> loose_;  // things that are no doors or windows
    std::size_t boxes_ = 0, shapeless_ = 0;
};

void HomeBuilder::add_walls() {
    for (const interchange::HomeWall& wall : home_.walls) {
        const double x = wall.end[0] - wall.start[0], z = wall.end[1] - wall.start[1];
        WallShape shape;
        shape.length = std::hypot(x, z);
        shape.height = wall.height;
        shape.rise = wall.end_height - wall.height;
        shape.thickness = wall.thickness;
        if (!physics::validate(shape).ok()) continue;
        const double y = elevation_of(wall.level);
        walls_.push_back(result_.document.entities.size());
        add_part("Wall", "wall", std::move(shape), placed(wall.start[0], y, wall.start[1], std::atan2(-z, x)),
                 wall.color.value_or(wall_color));
        const double half = wall.thickness / 2;
        for (const auto& end : {wall.start, wall.end})
            for (const double side : {-half, half}) reach({end[0] + side, y + wall.height, end[1] + side}, y);
    }
}

void HomeBuilder::add_rooms() {
    std::size_t left_out = 0;
    for (const interchange::HomeRoom& room : home_.rooms) {
        const auto level = levels_.find(room.level);
        physics::SlabShape slab;
        slab.thickness = level == levels_.end() ? 0.12 : level->second->floor_thickness;
        const auto origin = room.points.front();
        for (const auto& point : room.points) {
            slab.points.push_back({point[0] - origin[0], point[1] - origin[1]});
            const double y = elevation_of(room.level);
            reach({point[0], y, point[1]}, y);
        }
        if (!physics::validate(slab).ok()) {
            ++left_out;
            continue;
        }
        add_part(room.name.empty() ? "Floor" : room.name.c_str(), "floor", std::move(slab),
                 placed(origin[0], elevation_of(room.level), origin[1], 0), room.color.value_or(floor_color));
    }
    if (left_out > 0) result_.notes.push_back(std::to_string(left_out) + " floors cross themselves and are left out");
}

void HomeBuilder::add_piece(const HomePiece& piece) {
    const std::string key = piece.id.empty() ? std::string() : key_of_home_model(piece.id);
    const bool has_model = !key.empty() && has_model_(key);
    if (piece.light_source && !has_model && !key.empty()) {
        ++shapeless_;
        return;
    }
    const double y = elevation_of(piece.level) + piece.elevation;
    const bool is_tilted = piece.pitch != 0 || piece.roll != 0;
    // Turned about its middle: first about X, then about Z, then about the vertical.
    const Vec3 half{piece.size[0] / 2, piece.size[1] / 2, piece.size[2] / 2};
    Transform middle =
        placed(piece.place[0], y + (piece.height > 0 ? piece.height / 2 : half.y), piece.place[1], piece.angle);
    if (is_tilted)
        middle.rotation =
            middle.rotation * from_axis_angle({0, 0, 1}, piece.roll) * from_axis_angle({1, 0, 0}, piece.pitch);
    Entity& entity = add(piece.name, "", middle * Transform{{0, -half.y, 0}, {}});
    entity.group = piece.group;
    if (has_model) {
        entity.geometry = ModelReference{key};
    } else {
        boxes_ += key.empty() ? 0 : 1;
        entity.geometry = ShapeDefinition{physics::BoxShape{half}};
        entity.pose = middle;
        entity.category = piece.door_or_window ? "door" : "";
        entity.color = piece.color;
        if (piece.door_or_window || !piece.movable) entity.attributes["kind"] = to_value(PhysicalKind::static_body);
    }
    extent_.add(entity.pose.position);
    if (piece.door_or_window) return cut_wall(piece, entity);
    entity.start_asleep = true;
    // What leans or makes a roof was fastened by who drew it.
    if (is_tilted) entity.attributes["kind"] = to_value(PhysicalKind::static_body);
    loose_.push_back({result_.document.entities.size() - 1, transformed(middle, {-half, half})});
}

void HomeBuilder::cut_wall(const HomePiece& piece, const Entity& entity) {
    const double y = elevation_of(piece.level) + piece.elevation;
    const Transform base = placed(piece.place[0], y, piece.place[1], piece.angle);
    for (const std::size_t at : walls_) {
        WallShape cut = wall_at(at);
        const Transform local = inverse(result_.document.entities[at].pose) * base;
        auto opening = opening_of(cut, local, {piece.size[0], piece.size[1], piece.size[2]});
        if (!opening) continue;
        opening->owner = entity.index;
        cut.openings.push_back(*opening);
        if (physics::validate(cut).ok()) wall_at(at) = std::move(cut);
    }
}

void HomeBuilder::join_walls() {
    std::map<std::array<long, 3>, std::vector<WallEnd>> corners;
    for (const std::size_t at : walls_)
        for (const bool is_end : {false, true}) {
            const WallEnd end{&wall_at(at), result_.document.entities[at].pose, is_end};
            const Vec3 p = point_of(end);
            corners[{std::lround(p.x / 0.01), std::lround(p.y / 0.01), std::lround(p.z / 0.01)}].push_back(end);
        }
    for (const auto& [place, ends] : corners) {
        std::vector<WallShape> before;
        for (const WallEnd& end : ends) before.push_back(*end.wall);
        mitre(ends);
        for (std::size_t i = 0; i < ends.size(); ++i)
            if (!physics::validate(*ends[i].wall).ok()) *ends[i].wall = before[i];
    }
}

// Lamps and pictures have nothing below them.
void HomeBuilder::hang_pieces() {
    std::vector<double> floors{0};
    for (const HomeLevel& level : home_.levels) floors.push_back(level.elevation);
    for (const Placed& piece : loose_) {
        const double base = piece.bounds.lower.y;
        const bool stands =
            std::any_of(floors.begin(), floors.end(), [&](double y) { return std::fabs(base - y) < near_below; });
        const bool is_carried = stands || std::any_of(loose_.begin(), loose_.end(), [&](const Placed& other) {
                                    const Bounds& b = other.bounds;
                                    return other.entity != piece.entity && std::fabs(b.upper.y - base) < near_below &&
                                           b.lower.x < piece.bounds.upper.x && b.upper.x > piece.bounds.lower.x &&
                                           b.lower.z < piece.bounds.upper.z && b.upper.z > piece.bounds.lower.z;
                                });
        if (!is_carried)
            result_.document.entities[piece.entity].attributes["kind"] = to_value(PhysicalKind::static_body);
    }
}

void HomeBuilder::add_ground() {
    if (extent_.is_empty()) extent_.add(Vec3{});
    const double x0 = extent_.lower.x - garden, x1 = extent_.upper.x + garden;
    const double z0 = extent_.lower.z - garden, z1 = extent_.upper.z + garden;
    const auto add_box = [&](double from_x, double to_x, double from_z, double to_z, double top = -ground_depth) {
        const physics::BoxShape box{{(to_x - from_x) / 2, ground_thickness / 2, (to_z - from_z) / 2}};
        add_part("Ground", "ground", box,
                 placed((from_x + to_x) / 2, top - ground_thickness / 2, (from_z + to_z) / 2, 0), ground_color);
    };
    if (cellar_.is_empty()) return add_box(x0, x1, z0, z1);
    // Around the cellar and below it: it would have the ground across its rooms.
    const Vec3 low = cellar_.lower, high = cellar_.upper;
    add_box(low.x, high.x, low.z, high.z, lowest_floor_ - ground_depth);
    add_box(x0, low.x, z0, z1);
    add_box(high.x, x1, z0, z1);
    add_box(low.x, high.x, z0, low.z);
    add_box(low.x, high.x, high.z, z1);
}

void HomeBuilder::look_at_all() {
    const Vec3 middle = extent_.center();
    const double reach = std::max(3.0, length(extent_.half_extents()));
    result_.document.camera = Camera{middle + Vec3{0.5, 1.5, 1.3} * reach, middle};
}

}  // namespace

std::string key_of_home_model(const std::string& id) { return "sweethome3d:" + id; }

HomeDocument document_of_home(const interchange::SweethomeHome& home, const std::string& title,
                              const std::function<bool(const std::string& key)>& has_model) {
    return HomeBuilder(home, has_model).build(title);
}

}  // namespace embody::scene
