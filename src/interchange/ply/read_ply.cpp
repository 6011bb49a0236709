// SPDX-License-Identifier: MIT
// Format: G. Turk, The PLY Polygon File Format, 1994. Why a reader of our own: docs/decisions/0016-ply.md.
#include "interchange/ply/read_ply.h"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "interchange/one_line.h"
#include "interchange/ply/ply_header.h"
#include "interchange/ply/ply_numbers.h"
#include "interchange/polygon.h"
#include "interchange/screen_color.h"
#include "interchange/texture_reader.h"

namespace embody::interchange {
namespace {

constexpr std::size_t max_triangles = 20'000'000;

/// The file's elements one after another, made into one mesh.
class PlyReader {
public:
    PlyReader(std::string_view file, const PlyHeader& header) : header_(header), numbers_(file, header) {}

    Result<void> read() {
        for (const PlyElement& element : header_.elements) {
            // Without properties there is nothing to read, however often.
            if (element.properties.empty()) continue;
            if (const auto found = look_for_parts(element); !found) return found.error();
            for (std::uint64_t i = 0; i < element.count; ++i) {
                if (const auto taken = read_one(element); !taken) {
                    const std::string where = "element " + one_line(element.name) + " " + std::to_string(i);
                    return Error{where + ", " + numbers_.place(), taken.error().why, taken.error().remedy};
                }
            }
        }
        return {};
    }

    RawMesh take_mesh() { return std::move(mesh_); }
    /// Mean of the vertices' colours as in the file, 0 to 1 each; nothing where they have none.
    [[nodiscard]] std::optional<std::array<float, 4>> mean_color() const {
        if (colored_ == 0) return std::nullopt;
        std::array<float, 4> mean{};
        for (std::size_t c = 0; c < 4; ++c) mean[c] = static_cast<float>(color_sum_[c] / static_cast<double>(colored_));
        return mean;
    }

private:
    using Place = std::optional<std::size_t>;  // of a property in its element
    enum class Role : std::uint8_t { other, vertex, face, strips };

    /// The properties of an element that are read.
    struct Parts {
        Role role = Role::other;
        std::array<Place, 3> position, normal;
        std::array<Place, 2> texture;
        std::array<Place, 4> color;
        Place indices, corner_texture;
    };

    Result<void> look_for_parts(const PlyElement& element) {
        parts_ = {};
        if (element.name == "vertex") {
            if (!mesh_.positions.empty()) return Error{"element vertex", "is there twice"};
            parts_.role = Role::vertex;
            parts_.position = {element.find({"x"}), element.find({"y"}), element.find({"z"})};
            parts_.normal = {element.find({"nx"}), element.find({"ny"}), element.find({"nz"})};
            parts_.texture = {element.find({"u", "s", "texture_u"}), element.find({"v", "t", "texture_v"})};
            parts_.color = {element.find({"red", "diffuse_red", "r"}), element.find({"green", "diffuse_green", "g"}),
                            element.find({"blue", "diffuse_blue", "b"}), element.find({"alpha", "diffuse_alpha"})};
            for (const Place& place : parts_.position) {
                if (!place || element.properties[*place].count_type)
                    return Error{"element vertex", "has no x, y and z"};
            }
        } else if (element.name == "face" || element.name == "tristrips") {
            parts_.role = element.name == "face" ? Role::face : Role::strips;
            parts_.indices = element.find({"vertex_indices", "vertex_index"});
            parts_.corner_texture = element.find({"texcoord"});
            if (!parts_.indices || !element.properties[*parts_.indices].count_type) {
                return Error{"element " + element.name, "has no list of vertex_indices"};
            }
            if (vertices_ == 0) return Error{"element " + element.name, "comes before the vertices, or there are none"};
        }
        return {};
    }

