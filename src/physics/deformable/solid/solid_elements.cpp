// SPDX-License-Identifier: MIT
#include "physics/deformable/solid/solid_elements.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "math/rotation_part.h"

namespace embody::physics::deformable {

namespace {

// Stress of corotated linear elasticity for a strain ε in the element's axes, turned: R (2 μ ε + λ tr ε).
Mat3 turned_stress(const Mat3& rotation, const Mat3& strain, double mu, double lambda) {
    const double pressure = lambda * trace(strain);
    return rotation * (2 * mu * strain + Mat3::diagonal({pressure, pressure, pressure}));
}

Mat3 symmetric_part(const Mat3& m) { return 0.5 * (m + transpose(m)); }

double squares(const Mat3& m) { return length_squared(m.x) + length_squared(m.y) + length_squared(m.z); }

}  // namespace

SolidElements::SolidElements(const SoftSolid& solid, std::span<const Vec3> rest)
    : mu_(solid.youngs_modulus / (2 * (1 + solid.poisson_ratio)) + solid.internal_pressure / 2),
      lambda_(solid.youngs_modulus * solid.poisson_ratio / ((1 + solid.poisson_ratio) * (1 - 2 * solid.poisson_ratio))),
      damping_(solid.rayleigh_damping),
      yield_stress_(solid.yield_stress) {
    for (std::array<std::uint32_t, 4> corners : solid.tetrahedra) {
        const auto sides = [&] {
            const Vec3 origin = rest[corners[0]];
            return Mat3{rest[corners[1]] - origin, rest[corners[2]] - origin, rest[corners[3]] - origin};
        };
        if (determinant(sides()) < 0) std::swap(corners[2], corners[3]);
        const Mat3 shape = sides(), inverse = transpose(inverse_or_zero(shape));
        corners_.push_back(corners);
        gradient_.push_back({inverse.x, inverse.y, inverse.z});
        volume_.push_back(determinant(shape) / 6);
    }
    rotation_.resize(size());
    node_rotation_.resize(rest.size());
    plastic_.assign(size(), Mat3::zero());
    node_plastic_.assign(rest.size(), Mat3::zero());
    find_surroundings(rest.size());
    find_edges();
    deformation_.resize(size());
    for (std::vector<Mat3>& past : past_) past.assign(size(), Mat3::zero());
    for (std::vector<Mat3>& past : node_past_) past.assign(rest.size(), Mat3::zero());
    node_deformation_.resize(rest.size());
    node_stress_.resize(rest.size());
    rotation_f_.resize(size());
    gradient_f_.resize(size());
    node_rotation_f_.resize(rest.size());
    node_stress_f_.resize(rest.size());
    set(settings_);
}

// Of the energy μ |dev ε|² + K/2 tr² ε the elements have a part of the first term, the means around the nodes the rest:
// λ = K - 2 μ/3 of each.
void SolidElements::set(const SolidSettings& settings) {
    settings_ = settings;
    element_moduli_.mu = (1 - settings.node_fraction) * mu_;
    element_moduli_.lambda = -2.0 / 3 * element_moduli_.mu;
    node_moduli_ = {mu_ - element_moduli_.mu, lambda_ - element_moduli_.lambda};
}

void SolidElements::find_surroundings(std::size_t nodes) {
    first_around_.assign(nodes + 1, 0);
    node_volume_.assign(nodes, 0);
    for (std::size_t e = 0; e < size(); ++e) {
        for (const std::uint32_t node : corners_[e]) {
            ++first_around_[node + 1];
            node_volume_[node] += volume_[e] / 4;
        }
    }
    for (std::size_t i = 0; i < nodes; ++i) first_around_[i + 1] += first_around_[i];
    std::vector<std::uint32_t> next(first_around_.begin(), first_around_.end() - 1);
    around_.resize(4 * size());
    for (std::uint32_t e = 0; e < size(); ++e) {
        for (std::uint32_t k = 0; k < 4; ++k) {
            const std::uint32_t node = corners_[e][k];
            around_[next[node]++] = {e, k, volume_[e] / 4 / node_volume_[node]};
        }
    }
}

void SolidElements::find_edges() {
    for (const auto& corners : corners_) {
        for (std::size_t a = 0; a < 4; ++a) {
            for (std::size_t b = a + 1; b < 4; ++b)
                edges_.push_back({std::min(corners[a], corners[b]), std::max(corners[a], corners[b])});
        }
    }
    std::ranges::sort(edges_);
    edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
}

void SolidElements::add_stiffness_blocks(double factor, std::span<Mat3> diagonal, std::span<Mat3> blocks) const {
    for (std::size_t e = 0; e < size(); ++e) {
        const auto& [g1, g2, g3] = gradient_[e];
        std::array<Vec3, 4> g{-(g1 + g2 + g3), g1, g2, g3};
        for (Vec3& slope : g) slope = rotate(rotation_[e], slope);
        for (std::size_t a = 0; a < 4; ++a) {
            for (std::size_t b = 0; b < 4; ++b) {
                const std::uint32_t row = corners_[e][a], column = corners_[e][b];
                if (row > column) continue;
                // V (μ (gₐ·g_b 1 + g_b gₐᵀ) + λ gₐ g_bᵀ)
                const double shear = mu_ * dot(g[a], g[b]);
                const Mat3 block = (factor * volume_[e]) * (Mat3::diagonal({shear, shear, shear}) +
                                                            mu_ * outer(g[b], g[a]) + lambda_ * outer(g[a], g[b]));
                if (row == column) {
                    diagonal[row] += block;
                } else {
                    const std::array<std::uint32_t, 2> edge{row, column};
                    blocks[static_cast<std::size_t>(std::ranges::lower_bound(edges_, edge) - edges_.begin())] += block;
                }
            }
        }
    }
}

// ∇ of nodal values over an element: Σ value gᵀ.
Mat3 SolidElements::gradient(std::size_t element, std::span<const Vec3> values) const {
    const auto& corners = corners_[element];
    const Vec3 origin = values[corners[0]];
    const auto& g = gradient_[element];
    return outer(values[corners[1]] - origin, g[0]) + outer(values[corners[2]] - origin, g[1]) +
           outer(values[corners[3]] - origin, g[2]);
}

// Elastic stress of the strains of this and the last substeps, and that of β/h times the change of the strain.
Mat3 SolidElements::stress(const Moduli& moduli, const Mat3& deformation, Quat rotation, const Mat3& plastic,
                           const Past& past, std::size_t index) const {
    const Mat3 r = to_matrix(rotation);
    const Mat3 strain = symmetric_part(transpose(r) * deformation) - Mat3::identity() - plastic;
    Mat3 felt = (end_weight() + damping_rate_) * strain - damping_rate_ * past[0][index];
    if (is_second_order_) felt += (1.0 / 27) * (12 * past[0][index] + 6 * past[1][index] + past[2][index]);
    return turned_stress(r, felt, moduli.mu, moduli.lambda);
}

// Damping of β >= h would hide what the second order gains.
void SolidElements::begin_substep(double h) {
    is_substep_new_ = true;
    is_second_order_ = damping_ < h;
    damping_rate_ = damping_ / h;
}

// Elastic strains of these deformations in axes that are close to `rotation`.
void SolidElements::find_strains(std::span<const Mat3> deformation, std::vector<Quat> rotation,
                                 std::span<const Mat3> plastic, std::span<Mat3> strain) {
    follow_rotations(deformation, rotation);
    for (std::size_t i = 0; i < strain.size(); ++i)
        strain[i] = symmetric_part(transpose(to_matrix(rotation[i])) * deformation[i]) - Mat3::identity() - plastic[i];
}

// The strains when this substep began. The rotations of the last linearise() are close to those there.
void SolidElements::begin_strains(std::span<const Vec3> start) {
    if (is_second_order_) {
        shift(past_);
        shift(node_past_);
    }
    for (std::size_t e = 0; e < size(); ++e) deformation_[e] = gradient(e, start);
    for (std::size_t i = 0; i < node_rotation_.size(); ++i) node_deformation_[i] = mean_around(i, deformation_);
    find_strains(deformation_, rotation_, plastic_, past_[0]);
    find_strains(node_deformation_, node_rotation_, node_plastic_, node_past_[0]);
    for (Past* past : {&past_, &node_past_}) {
        if (!has_past_) (*past)[1] = (*past)[2] = (*past)[0];
    }
    has_past_ = true;
}

void SolidElements::shift(Past& past) {
    past[2].swap(past[1]);
    past[1].swap(past[0]);
}

void SolidElements::linearise(std::span<const Vec3> position, std::span<const Vec3> start, std::span<Vec3> force) {
    if (std::exchange(is_substep_new_, false)) begin_strains(start);
    const auto to_single = [](Quat rotation) {
        const Mat3 r = to_matrix(rotation);
        Matrix m;
        for (int c = 0; c < 3; ++c) {
            for (int row = 0; row < 3; ++row) m.value[3 * c + row] = static_cast<float>(r(row, c));
        }
        return m;
    };
    for (std::size_t e = 0; e < size(); ++e) deformation_[e] = gradient(e, position);
    follow_rotations(deformation_, rotation_);
    std::ranges::transform(rotation_, rotation_f_.begin(), to_single);
    // Means around the nodes.
    for (std::size_t i = 0; i < node_rotation_.size(); ++i) node_deformation_[i] = mean_around(i, deformation_);
    follow_rotations(node_deformation_, node_rotation_);
    std::ranges::transform(node_rotation_, node_rotation_f_.begin(), to_single);
    for (std::size_t i = 0; i < node_rotation_.size(); ++i)
        node_stress_[i] =
            stress(node_moduli_, node_deformation_[i], node_rotation_[i], node_plastic_[i], node_past_, i);
    for (std::size_t e = 0; e < size(); ++e) {
        Mat3 whole = stress(element_moduli_, deformation_[e], rotation_[e], plastic_[e], past_, e);
        for (const std::uint32_t node : corners_[e]) whole += 0.25 * node_stress_[node];
        whole = volume_[e] * whole;
        Vec3 sum;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 f = whole * gradient_[e][k];
            force[corners_[e][k + 1]] -= f;
            sum += f;
        }
        force[corners_[e][0]] += sum;
    }
}

