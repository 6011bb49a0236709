// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <initializer_list>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "attributes/number_range.h"
#include "foundation/result.h"
#include "math/transform.h"

namespace embody::attributes {

/// Reads the fields of one JSON object strictly: the one reader of all JSON that people or programs write. Each
/// function takes the field out of the object if it is there and leaves the value unchanged if not; finish() refuses
/// fields that no call read, and names the nearest name that was read. The first error of all readers with the same
/// `error` is kept; after it nothing more is read. Errors name the path of the field and what is wrong with it.
class FieldReader {
public:
    /// `json` and `error` outlive the reader. `where` is the object's path, e.g. "entities[3].pose" or
    /// "furniture.json: categories[3]"; empty for the top.
    FieldReader(const nlohmann::json& json, std::string where, std::optional<Error>& error);
    /// A reader with an error of its own.
    FieldReader(const nlohmann::json& json, std::string where);
    FieldReader(const FieldReader&) = delete;
    FieldReader& operator=(const FieldReader&) = delete;

    /// The field's value, or null where it is missing.
    const nlohmann::json* take(const char* name);
    /// Like take(), but missing is an error that says what the field holds.
    const nlohmann::json* need(const char* name, const char* what);
    /// Refuses the object if one of these fields is missing.
    void require(std::initializer_list<const char*> names);

    bool number(const char* name, double& value, NumberRange range = any_number);
    bool number(const char* name, std::optional<double>& value, NumberRange range = any_number);
    bool whole(const char* name, std::uint32_t& value, std::uint32_t low = 0,
               std::uint32_t high = std::numeric_limits<std::uint32_t>::max());
    bool whole(const char* name, int& value, int low, int high);
    bool truth(const char* name, bool& value);
    bool text(const char* name, std::string& value);
    /// Text that is not empty.
    bool word(const char* name, std::string& value);
    bool words(const char* name, std::vector<std::string>& value);
    /// As many numbers as `values` has, all in the range.
    bool numbers(const char* name, std::span<double> values, NumberRange range = any_number);
    bool vector(const char* name, Vec3& value);
    bool vector(const char* name, std::optional<Vec3>& value);
    /// A quaternion [x, y, z, w], stored as written but not zero, or {"axis": [x, y, z], "degrees": number}.
    bool rotation(const char* name, Quat& value);
    /// {"position": …, "rotation": …}; both may be missing.
    bool transform(const char* name, Transform& value);
    /// The list or object; null where it is missing or something is wrong.
    const nlohmann::json* list(const char* name);
    const nlohmann::json* object(const char* name);
    /// The index of the word in `words`.
    bool choice(const char* name, std::size_t& value, std::span<const char* const> words);
    bool choice(const char* name, std::size_t& value, std::initializer_list<const char*> words) {
        return choice(name, value, std::span(words.begin(), words.size()));
    }

    /// Refuses fields that no call read. Returns whether there is no error so far.
    bool finish();

    [[nodiscard]] bool ok() const { return !error_.has_value(); }
    /// Keeps the first error.
    void fail(const std::string& where, std::string why, std::string remedy = {});
    /// Like fail(), at a field of this object.
    void refuse(std::string_view field, std::string why, std::string remedy = {});
    /// The path of a field of this object; of the object itself for an empty name.
    [[nodiscard]] std::string path(std::string_view field) const;
    [[nodiscard]] std::optional<Error>& error() { return error_; }

private:
    const nlohmann::json& json_;
    std::string where_;
    std::optional<Error> own_error_;
    std::optional<Error>& error_;
    std::vector<std::string> known_;
    bool is_object_;
};

/// Readers of elements of arrays and of single values. At an error each sets `error` with `where` and returns false.
bool read_number(const nlohmann::json& json, const std::string& where, double& value, std::optional<Error>& error,
                 NumberRange range = any_number);
bool read_vector(const nlohmann::json& json, const std::string& where, Vec3& value, std::optional<Error>& error);
bool read_array(const nlohmann::json& json, const std::string& where, std::optional<Error>& error);

/// "a number", "text", "true or false", "nothing (null)", "a list" or "an object".
const char* json_kind(const nlohmann::json& json);
/// `where` of element `i` of a list: "entities[3]".
std::string element_path(const std::string& list, std::size_t i);

}  // namespace embody::attributes
