// SPDX-License-Identifier: MIT
#include "scene/matter/momenta.h"

#include <cmath>
#include <limits>

namespace embody::scene {

namespace {

// The two numbers of single precision at both sides of a number.
struct Neighbours {
    float nearest, other;

    explicit Neighbours(double number) : nearest(static_cast<float>(number)), other(nearest) {
        constexpr float infinity = std::numeric_limits<float>::infinity();
        if (static_cast<double>(nearest) != number)
            other = std::nextafterf(nearest, static_cast<double>(nearest) < number ? infinity : -infinity);
    }
};

// What rounding has done to the momenta of particles of mass one so far. Each is rounded so that it stays small, and so
// smaller than a particle's own rounding whatever their number.
class RoundingError {
public:
    explicit RoundingError(double radius_squared) : radius_squared_(radius_squared) {}

    // `place` from the particles' mean place.
    Vec3 rounded(Vec3 velocity, Vec3 place) {
        const Neighbours x(velocity.x), y(velocity.y), z(velocity.z);
        Vec3 best, best_linear, best_angular;
        double least = std::numeric_limits<double>::infinity();
        for (unsigned choice = 0; choice < 8; ++choice) {
            const Vec3 candidate =
                to_vec3(Vec3f{(choice & 1) != 0 ? x.other : x.nearest, (choice & 2) != 0 ? y.other : y.nearest,
                              (choice & 4) != 0 ? z.other : z.nearest});
            const Vec3 linear = linear_ + (candidate - velocity);
            const Vec3 angular = angular_ + cross(place, candidate - velocity);
            const double size = dot(linear, linear) * radius_squared_ + dot(angular, angular);
            if (!(size < least)) continue;
            least = size;
            best = candidate;
            best_linear = linear;
            best_angular = angular;
        }
        linear_ = best_linear;
        angular_ = best_angular;
        return best;
    }

private:
    double radius_squared_;  // of gyration, m²
    Vec3 linear_, angular_;
};

}  // namespace

ParticleMoments moments_of(std::span<const Vec3> places, double mass) {
    ParticleMoments moments;
    for (const Vec3 place : places) moments.mean += place;
    moments.mean = moments.mean / static_cast<double>(places.size());
    moments.inertia = Mat3::zero();
    for (const Vec3 place : places) {
        const Vec3 r = place - moments.mean;
        moments.inertia += mass * (dot(r, r) * Mat3::identity() - outer(r, r));
    }
    return moments;
}

Momenta momenta_of(std::span<const Vec3> places, std::span<const Vec3> velocities, double mass) {
    Momenta momenta;
    momenta.mass = mass * static_cast<double>(places.size());
    for (const Vec3 place : places) momenta.center += place;
    momenta.center = momenta.center / static_cast<double>(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
        momenta.linear += mass * velocities[i];
        momenta.angular += mass * cross(places[i] - momenta.center, velocities[i]);
    }
    return momenta;
}

bool can_turn(const ParticleMoments& moments) {
    constexpr double rounding = 1e-9;  // of the smallest moment beside the others
    const Vec3 values = eigen_symmetric(moments.inertia).values;
    return values.x > rounding * values.z;
}

std::vector<Vec3> with_momenta(std::span<const Vec3> places, std::span<const Vec3> velocities, double mass,
                               const Momenta& momenta) {
    const ParticleMoments moments = moments_of(places, mass);
    const Momenta before = momenta_of(places, velocities, mass);
    // What is lacking, about the particles' mean place.
    const Vec3 linear = momenta.linear - before.linear;
    const Vec3 angular = momenta.angular + cross(momenta.center - moments.mean, momenta.linear) - before.angular;
    const Vec3 shift = linear / before.mass, spin = solve(moments.inertia, angular);
    RoundingError error(trace(moments.inertia) / (2 * before.mass));
    std::vector<Vec3> changed;
    changed.reserve(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
        const Vec3 r = places[i] - moments.mean;
        changed.push_back(error.rounded(velocities[i] + shift + cross(spin, r), r));
    }
    return changed;
}

}  // namespace embody::scene
