// SPDX-License-Identifier: MIT
#include "cli/fill_line.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

#include "cli/output.h"

namespace embody::cli {
namespace {

/// Columns of a line that fits into most terminals.
constexpr std::size_t columns = 79;

}  // namespace

std::string time_left_text(std::optional<double> seconds) {
    if (!seconds) return {};
    if (*seconds < 10) return "a few seconds left";
    if (*seconds < 55) return fmt::format("{:.0f} s left", std::ceil(*seconds / 10) * 10);
    return fmt::format("{:.0f} min left", std::ceil(*seconds / 60));
}

void FillLine::show(const server::FillProgress& progress) {
    for (; told_notes_ < progress.notes.size(); ++told_notes_) {
        clear();
        print_error("embody: {}\n", progress.notes[told_notes_]);
    }
    if (progress.state == server::FillState::running && progress.done < progress.total) return draw(progress);
    if (progress.state != server::FillState::running) finish(progress);
}

void FillLine::draw(const server::FillProgress& progress) {
    std::string line = fmt::format("Filling the library: {} of {}", progress.done, progress.total);
    if (const std::string left = time_left_text(progress.seconds_left); !left.empty()) line += " · " + left;
    if (isatty(STDERR_FILENO) != 0) {
        if (!progress.file.empty()) line += " · " + progress.file;
        print_error("\r{}", padded(line, columns));
        std::fflush(stderr);
        drawn_ = true;
        return;
    }
    const std::size_t tenth = 10 * progress.done / progress.total;
    if (tenth == last_tenth_) return;
    last_tenth_ = tenth;
    print_error("{}\n", line);
}

void FillLine::finish(const server::FillProgress& progress) {
    clear();
    for (const catalog::ImportFailure& failure : progress.failures)
        print_error("embody: {}: {}\n", failure.path, failure.error.why);
    if (progress.shapeless > 0) print_error("{} light sources have no shape and were left out.\n", progress.shapeless);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
    if (progress.state == server::FillState::done) {
        print_error("The library is filled: {} new models in {:.0f} s.\n", progress.added, seconds);
    } else {
        print_error("Filling the library stopped; the next start goes on with it.\n");
    }
}

void FillLine::clear() {
    if (!drawn_) return;
    print_error("\r{:79}\r", "");
    drawn_ = false;
}

}  // namespace embody::cli
