// SPDX-License-Identifier: MIT
#include "database/statement.h"

#include <sqlite3.h>

#include "database/connection.h"

namespace embody::database {
namespace {

sqlite3_stmt* native(void* compiled) { return static_cast<sqlite3_stmt*>(compiled); }

}  // namespace

Statement::Statement(Statement&& other) noexcept
    : connection_(other.connection_),
      command_(std::move(other.command_)),
      compiled_(std::exchange(other.compiled_, nullptr)),
      bound_(other.bound_),
      bind_error_(std::move(other.bind_error_)) {}

Statement::~Statement() {
    if (compiled_) connection_->recycle(std::move(command_), compiled_);
}

void Statement::note(int code) {
    if (code != SQLITE_OK && !bind_error_) bind_error_ = connection_->last_error();
}

Statement& Statement::bind(std::int64_t value) {
    note(sqlite3_bind_int64(native(compiled_), ++bound_, value));
    return *this;
}

Statement& Statement::bind(double value) {
    note(sqlite3_bind_double(native(compiled_), ++bound_, value));
    return *this;
}

Statement& Statement::bind(std::string_view text) {
    // A null pointer would bind NULL; empty text is text.
    const char* start = text.data() ? text.data() : "";
    note(sqlite3_bind_text64(native(compiled_), ++bound_, start, text.size(), SQLITE_TRANSIENT, SQLITE_UTF8));
    return *this;
}

Statement& Statement::bind(std::span<const std::uint8_t> bytes) {
    const void* start = bytes.data() ? static_cast<const void*>(bytes.data()) : "";
    note(sqlite3_bind_blob64(native(compiled_), ++bound_, start, bytes.size(), SQLITE_TRANSIENT));
    return *this;
}

Result<bool> Statement::step() {
    if (bind_error_) return *bind_error_;
    const int code = sqlite3_step(native(compiled_));
    if (code == SQLITE_ROW) return true;
    if (code == SQLITE_DONE) return false;
    return connection_->last_error();
}

Result<void> Statement::run() {
    while (true) {
        const Result<bool> row = step();
        if (!row) return row.error();
        if (!*row) return {};
    }
}

std::int64_t Statement::integer(int column) const { return sqlite3_column_int64(native(compiled_), column); }

double Statement::real(int column) const { return sqlite3_column_double(native(compiled_), column); }

std::string Statement::text(int column) const {
    const auto* start = reinterpret_cast<const char*>(sqlite3_column_text(native(compiled_), column));
    const int size = sqlite3_column_bytes(native(compiled_), column);
    return start ? std::string(start, static_cast<std::size_t>(size)) : std::string();
}

std::vector<std::uint8_t> Statement::bytes(int column) const {
    const auto* start = static_cast<const std::uint8_t*>(sqlite3_column_blob(native(compiled_), column));
    const int size = sqlite3_column_bytes(native(compiled_), column);
    return start ? std::vector<std::uint8_t>(start, start + size) : std::vector<std::uint8_t>();
}

}  // namespace embody::database
