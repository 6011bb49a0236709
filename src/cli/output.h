// SPDX-License-Identifier: MIT
//
// The only file of the command line that writes to the terminal: nothing from a file, a database or a scene steers it,
// and what could not be written is remembered.
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

/// Puts `text` on the stream as it is. What standard output does not take is told by finish_output().
void write_text(std::FILE* stream, std::string_view text);

/// A part of a line: text as printable() has it, everything else as it is.
template <class Part>
auto printable_part(const Part& part) {
    if constexpr (std::is_convertible_v<const Part&, std::string_view>) {
        return printable(part);
    } else {
        return part;
    }
}

/// On standard output, as fmt::print does; line ends belong into `form`, those in `parts` are written out as "\n".
template <class... Parts>
void print_text(fmt::format_string<Parts...> form, Parts&&... parts) {
    write_text(stdout, fmt::vformat(form, fmt::make_format_args(printable_part(parts)...)));
}

/// The same on standard error.
template <class... Parts>
void print_error(fmt::format_string<Parts...> form, Parts&&... parts) {
    write_text(stderr, fmt::vformat(form, fmt::make_format_args(printable_part(parts)...)));
}

/// Says on standard error what failed, where, and what to do; returns exit_failed.
int report(const Error& error);

/// One JSON value on standard output.
void print_json(const nlohmann::json& value);

/// A line on standard output.
void print_line(std::string_view line);

/// To be called last: writes out what is buffered and returns the program's exit code. Where standard output did not
/// take everything, it says so and an exit_ok becomes exit_failed; a reader that has left (`| head`) is no news.
int finish_output(int exit_code);

/// Terminal column width of UTF-8 text, near enough for tables (one a code point).
std::size_t text_width(std::string_view text);
/// `text` as printable() has it, its end replaced by "…" where it is wider than `width` columns.
std::string shortened(std::string_view text, std::size_t width);
/// The same, filled with spaces to `width` columns.
std::string padded(std::string_view text, std::size_t width);

/// A number as people write it: six significant digits, no trailing zeros.
std::string short_number(double number);

/// A progress bar on standard error: redrawn in place on a terminal, a line every tenth elsewhere.
class ProgressBar {
public:
    explicit ProgressBar(std::string what) : what_(std::move(what)) {}
    void show(std::size_t done, std::size_t total, std::string_view now);
    /// Takes the bar off the terminal.
    void finish();

private:
    std::string what_;
    std::size_t last_tenth_ = 0;
    bool drawn_ = false;
};

}  // namespace embody::cli
