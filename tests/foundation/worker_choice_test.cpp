// SPDX-License-Identifier: MIT
#include "foundation/worker_choice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>

#include "foundation/random.h"

namespace embody {
namespace {

// What steps of one scene take on a machine whose cores others use at times: seconds by the number of workers.
struct Machine {
    int max_workers = 2;
    double serial = 0, parallel = 1;  ///< parts of the work, s by one worker
    int busy_cores = 0;               ///< used by others

    // Workers with a core of their own share the parallel part; where one has none, all wait for it at each barrier, so
    // that the part takes longer than alone.
    [[nodiscard]] double seconds(int workers) const {
        const bool is_short_of_cores = workers + busy_cores > max_workers;
        const double slower = workers > 1 && is_short_of_cores ? 2.5 : 1;
        return serial + parallel / workers * slower;
    }
    [[nodiscard]] double without_core(int workers) const {
        return workers > 1 && workers + busy_cores > max_workers ? 0.3 : 0;
    }
};

// Seconds of `steps` steps by the choice, and by each number of workers alone.
struct Spent {
    double chosen = 0;
    std::array<double, 9> alone{};
};
Spent spend(WorkerChoice& choice, const Machine& machine, Random& random, int steps) {
    Spent spent;
    for (int step = 0; step < steps; ++step) {
        // Steps differ by some tenths, now and then by more.
        const double work = random.between(0.9, 1.2) * (random.unit() < 0.02 ? 2.5 : 1);
        const int workers = choice.workers();
        EXPECT_GE(workers, 1);
        EXPECT_LE(workers, machine.max_workers);
        spent.chosen += work * machine.seconds(workers);
        for (int each = 1; each <= machine.max_workers; ++each)
            spent.alone[static_cast<std::size_t>(each)] += work * machine.seconds(each);
        choice.note(work * machine.seconds(workers), machine.without_core(workers));
    }
    return spent;
}

TEST(WorkerChoice, ComesNearTheFastestNumberWhateverElseRuns) {
    // Random machines, on which others come and go every 3,000 steps.
    Random random(1);
    double excess = 0;
    constexpr int runs = 200, phases = 6;
    for (int run = 0; run < runs; ++run) {
        Machine machine{.max_workers = 2 + static_cast<int>(random.between(0, 3)), .serial = random.between(0, 0.6)};
        WorkerChoice choice(machine.max_workers);
        for (int phase = 0; phase < phases; ++phase) {
            machine.busy_cores = static_cast<int>(random.between(0, machine.max_workers + 1));
            const Spent spent = spend(choice, machine, random, 3000);
            const double best =
                *std::min_element(spent.alone.begin() + 1, spent.alone.begin() + 1 + machine.max_workers);
            // Trials, and the steps before the change was seen.
            excess += spent.chosen / best - 1;
            EXPECT_LT(spent.chosen, 1.2 * best) << "run " << run << ", phase " << phase << ", " << machine.max_workers
                                                << " workers at most, " << machine.busy_cores << " cores busy";
        }
    }
    RecordProperty("mean_excess", std::to_string(excess / (runs * phases)));
    EXPECT_LT(excess / (runs * phases), 0.03);
}

TEST(WorkerChoice, QuietTrialsCostLessThanAHundredth) {
    Random random(2);
    const Machine machine{.max_workers = 2, .serial = 0, .parallel = 1};
    WorkerChoice choice(2);
    const Spent spent = spend(choice, machine, random, 20000);
    EXPECT_LT(spent.chosen, 1.01 * spent.alone[2]);
}

TEST(WorkerChoice, OneWorkerIsOne) {
    WorkerChoice choice(1);
    for (int step = 0; step < 5000; ++step) {
        EXPECT_EQ(choice.workers(), 1);
        choice.note(1e-3, 0.5);
    }
}

}  // namespace
}  // namespace embody
