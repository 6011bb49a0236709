// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <variant>

#include "attributes/number_range.h"

namespace embody::scene {

// The members of a plain value, listed once. All code that handles every member (file, messages, undo, comparison, the
// description of the format, the Studio's types, the tests of these) follows the list, and a member that is in no list
// does not compile.

/// When a scene file has the field.
enum class Saved : std::uint8_t {
    needed,    ///< always, and a file without it is refused
    always,    ///< always; a file that leaves it out means the default
    when_set,  ///< unless it has the default value
    beside,    ///< without a name of its own: the fields of its value are beside those of its owner
    never,     ///< of the machine or of a run, not of the scene
};

/// One member, with its name in files and messages.
template <class Owner, class Value, Saved when>
struct Field {
    static constexpr Saved saved = when;
    using Member = Value;

    const char* name;
    Value Owner::*member;
    const char* meaning;            ///< for people: a line of the format's description
    attributes::NumberRange range;  ///< of a number; of other values only the unit is used
};

using attributes::NumberRange;

template <class Owner, class Value>
constexpr Field<Owner, Value, Saved::needed> always_needed(const char* name, Value Owner::*member, const char* meaning,
                                                           NumberRange range = {}) {
    return {name, member, meaning, range};
}
template <class Owner, class Value>
constexpr Field<Owner, Value, Saved::always> always_saved(const char* name, Value Owner::*member, const char* meaning,
                                                          NumberRange range = {}) {
    return {name, member, meaning, range};
}
template <class Owner, class Value>
constexpr Field<Owner, Value, Saved::when_set> saved_when_set(const char* name, Value Owner::*member,
                                                              const char* meaning, NumberRange range = {}) {
    return {name, member, meaning, range};
}
template <class Owner, class Value>
constexpr Field<Owner, Value, Saved::beside> saved_beside(Value Owner::*member) {
    return {"", member, "", {}};
}
template <class Owner, class Value>
constexpr Field<Owner, Value, Saved::never> never_saved(const char* name, Value Owner::*member) {
    return {name, member, "", {}};
}

/// A tuple of all fields of `Owner`; declared beside each type that has one.
template <class Owner>
inline constexpr auto fields_of = std::tuple{};

/// The words of "type" for the alternatives of a variant, in its order; declared beside each variant that has them.
template <class Variant>
inline constexpr std::array<const char*, 0> alternatives_of{};

/// The `name` of each alternative, where the alternatives have one.
template <class... Alternatives>
constexpr std::array<const char*, sizeof...(Alternatives)> names_of(const std::variant<Alternatives...>*) {
    return {Alternatives::name...};
}

template <class Value>
concept Listed = std::tuple_size_v<std::remove_const_t<decltype(fields_of<Value>)>> >
0;
template <class Value>
concept ListedVariant = alternatives_of<Value>
.size() > 0;

/// Converts to a value of any type; only the number of values matters.
struct AnyValue {
    template <class Value>
    operator Value() const noexcept;
};

/// The number of members of an aggregate: the largest number of values that it can be made of.
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
    if (*one.name && std::string_view(one.name) == other.name) return true;
    if constexpr (std::is_same_v<decltype(one.member), decltype(other.member)>) return one.member == other.member;
    return false;
}

/// Whether the list has every member exactly once.
template <class Owner>
constexpr bool lists_all_members() {
    std::size_t same = 0;
    for_each_field<Owner>([&same](const auto& one) {
        for_each_field<Owner>([&](const auto& other) { same += are_of_one_member(one, other) ? 1 : 0; });
    });
    const std::size_t listed = std::tuple_size_v<std::remove_const_t<decltype(fields_of<Owner>)>>;
    return listed == count_members<Owner>() && same == listed;
}

template <class Value>
inline constexpr bool is_optional = false;
template <class Value>
inline constexpr bool is_optional<std::optional<Value>> = true;

/// Whether all saved fields of two values are equal.
template <class Value>
bool are_same(const Value& a, const Value& b) {
    if constexpr (Listed<Value>) {
        bool same = true;
        for_each_field<Value>([&](const auto& field) {
            if constexpr (std::remove_cvref_t<decltype(field)>::saved != Saved::never)
                same = same && are_same(a.*field.member, b.*field.member);
        });
        return same;
    } else if constexpr (is_optional<Value>) {
        return a.has_value() == b.has_value() && (!a || are_same(*a, *b));
    } else if constexpr (ListedVariant<Value>) {
        const auto is_as_in_b = [&b](const auto& one) {
            return are_same(one, std::get<std::remove_cvref_t<decltype(one)>>(b));
        };
        return a.index() == b.index() && std::visit(is_as_in_b, a);
    } else if constexpr (std::is_empty_v<Value>) {
        return true;
    } else {
        return a == b;
    }
}

}  // namespace embody::scene