void SolidElements::add_stiffness(float factor, std::span<const Vec3f> move, std::span<Vec3f> force) {
    // R (μ (W + Wᵀ) + λ tr W) of a move's gradient G, W = Rᵀ G
    const auto stress_of = [](const Moduli& moduli, const float* r, const float* g, float* s) {
        const auto mu = static_cast<float>(moduli.mu), lambda = static_cast<float>(moduli.lambda);
        float w[9];
        for (int c = 0; c < 3; ++c) {
            for (int row = 0; row < 3; ++row)
                w[3 * c + row] = r[3 * row] * g[3 * c] + r[3 * row + 1] * g[3 * c + 1] + r[3 * row + 2] * g[3 * c + 2];
        }
        const float pressure = lambda * (w[0] + w[4] + w[8]);
        const float xy = mu * (w[1] + w[3]), xz = mu * (w[2] + w[6]), yz = mu * (w[5] + w[7]);
        const float e[9] = {2 * mu * w[0] + pressure, xy, xz, xy, 2 * mu * w[4] + pressure, yz, xz, yz,
                            2 * mu * w[8] + pressure};
        for (int c = 0; c < 3; ++c) {
            for (int row = 0; row < 3; ++row)
                s[3 * c + row] = r[row] * e[3 * c] + r[3 + row] * e[3 * c + 1] + r[6 + row] * e[3 * c + 2];
        }
    };
    for (std::size_t e = 0; e < size(); ++e) {
        const auto& corners = corners_[e];
        const Vec3f origin = move[corners[0]];
        float* g = gradient_f_[e].value;
        std::fill(g, g + 9, 0.0f);
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3f d = move[corners[k + 1]];
            const Vec3f displacement{d.x - origin.x, d.y - origin.y, d.z - origin.z};
            const Vec3f slope = to_vec3f(gradient_[e][k]);
            const float along[3] = {slope.x, slope.y, slope.z};
            for (int c = 0; c < 3; ++c) {
                g[3 * c] += displacement.x * along[c];
                g[3 * c + 1] += displacement.y * along[c];
                g[3 * c + 2] += displacement.z * along[c];
            }
        }
    }
    for (std::size_t i = 0; i < node_rotation_.size(); ++i) {
        float g[9] = {};
        for (const Around& a : around(i)) {
            const auto fraction = static_cast<float>(a.fraction);
            for (int k = 0; k < 9; ++k) g[k] += fraction * gradient_f_[a.element].value[k];
        }
        stress_of(node_moduli_, node_rotation_f_[i].value, g, node_stress_f_[i].value);
    }
    for (std::size_t e = 0; e < size(); ++e) {
        float s[9];
        stress_of(element_moduli_, rotation_f_[e].value, gradient_f_[e].value, s);
        const float scale = factor * static_cast<float>(volume_[e]);
        for (int k = 0; k < 9; ++k) {
            float around_it = 0;
            for (const std::uint32_t node : corners_[e]) around_it += node_stress_f_[node].value[k];
            s[k] = scale * (s[k] + 0.25f * around_it);
        }
        Vec3f sum;
        const auto add = [](Vec3f& to, float x, float y, float z) { to = {to.x + x, to.y + y, to.z + z}; };
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3f g = to_vec3f(gradient_[e][k]);
            const float x = s[0] * g.x + s[3] * g.y + s[6] * g.z, y = s[1] * g.x + s[4] * g.y + s[7] * g.z,
                        z = s[2] * g.x + s[5] * g.y + s[8] * g.z;
            add(force[corners_[e][k + 1]], x, y, z);
            add(sum, x, y, z);
        }
        add(force[corners_[e][0]], -sum.x, -sum.y, -sum.z);
    }
}

