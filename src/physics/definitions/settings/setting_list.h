// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <tuple>
#include <type_traits>

namespace embody::physics {

// The settings of the solvers, listed once: validate() and the test that each of them is noticed
// (tests/validation/settings_test.cpp) follow the lists, and a member that is in no list does not compile.

/// One number that steers an algorithm, or a group of them.
template <class Owner, class Value>
struct Setting {
    const char* name;
    Value Owner::*member;
    double low = 0, high = 0;  ///< what validate() accepts; not for groups
    const char* unit = "";     ///< "" where it is a count or a ratio
};

/// A tuple of all settings of `Owner`; beside each struct of settings.
template <class Owner>
inline constexpr auto settings_of = std::tuple{};

template <class Owner>
inline constexpr std::size_t setting_count = std::tuple_size_v<std::remove_const_t<decltype(settings_of<Owner>)>>;

/// Calls `visit(path, number, setting)` for each number of `owner` and of its groups, in the order of the lists. `path`
/// is the setting's name after those of its groups: `joint.max_correction_speed`.
template <class Owner, class Visit>
void for_each_setting(Owner& owner, const Visit& visit, const std::string& group = "") {
    const auto visit_one = [&](const auto& setting) {
        auto& value = owner.*setting.member;
        if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(value)>>)
            visit(group + setting.name, value, setting);
        else
            for_each_setting(value, visit, group + setting.name + ".");
    };
    std::apply([&](const auto&... setting) { (visit_one(setting), ...); }, settings_of<std::remove_const_t<Owner>>);
}

/// Stands for a value of any type where only its number counts.
struct AnySetting {
    template <class Value>
    operator Value() const noexcept;
};

/// How many members an aggregate has: as many values as it can be made of.
template <class Aggregate, class... Values>
constexpr std::size_t member_count() {
    if constexpr (requires { Aggregate{Values{}..., AnySetting{}}; })
        return member_count<Aggregate, Values..., AnySetting>();
    else
        return sizeof...(Values);
}

}  // namespace embody::physics
