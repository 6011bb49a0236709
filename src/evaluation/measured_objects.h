// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "attributes/model_facts.h"
#include "foundation/result.h"

namespace embody::evaluation {

/// A real object that somebody weighed.
struct MeasuredObject {
    std::string id;                     ///< "source:number"
    std::string name;                   ///< as a catalogue would call it
    std::string category;               ///< words, the most exact first, separated by ";"
    Vec3 size;                          ///< extents of its box, m
    std::optional<double> mesh_volume;  ///< inside its scanned surface, m³
    double mass = 0;                    ///< kg

    /// The part of the id before the colon.
    [[nodiscard]] std::string source() const;
};

/// Reads a table with the columns id, name, category, dim_x_m, dim_y_m, dim_z_m, mass_kg and optionally mesh_volume_m3.
/// Refuses numbers that are not positive, and a table without rows.
Result<std::vector<MeasuredObject>> read_measured_objects(const std::filesystem::path& file);

/// The facts of a row that the predictor sees: never its mass.
enum class Told : std::uint8_t { everything, name, category };

/// The row as the facts of a model: name, category words as tags, stated size, the mesh's volume as that of a closed
/// surface. With `Told::category` the name is the first category word.
attributes::ModelFacts facts_of(const MeasuredObject& object, Told told);

}  // namespace embody::evaluation