double SolidElements::energy_density(const Moduli& moduli, const Mat3& strain) {
    return moduli.mu * squares(strain) + moduli.lambda / 2 * trace(strain) * trace(strain);
}

SolidElements::SubstepEnergy SolidElements::substep_energy(std::span<const Vec3> position) const {
    SubstepEnergy sum;
    std::vector<Mat3> deformation(size()), around(node_rotation_.size()), end(size());
    for (std::size_t e = 0; e < size(); ++e) deformation[e] = gradient(e, position);
    find_strains(deformation, rotation_, plastic_, end);
    for (std::size_t e = 0; e < size(); ++e) add_element_energy(e, has_past_ ? past_[0][e] : end[e], end[e], sum);
    for (std::size_t i = 0; i < around.size(); ++i) around[i] = mean_around(i, deformation);
    end.resize(around.size());
    find_strains(around, node_rotation_, node_plastic_, end);
    for (std::size_t i = 0; i < around.size(); ++i)
        add_energy(node_moduli_, node_volume_[i], has_past_ ? node_past_[0][i] : end[i], end[i], sum);
    return sum;
}

SolidElements::SubstepEnergy SolidElements::substep_energy_before() const {
    SubstepEnergy sum;
    for (std::size_t e = 0; e < size(); ++e) add_element_energy(e, past_[1][e], past_[0][e], sum);
    for (std::size_t i = 0; i < node_volume_.size(); ++i)
        add_energy(node_moduli_, node_volume_[i], node_past_[1][i], node_past_[0][i], sum);
    return sum;
}

