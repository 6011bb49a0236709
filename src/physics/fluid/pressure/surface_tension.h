// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "foundation/task_pool.h"
#include "physics/definitions/settings/fluid_pressure_settings.h"
#include "physics/fluid/grid/grid.h"
#include "physics/fluid/namespace.h"

namespace embody::physics::fluid {

/// Whether surface tension σ (N/m) is significant beside gravity on cells of h: these are finer than the limit of the
/// settings, by the capillary length √(σ/(ρ g)).
bool is_tense(const FluidTensionSettings& settings, double tension, double density, double gravity, double h);

/// The largest tension, N/m, with which the shortest waves of the surface do not grow in steps of dt (J. Brackbill, D.
/// Kothe, C. Zemach, "A continuum method for modeling surface tension", 1992): dt² = ρ h³/(4 π σ).
double steady_tension(double density, double h, double dt);

/// The liquid's pressure at its surface by the surface's curvature (docs/physics/fluids.md, "Surface tension"). It is
/// zero before measure().
class SurfacePressure {
public:
    /// Curvature from the density around centres. `impulse`: tension times the length of the step, N s/m, the same
    /// everywhere unless set_fractions() follows.
    void measure(double impulse, const FluidTensionSettings& settings, const FluidGrid& grid, TaskPool& workers);
    /// After measure(): tension times the length of the step by cell, over its `impulse`.
    void set_fractions(std::vector<float> fractions) { fractions_ = std::move(fractions); }
    /// The pressure is zero from here on.
    void clear() { impulse_ = 0; }
    [[nodiscard]] bool is_none() const { return impulse_ == 0; }
    /// Pressure times time, Pa s, between a liquid's cell and one in air, at a fraction of the distance to the latter.
    [[nodiscard]] double at(int liquid, int air, double fraction) const {
        const auto inside = static_cast<std::size_t>(liquid), outside = static_cast<std::size_t>(air);
        return impulse_ * (fractions_.empty() ? 1 : fractions_[inside]) *
               (curvature_[inside] + fraction * (static_cast<double>(curvature_[outside]) - curvature_[inside]));
    }

    /// Adds to `shift` the displacement of a place outside of the surface towards it, m: stray particles, which the
    /// cells do not resolve, would leave for good.
    void draw_in(const FluidGrid& grid, const float* place, float* shift) const;

private:
    FluidTensionSettings settings_;  // of the last measure()
    double impulse_ = 0;
    std::vector<float> fractions_;  // of the impulse, by cell; none: 1
    std::vector<float> filled_, room_, scratch_;
    std::vector<float> curvature_;  // of the surface through a centre or next to it, 1/m; positive around a drop
};

}  // namespace embody::physics::fluid
