// SPDX-License-Identifier: MIT
#include "physics/deformable/cloth/sheet_gas.h"

#include <algorithm>
#include <cmath>

namespace embody::physics::deformable {

namespace {

// Of the volume at rest, below which the gas is not pressed further: its inverse stays finite where the sheet is
// folded through itself and encloses less than nothing. Test: SheetGas.PressureTimesVolumeStaysTheSame.
constexpr double min_volume = 1e-3;

// Bounded, of that at rest.
double bounded(double volume, double rest_volume) { return std::max(volume, min_volume * rest_volume); }

}  // namespace

SheetGas::SheetGas(const DeformableDefinition& definition) {
    const Cloth& cloth = std::get<Cloth>(definition.matter);
    if (cloth.internal_pressure == 0) return;
    triangles_ = cloth.triangles;
    rest_volume_ = enclosed_volume(definition.nodes, triangles_);
    amount_ = (air_pressure + cloth.internal_pressure) * rest_volume_;
}

double SheetGas::volume(std::span<const Vec3> nodes) const { return enclosed_volume(nodes, triangles_); }

double SheetGas::pressure(double volume) const { return amount_ / bounded(volume, rest_volume_) - air_pressure; }

double SheetGas::energy(double volume) const {
    const double pressed = bounded(volume, rest_volume_);
    return air_pressure * (pressed - rest_volume_) - amount_ * std::log(pressed / rest_volume_) +
           pressure(volume) * (pressed - volume);
}

void SheetGas::linearize(std::span<const Vec3> nodes, std::span<const Vec3> moves) {
    place_.assign(nodes.begin(), nodes.end());
    moves_.assign(moves.begin(), moves.end());
    for (std::size_t i = 0; i < moves_.size(); ++i) place_[i] += moves_[i];
    volume_ = volume(place_);
    pressure_ = pressure(volume_);
    compression_ = (air_pressure + pressure_) / bounded(volume_, rest_volume_);
    gradient_.assign(nodes.size(), {});
    for (const auto& [a, b, c] : triangles_) {
        const Vec3 third = cross(place_[b] - place_[a], place_[c] - place_[a]) / 6;  // of the area's normal
        for (const std::uint32_t node : {a, b, c}) gradient_[node] += third;
    }
    force_.resize(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) force_[i] = pressure_ * gradient_[i];
    if (moves_.empty()) return;
    // Back to the part's start by the stiffness.
    double pull = 0;
    for (std::size_t i = 0; i < moves_.size(); ++i) pull += dot(gradient_[i], moves_[i]);
    for (std::size_t i = 0; i < moves_.size(); ++i) force_[i] += compression_ * pull * gradient_[i];
    for (const auto& corners : triangles_) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = corners[k], b = corners[(k + 1) % 3], c = corners[(k + 2) % 3];
            const Vec3 turned = cross(moves_[b] - moves_[a], place_[c] - place_[a]) +
                                cross(place_[b] - place_[a], moves_[c] - moves_[a]);
            force_[a] -= pressure_ / 6 * turned;
        }
    }
}

// Of corner a the gradient is (b - a) × (c - a) / 6 in each of its triangles: by b it changes by -[c - a]× / 6, by c by
// [b - a]× / 6; what it changes by a itself cancels around it.
Mat3 SheetGas::block(const std::array<std::uint32_t, 3>& corners, std::size_t k, bool is_after) const {
    const Vec3 v = pressure_ / 6 * (place_[corners[(k + (is_after ? 2 : 1)) % 3]] - place_[corners[k]]);
    const Mat3 turn{{0, v.z, -v.y}, {-v.z, 0, v.x}, {v.y, -v.x, 0}};  // [v]×
    return is_after ? turn : -1.0 * turn;
}

double SheetGas::unforeseen_energy(std::span<const Vec3> nodes, std::span<const Vec3> moves) const {
    std::vector<Vec3> end(nodes.begin(), nodes.end());
    for (std::size_t i = 0; i < end.size(); ++i) end[i] += moves[i];
    const double volume = this->volume(end);
    // V = V* + g·e + ½ e·H e + V(e) with e from the place of the equations, and V cubic without its last term.
    std::vector<Vec3> offset(end.size());
    double linear = 0;
    for (std::size_t i = 0; i < end.size(); ++i) {
        offset[i] = end[i] - place_[i];
        linear += dot(gradient_[i], offset[i]);
    }
    const double foreseen = energy(volume_) - pressure_ * (volume - enclosed_volume(offset, triangles_) - volume_) +
                            compression_ / 2 * linear * linear;
    return std::max(0.0, energy(volume) - foreseen);
}

}  // namespace embody::physics::deformable
