// SPDX-License-Identifier: MIT
#pragma once

#include "attributes/field_reader.h"
#include "attributes/taxonomy_data.h"

namespace embody::attributes {

/// Reads [low, typical, high], ascending and in the range; leaves the value where the field is missing or wrong.
bool read_interval(FieldReader& reader, const char* name, Interval& value, NumberRange range);

}  // namespace embody::attributes
