// SPDX-License-Identifier: MIT
#include "scene/embody/entity_meshes.h"

#include <algorithm>
#include <cmath>

#include "attributes/physical_kind.h"
#include "scene/embody/shape_surface.h"
#include "scene/embody/soft_primitive.h"

namespace embody::scene {

namespace {

bool is_sheet(const attributes::AttributeSet& attributes) { return matter_of(attributes) == attributes::Matter::sheet; }

int count_of(const attributes::AttributeSet& attributes) {
    return static_cast<int>(is_sheet(attributes) ? attributes.number("cloth_nodes", 1000)
                                                 : attributes.number("rope_segments", 50));
}

bool holds_gas(const attributes::AttributeSet& attributes) {
    return is_sheet(attributes) && attributes.number("internal_pressure", 0) > 0;
}

}  // namespace

Result<const catalog::SoftMesh*> EntityMeshes::soft_mesh(const Entity& entity,
                                                         const attributes::AttributeSet& attributes) {
    const GeometryKey key = key_of(entity.geometry);
    const int resolution = static_cast<int>(attributes.number("soft_resolution", 0));
    auto& meshes = forms_->soft_meshes[key];
    auto found = meshes.find(resolution);
    if (!key.is_shared() || found == meshes.end()) {
        found = meshes.insert_or_assign(resolution, make_soft_mesh(entity, resolution)).first;
        ++forms_->made;
    }
    if (!found->second.ok()) return found->second.error();
    return &found->second.value();
}

Result<catalog::SoftMesh> EntityMeshes::make_soft_mesh(const Entity& entity, int resolution) {
    if (const auto* model = std::get_if<ModelReference>(&entity.geometry)) {
        const Result<const KnownModel*> known = models_.find(model->key);
        if (!known.ok()) return known.error();
        return models_.catalog()->soft_mesh(known.value()->summary.id, resolution);
    }
    const auto& shape = std::get<physics::ShapeDefinition>(entity.geometry);
    if (auto primitive = soft_primitive(shape, resolution)) return std::move(*primitive);
    const auto surface = surface_of(shape);
    if (!surface) return surface.error();
    return catalog::make_soft_mesh(*surface, resolution);
}

Result<const ThinForm*> EntityMeshes::thin_form(const Entity& entity, const attributes::AttributeSet& attributes) {
    const GeometryKey key = key_of(entity.geometry);
    const bool is_closed = holds_gas(attributes);
    const std::string own =
        to_text(kind_of(attributes)) + ' ' + std::to_string(count_of(attributes)) + (is_closed ? " closed" : "");
    auto& forms = forms_->thin_forms[key];
    auto found = forms.find(own);
    if (!key.is_shared() || found == forms.end()) {
        const int count = count_of(attributes);
        Result<ThinForm> form =
            is_closed ? make_closed_form(entity, count) : make_thin_form(entity, is_sheet(attributes), count);
        if (is_closed && !form.ok()) form = make_thin_form(entity, is_sheet(attributes), count);
        found = forms.insert_or_assign(own, std::move(form)).first;
    }
    if (!found->second.ok()) return found->second.error();
    return &found->second.value();
}

// The tetrahedra of a soft thing whose surface has about `count` nodes. Finer ones may not be possible.
Result<catalog::SoftMesh> EntityMeshes::make_soft_mesh_about(const Entity& entity, int count) {
    constexpr int first = 4, largest = 12;  // cells across
    const auto nodes_of = [](const catalog::SoftMesh& soft) {
        return static_cast<double>(soft.mesh.surface.size()) / 2;  // Euler
    };
    Result<catalog::SoftMesh> mesh = make_soft_mesh(entity, first);
    if (!mesh) return make_soft_mesh(entity, 0);
    // As many as cells across, squared.
    const int wanted = static_cast<int>(std::lround(first * std::sqrt(count / nodes_of(*mesh))));
    for (int across = std::clamp(wanted, 1, largest); across != first; across += across > first ? -1 : 1) {
        Result<catalog::SoftMesh> other = make_soft_mesh(entity, across);
        if (!other) continue;
        const auto misfit = [&](const catalog::SoftMesh& soft) { return std::fabs(std::log(nodes_of(soft) / count)); };
        return misfit(*other) < misfit(*mesh) ? std::move(other) : std::move(mesh);
    }
    return mesh;
}

// The surface of its tetrahedra as a soft thing.
Result<ThinForm> EntityMeshes::make_closed_form(const Entity& entity, int count) {
    const Result<catalog::SoftMesh> soft = make_soft_mesh_about(entity, count);
    if (!soft) return soft.error();
    const geometry::TetrahedralMesh& mesh = soft->mesh;
    attributes::SheetMesh sheet;
    constexpr auto none = ~std::uint32_t{0};
    std::vector<std::uint32_t> node_of(mesh.nodes.size(), none);
    for (auto triangle : mesh.surface) {
        for (std::uint32_t& corner : triangle) {
            std::uint32_t& node = node_of[corner];
            if (node == none) {
                node = static_cast<std::uint32_t>(sheet.nodes.size());
                sheet.nodes.push_back(mesh.nodes[corner]);
            }
            corner = node;
        }
        sheet.triangles.push_back(triangle);
    }
    if (!is_closed(physics::Cloth{.triangles = sheet.triangles}))
        return Error{"shape", "parts of it meet in edges only, so it cannot be blown up", "leave its pressure 0"};
    return ThinForm(std::move(sheet));
}

Result<ThinForm> EntityMeshes::make_thin_form(const Entity& entity, bool is_sheet, int count) {
    const auto of = [&](const auto& geometry) -> Result<ThinForm> {
        if (!is_sheet) {
            Result<LineForm> line = line_of(geometry, count);
            if (!line.ok()) return line.error();
            return ThinForm(std::move(line).value());
        }
        Result<attributes::SheetMesh> sheet = sheet_of(geometry, count);
        if (!sheet.ok()) return sheet.error();
        return ThinForm(std::move(sheet).value());
    };
    const auto* model = std::get_if<ModelReference>(&entity.geometry);
    if (!model) return of(std::get<physics::ShapeDefinition>(entity.geometry));
    const Result<const KnownModel*> known = models_.find(model->key);
    if (!known.ok()) return known.error();
    const Result<geometry::TriangleMesh> surface = models_.catalog()->mesh(known.value()->summary.id);
    if (!surface.ok()) return surface.error();
    return of(surface.value());
}

}  // namespace embody::scene
