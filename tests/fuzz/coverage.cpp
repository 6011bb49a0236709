// SPDX-License-Identifier: MIT
// The counters of AFL (M. Zalewski): one byte for each pair of branches that follow each other, by a hash.
#include "coverage.h"

#include <array>
#include <bit>

namespace {

std::array<std::uint8_t, embody::fuzz::coverage_size> counters;
std::uintptr_t previous = 0;
bool called = false;

}  // namespace

extern "C" void __sanitizer_cov_trace_pc() {
    // Relative to this function, because the program is loaded at another address each time.
    const auto here = reinterpret_cast<std::uintptr_t>(__builtin_return_address(0)) -
                      reinterpret_cast<std::uintptr_t>(&__sanitizer_cov_trace_pc);
    const std::uintptr_t place = (here ^ (here >> 16)) & (embody::fuzz::coverage_size - 1);
    std::uint8_t& counter = counters[place ^ previous];
    if (counter != 255) ++counter;
    previous = place >> 1;
    called = true;
}

namespace embody::fuzz {

bool coverage_is_known() { return called; }

void forget_coverage() {
    counters.fill(0);
    previous = 0;
}

std::size_t add_coverage(std::uint8_t* seen) {
    std::size_t found = 0;
    for (std::size_t i = 0; i < coverage_size; ++i) {
        if (counters[i] == 0) continue;
        // One bit for 1, 2-3, 4-7 … 128-255 times.
        const auto bit = static_cast<std::uint8_t>(1u << (std::bit_width(static_cast<unsigned>(counters[i])) - 1));
        if ((seen[i] & bit) != 0) continue;
        seen[i] |= bit;
        ++found;
    }
    return found;
}

}  // namespace embody::fuzz
