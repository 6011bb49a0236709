// SPDX-License-Identifier: MIT
#include "attributes/mass_estimate.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "attributes/physical_kind.h"

namespace embody::attributes {
namespace {

// Standard deviations of ln(mass), chosen on measured objects; no single entry of the taxonomy was fitted to them
// (docs/attributes.md).
constexpr double spread_of_taxonomy = 0.1;  // between the word's meaning and the taxonomy's typical thing of its size
constexpr double spread_of_unit_outside = 1.5;  // per factor e by which the size is outside the usual range
constexpr double spread_of_proportions = 1.2;   // per factor e by which the sides' proportions differ
constexpr double spread_of_wrong_word = 1.0;    // of a category that is surely wrong
constexpr double spread_of_any_thing = 1.1;     // of things of one size, whatever they are

constexpr double sure = 0.95;                 // confidence of a plain word of the taxonomy in the name
constexpr double within_80_percent = 1.2816;  // standard deviations of a normal distribution

// Size in metres as people write it.
std::string size_text(Vec3 size) {
    return short_number(size.x) + " x " + short_number(size.y) + " x " + short_number(size.z) + " m";
}

// Density × fill fraction × volume of a closed surface, for things that are not hollow.
MassEstimate mass_of_solid(const CategoryData& category, const Substance& substance, const Form& form) {
    const auto product = [&](double density, double fill) { return density * fill * form.volume; };
    const Interval& density = substance.density;
    const Interval mass{product(density.low, category.fill_fraction.low),
                        product(density.typical, category.fill_fraction.typical),
                        product(density.high, category.fill_fraction.high)};
    return {mass,
            "density of " + substance.source + " x " + short_number(category.fill_fraction.typical) +
                " filled x volume of the " + form.volume_source,
            AttributeLevel::model};
}

double largest_of(Vec3 size) { return std::max({size.x, size.y, size.z}); }

// Whether cloth is folded or rolled: it is far smaller than hanging or spread cloth of its category, and not flat.
bool is_folded(const CategoryData& category, const Form& form) {
    return traits_of(category.kind).matter == Matter::sheet && category.scaling == MassScaling::area &&
           form.size_known && largest_of(form.size) < 0.2 * largest_of(category.at_size) &&
           std::min({form.size.x, form.size.y, form.size.z}) > 0.005;
}

// Folded cloth fills its box layer on layer.
MassEstimate mass_of_folded(const CategoryData& category, const Form& form, AttributeLevel level) {
    constexpr Interval packed{90, 180, 300};  // kg/m³
    return {{packed.low * form.box_volume, packed.typical * form.box_volume, packed.high * form.box_volume},
            category.name + ", folded to this size: 180 kg per cubic metre of its box (loosely folded linen 90 to " +
                "clothes pressed into bales 300)",
            level};
}

// The category's mass, scaled to this box.
MassEstimate mass_of_box(const CategoryData& category, const Form& form, AttributeLevel level) {
    const Form usual = form_of({}, category.at_size);
    const bool by_area = category.scaling == MassScaling::area;
    const double ratio = by_area ? form.face_area / usual.face_area : form.box_volume / usual.box_volume;
    const double exponent = mass_exponent(category);
    const double factor = std::pow(ratio, exponent);
    const Interval mass{category.mass.low * factor, category.mass.typical * factor, category.mass.high * factor};
    std::string source = category.name + " of " + size_text(category.at_size) + ": " +
                         short_number(category.mass.typical) + " kg (" + category.source + ")";
    if (form.size_known) {
        source +=
            ", x (" + short_number(ratio) + " times the " + (by_area ? "face" : "box") + ")^" + short_number(exponent);
    }
    return {mass, source, level};
}

// Difference between the proportions of a form and of a category's box: standard deviation of ln(side ratio) over the
// sides, sorted by length.
double difference_of_proportions(Vec3 form, Vec3 usual) {
    std::array<double, 3> sides{form.x, form.y, form.z}, others{usual.x, usual.y, usual.z};
    std::ranges::sort(sides);
    std::ranges::sort(others);
    double mean = 0, square = 0;
    for (std::size_t i = 0; i < sides.size(); ++i) {
        // form_of() never makes a side thinner than this.
        const bool is_minimal = sides[i] <= min_extent;
        const double ratio = std::log(sides[i] / (is_minimal ? std::max(others[i], min_extent) : others[i]));
        mean += ratio / 3;
        square += ratio * ratio / 3;
    }
    return std::sqrt(std::max(square - mean * mean, 0.0));
}

// Reasons why the category's law may not hold for this thing, beyond the category's own interval.
struct Doubt {
    double variance = 0;  ///< of ln(mass): uncertainty of the category's answer
    double widening = 0;  ///< part of the variance that shows in the errors of such answers
    std::string reasons;

