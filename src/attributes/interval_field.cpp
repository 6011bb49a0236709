// SPDX-License-Identifier: MIT
#include "attributes/interval_field.h"

#include <array>

namespace embody::attributes {

bool read_interval(FieldReader& reader, const char* name, Interval& value, NumberRange range) {
    std::array<double, 3> read{};
    if (!reader.numbers(name, read, range)) return false;
    if (read[0] > read[1] || read[1] > read[2]) {
        reader.refuse(name, "must be [low, typical, high], ascending");
        return false;
    }
    value = {read[0], read[1], read[2]};
    return true;
}

}  // namespace embody::attributes