void SolidElements::add_energy(const Moduli& moduli, double volume, const Mat3& start, const Mat3& end,
                               SubstepEnergy& sum) {
    sum.end += volume * energy_density(moduli, end);
    sum.middle += volume * energy_density(moduli, 0.5 * (start + end));
    sum.change += volume * energy_density(moduli, end - start);
}

void SolidElements::add_element_energy(std::size_t element, const Mat3& start, const Mat3& end,
                                       SubstepEnergy& sum) const {
    if (!is_second_order_) {
        sum.end += volume_[element] * energy_density(element_moduli_, end);
        return;
    }
    add_energy(element_moduli_, volume_[element], start, end, sum);
    sum.tetrahedra += volume_[element] * energy_density({mu_, lambda_}, end - start);
}

Mat3 SolidElements::mean_around(std::size_t node, std::span<const Mat3> of_elements) const {
    Mat3 mean = Mat3::zero();
    for (const Around& a : around(node)) mean += a.fraction * of_elements[a.element];
    return mean;
}

bool SolidElements::flow(std::span<const Vec3> position) {
    if (!std::isfinite(yield_stress_)) return false;
    for (std::size_t e = 0; e < size(); ++e) {
        deformation_[e] = gradient(e, position);
        flow(deformation_[e], rotation_[e], plastic_[e]);
    }
    for (std::size_t i = 0; i < node_rotation_.size(); ++i)
        flow(mean_around(i, deformation_), node_rotation_[i], node_plastic_[i]);
    return true;
}

