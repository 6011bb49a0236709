// SPDX-License-Identifier: MIT
#pragma once

#include "attributes/classify.h"

namespace embody::attributes {

/// The name of a liquid, powder, cloth or thread means the substance, but a model with this name shows its container or
/// one piece of it: "beer" is a fluid, a model of beer is a bottle; "cashew" is a granular material, a model of it is
/// one nut; a model of "thread" is the spool. Where the category names such an entry (`modelled_as`) and the facts are
/// those of a model (it has a size or a volume), the answer is that entry, and the source says so. A name that says
/// bulk ("spilled beer", "heap of flour"), or a stated size far beyond that of the entry, stays the substance itself.
Classification as_model(const Taxonomy::Data& data, const ModelFacts& facts, Classification what);

}  // namespace embody::attributes
