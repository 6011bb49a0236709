// SPDX-License-Identifier: MIT
#include "attributes/plausible.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>

#include "attributes/physical_kind.h"
#include "attributes/registry.h"

namespace embody::attributes {
namespace {

constexpr double osmium = 22'590;     // kg/m³, the densest element (CRC Handbook)
constexpr double aerogel = 1;         // kg/m³, the lightest silica aerogel without its air
constexpr double max_friction = 1.5;  // rubber on dry concrete has 1.0 to 1.2 (Marks' Handbook)
constexpr double max_bounce = 0.98;   // steel on hard steel reaches 0.97
/// So far outside an 80 % interval nothing real is: three standard deviations of ln mass are a factor of about 3.
constexpr double far_in_mass = 10, far_in_material = 3;
/// Share of its height by which a thing may give way under its own weight and still be the thing.
constexpr double max_sag = 0.5;
/// Vibrations of less than this share of a substep never show.
constexpr double seen_period = 0.25;

class Judge {
public:
    Judge(const AttributeSet& acting, const AttributeSet& automatic, const Circumstances& around)
        : acting_(acting), automatic_(automatic), around_(around) {}

    std::vector<Issue> judge() {
        check_mass();
        check_density();
        check_friction("friction_static");
        check_friction("friction_dynamic");
        check_bounce();
        check_center();
        check_stiffness();
        check_mask();
        check_joint();
        return std::move(issues_);
    }

private:
    // Whether a person changed the attribute, or what it follows from.
    [[nodiscard]] bool is_changed(const char* name) const {
        const AttributeEntry* now = acting_.find(name);
        const AttributeEntry* before = automatic_.find(name);
        return now && !(before && before->value == now->value);
    }
    void add(const char* name, std::string why, std::string remedy = {}) {
        issues_.push_back({name, std::move(why), std::move(remedy)});
    }

    // Compares the value with the interval of the automatic one.
    bool is_far(const char* name, double factor, const char* unit, const char* of) {
        const AttributeEntry* before = automatic_.find(name);
        if (!before || !before->low || !before->high || !(*before->low > 0)) return false;
        const double value = acting_.number(name, 0);
        const bool is_high = value > factor * *before->high;
        if (!is_high && value >= *before->low / factor) return false;
        const double times = is_high ? value / *before->high : *before->low / std::max(value, 1e-300);
        const std::string behind = *unit ? std::string(" ") + unit : "";
        add(name, readable_number(value) + behind + " is " + readable_number(times) + " times " +
                      (is_high ? "more" : "less") + " than " + of + ": " + readable_number(*before->low) + " … " +
                      readable_number(*before->high) + behind);
        return true;
    }

    void check_mass() {
        if (!is_changed("mass")) return;
        const double mass = acting_.number("mass", 1), volume = acting_.number("volume", 0);
        const double density = volume > 0 ? mass / volume : 0;
        if (density > osmium) {
            add("mass", readable_number(mass) + " kg in " + readable_number(volume * 1000) + " litres is " +
                            readable_number(density) + " kg/m³: denser than osmium, the densest of all (" +
                            readable_number(osmium) + " kg/m³)");
            return;
        }
        if (is_far("mass", far_in_mass, "kg", "what such things weigh")) return;
        const double usual = volume > 0 ? automatic_.number("mass", 0) / volume : 0;
        if (volume > 0 && density < aerogel && usual > 10 * aerogel)
            add("mass", readable_number(mass) + " kg in " + readable_number(volume * 1000) +
                            " litres is less than air weighs, or as little");
    }

    void check_density() {
        if (!is_changed("density") || !is_manual_density()) return;
        if (is_far("density", far_in_material, "kg/m³", "its material")) return;
        if (acting_.number("density", 1000) < aerogel)
            add("density", readable_number(acting_.number("density", 0)) +
                               " kg/m³ is lighter than any solid: aerogel has " + readable_number(aerogel));
    }
    // Else it follows from the mass, of which is told.
    [[nodiscard]] bool is_manual_density() const {
        const AttributeEntry* entry = acting_.find("density");
        return entry && entry->level == AttributeLevel::manual;
    }

    void check_friction(const char* name) {
        if (!is_changed(name)) return;
        if (acting_.number(name, 0) > max_friction) {
            add(name, readable_number(acting_.number(name, 0)) +
                          " is more than any two dry surfaces have: rubber on concrete has 1 to 1.2");
            return;
        }
        is_far(name, far_in_material, "", "its material has");
    }

