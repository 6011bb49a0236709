// SPDX-License-Identifier: MIT
#include <array>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/locations.h"
#include "cli/output.h"
#include "cli/scene_lookup.h"
#include "cli/zone_trace.h"
#include "scene/document/document_field.h"
#include "scene/simulation/recording.h"
#include "scene/simulation/simulation.h"

namespace embody::cli {
namespace {

/// Energy of the rigid bodies, over all steps (docs/physics/energy.md).
struct EnergySummary {
    std::optional<physics::Conserved> start;
    physics::Conserved end;
    std::array<double, static_cast<std::size_t>(physics::StepCause::count)> work{};  ///< J, by cause
    double unexplained = 0;                                                          ///< J
    double between_steps = 0;                        ///< energy that actions and commands add or take away, J
    double largest_gain = 0, largest_gain_time = 0;  ///< largest unexplained energy of one step, J, and its time, s

    void add(const physics::StepReport& report) {
        if (!report.account) return;
        const physics::StepAccount& account = *report.account;
        if (start) between_steps += account.before.energy() - end.energy();
        if (!start) start = account.before;
        end = account.after;
        for (std::size_t i = 0; i < work.size(); ++i) work[i] += account.entries[i].work;
        unexplained += account.unexplained_energy;
        if (account.unexplained_energy <= largest_gain) return;
        largest_gain = account.unexplained_energy;
        largest_gain_time = report.time;
    }
};

/// Results that are printed at the end.
struct Summary {
    std::uint64_t steps = 0;
    double simulated = 0, wall = 0;
    double slowest_ms = 0;
    std::uint32_t limits = 0;
    bool paused = false;
    std::size_t actions = 0;
    EnergySummary energy;
    std::vector<std::string> notes;  ///< at the start: what is not simulated as its entity's kind says
    std::set<scene::EntityIndex> waiting_taps;
    std::uint64_t zones_missing = 0;  ///< zones that are missing in the trace
};

/// The files that a run writes; null where not asked for.
struct Outputs {
    std::unique_ptr<scene::Recorder> recorder;
    std::unique_ptr<ZoneTrace> trace;
    std::uint64_t zones_missing = 0;

