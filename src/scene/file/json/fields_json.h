// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "foundation/shared_optional.h"
#include "scene/document/field_list.h"
#include "scene/file/json/field_reader.h"
#include "scene/file/json/field_values.h"

namespace embody::scene {

// JSON of listed values (scene/document/field_list.h): their fields, and optional values, lists and listed types under
// a name or beside their owner's fields. A field does not compile if its type neither has a pair in field_values.h nor
// is made of types that have one.

template <class Value>
void check_value(FieldReader&, const Value&) {}

template <class Owner>
void write_fields(nlohmann::json& object, const Owner& owner);
template <class Owner>
void read_fields(FieldReader& reader, Owner& owner);

template <class Value>
requires Listed<Value> || ListedVariant<Value>
void write_value(nlohmann::json& object, const char* name, const Value& value) {
    write_fields(add_object(object, name), value);
}

/// Null for an empty optional.
template <class Value>
void write_value(nlohmann::json& object, const char* name, const std::optional<Value>& value) {
    if (value)
        write_value(object, name, *value);
    else
        write_null(object, name);
}

/// Null for an empty one.
template <class Value>
void write_value(nlohmann::json& object, const char* name, const SharedOptional<Value>& value) {
    if (value)
        write_value(object, name, *value);
    else
        write_null(object, name);
}

template <Listed Item>
void write_value(nlohmann::json& object, const char* name, const std::vector<Item>& items) {
    nlohmann::json& list = add_list(object, name);
    for (const Item& item : items) write_fields(append_object(list), item);
}

/// Checks a value whose fields were read, and its members whose fields are beside its own.
template <class Value>
void check_fields(FieldReader& reader, const Value& value) {
    if constexpr (ListedVariant<Value>) {
        std::visit([&reader](const auto& alternative) { check_fields(reader, alternative); }, value);
    } else {
        for_each_field<Value>([&](const auto& field) {
            if constexpr (std::remove_cvref_t<decltype(field)>::saved == Saved::beside)
                check_fields(reader, value.*field.member);
        });
        check_value(reader, value);
    }
}

/// Reads a whole object; a wrong field name is reported before errors of the object as a whole.
template <class Value>
void read_whole(FieldReader& reader, Value& value) {
    Value read = value;
    read_fields(reader, read);
    if (reader.finish()) check_fields(reader, read);
    if (reader.ok()) value = std::move(read);
}

template <class Value>
requires Listed<Value> || ListedVariant<Value>
void read_value(FieldReader& reader, const char* name, NumberRange, Value& value) {
    const nlohmann::json* field = reader.take(name);
    if (!field || !reader.ok()) return;
    FieldReader inner(*field, reader.path(name), reader.error());
    read_whole(inner, value);
}

template <class Value>
void read_value(FieldReader& reader, const char* name, NumberRange range, std::optional<Value>& value) {
    if (!reader.take(name) || !reader.ok()) return;
    Value read{};
    read_value(reader, name, range, read);
    if (reader.ok()) value = std::move(read);
}

/// Replaces the whole value; null takes it away.
template <class Value>
void read_value(FieldReader& reader, const char* name, NumberRange range, SharedOptional<Value>& value) {
    const nlohmann::json* field = reader.take(name);
    if (!field || !reader.ok()) return;
    if (is_null(*field)) return value.reset();
    Value read{};
    read_value(reader, name, range, read);
    if (reader.ok()) value = std::move(read);
}

/// Replaces the whole list.
template <Listed Item>
void read_value(FieldReader& reader, const char* name, NumberRange, std::vector<Item>& items) {
    std::vector<Item> read;
    if (read_items(reader, name, [&read](FieldReader& item) { read_whole(item, read.emplace_back()); }))
        items = std::move(read);
}

template <class Owner, class OneField>
void write_field(nlohmann::json& object, const OneField& field, const Owner& owner) {
    if constexpr (OneField::saved == Saved::beside)
        write_fields(object, owner.*field.member);
    else if constexpr (OneField::saved != Saved::never)
        write_value(object, field.name, owner.*field.member);
}

template <class Owner, class OneField>
void read_field(FieldReader& reader, const OneField& field, Owner& owner) {
    if constexpr (OneField::saved == Saved::needed) reader.need(field.name, field.meaning);
    if constexpr (OneField::saved == Saved::beside)
        read_fields(reader, owner.*field.member);
    else if constexpr (OneField::saved != Saved::never)
        read_value(reader, field.name, field.range, owner.*field.member);
}

/// Writes the fields of a scene file: those with default values are left out.
template <class Owner>
void write_fields(nlohmann::json& object, const Owner& owner) {
    if constexpr (ListedVariant<Owner>) {
        write_value(object, "type", std::string(alternatives_of<Owner>[owner.index()]));
        std::visit([&object](const auto& alternative) { write_fields(object, alternative); }, owner);
    } else {
        static const Owner plain{};
        for_each_field<Owner>([&](const auto& field) {
            if constexpr (std::remove_cvref_t<decltype(field)>::saved == Saved::when_set)
                if (are_same(owner.*field.member, plain.*field.member)) return;
            write_field(object, field, owner);
        });
    }
}

/// Writes the fields of a message about a change: removed values are written, too, as null or empty.
template <class Owner>
void write_all_fields(nlohmann::json& object, const Owner& owner) {
    for_each_field<Owner>([&](const auto& field) { write_field(object, field, owner); });
}

template <std::size_t... alternative, class Variant>
void set_alternative(Variant& value, std::size_t wanted, std::index_sequence<alternative...>) {
    ((alternative == wanted ? void(value.template emplace<alternative>()) : void()), ...);
}

/// Reads the fields that are there over those of `owner`. The word in "type" selects the alternative of a variant.
template <class Owner>
void read_fields(FieldReader& reader, Owner& owner) {
    if constexpr (ListedVariant<Owner>) {
        constexpr std::size_t count = std::variant_size_v<Owner>;
        static_assert(count == alternatives_of<Owner>.size(), "each alternative has a word of its own");
        std::size_t type = 0;
        if (!read_type(reader, alternatives_of<Owner>, type)) return;
        set_alternative(owner, type, std::make_index_sequence<count>());
        std::visit([&reader](auto& alternative) { read_fields(reader, alternative); }, owner);
    } else {
        static_assert(lists_all_members<Owner>(), "a member is in no list, or one is there twice");
        for_each_field<Owner>([&](const auto& field) { read_field(reader, field, owner); });
    }
}

}  // namespace embody::scene
