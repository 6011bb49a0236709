// SPDX-License-Identifier: MIT
#pragma once

#include "attributes/field_reader.h"
#include "attributes/nearest_word.h"

namespace embody::scene {

// Documents and commands use the reader of all JSON.
using attributes::any_number;
using attributes::element_path;
using attributes::FieldReader;
using attributes::json_kind;
using attributes::nearest_word;
using attributes::not_negative;
using attributes::NumberRange;
using attributes::positive;
using attributes::read_array;
using attributes::read_number;
using attributes::read_vector;

}  // namespace embody::scene
