// SPDX-License-Identifier: MIT
#include "scene/live_scene.h"

#include "scene/file/scene_file.h"

namespace embody::scene::samples {

using nlohmann::json;

std::unique_ptr<Simulation> make(const Document& document) {
    auto made = Simulation::create(document, nullptr);
    if (!made.ok()) ADD_FAILURE() << made.error().message();
    return made.ok() ? std::move(made).value() : nullptr;
}

void step(Simulation& simulation, int count) {
    for (int i = 0; i < count; ++i) simulation.step();
}

std::vector<Vec3> points_of(const Simulation& simulation, EntityIndex entity) {
    std::vector<Vec3> points;
    if (const MovingPoints* its = simulation.points(entity)) its->read(points);
    return points;
}

void LiveSession::open(const Document& document) {
    session_ = Session::create(nullptr, {}).value();
    run("scene.load", {{"scene", document_to_json(document)}});
}

json LiveSession::run(const std::string& command, const json& params) {
    auto result = session_->execute(command, params);
    if (!result.ok()) ADD_FAILURE() << command << ": " << result.error().message();
    return result.ok() ? result.value() : json();
}

EntityState LiveSession::state(EntityIndex index) {
    std::vector<EntityState> states;
    session_->read_states(states);
    for (const EntityState& one : states)
        if (one.entity == index) return one;
    return {};
}

}  // namespace embody::scene::samples
