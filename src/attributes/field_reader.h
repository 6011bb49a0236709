// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "attributes/taxonomy_data.h"
#include "foundation/result.h"

namespace embody::attributes {

/// The JSON document of a file, read as parse_json() does; the error names the file, and the place where it is broken.
Result<nlohmann::json> read_json(const std::filesystem::path& file);

/// Reads the fields of one object of the taxonomy's files; remembers the first thing that is wrong and which fields
/// were asked for. A field that is missing keeps its value, unless it is required.
class FieldReader {
public:
    /// `where` names the object in errors, such as "furniture.json: categories[3]".
    FieldReader(const nlohmann::json& object, std::string where);

    void word(const char* field, std::string& value, bool required);
    void words(const char* field, std::vector<std::string>& value, bool required);
    void truth(const char* field, bool& value, bool required);
    void number(const char* field, double& value, std::pair<double, double> range, bool required);
    /// [low, typical, high], ascending.
    void interval(const char* field, Interval& value, std::pair<double, double> range, bool required);
    void size(const char* field, Vec3& value, bool required);
    /// [low, high], ascending.
    void range(const char* field, double& low, double& high, bool required);
    /// The list or object, null where it is missing or something is wrong.
    const nlohmann::json* list(const char* field, bool required);
    const nlohmann::json* object(const char* field, bool required);

    void fail(const std::string& field, const std::string& why);
    /// The first error; else the first field that nobody asked for.
    std::optional<Error> finish();

private:
    const nlohmann::json* find(const char* field, bool required);
    std::optional<std::vector<double>> numbers(const char* field, std::size_t count, std::pair<double, double> range,
                                               bool required);

    const nlohmann::json& object_;
    std::string where_;
    std::set<std::string, std::less<>> known_;
    std::optional<Error> error_;
};

}  // namespace embody::attributes
