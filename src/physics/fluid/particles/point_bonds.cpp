// SPDX-License-Identifier: MIT
// docs/physics/coupling.md, "Liquids and what bends". At a point g of the lattice, with trilinear weights w of
// particles q (mass m, velocity u) and bonds p (drag c):
//
//   M = Σ w_q m_q,   U = Σ w_q m_q u_q / M,   C = Σ w_p c_p,   b_p = w_p c_p M/(M + C)
//
// An impulse J_p on the bond's liquid is shared out by b_p, ΔU = Σ J_p b_p/(B_p M), and u_q += Σ w_q ΔU. Momentum is
// that of J. As Σ b_p <= M and Σ_g w_q = 1, the kinetic energy changes by no more than J·u + J²/(2 B).
#include "physics/fluid/particles/point_bonds.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace embody::physics::fluid {

namespace {

/// The points of the lattice around the bonds.
class Lattice {
public:
    Lattice(double cell, std::span<const PointBond> bonds) : cell_(cell) {
        std::array<int, 3> upper{};
        bool is_first = true;
        for (const PointBond& bond : bonds) {
            const Corner corner = corner_of(bond.place);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const int at = corner.lower[axis];
                lower_[axis] = is_first ? at : std::min(lower_[axis], at);
                upper[axis] = is_first ? at + 2 : std::max(upper[axis], at + 2);
            }
            is_first = false;
        }
        for (std::size_t axis = 0; axis < 3; ++axis) size_[axis] = upper[axis] - lower_[axis];
        number_.assign(static_cast<std::size_t>(size_[0]) * static_cast<std::size_t>(size_[1]) *
                           static_cast<std::size_t>(size_[2]),
                       -1);
        for (const PointBond& bond : bonds) {
            for_each(bond.place, [&](std::int32_t& number, double) {
                if (number < 0) number = static_cast<std::int32_t>(count_++);
            });
        }
    }

    [[nodiscard]] std::size_t count() const { return count_; }

    /// Calls visit(number, weight) for those of the eight points around a place that a bond is near.
    template <class Visit>
    void visit(Vec3 place, Visit visit) {
        for_each(place, [&](std::int32_t number, double weight) {
            if (number >= 0) visit(static_cast<std::size_t>(number), weight);
        });
    }

private:
    struct Corner {
        std::array<int, 3> lower{};
        std::array<double, 3> fraction{};
    };
    [[nodiscard]] Corner corner_of(Vec3 place) const {
        Corner corner;
        for (int axis = 0; axis < 3; ++axis) {
            const double at = place[axis] / cell_, low = std::floor(at);
            corner.lower[static_cast<std::size_t>(axis)] = static_cast<int>(low);
            corner.fraction[static_cast<std::size_t>(axis)] = at - low;
        }
        return corner;
    }
    template <class Visit>
    void for_each(Vec3 place, Visit visit) {
        const Corner corner = corner_of(place);
        for (unsigned k = 0; k < 8; ++k) {
            std::size_t index = 0;
            double weight = 1;
            bool is_inside = true;
            for (std::size_t axis = 3; axis-- > 0;) {
                const bool is_upper = (k >> axis & 1u) != 0;
                const int at = corner.lower[axis] + (is_upper ? 1 : 0) - lower_[axis];
                is_inside = is_inside && at >= 0 && at < size_[axis];
                index = index * static_cast<std::size_t>(size_[axis]) + static_cast<std::size_t>(at);
                weight *= is_upper ? corner.fraction[axis] : 1 - corner.fraction[axis];
            }
            if (is_inside) visit(number_[index], weight);
        }
    }

    double cell_;
    std::array<int, 3> lower_{}, size_{};
    std::vector<std::int32_t> number_;  // by place in the box; −1: no bond is near
    std::size_t count_ = 0;
};

/// What is at a point of the lattice.
struct Parcel {
    double mass = 0;  // M, kg
    Vec3 momentum;    // M U, N s
    Vec3 drag;        // C, kg
    Vec3 change;      // ΔU, m/s

    [[nodiscard]] Vec3 bound(Vec3 drag_there) const {
        Vec3 part;
        for (int axis = 0; axis < 3; ++axis)
            part[axis] = drag_there[axis] > 0 ? drag_there[axis] * mass / (mass + drag[axis]) : 0.0;
        return part;
    }
};

std::vector<Parcel> collect(Lattice& lattice, const Mixture& liquids, std::span<const PointBond> bonds,
                            std::span<const FluidParticle> particles) {
    std::vector<Parcel> parcels(lattice.count());
    for (const PointBond& bond : bonds)
        lattice.visit(bond.place, [&](std::size_t at, double weight) { parcels[at].drag += weight * bond.drag; });
    for (const FluidParticle& particle : particles) {
        lattice.visit(to_vec(particle.position), [&](std::size_t at, double weight) {
            const FluidProperties& liquid = liquids.of(particle.id);
            const double mass = weight * liquid.density * liquid.particle_volume;
            parcels[at].mass += mass;
            parcels[at].momentum += mass * to_vec(particle.velocity);
        });
    }
    return parcels;
}

}  // namespace

void find_bonds(double cell, const Mixture& liquids, std::span<const FluidParticle> particles,
                std::span<PointBond> bonds) {
    if (bonds.empty()) return;
    Lattice lattice(cell, bonds);
    const std::vector<Parcel> parcels = collect(lattice, liquids, bonds, particles);
    for (PointBond& bond : bonds) {
        Vec3 momentum;
        bond.bound = bond.velocity = {};
        lattice.visit(bond.place, [&](std::size_t at, double weight) {
            const Parcel& parcel = parcels[at];
            if (!(parcel.mass > 0)) return;
            const Vec3 part = parcel.bound(weight * bond.drag);
            bond.bound += part;
            momentum += scale(part, parcel.momentum / parcel.mass);
        });
        for (int axis = 0; axis < 3; ++axis) {
            if (bond.bound[axis] > 0) bond.velocity[axis] = momentum[axis] / bond.bound[axis];
        }
    }
}

void push_bonds(double cell, const Mixture& liquids, std::span<const PointBond> bonds, std::span<const Vec3> impulses,
                std::span<FluidParticle> particles) {
    if (bonds.empty()) return;
    Lattice lattice(cell, bonds);
    std::vector<Parcel> parcels = collect(lattice, liquids, bonds, particles);
    for (std::size_t i = 0; i < bonds.size(); ++i) {
        lattice.visit(bonds[i].place, [&](std::size_t at, double weight) {
            Parcel& parcel = parcels[at];
            if (!(parcel.mass > 0)) return;
            const Vec3 part = parcel.bound(weight * bonds[i].drag);
            for (int axis = 0; axis < 3; ++axis) {
                if (part[axis] > 0)
                    parcel.change[axis] += impulses[i][axis] * part[axis] / (bonds[i].bound[axis] * parcel.mass);
            }
        });
    }
    for (FluidParticle& particle : particles) {
        Vec3 change;
        lattice.visit(to_vec(particle.position),
                      [&](std::size_t at, double weight) { change += weight * parcels[at].change; });
        for (int axis = 0; axis < 3; ++axis) particle.velocity[axis] += static_cast<float>(change[axis]);
    }
}

}  // namespace embody::physics::fluid
