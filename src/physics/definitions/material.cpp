// SPDX-License-Identifier: MIT
#include "physics/definitions/material.h"

#include <algorithm>
#include <cmath>

#include "physics/definitions/field_check.h"

namespace embody::physics {

namespace {

Result<void> check_rule(const char* field, CombineRule rule) {
    if (rule < CombineRule::pair_table || rule > CombineRule::multiply) return Error{field, "is not a combine rule"};
    return {};
}

double combine(CombineRule rule, double a, double b) {
    switch (rule) {
        case CombineRule::pair_table:  // replaced before by the rule that stands in for it
        case CombineRule::own:         // likewise; here both bodies have this rule
        case CombineRule::geometric_mean:
            return std::sqrt(a * b);
        case CombineRule::average:
            return (a + b) / 2;
        case CombineRule::minimum:
            return std::min(a, b);
        case CombineRule::maximum:
            return std::max(a, b);
        case CombineRule::multiply:
            return a * b;
    }
    return 0;
}

/// A coefficient of each body with the body's own rule.
struct Side {
    CombineRule rule;
    double value;
};

double combine(CombineRule rule, Side a, Side b) {
    const bool only_one = (a.rule == CombineRule::own) != (b.rule == CombineRule::own);
    if (rule == CombineRule::own && only_one) return a.rule == CombineRule::own ? a.value : b.value;
    return combine(rule, a.value, b.value);
}

}  // namespace

Result<void> validate(const Material& material) {
    auto result =
        first_error(check_number("friction_static", material.friction_static, 0, 2),
                    check_number("friction_dynamic", material.friction_dynamic, 0, 2),
                    check_number("friction_rolling", material.friction_rolling, 0, 0.05, "m"),
                    check_number("friction_rolling_on_others", material.friction_rolling_on_others, 0, 0.05, "m"),
                    check_number("friction_torsional", material.friction_torsional, 0, 0.1, "m"),
                    check_number("restitution", material.restitution, 0, 1),
                    check_number("restitution_threshold", material.restitution_threshold, 0, 10, "m/s"),
                    check_rule("friction_combine", material.friction_combine),
                    check_rule("restitution_combine", material.restitution_combine));
    if (!result) return result;
    if (material.friction_static < material.friction_dynamic) {
        return Error{"friction_static", "must not be less than friction_dynamic"};
    }
    return {};
}

Material combine(const Material& a, const Material& b, const SurfacePairs& pairs) {
    Material pair;
    pair.friction_combine = std::max(a.friction_combine, b.friction_combine);
    pair.restitution_combine = std::max(a.restitution_combine, b.restitution_combine);
    const PairCoefficients* known = pairs.find(a.surface, b.surface);

    // Friction: from the table where both bodies ask for the table, else by rule.
    const bool by_table = pair.friction_combine == CombineRule::pair_table;
    const CombineRule friction = by_table ? CombineRule::geometric_mean : pair.friction_combine;
    const auto friction_impulse = [&](double of_a, double of_b) {
        return combine(friction, Side{a.friction_combine, of_a}, Side{b.friction_combine, of_b});
    };
    pair.friction_static = friction_impulse(a.friction_static, b.friction_static);
    pair.friction_dynamic = friction_impulse(a.friction_dynamic, b.friction_dynamic);
    if (by_table && known != nullptr) {
        pair.friction_static = known->friction_static;
        pair.friction_dynamic = known->friction_dynamic;
    }

    // Restitution: likewise.
    const bool bounces_by_table = pair.restitution_combine == CombineRule::pair_table;
    const CombineRule restitution = bounces_by_table ? CombineRule::maximum : pair.restitution_combine;
    pair.restitution = bounces_by_table && known != nullptr
                           ? known->restitution
                           : combine(restitution, Side{a.restitution_combine, a.restitution},
                                     Side{b.restitution_combine, b.restitution});

    // A lever arm is a length of the softer of the two surfaces; the pair has the larger of the two.
    pair.friction_rolling = std::max(a.friction_rolling, b.friction_rolling);
    const bool are_alike = a.friction_rolling_on_others > 0 && b.friction_rolling_on_others > 0;
    if (!are_alike)
        pair.friction_rolling_on_others = std::max(a.friction_rolling_on_others, b.friction_rolling_on_others);
    pair.friction_torsional = std::max(a.friction_torsional, b.friction_torsional);
    pair.restitution_threshold = std::max(a.restitution_threshold, b.restitution_threshold);
    return pair;
}

PairFriction friction_between(const Material& a, const Material& b, const SurfacePairs& pairs) {
    const Material pair = combine(a, b, pairs);
    return {pair.friction_static, pair.friction_dynamic};
}

}  // namespace embody::physics
