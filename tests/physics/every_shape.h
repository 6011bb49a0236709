// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <utility>
#include <variant>

#include "physics/definitions/shape_definition.h"

namespace embody::physics {

/// Calls visit(shape) with one of each of the variant's alternatives that are no more than their lengths, so that a new
/// one is tried with those that are known.
template <class Variant, class Visit>
void for_each_shape_of_lengths(Visit&& visit) {
    const auto try_one = [&]<class Shape>(Shape shape) {
        if constexpr (HasLengths<Shape>) visit(shape);
    };
    [&]<std::size_t... I>(std::index_sequence<I...>) { (try_one(std::variant_alternative_t<I, Variant>{}), ...); }
    (std::make_index_sequence<std::variant_size_v<Variant>>{});
}

}  // namespace embody::physics
