// SPDX-License-Identifier: MIT
// What was recorded of the run: looking back, going on from there, marks and curves.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "scene/session/commands/commands.h"

namespace embody::scene {

using nlohmann::json;

namespace {

constexpr double min_rate = 0.05, max_rate = 4;
constexpr double longest_time = 1e9;  // s
constexpr std::uint32_t usual_samples = 1000, max_samples = 20'000;
constexpr std::size_t max_curves = 64;

Result<json> seek(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    double time = 0;
    if (reader.need("time", "simulated time to show, s")) reader.number("time", time, {0, longest_time});
    if (!reader.finish()) return *error;
    if (Result<void> shown = state.look_at(time); !shown.ok()) return shown.error();
    return json{{"time", state.shown_time()}, {"step", state.shown_step()}};
}

Result<json> branch(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    if (!reader.finish()) return *error;
    Result<std::vector<std::string>> notes = state.branch();
    if (!notes.ok()) return notes.error();
    return json{{"time", state.shown_time()}, {"notes", notes.value()}};
}

Result<json> set_rate(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    double rate = 1;
    if (reader.need("rate", "simulated seconds in one of the clock's"))
        reader.number("rate", rate, {min_rate, max_rate});
    if (!reader.finish()) return *error;
    state.past.rate = rate;
    state.tell(state.simulation_event());
    return json::object();
}

const char* kind_name(Mark::Kind kind) {
    switch (kind) {
        case Mark::Kind::contact:
            return "contact";
        case Mark::Kind::action:
            return "action";
        case Mark::Kind::rope:
            return "rope_broke";
        case Mark::Kind::tear:
            return "sheet_tore";
        case Mark::Kind::hand:
            return "hand";
        case Mark::Kind::branch:
            return "branch";
    }
    return "";
}

Result<json> marks(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    if (!reader.finish()) return *error;
    json list = json::array();
    for (const Mark& mark : state.past.marks.all()) {
        json told = {{"time", mark.time}, {"kind", kind_name(mark.kind)}};
        if (mark.a != 0) told["a"] = mark.a;
        if (mark.b != 0) told["b"] = mark.b;
        if (mark.kind == Mark::Kind::contact) told["impulse"] = mark.impulse;
        if (!mark.name.empty()) told["name"] = mark.name;
        list.push_back(std::move(told));
    }
    return json{{"marks", std::move(list)}, {"revision", state.past.marks.revision()}};
}

// Curves
// -----------------------------------------------------------------------------------------------------------------

enum class Quantity : std::uint8_t { height, x, z, speed, spin, kinetic_energy, momentum };
constexpr std::array<std::pair<const char*, const char*>, 7> quantities = {{{"height", "m"},
                                                                            {"x", "m"},
                                                                            {"z", "m"},
                                                                            {"speed", "m/s"},
                                                                            {"spin", "rad/s"},
                                                                            {"kinetic_energy", "J"},
                                                                            {"momentum", "kg m/s"}}};

struct Curve {
    EntityIndex index = 0;
    Quantity quantity = Quantity::height;
    json values = json::array();
};

/// What does not change in a run, of a thing that is in the world; points count as one mass.
struct Weight {
    Vec3 center;  ///< of mass, in the entity's frame, m
    double mass = 0;
    Mat3 inertia{};
    /// Points whose mean place counts: of a sheet that has torn those that it had when it was whole, so that the mean
    /// does not jump where it gets new ones.
    std::size_t points = std::numeric_limits<std::size_t>::max();
};

Weight weight_of(const SessionState& state, EntityIndex index) {
    const Simulation& simulation = *state.simulation;
    Weight weight;
    if (const auto known = state.past.torn.find(index); known != state.past.torn.end()) {
        for (const Past::Torn& torn : known->second)
            for (const physics::TornCorner& corner : torn.corners)
                weight.points = std::min<std::size_t>(weight.points, corner.node);
    }
    if (const MovingPoints* points = simulation.points(index)) {
        weight.mass = points->mass();
        return weight;
    }
    const physics::World& world = simulation.world();
    const physics::BodyHandle body = simulation.body(index);
    if (body.is_null() || !std::isfinite(world.mass(body))) return weight;
    weight.mass = world.mass(body);
    weight.inertia = world.inertia(body);
    weight.center = inverse_transform_point(simulation.pose(index), world.center_of_mass(body));
    return weight;
}

double value_of(Quantity quantity, const EntityMoment& was, const Weight& weight) {
    const EntityMotion& motion = was.motion;
    const double speed = length(motion.linear_velocity);
    if (quantity == Quantity::speed) return speed;
    if (quantity == Quantity::spin) return length(motion.angular_velocity);
    if (quantity == Quantity::momentum) return weight.mass * speed;
    if (quantity == Quantity::kinetic_energy) {
        const Vec3 spin = rotate_inverse(motion.pose.rotation, motion.angular_velocity);
        return (weight.mass * speed * speed + dot(spin, weight.inertia * spin)) / 2;
    }
    Vec3 center = transform_point(motion.pose, weight.center);
    if (was.points) {
        std::vector<Vec3> positions;
        was.points->read(positions);
        positions.resize(std::min(positions.size(), weight.points));
        center = {};
        for (const Vec3 p : positions) center += p / static_cast<double>(positions.size());
    }
    return quantity == Quantity::x ? center.x : quantity == Quantity::z ? center.z : center.y;
}

void read_curve(const json& item, const std::string& where, std::optional<Error>& error, std::vector<Curve>& curves) {
    FieldReader reader(item, where, error);
    Curve& curve = curves.emplace_back();
    std::string name;
    need_index(reader, "index", curve.index);
    need_text(reader, "quantity", "what to tell, such as \"speed\"", name);
    const auto found = std::ranges::find_if(quantities, [&](const auto& each) { return name == each.first; });
    if (found == quantities.end())
        reader.refuse("quantity", "is not known", "use height, x, z, speed, spin, kinetic_energy or momentum");
    else
        curve.quantity = static_cast<Quantity>(found - quantities.begin());
    reader.finish();
}

// At most as many samples as asked for, evenly, the first and the last among them.
std::vector<double> chosen_times(const Take& take, double from, double to, std::size_t most) {
    std::vector<double> times;
    for (const double time : take.times())
        if (time >= from && time <= to) times.push_back(time);
    if (times.size() <= most) return times;
    std::vector<double> chosen;
    for (std::size_t i = 0; i < most; ++i) chosen.push_back(times[i * (times.size() - 1) / (most - 1)]);
    return chosen;
}

Result<json> curves(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    double from = 0, to = longest_time;
    std::uint32_t samples = usual_samples;
    std::vector<Curve> asked;
    reader.number("from", from, {0, longest_time});
    reader.number("to", to, {0, longest_time});
    reader.whole("samples", samples, 2, max_samples);
    if (const json* list = reader.need("curves", "what to tell: [{index, quantity}…]");
        list && read_array(*list, "curves", error)) {
        if (list->size() > max_curves) reader.refuse("curves", "are more than 64", "ask for fewer");
        for (std::size_t i = 0; i < std::min(list->size(), max_curves); ++i)
            read_curve((*list)[i], element_path("curves", i), error, asked);
    }
    if (!reader.finish()) return *error;
    if (state.past.take.empty()) return Error{"time.curves", "nothing has been recorded yet", "play first"};

    std::set<EntityIndex> indices;
    std::map<EntityIndex, Weight> weights;
    for (const Curve& curve : asked)
        if (indices.insert(curve.index).second) weights[curve.index] = weight_of(state, curve.index);
    const std::vector<double> times = chosen_times(state.past.take, from, to, samples);
    for (const double time : times) {
        const Moment moment = state.past.take.at(time, &indices);
        for (Curve& curve : asked) {
            const auto was = std::ranges::find(moment.entities, curve.index,
                                               [](const EntityMoment& each) { return each.motion.entity; });
            // Null where it was not there.
            curve.values.push_back(was == moment.entities.end()
                                       ? json(nullptr)
                                       : json(value_of(curve.quantity, *was, weights[curve.index])));
        }
    }
    json told = json::array();
    for (Curve& curve : asked) {
        const auto& [name, unit] = quantities[static_cast<std::size_t>(curve.quantity)];
        told.push_back(
            {{"index", curve.index}, {"quantity", name}, {"unit", unit}, {"values", std::move(curve.values)}});
    }
    return json{{"times", times}, {"curves", std::move(told)}};
}

}  // namespace

std::span<const Command> time_commands() {
    static constexpr Command commands[] = {{"simulation.set_rate", set_rate, Need::run},
                                           {"time.seek", seek, Need::run},
                                           {"time.branch", branch, Need::run},
                                           {"time.marks", marks, Need::look},
                                           {"time.curves", curves, Need::look}};
    return commands;
}

}  // namespace embody::scene
