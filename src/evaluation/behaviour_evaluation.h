// SPDX-License-Identifier: MIT
//
// Whether what the attributes say is what the simulator does: small scenes with one model each, measured.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "catalog/catalog.h"
#include "foundation/result.h"

namespace embody::evaluation {

/// A number that follows from attributes on paper, and the same measured in a simulation.
struct Compared {
    double expected = 0, measured = 0;
};

/// What one model did on a concrete floor.
struct Behaviour {
    std::string key, name, category;
    bool is_furniture = false;        ///< stands on the floor by its placement
    Compared mass;                    ///< attribute and body, kg
    double tilt = 0;                  ///< after five seconds at its usual pose, degrees
    double speed = 0;                 ///< then, m/s
    std::optional<Compared> slide;    ///< stopping distance of a push at 1 m/s, m; none where it tipped or rolled
    std::optional<Compared> rebound;  ///< restitution of a flat drop, from the height it came back to; likewise
};

struct BehaviourEvaluation {
    std::vector<Behaviour> models;
    std::vector<std::pair<std::string, Error>> failures;  ///< models that could not be simulated

    // How many were judged, and how many of them did otherwise than their attributes say.
    struct Verdict {
        std::size_t judged = 0;
        std::vector<const Behaviour*> wrong;
    };
    [[nodiscard]] Verdict masses() const;     ///< off by more than 1e-9 of it
    [[nodiscard]] Verdict resting() const;    ///< moving after five seconds, faster than 1 cm/s
    [[nodiscard]] Verdict furniture() const;  ///< leaning by more than 5 degrees
    [[nodiscard]] Verdict slides() const;     ///< off by more than 5 %
    [[nodiscard]] Verdict rebounds() const;   ///< off by more than 0.03
};

/// Simulates every moving model of the catalogue, at most `limit` of them (0: all). `progress` is told how many are
/// done of how many; it may be empty.
Result<BehaviourEvaluation> evaluate_behaviour(catalog::Catalog& catalog, std::size_t limit,
                                               const std::function<void(std::size_t, std::size_t)>& progress);

}  // namespace embody::evaluation