    /// Reads one element: all of its numbers, then their meanings.
    Result<void> read_one(const PlyElement& element) {
        values_.assign(element.properties.size(), 0);
        corner_texture_.clear();
        for (std::size_t i = 0; i < element.properties.size(); ++i) {
            const PlyProperty& property = element.properties[i];
            std::vector<double>& list = i == parts_.indices          ? indices_
                                        : i == parts_.corner_texture ? corner_texture_
                                                                     : ignored_;
            bool there = false;
            if (property.count_type) {
                there = numbers_.next_list(property, list);
            } else if (const auto number = numbers_.next(property.type)) {
                there = true;
                values_[i] = *number;
            }
            if (!there) {
                return Error{"", "has no readable number for " + one_line(property.name), "is the file complete?"};
            }
        }
        switch (parts_.role) {
            case Role::vertex:
                return take_vertex(element);
            case Role::face:
                return take_face();
            case Role::strips:
                return take_strips();
            case Role::other:
                break;
        }
        return {};
    }

    Result<void> take_vertex(const PlyElement& element) {
        const auto value = [&](const Place& place) { return static_cast<float>(values_[*place]); };
        const Vec3f p{value(parts_.position[0]), value(parts_.position[1]), value(parts_.position[2])};
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
            return Error{"", "has a coordinate that is not a finite number"};
        }
        mesh_.positions.push_back(p);
        ++vertices_;
        if (parts_.normal[0] && parts_.normal[1] && parts_.normal[2]) {
            const Vec3f n{value(parts_.normal[0]), value(parts_.normal[1]), value(parts_.normal[2])};
            const float length = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
            const bool usable = std::isfinite(length) && length > 0;
            mesh_.normals.push_back(usable ? Vec3f{n.x / length, n.y / length, n.z / length} : Vec3f{0, 1, 0});
        }
        if (parts_.texture[0] && parts_.texture[1]) {
            mesh_.texture_coordinates.push_back(upper_left(values_[*parts_.texture[0]], values_[*parts_.texture[1]]));
        }
        if (parts_.color[0] && parts_.color[1] && parts_.color[2]) add_color(element);
        return {};
    }

    /// Whole numbers are in 0 … 255, fractions in 0 … 1.
    void add_color(const PlyElement& element) {
        ++colored_;
        for (std::size_t c = 0; c < 4; ++c) {
            const Place& place = parts_.color[c];
            const bool is_fraction = place && element.properties[*place].type >= PlyType::float32;
            const double value = !place ? 1 : is_fraction ? values_[*place] : values_[*place] / 255;
            color_sum_[c] += static_cast<double>(unit_range(static_cast<float>(value)));
        }
    }

    /// PLY's texture origin is the lower left.
    static std::array<float, 2> upper_left(double u, double v) {
        const std::array<float, 2> uv{static_cast<float>(u), static_cast<float>(1 - v)};
        return std::isfinite(uv[0]) && std::isfinite(uv[1]) ? uv : std::array{0.0f, 0.0f};
    }

    /// The vertex with this number; empty where there is none.
    [[nodiscard]] std::optional<std::uint32_t> vertex_of(double index) const {
        if (!(index >= 0) || index >= static_cast<double>(vertices_) || index != std::floor(index)) return std::nullopt;
        return static_cast<std::uint32_t>(index);
    }

    Result<void> add_triangle(const std::array<std::uint32_t, 3>& triangle) {
        if (mesh_.triangles.size() >= max_triangles) {
            return Error{"", "is one triangle more than " + std::to_string(max_triangles)};
        }
        mesh_.triangles.push_back(triangle);
        return {};
    }

    static Error no_vertex(double index) {
        std::array<char, 32> text{};
        const auto end = std::to_chars(text.begin(), text.end(), index).ptr;
        return {"", "refers to vertex " + std::string(text.begin(), end) + ", which does not exist"};
    }

