// SPDX-License-Identifier: MIT
#include "attributes/model_facts.h"

namespace embody::attributes {

GeometryFacts scaled(const GeometryFacts& facts, double factor) {
    const double area = factor * factor, volume = area * factor;
    // Moments of inertia: what is measured (area or volume) times length².
    const auto grow = [&](geometry::MassProperties& p, double measure) {
        p.volume *= measure;
        p.center *= factor;
        p.inertia = (measure * area) * p.inertia;
    };
    GeometryFacts result = facts;
    result.size *= factor;
    result.volume *= volume;
    result.center_of_volume *= factor;
    result.unit_inertia = (volume * area) * facts.unit_inertia;
    result.hull_volume *= volume;
    result.hull_concavity *= factor;
    result.surface_area *= area;
    result.fitted_dimensions *= factor;
    result.fitted_pose.position *= factor;
    result.fitted_error *= factor;
    for (PartFacts& part : result.parts) {
        grow(part.form.shell, area);
        grow(part.form.solid, volume);
    }
    return result;
}

}  // namespace embody::attributes
