// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "foundation/result.h"

namespace embody::database {

class Connection;

/// A compiled command, borrowed from its connection until it goes out of scope. Bind the values in order, then step
/// through the rows. A failed bind is reported by the next step().
class Statement {
public:
    Statement(Statement&& other) noexcept;
    Statement& operator=(Statement&&) = delete;
    ~Statement();

    // The next parameter's value. Text and bytes are copied.
    Statement& bind(std::int64_t value);
    Statement& bind(int value) { return bind(std::int64_t{value}); }
    /// 64-bit patterns such as hashes are stored in the signed integer of the same bits.
    Statement& bind(std::uint64_t bits) { return bind(static_cast<std::int64_t>(bits)); }
    Statement& bind(double value);
    Statement& bind(std::string_view text);
    Statement& bind(const char* text) { return bind(std::string_view(text)); }
    Statement& bind(std::span<const std::uint8_t> bytes);

    /// Goes to the next row; false where there is none.
    Result<bool> step();
    /// Runs a command whose rows, if any, are of no interest.
    Result<void> run();

    // Columns of the current row, counted from 0.
    [[nodiscard]] std::int64_t integer(int column) const;
    [[nodiscard]] std::uint64_t bits(int column) const { return static_cast<std::uint64_t>(integer(column)); }
    [[nodiscard]] double real(int column) const;
    [[nodiscard]] std::string text(int column) const;
    [[nodiscard]] std::vector<std::uint8_t> bytes(int column) const;

private:
    friend class Connection;
    Statement(Connection& connection, std::string command, void* compiled)
        : connection_(&connection), command_(std::move(command)), compiled_(compiled) {}
    void note(int code);

    Connection* connection_;
    std::string command_;
    void* compiled_;  ///< the library's statement; its type is seen in the .cpp only
    int bound_ = 0;
    std::optional<Error> bind_error_;
};

}  // namespace embody::database
