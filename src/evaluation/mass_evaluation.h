// SPDX-License-Identifier: MIT
//
// Compares predicted masses with those of real objects.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "attributes/resolver.h"
#include "evaluation/measured_objects.h"

namespace embody::evaluation {

/// One object's prediction.
struct MassPrediction {
    MeasuredObject object;
    double mass = 0, low = 0, high = 0;      ///< kg; low to high is the 80 % interval
    std::string category;                    ///< subcategory, else category, of the answer
    std::string level;                       ///< level_name() of the category
    [[nodiscard]] double log_error() const;  ///< ln(predicted / real)
};

/// Over a set of objects, with m̂ predicted and m real.
struct MassFigures {
    std::size_t objects = 0;
    double alde = 0;      ///< mean |ln m̂/m| (absolute log difference error)
    double alde_low = 0;  ///< 95 % of bootstrap samples of the objects have an ALDE in this range
    double alde_high = 0;
    double bias = 0;             ///< mean ln m̂/m: above 0 is too heavy
    double mnre = 0;             ///< mean min(m̂/m, m/m̂) (minimum ratio error; higher is better)
    double within_factor_2 = 0;  ///< fraction
    double coverage_80 = 0;      ///< fraction of real masses inside the predicted 80 % interval
};

struct MassEvaluation {
    MassFigures all;
    std::map<std::string, MassFigures> by_source, by_level;
    std::vector<MassPrediction> predictions;  ///< worst first
    std::vector<std::string> without_mass;    ///< ids of objects whose answer has no mass (a liquid, a picture)
};

/// Whether the taxonomy may know the object's word. `unseen`: the category of the answer, with its subcategories and
/// all their words, is hidden, and the mass is predicted by the rest (other words of the name, WordNet's hypernyms).
enum class Words : std::uint8_t { known, unseen };

/// Predicts each object's mass from the facts that `told` allows, and compares. Deterministic.
MassEvaluation evaluate_mass(const attributes::Taxonomy& taxonomy, const std::vector<MeasuredObject>& objects,
                             Told told, Words words = Words::known);

}  // namespace embody::evaluation
