// SPDX-License-Identifier: MIT
//
// Compares attributes with the behaviour in the simulator: small scenes with one model each are measured.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "catalog/catalog.h"
#include "foundation/result.h"

namespace embody::evaluation {

/// A number computed from attributes, and the same number measured in a simulation.
struct Compared {
    double expected = 0, measured = 0;
};

/// Behaviour of one model on a concrete floor.
struct Behaviour {
    std::string key, name, category;
    bool is_furniture = false;        ///< stands on the floor by its placement
    Compared mass;                    ///< attribute and body, kg
    double tilt = 0;                  ///< after five seconds at its usual pose, degrees
    double speed = 0;                 ///< at the same time, m/s
    std::optional<Compared> slide;    ///< stopping distance of a push at 1 m/s, m; empty where it tipped or rolled
    std::optional<Compared> rebound;  ///< restitution of a flat drop, from the height of the rebound; empty as `slide`
};

struct BehaviourEvaluation {
    std::vector<Behaviour> models;
    std::vector<std::pair<std::string, Error>> failures;  ///< models that could not be simulated

    // Number of models that were judged, and those that did not behave as their attributes say.
    struct Verdict {
        std::size_t judged = 0;
        std::vector<const Behaviour*> wrong;
    };
    [[nodiscard]] Verdict masses() const;     ///< relative error above 1e-9
    [[nodiscard]] Verdict resting() const;    ///< faster than 1 cm/s after five seconds
    [[nodiscard]] Verdict furniture() const;  ///< leaning by more than 5 degrees
    [[nodiscard]] Verdict slides() const;     ///< relative error above 5 %
    [[nodiscard]] Verdict rebounds() const;   ///< error above 0.03
};

/// Simulates every moving model of the catalogue, at most `limit` of them (0: all). `progress` is called with the
/// number done and the number of all; it may be empty.
Result<BehaviourEvaluation> evaluate_behaviour(catalog::Catalog& catalog, std::size_t limit,
                                               const std::function<void(std::size_t, std::size_t)>& progress);

}  // namespace embody::evaluation
