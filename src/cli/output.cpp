// SPDX-License-Identifier: MIT
#include "cli/output.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

#include "cli/arguments.h"

namespace embody::cli {

namespace {

/// errno of the first failed write to standard output; 0: everything was written.
int output_failure = 0;

}  // namespace

void write_text(std::FILE* stream, std::string_view text) {
    const std::size_t written = std::fwrite(text.data(), 1, text.size(), stream);
    if (written < text.size() && stream == stdout && output_failure == 0) output_failure = errno;
}

int finish_output(int exit_code) {
    if (std::fflush(stdout) != 0 && output_failure == 0) output_failure = errno;
    if (output_failure == 0) return exit_code;
    if (output_failure != EPIPE)
        report({"standard output", std::string("cannot be written: ") + std::strerror(output_failure),
                "free some space, or write to another file"});
    return exit_code == exit_ok ? int{exit_failed} : exit_code;
}

int report(const Error& error) {
    print_error("embody: {}\n", error.message());
    return exit_failed;
}

void print_json(const nlohmann::json& value) {
    // printable_lines() escapes what dump() does not, code points from U+007F on; its escapes are valid in JSON, too.
    write_text(stdout, printable_lines(value.dump(2, ' ', false, nlohmann::json::error_handler_t::replace)) + '\n');
}

void print_line(std::string_view line) { print_text("{}\n", line); }

std::size_t text_width(std::string_view text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
        return (static_cast<unsigned char>(c) & 0xC0) != 0x80;  // not a continuation byte of UTF-8
    }));
}

std::string shortened(std::string_view text, std::size_t width) {
    std::string line = printable(text);
    if (text_width(line) <= width) return line;
    // Removes whole code points from the end.
    while (!line.empty() && text_width(line) >= width) {
        while (!line.empty() && (static_cast<unsigned char>(line.back()) & 0xC0) == 0x80) line.pop_back();
        if (!line.empty()) line.pop_back();
    }
    return line + "…";
}

std::string padded(std::string_view text, std::size_t width) {
    std::string line = shortened(text, width);
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
        print_error("\r{} [{}] {}/{} {}", what_, bar, done, total, padded(now, 36));
        std::fflush(stderr);
        drawn_ = true;
        return;
    }
    const std::size_t tenth = 10 * done / total;
    if (tenth == last_tenth_) return;
    last_tenth_ = tenth;
    print_error("{} {}/{}\n", what_, done, total);
}

void ProgressBar::finish() {
    if (!drawn_) return;
    print_error("\r{:100}\r", "");
    drawn_ = false;
}

}  // namespace embody::cli
