// SPDX-License-Identifier: MIT
#pragma once

#include "benches/race/engine.h"

namespace embody::race {

// One function for each engine's file in this folder; CMake compiles those whose engine it finds and defines
// EMBODY_RACE_….

Result<std::unique_ptr<RaceEngine>> make_bullet_engine(const RaceScene& scene, const EngineSetup& setup);
Result<std::unique_ptr<RaceEngine>> make_ode_engine(const RaceScene& scene, const EngineSetup& setup);
Result<std::unique_ptr<RaceEngine>> make_box3d_engine(const RaceScene& scene, const EngineSetup& setup);
Result<std::unique_ptr<RaceEngine>> make_jolt_engine(const RaceScene& scene, const EngineSetup& setup);
Result<std::unique_ptr<RaceEngine>> make_physx_pgs_engine(const RaceScene& scene, const EngineSetup& setup);
Result<std::unique_ptr<RaceEngine>> make_physx_tgs_engine(const RaceScene& scene, const EngineSetup& setup);

}  // namespace embody::race
