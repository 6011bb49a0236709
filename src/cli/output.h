// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "foundation/result.h"

namespace embody::cli {

/// Says on standard error what failed, where, and what to do; returns exit_failed.
int report(const Error& error);

/// One JSON value on standard output.
void print_json(const nlohmann::json& value);

/// A line on standard output.
void print_line(std::string_view line);

/// Terminal column width of UTF-8 text, near enough for tables (one a code point).
std::size_t text_width(std::string_view text);
/// `text` cut or filled with spaces to `width` columns.
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
