// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <utility>

namespace embody {

/// A value or none, like std::optional, that never changes and that all copies have in common: for values of many bytes
/// in owners that are copied often.
template <class T>
class SharedOptional {
public:
    SharedOptional() = default;
    SharedOptional(std::nullopt_t) {}
    SharedOptional(T value) : value_(std::make_shared<const T>(std::move(value))) {}

    void reset() { value_.reset(); }
    [[nodiscard]] bool has_value() const { return value_ != nullptr; }
    explicit operator bool() const { return has_value(); }
    const T& operator*() const { return *value_; }
    const T* operator->() const { return value_.get(); }
    /// Whether both are one value in memory, or none.
    [[nodiscard]] bool is_copy_of(const SharedOptional& other) const { return value_ == other.value_; }

    friend bool operator==(const SharedOptional& a, const SharedOptional& b) {
        return a.is_copy_of(b) || (a && b && *a == *b);
    }

private:
    std::shared_ptr<const T> value_;
};

}  // namespace embody