// Radial return (J. C. Simo, T. J. R. Hughes, "Computational Inelasticity", 1998, 3.3): stress s = 2 μ dev(ε - εᵖ) is
// brought back to |s|² 3/2 = Y².
void SolidElements::flow(const Mat3& deformation, Quat rotation, Mat3& plastic) const {
    Mat3 elastic = symmetric_part(transpose(to_matrix(rotation)) * deformation) - Mat3::identity() - plastic;
    const double third = trace(elastic) / 3;
    elastic = elastic - Mat3::diagonal({third, third, third});
    const double stress = 2 * mu_ * std::sqrt(1.5 * squares(elastic));
    if (!(stress > yield_stress_)) return;
    plastic += (1 - yield_stress_ / stress) * elastic;
    limit_strain(plastic);
}

void SolidElements::take_plastic_strain(const SolidElements& other) {
    plastic_ = other.plastic_;
    node_plastic_ = other.node_plastic_;
    forget_past();
}

std::vector<std::array<double, 5>> SolidElements::plastic_strain() const {
    std::vector<std::array<double, 5>> strains;
    bool has_flowed = false;
    for (const std::vector<Mat3>* list : {&plastic_, &node_plastic_}) {
        for (const Mat3& p : *list) {
            strains.push_back({p(0, 0), p(1, 1), p(0, 1), p(0, 2), p(1, 2)});
            has_flowed = has_flowed || squares(p) > 0;
        }
    }
    return has_flowed ? strains : std::vector<std::array<double, 5>>();
}

void SolidElements::set_plastic_strain(std::span<const std::array<double, 5>> strains) {
    forget_past();
    std::size_t next = 0;
    for (std::vector<Mat3>* list : {&plastic_, &node_plastic_}) {
        for (Mat3& plastic : *list) {
            const auto [xx, yy, xy, xz, yz] = strains.empty() ? std::array<double, 5>{} : strains[next++];
            plastic = {{xx, xy, xz}, {xy, yy, yz}, {xz, yz, -(xx + yy)}};
            limit_strain(plastic);
        }
    }
}

void SolidElements::limit_strain(Mat3& plastic) const {
    const double strain = std::sqrt(squares(plastic)), most = settings_.max_plastic_strain;
    if (strain > most) plastic = (most / strain) * plastic;
}

void SolidElements::reset_rotations(Quat rotation) {
    std::ranges::fill(rotation_, rotation);
    std::ranges::fill(node_rotation_, rotation);
    forget_past();
}

}  // namespace embody::physics::deformable