    void add(double spread, const char* reason, double seen = 1) {
        constexpr double min_spread = 0.3;
        variance += spread * spread;
        widening += seen * spread * spread;
        if (spread > min_spread) reasons += (reasons.empty() ? "" : ", ") + std::string(reason);
    }
};

Doubt doubt_about(const Classification& what, const Form& form) {
    const CategoryData& category = *what.category;
    Doubt doubt;
    doubt.add(spread_of_steps(what.steps), "its word is only a kind of this");
    if (!form.size_known) return doubt;
    doubt.add(spread_of_unit_outside * outside_usual_size(category, largest_of(form.size)), "its size is unusual");
    doubt.add(spread_of_proportions * difference_of_proportions(form.size, category.at_size),
              "its proportions are unusual", 0.4);
    doubt.add(spread_of_wrong_word * std::sqrt(std::max(sure - what.confidence, 0.0)), "its words leave a doubt");
    return doubt;
}

// Mean of two independent answers weighted by their precision, as of errors of measurement: the category's mass with
// its doubt, and the mass of any thing of this size.
void blend_with_any_thing(MassEstimate& estimate, Doubt& doubt, const CategoryData& any, const Form& form) {
    const double weight = doubt.variance / (doubt.variance + spread_of_any_thing * spread_of_any_thing);
    const double mass_of_any = mass_of_box(any, form, AttributeLevel::standard).mass.typical;
    const double factor = std::pow(mass_of_any / estimate.mass.typical, weight);
    for (double* mass : {&estimate.mass.low, &estimate.mass.typical, &estimate.mass.high}) *mass *= factor;
    doubt.widening *= 1 - weight;
    if (doubt.reasons.empty()) return;
    estimate.source += "; drawn by " + short_number(100 * weight) + " % to the " + short_number(mass_of_any) +
                       " kg of any thing of this size, since " + doubt.reasons;
}

// Widens the interval by the doubt.
void widen(MassEstimate& estimate, const Doubt& doubt) {
    const double more = within_80_percent * std::hypot(spread_of_taxonomy, std::sqrt(doubt.widening));
    Interval& mass = estimate.mass;
    mass.low = mass.typical * std::exp(-std::hypot(std::log(mass.typical / mass.low), more));
    mass.high = mass.typical * std::exp(std::hypot(std::log(mass.high / mass.typical), more));
}

}  // namespace

double mass_exponent(const CategoryData& category) {
    constexpr double solid_from = 0.95, flattening = 0.8;
    const bool is_of_many_kinds = category.domain == "general";
    const bool is_as_told =
        is_of_many_kinds || category.exponent >= solid_from || category.set_by_file.contains("exponent");
    return is_as_told ? category.exponent : flattening * category.exponent;
}

MassEstimate estimate_mass(const Taxonomy::Data& data, const Classification& what, const Substance& substance,
                           const Form& form, bool closed) {
    const CategoryData& category = *what.category;
    const CategoryData& any = data.categories[data.unknown];
    Doubt doubt = doubt_about(what, form);
    MassEstimate estimate;
    if (category.solid && closed && form.volume_is_own) {
        estimate = mass_of_solid(category, substance, form);
    } else if (is_folded(category, form)) {
        estimate = mass_of_folded(category, form, what.level);
        doubt = {};
    } else {
        estimate = mass_of_box(category, form, what.level);
        // A user who weighed the things knows their mass better.
        const bool is_users = category.set_by_file.contains("mass");
        if (form.size_known && &category != &any && !is_users) blend_with_any_thing(estimate, doubt, any, form);
    }
    widen(estimate, doubt);
    return estimate;
}

}  // namespace embody::attributes
