// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "attributes/resolver.h"
#include "catalog/prepare/prepared_model.h"
#include "database/attribute_table.h"
#include "database/model_table.h"

namespace embody::catalog {

/// The entries that persons made, as attribute entries of the highest level; one that can no longer be read is left
/// out.
std::vector<attributes::AttributeEntry> manual_entries(const std::vector<database::ManualAttribute>& stored);

/// Puts into `facts` what the catalogue says about the item.
void apply_item(attributes::ModelFacts& facts, const ImportItem& item);
/// Puts into `row` the item's words; tags get the catalogue's category, so that it is found by it.
void apply_item(database::ModelRow& row, const ImportItem& item);

/// Resolves the automatic attributes from the facts, and takes category, subcategory and kind of `row` from them, with
/// the manual ones on top. Returns the facts that the database keeps.
database::ModelKnowledge describe(database::ModelRow& row, const attributes::ModelFacts& facts,
                                  const attributes::Taxonomy& taxonomy,
                                  const std::vector<attributes::AttributeEntry>& manual);
/// Only the second half, for a changed manual attribute.
void classify(database::ModelRow& row, const attributes::ModelFacts& facts, const attributes::AttributeSet& automatic,
              const std::vector<attributes::AttributeEntry>& manual);

/// Hash of all files that attributes are resolved with; another hash: all models are to be resolved again.
std::string taxonomy_hash(const std::filesystem::path& taxonomy_folder, const std::filesystem::path& user_folder = {});

}  // namespace embody::catalog
