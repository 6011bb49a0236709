// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>

#include "attributes/attribute.h"
#include "attributes/model_facts.h"
#include "catalog/catalog.h"
#include "foundation/result.h"
#include "scene/document/document.h"

namespace embody::scene {

/// A model of the catalogue with the data that entities need.
struct KnownModel {
    catalog::ModelSummary summary;
    attributes::ModelFacts facts;
    attributes::AttributeSet attributes;
};

/// The models of the catalogue that entities name, looked up once each.
class KnownModels {
public:
    /// `catalog` may be null, then no model is known; it outlives this.
    explicit KnownModels(catalog::Catalog* catalog) : catalog_(catalog) {}

    /// Valid until forget() is called for it.
    Result<const KnownModel*> find(const std::string& key);
    /// Summary of an entity's model; fails for an entity without a model.
    Result<catalog::ModelSummary> summary_of(const Entity& entity);
    void forget(const std::string& key) { models_.erase(key); }

    /// Null without a catalogue.
    [[nodiscard]] catalog::Catalog* catalog() const { return catalog_; }
    /// The catalogue's taxonomy; null without a catalogue.
    [[nodiscard]] const attributes::Taxonomy* taxonomy() const { return catalog_ ? &catalog_->taxonomy() : nullptr; }

private:
    catalog::Catalog* catalog_;
    std::map<std::string, KnownModel> models_;
};

}  // namespace embody::scene
