// SPDX-License-Identifier: MIT
#include "benches/race/race.h"

#include <time.h>

#include <algorithm>
#include <limits>
#include <numeric>

namespace embody::race {
namespace {

// Short enough that slow changes of the machine's speed affect all engines, long enough that caches are warm for most
// of it.
constexpr int frames_in_block = 10;

double now_ms(clockid_t clock) {
    timespec now{};
    clock_gettime(clock, &now);
    return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

/// One engine in one repeat.
struct Runner {
    std::unique_ptr<RaceEngine> engine;
    RunWatch watch;
};

/// Results of an engine that are kept over the repeats.
struct Best {
    std::vector<double> frame_ms;                ///< the minimum over the repeats
    std::vector<std::vector<StageTime>> stages;  ///< the minimum of each stage, by frame
};

Result<Runner> start(const RaceScene& scene, const EngineKind& kind, const EngineSetup& setup) {
    auto engine = kind.make(scene, setup);
    if (!engine) return engine.error();
    for (const RaceBody& body : scene.bodies)
        if (auto added = (*engine)->add_body(body); !added) return added.error();
    return Runner{std::move(*engine), RunWatch(scene)};
}

Result<void> apply_events(const RaceScene& scene, int frame, Runner& runner) {
    for (const RaceEvent& event : scene.events) {
        if (event.frame != frame) continue;
        runner.watch.before_event(event, *runner.engine);
        if (!event.spawned) {
            runner.engine->set_velocity(event.body, event.velocity);
        } else if (auto added = runner.engine->add_body(*event.spawned); !added) {
            return added;
        }
    }
    return {};
}

void keep_least(std::vector<StageTime>& least, std::vector<StageTime> now) {
    if (least.empty()) {
        least = std::move(now);
        return;
    }
    for (std::size_t i = 0; i < least.size(); ++i)
        least[i].milliseconds = std::min(least[i].milliseconds, now[i].milliseconds);
}

/// Runs the frames `first` … `last`-1 of one engine.
Result<void> run_block(const RaceScene& scene, int first, int last, clockid_t clock, Runner& runner, Best& best) {
    for (int frame = first; frame < last; ++frame) {
        runner.watch.before_frame(frame, *runner.engine);
        if (auto applied = apply_events(scene, frame, runner); !applied) return applied;

        const double start_ms = now_ms(clock);
        runner.engine->step();
        const double took_ms = now_ms(clock) - start_ms;

        const auto i = static_cast<std::size_t>(frame);
        best.frame_ms[i] = std::min(best.frame_ms[i], took_ms);
        keep_least(best.stages[i], runner.engine->stages());
    }
    return {};
}

void summarise(const Best& best, Lap& lap) {
    std::vector<double> sorted = best.frame_ms;
    std::sort(sorted.begin(), sorted.end());
    const std::size_t count = sorted.size();
    lap.mean_ms = std::accumulate(sorted.begin(), sorted.end(), 0.0) / static_cast<double>(count);
    lap.median_ms = sorted[count / 2];
    lap.p99_ms = sorted[count * 99 / 100];
    lap.max_ms = sorted.back();

    // Stages: the mean over the frames.
    lap.stages = best.stages.front();
    for (std::size_t s = 0; s < lap.stages.size(); ++s) {
        double sum = 0;
        for (const auto& frame : best.stages) sum += frame[s].milliseconds;
        lap.stages[s].milliseconds = sum / static_cast<double>(count);
    }
}

}  // namespace

Result<RaceResult> race(const RaceScene& scene, const std::vector<EngineKind>& kinds, const RaceOptions& options) {
    RaceResult result{.scene = &scene, .steps = options.steps > 0 ? options.steps : scene.steps, .laps = {}};
    const auto frames = static_cast<std::size_t>(result.steps);
    const clockid_t clock = options.setup.threads == 1 ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC;
    std::vector<Best> best(kinds.size(), {std::vector<double>(frames, std::numeric_limits<double>::max()),
                                          std::vector<std::vector<StageTime>>(frames)});

    for (int repeat = 0; repeat < options.repeats; ++repeat) {
        std::vector<Runner> runners;
        for (const EngineKind& kind : kinds) {
            auto runner = start(scene, kind, options.setup);
            if (!runner) return Error{std::string(kind.name) + ", " + scene.name, runner.error().message()};
            runners.push_back(std::move(*runner));
        }
        for (int first = 0; first < result.steps; first += frames_in_block) {
            const int last = std::min(first + frames_in_block, result.steps);
            for (std::size_t i = 0; i < runners.size(); ++i)
                if (auto ran = run_block(scene, first, last, clock, runners[i], best[i]); !ran) return ran.error();
        }
        if (repeat + 1 < options.repeats) continue;
        for (std::size_t i = 0; i < runners.size(); ++i) {
            const RaceEngine& engine = *runners[i].engine;
            result.laps.push_back({.engine = std::string(kinds[i].name),
                                   .settings = engine.settings(),
                                   .threads = engine.threads(),
                                   .end = runners[i].watch.finish(engine)});
            summarise(best[i], result.laps.back());
        }
    }
    return result;
}

}  // namespace embody::race
