// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace embody::catalog {

/// Appends plain values in the machine's own byte order: both ends of the worker's pipe are one machine.
class ByteWriter {
public:
    template <class T>
    requires std::is_arithmetic_v<T>
    void number(T value) { raw({reinterpret_cast<const std::uint8_t*>(&value), sizeof value}); }
    /// The bytes without their count.
    void raw(std::span<const std::uint8_t> data) {
        // One by one: gcc 12 raises false alarms about insert() and resize() here at -O3.
        for (const std::uint8_t byte : data) bytes_.push_back(byte);
    }
    void block(std::span<const std::uint8_t> data) {
        number(static_cast<std::uint64_t>(data.size()));
        raw(data);
    }
    void text(std::string_view value) { block({reinterpret_cast<const std::uint8_t*>(value.data()), value.size()}); }

    std::vector<std::uint8_t> take() { return std::move(bytes_); }

private:
    std::vector<std::uint8_t> bytes_;
};

/// Reads what ByteWriter wrote, trusting nothing: past the end or over a limit, everything read from then on is zero or
/// empty and ok() is false. Check it once, at the end.
class ByteReader {
public:
    explicit ByteReader(std::span<const std::uint8_t> bytes) : left_(bytes) {}

    template <class T>
    requires std::is_arithmetic_v<T> T number() {
        T value{};
        if (left_.size() < sizeof value) {
            fail();
            return value;
        }
        std::memcpy(&value, left_.data(), sizeof value);
        left_ = left_.subspan(sizeof value);
        return value;
    }
    std::span<const std::uint8_t> block(std::size_t limit) {
        const auto size = number<std::uint64_t>();
        if (size > limit || size > left_.size()) {
            fail();
            return {};
        }
        const auto data = left_.first(static_cast<std::size_t>(size));
        left_ = left_.subspan(data.size());
        return data;
    }
    std::string text(std::size_t limit) {
        const auto data = block(limit);
        return {data.begin(), data.end()};
    }
    /// Number of elements that follow, each of at least `element_size` bytes.
    std::size_t count(std::size_t limit, std::size_t element_size) {
        const auto value = number<std::uint64_t>();
        if (value > limit || value > left_.size() / element_size) {
            fail();
            return 0;
        }
        return static_cast<std::size_t>(value);
    }
    /// For callers that find an impossible value.
    void fail() {
        ok_ = false;
        left_ = {};
    }
    /// Whether everything was there, and nothing is left over.
    [[nodiscard]] bool is_complete() const { return ok_ && left_.empty(); }

private:
    std::span<const std::uint8_t> left_;
    bool ok_ = true;
};

}  // namespace embody::catalog
