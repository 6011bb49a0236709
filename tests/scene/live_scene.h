// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scene/session/session.h"
#include "scene/simulation/simulation.h"

namespace embody::scene::samples {

/// The entity that floor_and_box() puts on its floor.
inline constexpr EntityIndex thing = 2;

/// The simulation of a document, without a catalogue; null, and the test fails, where it is refused.
std::unique_ptr<Simulation> make(const Document& document);
void step(Simulation& simulation, int count);
/// Grains, particles or nodes of an entity; none where it is one body.
std::vector<Vec3> points_of(const Simulation& simulation, EntityIndex entity = thing);

/// A session without a catalogue, and commands that must not be refused.
class LiveSession : public testing::Test {
protected:
    void open(const Document& document);
    nlohmann::json run(const std::string& command, const nlohmann::json& params = nlohmann::json::object());
    EntityState state(EntityIndex index);

    std::unique_ptr<Session> session_;
};

}  // namespace embody::scene::samples
