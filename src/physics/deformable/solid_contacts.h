// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "physics/deformable/node_contacts.h"
#include "physics/deformable/solid_deformable.h"

namespace embody::physics {

/// A point that up to three nodes of a solid carry.
struct CarriedPoint {
    std::uint32_t solid = 0;  ///< index in the list of solids
    std::uint32_t count = 0;
    std::array<std::uint32_t, 3> node{};
    std::array<double, 3> weight{};  ///< their sum is 1
};

/// A place where a solid may touch a body, or is held to it.
struct SolidContact {
    CarriedPoint point;
    std::uint32_t body = 0;  ///< index in the list of bodies
    std::uint32_t slot = 0;  ///< of that body
    Vec3 anchor, normal;     ///< on the body, from its centre of mass, and from it to the solid; when the step began
    double radius = 0;       ///< distance that the two keep, m
    double friction = 0;     ///< Coulomb coefficient of the pair
    bool holds = false;      ///< the point stays at the anchor, whatever it takes
    Vec3 force;              ///< on the solid in the last substep, N; what the next one begins with
};

/// Hard contacts with Coulomb friction, and attachments, of all solids with all bodies in a substep: projected
/// Gauss-Seidel on forces p (paper, eqs. (4) and (7)),
///
///   gap = gap of the free motion + W p >= 0, p >= 0, gap p = 0,    |p_t| <= μ p_n against the sliding,
///
/// with W what the solids' factors say of the touched nodes and the masses of the bodies.
class SolidContacts {
public:
    using Solids = std::span<SolidDeformable* const>;

    /// Lets the forces that are remembered act on solids and bodies; before the solids' solve().
    static void begin(std::span<const SolidContact> contacts, Solids solids, std::span<TouchedBody> bodies, double h);
    /// Finds the forces for a substep of h seconds that ends `time` (s) after the step began, settles the solids.
    void solve(std::span<SolidContact> contacts, Solids solids, std::span<TouchedBody> bodies, double h, double time,
               TaskPool& workers);

private:
    enum class State : std::uint8_t { open, sticks, slides, holds };
    /// A contact in this substep, in world axes.
    struct Active {
        SolidContact* contact = nullptr;
        std::array<std::uint32_t, 3> local{};  ///< of its nodes in the list of the solid's touched nodes
        Vec3 normal, arm;                      ///< arm: from the body's centre
        double gap = 0, target = 0;            ///< of the free motion, and the least allowed, m
        Vec3 slid;                             ///< relative motion in the substep, free, m
        Vec3 shift, turn;                      ///< of the body when `gap` was taken
        Mat3 give = Mat3::zero();              ///< relative motion by a force on it, m/N
        State state = State::open;
        Vec3 change, direction;   ///< of the force, N: by conjugate gradients
        Vec3 residual, response;  ///< m
    };
    /// The touched nodes of a solid.
    struct Touched {
        std::vector<std::uint32_t> nodes;
        std::vector<std::uint32_t> local_of;  ///< by node; only those in `nodes` count
        std::vector<Quat> rotation;
        std::size_t stride = 0;  ///< numbers from one row to the next
        std::vector<float>
            compliance;            ///< of node j nine rows over all nodes i: element (r, c) of W(i, j) in row 3 c + r
        std::vector<float> moved;  ///< by forces of this solve, in the nodes' axes at rest, m: rows x, y, z
        std::vector<Vec3> force;   ///< of this solve, world, N
        [[nodiscard]] Mat3 block(std::size_t i, std::size_t j) const;
        std::vector<float> probe;       ///< as `moved`, by probe_force
        std::vector<Vec3> probe_force;  ///< N
        [[nodiscard]] Vec3 move_of(std::size_t i, std::span<const float> moves) const;
        void push(std::size_t j, Vec3 force);
        void add_moves(std::size_t j, Vec3 force, std::span<float> moves) const;
    };
    void gather(std::span<SolidContact> contacts, Solids solids, std::span<TouchedBody> bodies, double h, double time);
    void gather_nodes(Solids solids);
    void find_give(Active& active, const TouchedBody& body, double h) const;
    [[nodiscard]] Vec3 moved(const Active& active, const TouchedBody& body) const;
    void apply(const Active& active, TouchedBody& body, Vec3 force, double h);
    double relax(Active& active, TouchedBody& body, double h);
    double sweep(std::span<TouchedBody> bodies, double h, bool forwards);
    void solve_together(std::span<TouchedBody> bodies, double h);
    void respond(std::span<const TouchedBody> bodies, double h);
    [[nodiscard]] Vec3 missing(const Active& active, const TouchedBody& body) const;
    static void find_state(Active& active);
    [[nodiscard]] static Vec3 free_part(const Active& active, Vec3 v);

    std::vector<Active> active_;
    std::vector<Touched> touched_;
    std::vector<Vec3> probe_forces_, probe_torques_;  // by body, N and N m
};

}  // namespace embody::physics
