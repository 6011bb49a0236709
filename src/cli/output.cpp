// SPDX-License-Identifier: MIT
#include "cli/output.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "cli/arguments.h"

namespace embody::cli {

int report(const Error& error) {
    fmt::print(stderr, "embody: {}\n", error.message());
    return exit_failed;
}

void print_json(const nlohmann::json& value) {
    fmt::print("{}\n", value.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

void print_line(std::string_view line) { fmt::print("{}\n", line); }

std::size_t text_width(std::string_view text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
        return (static_cast<unsigned char>(c) & 0xC0) != 0x80;  // not a continuation byte of UTF-8
    }));
}

std::string padded(std::string_view text, std::size_t width) {
    std::string line(text);
    // Cut whole code points from the end, and say so.
    if (text_width(line) > width) {
        while (!line.empty() && text_width(line) >= width) {
            while (!line.empty() && (static_cast<unsigned char>(line.back()) & 0xC0) == 0x80) line.pop_back();
            if (!line.empty()) line.pop_back();
        }
        line += "…";
    }
    line.append(width - text_width(line), ' ');
    return line;
}

std::string short_number(double number) { return fmt::format("{:.6g}", number); }

void ProgressBar::show(std::size_t done, std::size_t total, std::string_view now) {
    if (total == 0) return;
    if (isatty(STDERR_FILENO) != 0) {
        constexpr std::size_t width = 30;
        const std::size_t full = width * std::min(done, total) / total;
        std::string bar(full, '#');
        bar.append(width - full, '.');
        fmt::print(stderr, "\r{} [{}] {}/{} {}", what_, bar, done, total, padded(now, 36));
        std::fflush(stderr);
        drawn_ = true;
        return;
    }
    const std::size_t tenth = 10 * done / total;
    if (tenth == last_tenth_) return;
    last_tenth_ = tenth;
    fmt::print(stderr, "{} {}/{}\n", what_, done, total);
}

void ProgressBar::finish() {
    if (!drawn_) return;
    fmt::print(stderr, "\r{:100}\r", "");
    drawn_ = false;
}

}  // namespace embody::cli
