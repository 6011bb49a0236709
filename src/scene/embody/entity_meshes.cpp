// SPDX-License-Identifier: MIT
#include "scene/embody/entity_meshes.h"

#include "attributes/physical_kind.h"
#include "scene/embody/closed_sheet.h"
#include "scene/embody/shape_surface.h"
#include "scene/embody/soft_primitive.h"

namespace embody::scene {

namespace {

bool is_sheet(const attributes::AttributeSet& attributes) { return matter_of(attributes) == attributes::Matter::sheet; }

int count_of(const attributes::AttributeSet& attributes) {
    return static_cast<int>(is_sheet(attributes) ? attributes.number("cloth_nodes", 1000)
                                                 : attributes.number("rope_segments", 50));
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
    const bool has_gas = is_sheet(attributes) && attributes.number("inflation", 0) > 0;
    const std::string own =
        to_text(kind_of(attributes)) + ' ' + std::to_string(count_of(attributes)) + (has_gas ? " closed" : "");
    auto& forms = forms_->thin_forms[key];
    auto found = forms.find(own);
    if (!key.is_shared() || found == forms.end()) {
        Result<ThinForm> form = has_gas ? make_closed_form(entity, count_of(attributes))
                                        : make_thin_form(entity, is_sheet(attributes), count_of(attributes));
        if (has_gas && !form.ok()) form = make_thin_form(entity, true, count_of(attributes));
        found = forms.insert_or_assign(own, std::move(form)).first;
    }
    if (!found->second.ok()) return found->second.error();
    return &found->second.value();
}

// Of models and other shapes it is the surface of what fills them, which is closed whatever the model's mesh is like.
Result<ThinForm> EntityMeshes::make_closed_form(const Entity& entity, int count) {
    if (const auto* shape = std::get_if<physics::ShapeDefinition>(&entity.geometry)) {
        if (auto sheet = closed_sheet_of(*shape, count)) return ThinForm(std::move(*sheet));
    }
    const Result<catalog::SoftMesh> filling = make_soft_mesh(entity, 0);
    if (!filling.ok()) return filling.error();
    return ThinForm(closed_sheet_of(filling.value().mesh));
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
