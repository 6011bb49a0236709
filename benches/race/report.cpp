// SPDX-License-Identifier: MIT
#include "benches/race/report.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace embody::race {
namespace {

constexpr std::string_view own_name = "embody";

/// Embody's lap, if it took part.
const Lap* own_lap(const RaceResult& result) {
    const auto is_own = [](const Lap& lap) { return lap.engine == own_name; };
    const auto found = std::find_if(result.laps.begin(), result.laps.end(), is_own);
    return found == result.laps.end() ? nullptr : &*found;
}

/// Embody's time divided by the other engine's; below 1 Embody is faster.
std::string ratio(double own, double peer) { return fmt::format("{:.2f}", own / peer); }

std::string end_in_words(const EndState& end) {
    std::string words = end.wrong.empty() ? "right" : "WRONG: " + end.wrong;
    if (end.top_gap) words += fmt::format(", top {:+.1f} mm", *end.top_gap * 1e3);
    words += fmt::format(", overlap {:.1f} mm, {:.3g} J", std::max(end.overlap.bodies, end.overlap.statics) * 1e3,
                         end.kinetic_energy);
    if (end.asleep > 0) words += fmt::format(", {} asleep", end.asleep);
    return words;
}

void print_lap(const Lap& lap, const Lap* own) {
    const bool compare = own != nullptr && own != &lap;
    fmt::print("  {:<10} {:>9.4f} {:>9.4f} {:>9.4f} {:>9.4f} {:>7} {:>7}   {}\n", lap.engine, lap.mean_ms,
               lap.median_ms, lap.p99_ms, lap.max_ms, compare ? ratio(own->mean_ms, lap.mean_ms) : "",
               compare ? ratio(own->p99_ms, lap.p99_ms) : "", end_in_words(lap.end));
}

void print_stages(const Lap& lap) {
    double sum = 0;
    for (const StageTime& stage : lap.stages) sum += stage.milliseconds;
    if (sum <= 0) return;
    fmt::print("  stages of {}:", lap.engine);
    for (const StageTime& stage : lap.stages)
        fmt::print("  {} {:.4f} ({:.0f} %)", stage.name, stage.milliseconds, 100 * stage.milliseconds / sum);
    fmt::print("\n");
}

nlohmann::json lap_to_json(const Lap& lap, const Lap* own) {
    const EndState& end = lap.end;
    nlohmann::json stages = nlohmann::json::object();
    for (const StageTime& stage : lap.stages) stages[std::string(stage.name)] = stage.milliseconds;
    nlohmann::json json = {{"engine", lap.engine},
                           {"settings", lap.settings},
                           {"threads", lap.threads},
                           {"mean_ms", lap.mean_ms},
                           {"p50_ms", lap.median_ms},
                           {"p99_ms", lap.p99_ms},
                           {"max_ms", lap.max_ms},
                           {"stages_ms", std::move(stages)},
                           {"end",
                            {{"state", end.wrong.empty() ? "right" : end.wrong},
                             {"kinetic_energy", end.kinetic_energy},
                             {"potential_energy", end.potential_energy},
                             {"overlap_bodies", end.overlap.bodies},
                             {"overlap_statics", end.overlap.statics},
                             {"escaped", end.overlap.escaped},
                             {"asleep", end.asleep}}}};
    if (end.top_gap) json["end"]["top_gap"] = *end.top_gap;
    if (own != nullptr && own != &lap) {
        json["embody_over_mean"] = own->mean_ms / lap.mean_ms;
        json["embody_over_p99"] = own->p99_ms / lap.p99_ms;
    }
    return json;
}

}  // namespace

void print_race(const RaceResult& result, const RaceOptions& options, bool stages) {
    const RaceScene& scene = *result.scene;
    fmt::print("{}: {}\n", scene.name, scene.what);
    fmt::print("  {} bodies, {} steps, {} a step of the least of {} repeats, sleep {}\n", scene.bodies.size(),
               result.steps, options.setup.threads == 1 ? "CPU ms" : "wall ms", options.repeats,
               options.setup.sleep ? "on" : "off");
    fmt::print("  {:<10} {:>9} {:>9} {:>9} {:>9} {:>7} {:>7}   {}\n", "", "mean", "p50", "p99", "max", "embody/", "p99",
               "end state");
    const Lap* own = own_lap(result);
    for (const Lap& lap : result.laps) print_lap(lap, own);
    for (const Lap& lap : result.laps)
        if (options.setup.threads != lap.threads)
            fmt::print("  {} steps with {} of the {} threads\n", lap.engine, lap.threads, options.setup.threads);
    if (stages && own != nullptr) print_stages(*own);
    fmt::print("\n");
    std::fflush(stdout);
}

nlohmann::json to_json(const RaceResult& result) {
    const RaceScene& scene = *result.scene;
    nlohmann::json engines = nlohmann::json::array();
    for (const Lap& lap : result.laps) engines.push_back(lap_to_json(lap, own_lap(result)));
    return {{"scene", scene.name},
            {"what", scene.what},
            {"bodies", scene.bodies.size()},
            {"steps", result.steps},
            {"engines", std::move(engines)}};
}

bool embody_is_right(const RaceResult& result) {
    const Lap* own = own_lap(result);
    return own == nullptr || own->end.wrong.empty();
}

}  // namespace embody::race
