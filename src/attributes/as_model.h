// SPDX-License-Identifier: MIT
#pragma once

#include "attributes/classify.h"

namespace embody::attributes {

/// The word of a liquid, powder, cloth or thread means the stuff, but a model that is called so shows what the stuff
/// comes in, or one piece of it: "beer" is a fluid, a model of beer a bottle; "cashew" is a heap of grains, a model of
/// it one nut; of "thread" the spool. Where the category names such an entry (`modelled_as`) and the facts are those of
/// a model (it has a size or a volume), the answer is that entry, and the source says so. A name that says bulk
/// ("spilled beer", "heap of flour"), or a stated size far beyond that of the entry, stays the stuff itself.
Classification as_model(const Taxonomy::Data& data, const ModelFacts& facts, Classification what);

}  // namespace embody::attributes
