// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>
#include <tuple>
#include <type_traits>

namespace embody::scene {

// The members of a plain value, listed once. What goes over all of them (file, messages, undo, the tests of these)
// follows the list, and a member that is in no list does not compile.

/// When a scene file has the field.
enum class Saved : std::uint8_t {
    always,
    when_set,  ///< unless it is as it would be anyway
    never,     ///< of the machine or of a run, not of the scene
};

/// The valid range of a number, as scene files refuse it; open where infinite.
struct FieldRange {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
};

/// One member, under the name that files and messages give it.
template <class Owner, class Value, Saved when>
struct Field {
    static constexpr Saved saved = when;
    using Member = Value;

    const char* name;
    Value Owner::*member;
    FieldRange range;
};

template <class Owner, class Value>
constexpr Field<Owner, Value, Saved::always> always_saved(const char* name, Value Owner::*member,
                                                          FieldRange range = {}) {
    return {name, member, range};
}
template <class Owner, class Value>
constexpr Field<Owner, Value, Saved::when_set> saved_when_set(const char* name, Value Owner::*member,
                                                              FieldRange range = {}) {
    return {name, member, range};
}
template <class Owner, class Value>
constexpr Field<Owner, Value, Saved::never> never_saved(const char* name, Value Owner::*member) {
    return {name, member, {}};
}

/// A tuple of all fields of `Owner`; beside each type that has one.
template <class Owner>
inline constexpr auto fields_of = std::tuple{};

/// Stands for a value of any type where only its number counts.
struct AnyValue {
    template <class Value>
    operator Value() const noexcept;
};

/// How many members an aggregate has: as many values as it can be made of.
template <class Aggregate, class... Values>
constexpr std::size_t count_members() {
    if constexpr (requires { Aggregate{Values{}..., AnyValue{}}; })
        return count_members<Aggregate, Values..., AnyValue>();
    else
        return sizeof...(Values);
}

/// Calls `visit(field)` for each field in turn.
template <class Owner, class Visit>
constexpr void for_each_field(Visit&& visit) {
    std::apply([&visit](const auto&... field) { (visit(field), ...); }, fields_of<Owner>);
}

template <class One, class Other>
constexpr bool are_of_one_member(const One& one, const Other& other) {
    if (std::string_view(one.name) == other.name) return true;
    if constexpr (std::is_same_v<decltype(one.member), decltype(other.member)>) return one.member == other.member;
    return false;
}

/// Whether the list has every member, and each once.
template <class Owner>
constexpr bool lists_all_members() {
    std::size_t same = 0;
    for_each_field<Owner>([&same](const auto& one) {
        for_each_field<Owner>([&](const auto& other) { same += are_of_one_member(one, other) ? 1 : 0; });
    });
    const std::size_t listed = std::tuple_size_v<std::remove_const_t<decltype(fields_of<Owner>)>>;
    return listed == count_members<Owner>() && same == listed;
}

}  // namespace embody::scene
