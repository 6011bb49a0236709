// SPDX-License-Identifier: MIT
//
// The only file of the command line that writes to the terminal: text from a file, a database or a scene cannot control
// the terminal, and a failed write is remembered.
#pragma once

#include <fmt/core.h>

#include <cstddef>
#include <cstdio>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <type_traits>

#include "foundation/printable.h"
#include "foundation/result.h"

namespace embody::cli {

/// Writes `text` unchanged to the stream. finish_output() reports what could not be written.
void write_text(std::FILE* stream, std::string_view text);

/// A part of a line: text is escaped by printable(), every other type stays as it is.
template <class Part>
auto printable_part(const Part& part) {
    if constexpr (std::is_convertible_v<const Part&, std::string_view>) {
        return printable(part);
    } else {
        return part;
    }
}

/// Prints to standard output, as fmt::print does; line ends belong into `form`, those in `parts` are escaped as "\n".
template <class... Parts>
void print_text(fmt::format_string<Parts...> form, Parts&&... parts) {
    write_text(stdout, fmt::vformat(form, fmt::make_format_args(printable_part(parts)...)));
}

/// The same for standard error.
template <class... Parts>
void print_error(fmt::format_string<Parts...> form, Parts&&... parts) {
    write_text(stderr, fmt::vformat(form, fmt::make_format_args(printable_part(parts)...)));
}

/// Prints to standard error what failed, where, and what to do; returns exit_failed.
int report(const Error& error);

/// Prints one JSON value to standard output.
void print_json(const nlohmann::json& value);

/// Prints a line to standard output.
void print_line(std::string_view line);

/// To be called last: flushes the output and returns the program's exit code. Where standard output failed, it says so
/// and an exit_ok becomes exit_failed; a reader that has closed the pipe (`| head`) is no failure.
int finish_output(int exit_code);

/// Columns of UTF-8 text on a terminal, counted as one for each code point: good enough for tables.
std::size_t text_width(std::string_view text);
/// `text` as escaped by printable(), its end replaced by "…" where it is wider than `width` columns.
std::string shortened(std::string_view text, std::size_t width);
/// The same, filled with spaces to `width` columns.
std::string padded(std::string_view text, std::size_t width);

/// A number with six significant digits and no trailing zeros.
std::string short_number(double number);

/// A progress bar on standard error: redrawn in place on a terminal; elsewhere a line for each tenth.
class ProgressBar {
public:
    explicit ProgressBar(std::string what) : what_(std::move(what)) {}
    void show(std::size_t done, std::size_t total, std::string_view now);
    /// Removes the bar from the terminal.
    void finish();

private:
    std::string what_;
    std::size_t last_tenth_ = 0;
    bool drawn_ = false;
};

}  // namespace embody::cli
