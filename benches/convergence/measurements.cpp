// SPDX-License-Identifier: MIT
#include "benches/convergence/measurements.h"

#include <algorithm>
#include <cmath>

namespace embody::convergence {

void run(physics::World& world, double seconds) {
    const long steps = std::lround(seconds / world.settings().time_step);
    for (long i = 0; i < steps; ++i) world.step();
}

double period_of(const std::vector<double>& signal, double time_step) {
    if (signal.empty()) return 0;
    const auto [lowest, highest] = std::minmax_element(signal.begin(), signal.end());
    const double middle = (*lowest + *highest) / 2;
    double first = 0, last = 0;
    int crossings = 0;
    for (std::size_t i = 1; i < signal.size(); ++i) {
        if (!(signal[i - 1] < middle && signal[i] >= middle)) continue;
        last = (static_cast<double>(i) + (middle - signal[i - 1]) / (signal[i] - signal[i - 1])) * time_step;
        if (crossings++ == 0) first = last;
    }
    return crossings > 1 ? (last - first) / (crossings - 1) : 0;
}

std::vector<double> record(physics::World& world, double seconds, const std::function<double()>& read) {
    std::vector<double> signal;
    const long steps = std::lround(seconds / world.settings().time_step);
    signal.reserve(static_cast<std::size_t>(steps));
    for (long i = 0; i < steps; ++i) {
        world.step();
        signal.push_back(read());
    }
    return signal;
}

}  // namespace embody::convergence