    void check_bounce() {
        if (is_changed("restitution") && acting_.number("restitution", 0) > max_bounce)
            add("restitution", "bounces for ever: nothing loses less than 2 % of its speed",
                "a rubber ball has 0.8, steel 0.6");
    }

    void check_center() {
        const AttributeEntry* entry = acting_.find("center_of_mass");
        const Vec3* center = entry ? std::get_if<Vec3>(&entry->value) : nullptr;
        if (!center || around_.box.is_empty() || !is_changed("center_of_mass")) return;
        const double slack = 1e-6 * length(around_.box.size());
        const Bounds box{around_.box.lower - Vec3{slack, slack, slack}, around_.box.upper + Vec3{slack, slack, slack}};
        if (contains(box, *center)) return;
        const double outside = distance(*center, min(max(*center, box.lower), box.upper));
        add("center_of_mass", "lies " + readable_number(outside) + " m outside the thing");
    }

    void check_stiffness() {
        if (matter_of(acting_) != Matter::solid || around_.box.is_empty()) return;
        if (!is_changed("youngs_modulus") && !is_changed("density") && !is_changed("mass") && !is_changed("kind"))
            return;
        const double stiffness = acting_.number("youngs_modulus", 1e5), density = acting_.number("density", 1000);
        const Vec3 size = around_.box.size();
        const double height = size.y, extent = std::max({size.x, size.y, size.z});
        // The slowest vibration of a bar that is free at both ends: half a wave along it.
        const double period = 2 * extent * std::sqrt(density / stiffness);
        if (period < seen_period * around_.substep) {
            const double shown = density * std::pow(2 * extent / (seen_period * around_.substep), 2);
            add("youngs_modulus",
                "so stiff that it vibrates once in " + readable_number(period * 1000) + " ms, where a substep lasts " +
                    readable_number(around_.substep * 1000) + " ms: it looks rigid and costs more",
                "make its kind rigid, or stay below " + readable_number(shown) + " Pa");
            return;
        }
        // Strain of a column at its foot, by its own weight.
        const double sag = density * around_.gravity * height / stiffness;
        if (sag > max_sag)
            add("youngs_modulus",
                "so soft that its own weight presses it to " + readable_number(100 * std::exp(-sag)) +
                    " % of its height",
                "take more than " + readable_number(density * around_.gravity * height / max_sag) + " Pa");
    }

    void check_mask() {
        const bool falls = around_.gravity > 0 && acting_.number("gravity_factor", 1) != 0 &&
                           !is_static(kind_of(acting_)) && !acting_.truth("kinematic", false);
        if (falls && is_changed("collision_mask") && acting_.number("collision_mask", 1) == 0)
            add("collision_mask", "meets nothing, so that it falls through the floor and is gone");
    }

    void check_joint() {
        if (kind_of(acting_) == PhysicalKind::articulated && is_changed("kind") && !around_.has_joint)
            add("kind", "articulated, but no joint holds it: it moves as one rigid body",
                "add a joint, or make it rigid");
    }

    const AttributeSet& acting_;
    const AttributeSet& automatic_;
    const Circumstances& around_;
    std::vector<Issue> issues_;
};

}  // namespace

void offer_reset(Issue& issue, const AttributeSet& automatic) {
    issue.reset = issue.attribute;
    if (!issue.remedy.empty()) return;
    const AttributeEntry* before = automatic.find(issue.attribute);
    const auto* number = before ? std::get_if<double>(&before->value) : nullptr;
    const AttributeDescription* description = describe(issue.attribute);
    const std::string unit = description && description->unit != "1" ? " " + description->unit : "";
    issue.remedy = "back to automatic" + (number ? ": " + readable_number(*number) + unit : "");
}

std::string readable_number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", value);
    const double rounded = std::strtod(text, nullptr);
    const double size = std::fabs(rounded);
    if (size >= 1000 && size < 1e6) std::snprintf(text, sizeof text, "%.0f", rounded);
    std::string written = text;
    // 1e+09 is 1e9 to people.
    const std::size_t power = written.find('e');
    if (power == std::string::npos) return written;
    return written.substr(0, power + 1) + std::to_string(std::atoi(written.c_str() + power + 1));
}

std::vector<Issue> find_implausible(const AttributeSet& acting, const AttributeSet& automatic,
                                    const Circumstances& around) {
    return Judge(acting, automatic, around).judge();
}

}  // namespace embody::attributes
