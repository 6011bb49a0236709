// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "math/mat3.h"
#include "math/vec3.h"

namespace embody::attributes {

/// Number (in the entry's unit), word (a choice, a name), yes or no, vector (m or kg m²) or symmetric tensor (kg m²).
using AttributeValue = std::variant<double, std::string, bool, Vec3, Mat3>;

/// How specific the origin of a value is. A higher level overrides a lower one; the machine never overrides `manual`.
enum class AttributeLevel : std::uint8_t { standard, kind, category, subcategory, model, measured, manual };

/// "default", "kind", "category", "subcategory", "model", "measured" or "manual".
const char* level_name(AttributeLevel level);
std::optional<AttributeLevel> level_from_name(std::string_view name);

/// The paper's Attr_Entry = {attr_name, attr_kind, attr_value} (definition 5), with unit, interval, source and level.
struct AttributeEntry {
    std::string name;  ///< a name of the registry
    AttributeValue value;
    std::optional<double> low, high;  ///< 80 % interval of a number, where one is known
    std::string source;               ///< why we think so, in words a user reads; names the literature that it is from
    AttributeLevel level = AttributeLevel::standard;
};

/// The paper's PhyAttr (definition 4): at most one entry a name, in the registry's order.
class AttributeSet {
public:
    [[nodiscard]] const std::vector<AttributeEntry>& entries() const { return entries_; }
    [[nodiscard]] const AttributeEntry* find(std::string_view name) const;
    /// Puts the entry in unless one of a higher level is there already; returns whether it is in.
    bool put(AttributeEntry entry);
    /// Takes the entry out whatever its level.
    void erase(std::string_view name);

    /// The value as a number, word or truth, or the fallback where the entry is missing or of another type.
    [[nodiscard]] double number(std::string_view name, double fallback) const;
    [[nodiscard]] std::string word(std::string_view name, std::string_view fallback) const;
    [[nodiscard]] bool truth(std::string_view name, bool fallback) const;

private:
    std::vector<AttributeEntry> entries_;
};

}  // namespace embody::attributes
