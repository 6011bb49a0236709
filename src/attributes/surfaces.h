// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "attributes/taxonomy_data.h"
#include "foundation/result.h"
#include "physics/definitions/surface_pairs.h"

namespace embody::attributes {

/// Measured friction and restitution of two families of materials against each other.
struct SurfacePairData {
    std::string a, b;  ///< families
    Interval friction_static, friction_dynamic, restitution;
    std::string source;
};

/// Families of materials with the same friction, and the values of each pair of families:
/// data/taxonomy/material_pairs.json.
class Surfaces {
public:
    /// Every family's material must be one of `materials`, and in no other family; a pair occurs once in the file.
    /// Errors name file, row and field.
    static Result<Surfaces> load(const std::filesystem::path& file, const std::vector<MaterialData>& materials);

    /// 0 where the material is in no family: then the combine rules' fallbacks hold.
    [[nodiscard]] physics::SurfaceId surface_of(std::string_view material) const;
    /// Typical values of all pairs, for a world.
    [[nodiscard]] const physics::SurfacePairs& table() const { return table_; }
    [[nodiscard]] const std::vector<std::string>& families() const { return families_; }
    /// All pairs, as in the file.
    [[nodiscard]] const std::vector<SurfacePairData>& pairs() const { return pairs_; }
    /// The values of two materials; null where the table has none.
    [[nodiscard]] const SurfacePairData* pair(std::string_view material_a, std::string_view material_b) const;

private:
    Result<void> add_pair(SurfacePairData pair);

    std::vector<std::string> families_;  ///< surface 1 first
    std::map<std::string, physics::SurfaceId, std::less<>> by_material_;
    std::vector<SurfacePairData> pairs_;
    std::map<std::pair<physics::SurfaceId, physics::SurfaceId>, std::size_t> index_;  ///< lower surface first
    physics::SurfacePairs table_;
};

}  // namespace embody::attributes
