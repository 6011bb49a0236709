// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>

#include "server/library_fill.h"

namespace embody::cli {

/// "1 min left": a time for people, coarse where it is long. Empty for none.
std::string time_left_text(std::optional<double> seconds);

/// The filling of the library on standard error: one line that is redrawn on a terminal, elsewhere a line for each
/// tenth; at the end what came, what was left out, and what failed.
class FillLine {
public:
    void show(const server::FillProgress& progress);

private:
    void draw(const server::FillProgress& progress);
    void finish(const server::FillProgress& progress);
    void clear();

    std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
    std::size_t last_tenth_ = 0, told_notes_ = 0;
    bool drawn_ = false;
};

}  // namespace embody::cli
