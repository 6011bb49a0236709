// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "attributes/attribute.h"
#include "catalog/soft_mesh.h"
#include "foundation/result.h"
#include "scene/document/document.h"
#include "scene/embody/form_cache.h"
#include "scene/embody/known_models.h"

namespace embody::scene {

/// Simulation meshes of deformable things in the size of the model or primitive: made once for each. A returned pointer
/// is valid until the next call; the error says why the thing cannot be of that kind.
class EntityMeshes {
public:
    /// `models` outlives this. `forms` may have been filled by others before.
    EntityMeshes(KnownModels& models, std::shared_ptr<FormCache> forms) : models_(models), forms_(std::move(forms)) {}

    /// The tetrahedra of an entity of kind soft.
    Result<const catalog::SoftMesh*> soft_mesh(const Entity& entity, const attributes::AttributeSet& attributes);
    /// The sheet of an entity of kind cloth, with gas inside all of its surface; the line of one of kind rope.
    Result<const ThinForm*> thin_form(const Entity& entity, const attributes::AttributeSet& attributes);
    /// Forgets the meshes of a model.
    void forget(const std::string& key) {
        forms_->soft_meshes.erase(key_of_model(key));
        forms_->thin_forms.erase(key_of_model(key));
    }

private:
    Result<catalog::SoftMesh> make_soft_mesh(const Entity& entity, int resolution);
    Result<catalog::SoftMesh> make_soft_mesh_about(const Entity& entity, int count);
    Result<ThinForm> make_closed_form(const Entity& entity, int count);
    Result<ThinForm> make_thin_form(const Entity& entity, bool is_cloth, int count);

    KnownModels& models_;
    std::shared_ptr<FormCache> forms_;
};

}  // namespace embody::scene
