// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace embody::attributes {

/// Number of letters to insert, drop or replace that turn `a` into `b`: Wagner and Fischer, 1974. Time grows with the
/// product of the lengths.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The word of `known` that `word` most likely stands for with a typing error; empty if none is similar.
std::string nearest_word(std::string_view word, const std::vector<std::string>& known);

}  // namespace embody::attributes
