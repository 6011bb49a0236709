// SPDX-License-Identifier: MIT
#include "scene/simulation/recording.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>

namespace embody::scene {
namespace {

using nlohmann::json;

constexpr std::size_t bytes_held = std::size_t{1} << 20;

json to_json(Vec3 v) { return {v.x, v.y, v.z}; }
json to_json(Quat q) { return {q.x, q.y, q.z, q.w}; }

const char* state_name(const Simulation& simulation, EntityIndex entity) {
    if (!simulation.is_movable(entity)) return "static";
    switch (simulation.sleep_state(entity)) {
        case physics::SleepState::active:
            return "active";
        case physics::SleepState::wants_to_sleep:
            return "wants_to_sleep";
        case physics::SleepState::asleep:
            return "asleep";
    }
    return "active";
}

json points_json(const MovingPoints& points) {
    std::vector<Vec3> positions;
    points.read(positions);
    json numbers = json::array();
    for (const Vec3 p : positions)
        for (const double number : {p.x, p.y, p.z}) numbers.push_back(number);
    return numbers;
}

json entities_json(const Simulation& simulation) {
    const physics::World& world = simulation.world();
    json entities = json::array();
    for (const EntityIndex entity : simulation.entities()) {
        const physics::BodyHandle body = simulation.body(entity);
        const MovingPoints* points = simulation.points(entity);
        const Transform pose = simulation.pose(entity);
        entities.push_back(
            {{"index", entity},
             {"position", to_json(pose.position)},
             {"rotation", to_json(pose.rotation)},
             {"linear_velocity", to_json(points ? points->linear_velocity() : world.linear_velocity(body))},
             {"angular_velocity", to_json(points ? points->angular_velocity() : world.angular_velocity(body))},
             {"state", state_name(simulation, entity)}});
        if (points) entities.back()["points"] = points_json(*points);
    }
    return entities;
}

json contacts_json(const Simulation& simulation) {
    json contacts = json::array();
    for (const physics::ContactView& contact : simulation.world().contacts()) {
        contacts.push_back({{"a", simulation.entity(contact.a)},
                            {"b", simulation.entity(contact.b)},
                            {"position", to_json(contact.position)},
                            {"normal", to_json(contact.normal)},
                            {"separation", contact.separation},
                            {"impulse", to_json(contact.impulse)}});
    }
    return contacts;
}

}  // namespace

struct Recorder::State {
    int file = -1;
    std::filesystem::path path;
    RecordingOptions options;
    std::string held;  ///< whole lines not yet written
    std::uint64_t samples = 0;

    Result<void> write_held();
};

// A line is written together with its line end, so that a killed program leaves no half line.
Result<void> Recorder::State::write_held() {
    std::size_t written = 0;
    while (written < held.size()) {
        const ssize_t count = ::write(file, held.data() + written, held.size() - written);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) {
            const Error error{path.string(), std::string("cannot be written: ") + std::strerror(errno),
                              "free some space or choose another file"};
            held.clear();
            return error;
        }
        written += static_cast<std::size_t>(count);
    }
    held.clear();
    return {};
}

Recorder::Recorder() : state_(std::make_unique<State>()) {}

Recorder::~Recorder() {
    if (state_->file >= 0) ::close(state_->file);
}

Result<std::unique_ptr<Recorder>> Recorder::create(const std::filesystem::path& file, const Document& document,
                                                   const RecordingOptions& options) {
    if (!(options.rate > 0) || !std::isfinite(options.rate))
        return Error{"rate", "must be greater than 0 samples a second", {}};
    std::unique_ptr<Recorder> recorder(new Recorder);
    State& state = *recorder->state_;
    state.path = file;
    state.options = options;
    state.file = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (state.file < 0)
        return Error{file.string(), std::string("cannot be written: ") + std::strerror(errno),
                     "choose a file in a folder that exists and that you may write to"};
    json entities = json::array();
    for (const Entity& entity : document.entities) entities.push_back({{"index", entity.index}, {"name", entity.name}});
    const json header = {{"embody_recording", 1},
                         {"scene", document.title},
                         {"time_step", document.settings.time_step},
                         {"gravity", to_json(document.settings.gravity)},
                         {"rate", options.rate},
                         {"entities", std::move(entities)}};
    state.held = header.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
    if (auto written = state.write_held(); !written) return written.error();
    return recorder;
}

Result<void> Recorder::sample(const Simulation& simulation) {
    const physics::World& world = simulation.world();
    const physics::StepReport& report = world.last_report();
    // Due when the time has reached sample number `samples`, with a tolerance of half a step for rounding.
    const double slack = 0.5 * world.settings().time_step;
    if (report.time + slack < static_cast<double>(state_->samples) / state_->options.rate) return {};
    state_->samples = static_cast<std::uint64_t>((report.time + slack) * state_->options.rate) + 1;

    json line = {{"t", report.time}, {"step", report.step}, {"entities", entities_json(simulation)}};
    if (state_->options.contacts) line["contacts"] = contacts_json(simulation);
    if (state_->options.energy) {
        const physics::Conserved sums = world.conserved();
        line["energy"] = {{"kinetic", sums.kinetic_energy},
                          {"potential", sums.potential_energy},
                          {"total", sums.kinetic_energy + sums.potential_energy}};
        line["linear_momentum"] = to_json(sums.linear_momentum);
        line["angular_momentum"] = to_json(sums.angular_momentum);
    }
    state_->held += line.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
    return state_->held.size() >= bytes_held ? state_->write_held() : Result<void>{};
}

Result<void> Recorder::finish() {
    if (auto written = state_->write_held(); !written) return written;
    const int closed = ::close(state_->file);
    state_->file = -1;
    if (closed != 0) return Error{state_->path.string(), std::string("cannot be written: ") + std::strerror(errno), {}};
    return {};
}

}  // namespace embody::scene
