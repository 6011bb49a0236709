// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "benches/race/scenes.h"
#include "foundation/result.h"

namespace embody::race {

/// Pose and velocity of a body, world axes, m, m/s, rad/s.
struct BodyState {
    Vec3 position;  ///< of the centre of mass
    Quat rotation;
    Vec3 velocity, angular_velocity;
};

struct EngineSetup {
    int threads = 1;
    bool sleep = false;
};

/// Time of one named part of a step.
struct StageTime {
    std::string_view name;
    double milliseconds = 0;
};

/// A scene in an engine. All engines run with their own default settings. Bodies are numbered in the order in which
/// they were added, the scene's own first. The scene outlives the engine.
class RaceEngine {
public:
    virtual ~RaceEngine() = default;
    RaceEngine(const RaceEngine&) = delete;
    RaceEngine& operator=(const RaceEngine&) = delete;

    /// Version of the engine, and the settings that determine cost and quality, as text.
    [[nodiscard]] virtual std::string settings() const = 0;
    /// Number of threads that it really uses; some engines or builds of them support only one.
    [[nodiscard]] virtual int threads() const = 0;

    virtual Result<void> add_body(const RaceBody& body) = 0;
    virtual void set_velocity(std::size_t body, Vec3 velocity) = 0;
    /// Advances by race_time_step; only this call is timed.
    virtual void step() = 0;

    [[nodiscard]] virtual BodyState state(std::size_t body) const = 0;
    [[nodiscard]] virtual int count_asleep() const = 0;
    /// Times of the parts of the last step, where the engine reports them.
    [[nodiscard]] virtual std::vector<StageTime> stages() const { return {}; }

protected:
    RaceEngine() = default;
};

/// A function that makes an engine with the scene's static bodies in it; race() adds the movable ones.
struct EngineKind {
    std::string_view name;
    Result<std::unique_ptr<RaceEngine>> (*make)(const RaceScene& scene, const EngineSetup& setup);
};

/// Embody first, then the other engines that were found by the build.
const std::vector<EngineKind>& engine_kinds();

Result<std::unique_ptr<RaceEngine>> make_embody_engine(const RaceScene& scene, const EngineSetup& setup);

}  // namespace embody::race
