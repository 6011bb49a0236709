// SPDX-License-Identifier: MIT
// Kept forms and their packed numbers.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "foundation/base64.h"
#include "scene/file/json/field_values.h"

namespace embody::scene {

using nlohmann::json;

namespace {

static_assert(std::endian::native == std::endian::little, "packed numbers are little-endian");

constexpr std::size_t line_length = 120;  // characters of base64 on a line of a file
constexpr std::size_t fingerprint_length = 16;

}  // namespace

void write_value(json& object, const char* name, const PackedNumbers& numbers) {
    const std::vector<double>& values = numbers.values;
    std::string bytes(values.size() * sizeof(double), '\0');
    if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
    const std::string text = to_base64(bytes);
    json lines = json::array();
    for (std::size_t at = 0; at < text.size(); at += line_length) lines.push_back(text.substr(at, line_length));
    object[name] = std::move(lines);
}

void read_value(FieldReader& reader, const char* name, NumberRange, PackedNumbers& numbers) {
    const json* lines = reader.list(name);
    if (!lines) return;
    constexpr std::size_t max_length = (max_packed_numbers * sizeof(double) + 2) / 3 * 4;
    std::string text;
    for (std::size_t i = 0; i < lines->size(); ++i) {
        const json& line = (*lines)[i];
        if (!line.is_string())
            return reader.fail(element_path(reader.path(name), i),
                               std::string("must be a line of base64, got ") + json_kind(line));
        text += line.get_ref<const std::string&>();
        if (text.size() > max_length)
            return reader.refuse(name, "has more than " + std::to_string(max_packed_numbers) + " numbers");
    }
    const std::optional<std::string> bytes = from_base64(text);
    if (!bytes || bytes->size() % sizeof(double) != 0)
        return reader.refuse(name, "is not whole base64 of numbers of 8 bytes",
                             "take the field kept out: the thing then begins as modelled");
    std::vector<double> values(bytes->size() / sizeof(double));
    if (!values.empty()) std::memcpy(values.data(), bytes->data(), bytes->size());
    const auto wrong = std::ranges::find_if_not(values, [](double value) { return std::isfinite(value); });
    if (wrong != values.end())
        return reader.refuse(name, "has a number that is not finite, number " + std::to_string(wrong - values.begin()));
    numbers.values = std::move(values);
}

// What does not need the entity's mesh; the rest is EntityPoints::check_kept().
void check_value(FieldReader& reader, const KeptForm& kept) {
    if (!reader.ok()) return;
    const auto is_digit = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
    if (kept.fingerprint.size() != fingerprint_length || !std::ranges::all_of(kept.fingerprint, is_digit))
        return reader.refuse("fingerprint", "must be 16 hexadecimal digits, 0 … 9 and a … f");
    const std::vector<double>& places = kept.places.values;
    if ((places.empty() && kept.cell_size == 0) || places.size() % 3 != 0)
        return reader.refuse("places", "must be x, y and z of each point, of a liquid none too, got " +
                                           std::to_string(places.size()) + " numbers");
    if (std::ranges::any_of(places, [](double at) { return std::fabs(at) > max_kept_distance; }))
        return reader.refuse("places", "must be between -1e+06 and 1e+06 m");
    if (kept.plastic_strain.values.size() % numbers_per_strain != 0)
        return reader.refuse("plastic_strain", "must be five numbers each: xx, yy, xy, xz, yz");
    if (kept.bend.values.size() % numbers_per_bend != 0)
        return reader.refuse("bend",
                             "must be six numbers each: of a triangle xx, yy and √2 xy of friction, then of folds; of "
                             "a wire's node two each of three folds");
    if (kept.torn.size() % numbers_per_tear != 0)
        return reader.refuse("torn", "must be three numbers each: corner, node before, node");
    if (!std::ranges::is_sorted(kept.broken)) reader.refuse("broken", "must be ascending");
}

}  // namespace embody::scene