    Result<void> take_face() {
        corners_.clear();
        corner_positions_.clear();
        for (const double index : indices_) {
            const auto vertex = vertex_of(index);
            if (!vertex) return no_vertex(index);
            corners_.push_back(*vertex);
            corner_positions_.push_back(mesh_.positions[*vertex]);
        }
        // Corners with texture coordinates of their own are vertices of their own.
        if (!corner_texture_.empty() && corner_texture_.size() == 2 * corners_.size()) {
            if (mesh_.positions.size() + corners_.size() > 3 * max_triangles) {
                return Error{"", "makes more than " + std::to_string(3 * max_triangles) + " corners with textures"};
            }
            for (std::size_t i = 0; i < corners_.size(); ++i) corners_[i] = split_corner(i);
        }
        for (const auto& t : triangles_of_polygon(corner_positions_)) {
            const auto added = add_triangle({corners_[t[0]], corners_[t[1]], corners_[t[2]]});
            if (!added) return added;
        }
        return {};
    }

    std::uint32_t split_corner(std::size_t corner) {
        const std::uint32_t vertex = corners_[corner];
        mesh_.texture_coordinates.resize(mesh_.positions.size());
        mesh_.positions.push_back(mesh_.positions[vertex]);
        if (!mesh_.normals.empty()) mesh_.normals.push_back(mesh_.normals[vertex]);
        mesh_.texture_coordinates.push_back(upper_left(corner_texture_[2 * corner], corner_texture_[2 * corner + 1]));
        return static_cast<std::uint32_t>(mesh_.positions.size() - 1);
    }

    /// Strips one after another, -1 between them; every second triangle of a strip turns the other way.
    Result<void> take_strips() {
        std::vector<std::uint32_t> strip;
        for (const double index : indices_) {
            if (index == -1) {
                strip.clear();
                continue;
            }
            const auto vertex = vertex_of(index);
            if (!vertex) return no_vertex(index);
            strip.push_back(*vertex);
            const std::size_t n = strip.size();
            if (n < 3) continue;
            const bool turned = n % 2 == 0;
            const auto added = add_triangle({strip[n - (turned ? 2 : 3)], strip[n - (turned ? 3 : 2)], strip[n - 1]});
            if (!added) return added;
        }
        return {};
    }

    const PlyHeader& header_;
    PlyNumbers numbers_;
    RawMesh mesh_;
    std::uint64_t vertices_ = 0;  // of the file; the mesh has more where corners were split
    std::array<double, 4> color_sum_{};
    std::uint64_t colored_ = 0;

    // Of the present element.
    Parts parts_;
    std::vector<double> values_, indices_, corner_texture_, ignored_;
    std::vector<std::uint32_t> corners_;
    std::vector<Vec3f> corner_positions_;
};

}  // namespace

Result<RawScene> read_ply(const FileSource& source, const std::string& path) {
    const std::string where = source.describe(path);
    const auto bytes = source.read(path);
    if (!bytes) return bytes.error();
    if (bytes->empty()) return Error{where, "is empty"};
    const std::string_view file(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    const auto header = read_ply_header(file);
    if (!header) return Error{where + ": " + header.error().where, header.error().why, header.error().remedy};
    PlyReader reader(file, *header);
    if (const auto read = reader.read(); !read) {
        return Error{where + ": " + read.error().where, read.error().why, read.error().remedy};
    }

    RawScene scene;
    RawMaterial material;
    material.name = "material 1";
    material.double_sided = true;  // the format cannot say, and scans are often open
    if (const auto color = reader.mean_color()) {
        material.base_color = {linear_from_srgb((*color)[0]), linear_from_srgb((*color)[1]),
                               linear_from_srgb((*color)[2]), (*color)[3]};
    }
    if (!header->texture.empty()) {
        material.base_color_image = TextureReader(source, path, scene).index_of(header->texture);
        if (material.base_color_image >= 0) material.base_color = {1, 1, 1, 1};
    }
    scene.materials.push_back(std::move(material));
    scene.meshes.push_back(reader.take_mesh());
    scene.meshes.back().material = 0;
    if (scene.meshes.back().triangles.empty()) return Error{where, "holds no triangles"};
    return scene;
}

}  // namespace embody::interchange
