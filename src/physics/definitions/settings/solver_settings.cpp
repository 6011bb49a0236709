// SPDX-License-Identifier: MIT
#include "physics/definitions/settings/solver_settings.h"

#include <cmath>
#include <type_traits>

#include "physics/definitions/field_check.h"

namespace embody::physics {

Result<void> validate(const SolverSettings& settings) {
    for (const SettingNumber& number : list_settings(settings)) {
        auto good = check_number("solver." + number.path, number.value, number.low, number.high, number.unit);
        if (!good) return good;
    }
    return {};
}

std::vector<SettingNumber> list_settings(const SolverSettings& settings) {
    std::vector<SettingNumber> numbers;
    for_each_setting(settings, [&numbers](const std::string& path, auto value, const auto& setting) {
        numbers.push_back({path, static_cast<double>(value), setting.low, setting.high, setting.unit,
                           std::is_integral_v<decltype(value)>});
    });
    return numbers;
}

Result<void> set_setting(SolverSettings& settings, std::string_view path, double value) {
    bool is_known = false;
    for_each_setting(settings, [&](const std::string& own, auto& place, const auto&) {
        if (own != path) return;
        using Number = std::remove_reference_t<decltype(place)>;
        place = static_cast<Number>(std::is_integral_v<Number> ? std::round(value) : value);
        is_known = true;
    });
    if (!is_known) return Error{std::string(path), "is no setting of the solvers", "list_settings() has them all"};
    return {};
}

}  // namespace embody::physics