    Result<void> open(const SimulateArguments& arguments, const scene::Document& document,
                      const scene::Simulation& simulation) {
        if (!arguments.record.empty()) {
            auto created = scene::Recorder::create(arguments.record, document,
                                                   {arguments.rate, arguments.contacts, arguments.energy});
            if (!created) return created.error();
            recorder = std::move(*created);
            if (auto sampled = recorder->sample(simulation); !sampled) return sampled;
        }
        if (arguments.trace.empty()) return {};
        auto created = ZoneTrace::create(arguments.trace);
        if (!created) return created.error();
        trace = std::move(*created);
        return {};
    }
    Result<void> write_step(const scene::Simulation& simulation) {
        if (trace) {
            if (auto taken = trace->take(); !taken) return taken;
        }
        return recorder ? recorder->sample(simulation) : Result<void>{};
    }
    Result<void> finish() {
        if (trace) {
            const auto finished = trace->finish();
            if (!finished) return finished.error();
            zones_missing = *finished;
        }
        return recorder ? recorder->finish() : Result<void>{};
    }
};

nlohmann::json to_json(const EnergySummary& energy) {
    const auto sums = [](const physics::Conserved& conserved) {
        return nlohmann::json{{"kinetic", conserved.kinetic_energy}, {"potential", conserved.potential_energy}};
    };
    nlohmann::json work;
    for (std::size_t i = 0; i < energy.work.size(); ++i) {
        work[physics::name_of(static_cast<physics::StepCause>(i))] = energy.work[i];
    }
    return {{"start", sums(energy.start.value_or(physics::Conserved{}))},
            {"end", sums(energy.end)},
            {"work", work},
            {"between_steps", energy.between_steps},
            {"unexplained", energy.unexplained},
            {"largest_unexplained_gain", {{"joules", energy.largest_gain}, {"time", energy.largest_gain_time}}}};
}

nlohmann::json to_json(const Summary& summary, const scene::Simulation& simulation) {
    const physics::StepReport& report = simulation.world().last_report();
    const physics::Conserved sums = simulation.world().conserved();
    const scene::Activity activity = simulation.activity();
    nlohmann::json json{
        {"steps", summary.steps},
        {"simulated_seconds", summary.simulated},
        {"wall_seconds", summary.wall},
        {"average_ms", summary.steps > 0 ? 1000 * summary.wall / static_cast<double>(summary.steps) : 0},
        {"slowest_ms", summary.slowest_ms},
        {"things", activity.things},
        {"active", activity.active},
        {"wants_to_sleep", activity.wants_to_sleep},
        {"asleep", activity.asleep},
        {"points", activity.points},
        {"contacts", report.contacts},
        {"actions", summary.actions},
        {"paused", summary.paused},
        {"energy", sums.kinetic_energy + sums.potential_energy},
        {"limits", summary.limits},
        {"notes", summary.notes},
        {"trace_zones_missing", summary.zones_missing},
        {"state_hash", std::to_string(simulation.world().state_hash())}};
    if (summary.energy.start) json["energy_account"] = to_json(summary.energy);
    return json;
}

void print(const EnergySummary& energy) {
    if (!energy.start) return;
    const auto told = [](const physics::Conserved& sums) {
        return short_number(sums.energy()) + " J (kinetic " + short_number(sums.kinetic_energy) + ", potential " +
               short_number(sums.potential_energy) + ")";
    };
    print_line("energy of the rigid bodies: " + told(*energy.start) + " at the start, " + told(energy.end) +
               " at the end");
    std::string work;
    for (std::size_t i = 0; i < energy.work.size(); ++i) {
        if (energy.work[i] == 0) continue;
        work += (work.empty() ? "work, J: " : ", ") +
                std::string(physics::name_of(static_cast<physics::StepCause>(i))) + " " + short_number(energy.work[i]);
    }
    if (!work.empty()) print_line(work);
    if (energy.between_steps != 0) {
        print_line("given by actions between steps: " + short_number(energy.between_steps) + " J");
    }
    print_line("unexplained: " + short_number(energy.unexplained) + " J; largest gain in a step " +
               short_number(energy.largest_gain) + " J" +
               (energy.largest_gain > 0 ? " at " + short_number(energy.largest_gain_time) + " s" : std::string()));
}

void print(const Summary& summary, const scene::Simulation& simulation) {
    const physics::StepReport& report = simulation.world().last_report();
    print_text("{} steps, {:.3f} s simulated in {:.3f} s ({:.1f} times real time), slowest step {:.3f} ms\n",
               summary.steps, summary.simulated, summary.wall,
               summary.wall > 0 ? summary.simulated / summary.wall : 0.0, summary.slowest_ms);
    const scene::Activity activity = simulation.activity();
    print_text("{} of {} things active, {} want to sleep, {} asleep; {} contacts; {} actions carried out\n",
               activity.active, activity.things, activity.wants_to_sleep, activity.asleep, report.contacts,
               summary.actions);
    print(summary.energy);
    if (activity.points > 0) print_text("grains, drops and nodes of soft things: {}\n", activity.points);
    const auto reached = [&](physics::StepLimit limit) {
        return (summary.limits & static_cast<std::uint32_t>(limit)) != 0;
    };
    for (const std::string& note : summary.notes) print_line("note: " + note);
    if (summary.zones_missing > 0)
        print_text("note: {} zones are missing in the trace: steps had more of them than there is room for\n",
                   summary.zones_missing);
    using physics::StepLimit;
    if (reached(StepLimit::linear_speed_clamped)) print_line("note: a body was slowed to settings.max_linear_speed");
    if (reached(StepLimit::angular_speed_clamped)) print_line("note: a body was slowed to settings.max_angular_speed");
    if (reached(StepLimit::too_many_pairs))
        print_line("note: so many bodies overlap that some pairs are left out; place them apart");
    if (reached(StepLimit::not_finite_body_frozen))
        print_line("note: a body's state left the finite numbers; it was switched off where it last was");
    if (reached(StepLimit::not_finite_deformable_frozen))
        print_line("note: a soft thing's motion left the finite numbers; it was frozen where it was");
    if (reached(StepLimit::not_finite_fluid_frozen))
        print_line("note: a liquid's motion left the finite numbers; it was frozen where it was");
    if (reached(StepLimit::fluid_particles_lost))
        print_line("note: liquid flowed so far away that it was removed; a floor or walls keep it");
    for (const scene::EntityIndex index : summary.waiting_taps) {
        const scene::Entity* tap = simulation.definition(index);
        const std::string name = tap != nullptr ? tap->name : std::string();
        print_text("note: tap {} waited, as its liquid has as many drops as its particle_budget allows\n",
                   name.empty() ? "of entity " + std::to_string(index) : "\"" + name + "\"");
    }
    if (reached(StepLimit::impact_iterations_exhausted))
        print_line("note: an impact needed more iterations than allowed; a smaller settings.time_step helps");
    if (reached(StepLimit::deep_penetration))
        print_line("note: bodies overlapped deeply; place them apart or use a smaller settings.time_step");
    if (summary.paused) print_line("an action paused the scene before the time was over");
}

}  // namespace

int run_simulate(const SimulateArguments& arguments) {
    const auto document = find_scene(arguments.scene);
    if (!document) return report(document.error());
    auto catalog = open_catalog(arguments.database);
    if (!catalog) return report(catalog.error());
    auto simulation = scene::Simulation::create(*document, catalog->get());
    if (!simulation) return report(scene::in_place(arguments.scene, simulation.error()));

    // Ctrl+C ends the run; what was recorded before is written in whole lines.
    watch_interrupts();
    Outputs outputs;
    if (auto opened = outputs.open(arguments, *document, **simulation); !opened) return report(opened.error());

    Summary summary;
    summary.notes = (*simulation)->notes();
    const auto steps =
        static_cast<std::uint64_t>(std::llround(arguments.seconds / (*simulation)->world().settings().time_step));
    (*simulation)->world().keep_account(arguments.energy);
    ProgressBar bar("Simulating");
    const auto start = std::chrono::steady_clock::now();
    while (summary.steps < steps && !summary.paused && !interrupted()) {
        const physics::StepReport& step = (*simulation)->step();
        ++summary.steps;
        summary.slowest_ms = std::max(summary.slowest_ms, step.milliseconds);
        summary.limits |= step.limits;
        const std::vector<scene::EntityIndex> waiting = (*simulation)->waiting_taps();
        summary.waiting_taps.insert(waiting.begin(), waiting.end());
        summary.simulated = step.time;
        summary.energy.add(step);
        summary.actions += (*simulation)->fired().size();
        summary.paused = (*simulation)->pause_requested();
        if (auto written = outputs.write_step(**simulation); !written) return report(written.error());
        if (summary.steps % 30 == 0) bar.show(summary.steps, steps, short_number(summary.simulated) + " s");
    }
    summary.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    bar.finish();
    if (auto finished = outputs.finish(); !finished) return report(finished.error());
    summary.zones_missing = outputs.zones_missing;
    if (arguments.json)
        print_json(to_json(summary, **simulation));
    else
        print(summary, **simulation);
    if (!interrupted()) return exit_ok;
    print_error("embody: stopped at {} s of {} s\n", short_number(summary.simulated), short_number(arguments.seconds));
    return exit_failed;
}

}  // namespace embody::cli
