// SPDX-License-Identifier: MIT
#include "evaluation/measured_objects.h"

#include <charconv>
#include <cmath>

#include "evaluation/table_reader.h"

namespace embody::evaluation {
namespace {

constexpr ColumnNames columns = {"id",      "name",    "category", "dim_x_m",
                                 "dim_y_m", "dim_z_m", "mass_kg",  "mesh_volume_m3"};
constexpr std::size_t required_columns = 7;

Result<double> positive(const std::string& column, const std::string& cell) {
    double value = 0;
    const auto [end, problem] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (problem != std::errc() || end != cell.data() + cell.size() || !(value > 0) || !std::isfinite(value))
        return Error{column, "must be a positive number, got \"" + cell + "\""};
    return value;
}

Result<MeasuredObject> object_of(const TableRow& row) {
    MeasuredObject object{.id = row.cells[0], .name = row.cells[1], .category = row.cells[2]};
    double* const numbers[] = {&object.size.x, &object.size.y, &object.size.z, &object.mass};
    for (std::size_t i = 0; i < std::size(numbers); ++i) {
        const auto value = positive(columns[i + 3], row.cells[i + 3]);
        if (!value) return value.error();
        *numbers[i] = *value;
    }
    if (!row.cells[7].empty()) {
        const auto volume = positive(columns[7], row.cells[7]);
        if (!volume) return volume.error();
        object.mesh_volume = *volume;
    }
    return object;
}

}  // namespace

std::string MeasuredObject::source() const { return id.substr(0, id.find(':')); }

Result<std::vector<MeasuredObject>> read_measured_objects(const std::filesystem::path& file) {
    std::vector<MeasuredObject> objects;
    const auto read = read_table(file, columns, required_columns, [&](const TableRow& row) -> Result<void> {
        auto object = object_of(row);
        if (!object) return object.error();
        objects.push_back(std::move(*object));
        return {};
    });
    if (!read) return read.error();
    if (objects.empty()) return Error{file.string(), "holds no rows", "give a table of measured objects"};
    return objects;
}

attributes::ModelFacts facts_of(const MeasuredObject& object, Told told) {
    attributes::ModelFacts facts;
    std::vector<std::string> words = split_cell(object.category);
    if (told == Told::category) {
        if (!words.empty()) facts.name = words.front();
    } else {
        facts.name = object.name;
    }
    if (told != Told::name) facts.tags = std::move(words);
    facts.size_is_stated = true;
    facts.geometry.size = object.size;
    if (object.mesh_volume && told == Told::everything) {
        facts.geometry.closed = true;
        facts.geometry.volume = *object.mesh_volume;
        facts.geometry.volume_method = "stated with the measured object";
    }
    return facts;
}

}  // namespace embody::evaluation
