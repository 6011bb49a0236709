// SPDX-License-Identifier: MIT
#include "physics/definitions/shape_definition.h"

#include <cmath>
#include <cstdio>
#include <string>

namespace embody::physics {

namespace {

// Sizes beyond these lose all digits in volumes and inertias (products of five lengths) or in float vertices.
constexpr double smallest_size = 1e-6;
constexpr double largest_size = 1e6;

std::string to_text(double number) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", number);
    return text;
}

std::string element(const char* array, std::size_t index) {
    return std::string(array).append("[").append(std::to_string(index)).append("]");
}

Result<void> check_size(const char* field, double size) {
    if (size >= smallest_size && size <= largest_size) return {};
    return Error{field, "must be a length from 1e-6 m to 1e6 m, got " + to_text(size)};
}

Result<void> check_point(const std::string& field, Vec3 p) {
    if (is_finite(p) && std::fabs(p.x) <= largest_size && std::fabs(p.y) <= largest_size &&
        std::fabs(p.z) <= largest_size) {
        return {};
    }
    return Error{field, "must have finite coordinates of at most 1e6 m, got (" + to_text(p.x) + ", " + to_text(p.y) +
                            ", " + to_text(p.z) + ")"};
}

Result<void> check_size(const char* field, Vec3 sizes) {
    const std::string name(field);
    if (auto r = check_size((name + ".x").c_str(), sizes.x); !r) return r;
    if (auto r = check_size((name + ".y").c_str(), sizes.y); !r) return r;
    return check_size((name + ".z").c_str(), sizes.z);
}

Result<void> check(const HasLengths auto& shape) {
    Result<void> checked;
    const auto check_next = [&](const char* field, const auto& length, const char*) {
        if (checked) checked = check_size(field, length);
    };
    shape.lengths(shape, check_next);
    return checked;
}

Result<void> check(const HullShape& s) {
    if (s.points.size() < 4) {
        return Error{"points", "needs at least 4 points, got " + std::to_string(s.points.size())};
    }
    for (std::size_t i = 0; i < s.points.size(); ++i) {
        if (auto r = check_point(element("points", i), s.points[i]); !r) return r;
    }
    return {};
}

Result<void> check(const PlaneShape& s) {
    if (!is_finite(s.normal) || !(length(s.normal) > 1e-12) || length(s.normal) > 1e12) {
        return Error{"normal", "must be a finite direction of non-zero length"};
    }
    if (!(std::fabs(s.offset) <= largest_size)) {
        return Error{"offset", "must be a finite length of at most 1e6 m, got " + to_text(s.offset)};
    }
    return {};
}

Result<void> check(const HeightfieldShape& s) {
    constexpr int max_samples = 1 << 15;  // along a side
    if (s.columns < 2 || s.columns > max_samples) {
        return Error{"columns", "must be 2 to 32768, got " + std::to_string(s.columns)};
    }
    if (s.rows < 2 || s.rows > max_samples) return Error{"rows", "must be 2 to 32768, got " + std::to_string(s.rows)};
    if (auto r = check_size("cell_x", s.cell_x); !r) return r;
    if (auto r = check_size("cell_z", s.cell_z); !r) return r;

    // As many samples as the grid has corners, each a usable height.
    const std::size_t wanted = static_cast<std::size_t>(s.columns) * static_cast<std::size_t>(s.rows);
    if (s.heights.size() != wanted) {
        return Error{"heights", "must have columns * rows = " + std::to_string(wanted) + " numbers, got " +
                                    std::to_string(s.heights.size())};
    }
    for (std::size_t i = 0; i < wanted; ++i) {
        const double height = static_cast<double>(s.heights[i]);
        if (!(std::fabs(height) <= largest_size)) {
            return Error{element("heights", i), "must be a finite height of at most 1e6 m, got " + to_text(height)};
        }
    }
    return {};
}

Result<void> check(const MeshShape& s) {
    if (s.positions.size() < 3) {
        return Error{"positions", "needs at least 3 points, got " + std::to_string(s.positions.size())};
    }
    for (std::size_t i = 0; i < s.positions.size(); ++i) {
        if (auto r = check_point(element("positions", i), to_vec3(s.positions[i])); !r) return r;
    }
    if (s.triangles.empty()) return Error{"triangles", "needs at least one triangle"};
    for (std::size_t i = 0; i < s.triangles.size(); ++i) {
        for (const std::uint32_t corner : s.triangles[i]) {
            if (corner < s.positions.size()) continue;
            return Error{element("triangles", i),
                         "names position " + std::to_string(corner) + " of " + std::to_string(s.positions.size())};
        }
    }
    return {};
}

Result<void> check(const WallOpening& opening, const std::string& field) {
    const auto check_length = [&field](const char* name, double value) -> Result<void> {
        auto checked = check_size(name, value);
        return checked ? checked : Result<void>(Error{field + "." + name, checked.error().why});
    };
    if (!(std::fabs(opening.offset) <= largest_size))
        return Error{field + ".offset", "must be a finite length, got " + to_text(opening.offset)};
    if (auto r = check_length("width", opening.width); !r) return r;
    if (auto r = check_length("height", opening.height); !r) return r;
    if (opening.sill >= 0 && opening.sill <= largest_size) return {};
    return Error{field + ".sill", "must be a height from 0 to 1e6 m, got " + to_text(opening.sill)};
}

Result<void> check(const WallShape& s) {
    if (auto r = check_size("length", s.length); !r) return r;
    if (auto r = check_size("height", s.height); !r) return r;
    if (auto r = check_size("thickness", s.thickness); !r) return r;
    if (!(s.height + s.rise >= smallest_size && s.height + s.rise <= largest_size))
        return Error{"rise", "must leave a height at the wall's end, got " + to_text(s.rise)};
    for (std::size_t i = 0; i < 2; ++i) {
        if (!(std::fabs(s.start_cut[i]) <= largest_size))
            return Error{element("start_cut", i), "must be a finite length, got " + to_text(s.start_cut[i])};
        if (!(std::fabs(s.end_cut[i]) <= largest_size))
            return Error{element("end_cut", i), "must be a finite length, got " + to_text(s.end_cut[i])};
    }
    const auto [first, last] = s.straight_part();
    if (!(last - first >= smallest_size)) return Error{"end_cut", "leaves nothing of the wall between its mitred ends"};
    if (s.openings.size() > max_openings)
        return Error{"openings", "must be at most 256, got " + std::to_string(s.openings.size())};
    for (std::size_t i = 0; i < s.openings.size(); ++i)
        if (auto r = check(s.openings[i], element("openings", i)); !r) return r;
    if (s.parts().empty()) return Error{"openings", "leave nothing of the wall"};
    return {};
}

Result<void> check(const SlabShape& s) {
    if (s.points.size() < 3 || s.points.size() > max_slab_points)
        return Error{"points", "must be 3 to 500 corners, got " + std::to_string(s.points.size())};
    for (std::size_t i = 0; i < s.points.size(); ++i)
        if (auto r = check_point(element("points", i), {s.points[i][0], 0, s.points[i][1]}); !r) return r;
    if (auto r = check_size("thickness", s.thickness); !r) return r;
    if (const auto crossing = geometry::crossing_sides(s.points))
        return Error{"points", "must go around once: the sides from corner " + std::to_string(crossing->first) +
                                   " and from corner " + std::to_string(crossing->second) + " meet"};
    const double area = std::fabs(geometry::signed_area(s.points));
    if (!(area >= smallest_size) || s.parts().empty()) return Error{"points", "enclose no area"};
    return {};
}

Result<void> check(const CompoundShape& s) {
    if (s.children.empty()) return Error{"children", "needs at least one child"};
    for (std::size_t i = 0; i < s.children.size(); ++i) {
        const CompoundChild& child = s.children[i];
        const std::string field = element("children", i);
        if (auto r = check_point(field + ".local.position", child.local.position); !r) return r;
        const double norm = dot(child.local.rotation, child.local.rotation);
        if (!(std::fabs(norm - 1) < 1e-6)) return Error{field + ".local.rotation", "must be a unit quaternion"};
        const auto checked = std::visit([](const auto& shape) { return check(shape); }, child.shape);
        if (!checked) return Error{field + "." + checked.error().where, checked.error().why};
    }
    return {};
}

}  // namespace

Result<void> validate(const ShapeDefinition& definition) {
    return std::visit([](const auto& shape) { return check(shape); }, definition);
}

const char* shape_name(const ShapeDefinition& definition) {
    return std::visit([](const auto& shape) { return shape.name; }, definition);
}

bool is_static_only(const ShapeDefinition& definition) {
    return std::holds_alternative<PlaneShape>(definition) || std::holds_alternative<HeightfieldShape>(definition) ||
           std::holds_alternative<MeshShape>(definition);
}

}  // namespace embody::physics
