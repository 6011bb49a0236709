// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace embody {

/// Bad input, described so that a person can correct it: where it is, why it is wrong, what to do.
struct Error {
    std::string where;        ///< file, field or row, e.g. "scene.json: entities[3].attributes.mass"
    std::string why;          ///< e.g. "must be greater than 0 kg, got -2"
    std::string remedy = {};  ///< what the reader can do about it; empty where `why` says it already

    /// One line for people: "where: why (remedy)".
    [[nodiscard]] std::string message() const {
        std::string line = where.empty() ? why : where + ": " + why;
        if (!remedy.empty()) line += " (" + remedy + ")";
        return line;
    }
};

/// A value or the reason why there is none. No exception crosses a part's border; this does.
template <class T>
class [[nodiscard]] Result {
public:
    Result(T value) : held_(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : held_(std::in_place_index<1>, std::move(error)) {}

    [[nodiscard]] bool ok() const { return held_.index() == 0; }
    explicit operator bool() const { return ok(); }

    /// The value; only when ok().
    [[nodiscard]] T& value() & { return std::get<0>(held_); }
    [[nodiscard]] const T& value() const& { return std::get<0>(held_); }
    [[nodiscard]] T&& value() && { return std::get<0>(std::move(held_)); }
    T& operator*() & { return value(); }
    const T& operator*() const& { return value(); }
    T&& operator*() && { return std::move(*this).value(); }
    T* operator->() { return &value(); }
    const T* operator->() const { return &value(); }

    /// The reason; only when not ok().
    [[nodiscard]] const Error& error() const { return std::get<1>(held_); }

private:
    std::variant<T, Error> held_;
};

/// Success, or the reason why not.
template <>
class [[nodiscard]] Result<void> {
public:
    Result() = default;
    Result(Error error) : error_(std::move(error)) {}

    [[nodiscard]] bool ok() const { return !error_.has_value(); }
    explicit operator bool() const { return ok(); }
    [[nodiscard]] const Error& error() const { return *error_; }

private:
    std::optional<Error> error_;
};

}  // namespace embody
