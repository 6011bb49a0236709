// SPDX-License-Identifier: MIT
#include "scene/embody/known_models.h"

#include "scene/document/document_field.h"

namespace embody::scene {

Result<const KnownModel*> KnownModels::find(const std::string& key) {
    if (const auto found = models_.find(key); found != models_.end()) return &found->second;
    if (!catalog_) return Error{"model", "\"" + key + "\" is in no database: none is open", "open one with --database"};
    Result<catalog::ModelSummary> summary = catalog_->model(key);
    if (!summary.ok()) return Error{"model", summary.error().message(), "import it, or take another key"};
    Result<attributes::ModelFacts> facts = catalog_->facts(summary.value().id);
    if (!facts.ok()) return in_place("model", facts.error());
    Result<attributes::AttributeSet> set = catalog_->attributes(summary.value().id);
    if (!set.ok()) return in_place("model", set.error());
    KnownModel model{std::move(summary).value(), std::move(facts).value(), std::move(set).value()};
    return &models_.emplace(key, std::move(model)).first->second;
}

Result<catalog::ModelSummary> KnownModels::summary_of(const Entity& entity) {
    const auto* reference = std::get_if<ModelReference>(&entity.geometry);
    if (!reference) return Error{"model", "this entity is a primitive"};
    const Result<const KnownModel*> found = find(reference->key);
    if (!found.ok()) return found.error();
    return found.value()->summary;
}

}  // namespace embody::scene
