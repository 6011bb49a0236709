// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "physics/definitions/settings/solid_settings.h"
#include "physics/deformable/contact/touched_body.h"
#include "physics/deformable/namespace.h"
#include "physics/deformable/solid/solid_contact.h"
#include "physics/deformable/solid/touched_nodes.h"

namespace embody::physics::deformable {

/// Hard contacts with Coulomb friction, and attachments, of all solids with bodies and each other in a substep: forces
/// p (paper, eqs. (4) and (7)) with
///
///   gap = gap of the free motion + W p >= 0,  p >= 0,  gap p = 0,    |p_t| <= μ p_n against the sliding,
///
/// W by the solids' metrics at the touched nodes and the masses of the bodies (docs/physics/deformables.md).
class SolidContacts {
public:
    using Solids = std::span<SolidDeformable* const>;

    /// Lets the forces that are remembered, and those of what bears the bodies, act on solids and bodies; before the
    /// solids' solve().
    static void begin(std::span<const SolidContact> contacts, Solids solids, std::span<TouchedBody> bodies, double h,
                      double time);
    /// A substep of h seconds that ends `time` (s) after the step began.
    struct Substep {
        double h = 0, time = 0;
        SolidContactSettings settings = {};
    };
    /// Finds the forces for the substep, settles the solids.
    void solve(std::span<SolidContact> contacts, Solids solids, std::span<TouchedBody> bodies, const Substep& substep,
               TaskPool& workers);

private:
    enum class State : std::uint8_t { open, sticks, slides, holds };
    /// A touched node that takes part in a contact.
    struct Term {
        std::uint32_t solid = 0, number = 0;
        double weight = 0;  ///< negative on the other side
    };
    /// A contact's part of the vectors in linear/conjugate_gradient.h.
    struct ContactGradient {
        Vec3 x, z, p;  ///< changes of the force, N
        Vec3 r, q;     ///< relative motions, m
    };
    /// A contact in this substep, in world axes.
    struct Active {
        SolidContact* contact = nullptr;
        std::array<Term, 6> terms{};
        std::size_t term_count = 0;
        TouchedBody* body = nullptr;     ///< none: between solids
        BodySupport* support = nullptr;  ///< that this is: no solid takes part
        Mat3 held = Mat3::identity();    ///< projection onto the directions in which it holds
        Vec3 normal, arm;                ///< arm: from the body's centre
        double gap = 0, target = 0;      ///< of the free motion, and the minimum allowed, m
        Vec3 slid;                       ///< relative motion in the substep, free, m
        Vec3 shift, turn;                ///< of the body when `gap` was taken
        Mat3 compliance = Mat3::zero();  ///< relative motion by a force on it, m/N
        State state = State::open;
        Vec3 before, best;         ///< force before a sweep, and of the best iteration, N
        Vec3 direction;            ///< of sweeps with conjugate directions, N
        ContactGradient gradient;  ///< of the solve of all at once
    };
    /// Contacts that are coupled, with solids and bodies that no other group moves.
    struct Group {
        std::vector<Active*> active;
        std::vector<std::uint32_t> solids, bodies;
    };
    void gather(std::span<SolidContact> contacts, Solids solids, std::span<TouchedBody> bodies, double h, double time);
    void gather_supports(std::span<TouchedBody> bodies, double h, double time);
    static void place_support(Active& active, double h, double time);
    void end_supports() const;
    void place_against_body(Active& active, Vec3 at, Vec3 was, double h, double time) const;
    void add_terms(Active& active, const CarriedPoint& point, double sign);
    void find_compliance(Active& active, double h) const;
    [[nodiscard]] Vec3 moved(const Active& active) const;
    void apply(const Active& active, Vec3 force, double h);
    [[nodiscard]] static Mat3 compliance_of_held(const Active& active);
    double relax(Active& active, double h);
    void find_groups(std::size_t solids, std::span<const TouchedBody> bodies);
    void find_forces(double h, TaskPool& workers);
    void find_forces(const Group& group, double h, TaskPool& workers);
    void lean_on(const Group& group, double factor, double h);
    double sweep(const Group& group, double h, bool forwards);
    void settle_bodies(const Group& group, double h);
    void solve_together(const Group& group, double h, TaskPool& workers);
    void respond(const Group& group, double h, TaskPool& workers);
    void probe(const Group& group, TaskPool& workers);
    [[nodiscard]] static Vec3 within_cone(Vec3 force, Vec3 normal, double friction);
    [[nodiscard]] Vec3 soft_part(const Active& active, Vec3 force) const;
    [[nodiscard]] Vec3 missing(const Active& active) const;
    static void find_state(Active& active);
    void note_sticking(const Active& active, double h);
    [[nodiscard]] static double precondition(Active& active);
    [[nodiscard]] static Vec3 free_part(const Active& active, Vec3 v);

    SolidContactSettings settings_;  // of the substep
    std::vector<Active> active_;
    std::vector<SolidContact> supports_;  // those of the bodies in active_, of which they are the last
    std::vector<Group> groups_;
    std::vector<TouchedNodes> touched_;               // by solid
    std::vector<Vec3> probe_forces_, probe_torques_;  // by body, N and N m
};

}  // namespace embody::physics::deformable
