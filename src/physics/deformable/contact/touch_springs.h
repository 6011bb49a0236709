// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "math/mat3.h"
#include "physics/definitions/deformable_definition.h"
#include "physics/deformable/contact/node_contacts.h"
#include "physics/deformable/contact/substep.h"
#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

/// Displacement of a body off its path by the pushes of a substep: m, rad.
struct BodyMove {
    Vec3 shift, turn;
};

/// The move of a point at `arm` when the body's unknown c (three of its place, three of its turn) goes by one.
inline Vec3 unit_move(std::size_t c, Vec3 arm) {
    Vec3 axis;
    axis[static_cast<int>(c % 3)] = 1;
    return c < 3 ? axis : cross(axis, arm);
}

inline constexpr std::uint32_t no_body = 0xFFFFFFFFu;
inline constexpr std::uint32_t no_node = 0xFFFFFFFFu;

/// Inertia of bodies within a substep of h seconds, for those that pushes move.
struct BodyInertia {
    bool moves = false;
    double mass = 0;  ///< over the substep squared, kg/s²
    Mat3 inertia = Mat3::zero();
};
std::vector<BodyInertia> inertias_of(std::span<const TouchedBody> bodies, double h);

/// A point between two neighbours of a line, over a plane of a body.
struct SegmentContact {
    std::uint32_t node = 0;  ///< the first; the second comes after it
    double along = 0.5;      ///< 0 … 1 from the first to the second
    NodeContact plane;       ///< `node` does not count
};

/// Feature of a deformable that touches, the same from substep to substep: a node and no_node, the two ends of an edge,
/// or no_node and the number of a body's feature that pokes into a triangle.
using TouchFeature = std::array<std::uint32_t, 2>;

/// A point of a sheet between two or three of its nodes, over a plane of a body.
struct SheetContact {
    std::array<std::uint32_t, 3> node{};
    std::array<double, 3> weight{};
    int count = 2;
    TouchFeature feature{};
    NodeContact plane;  ///< `node` does not count
};

/// What holds a point of a deformable, Σ weight x, off a plane or to an anchor of a body: the force
///   load - matrix s
/// on the point, where s is its displacement in the substep beyond that of the touched body by its pushes.
struct TouchSpring {
    std::array<std::uint32_t, 4> node{};
    std::array<double, 4> weight{};
    int count = 1;                 ///< of nodes
    TouchFeature feature{};        ///< with the body: its anchor; about that direction: what is remembered
    std::uint32_t body = no_body;  ///< index in the list of bodies
    bool is_attachment = false;    ///< pulls too, in every direction
    bool is_recovery = false;      ///< of a point that began inside: its force is forgotten
    Vec3 normal;                   ///< unit, towards the point, at the end of the substep
    Vec3 arm;                      ///< from the body's centre of mass to what is touched, then
    PairFriction friction;         ///< of the two surfaces
    bool sticks = true;            ///< holds by static friction until its limit is left
    bool predicts_slip = false;    ///< as of TouchSprings
    double gap = 0;                ///< at the end of the substep if the point stays, m
    double overlap = 0;            ///< at the substep's start, of a contact with a body, m
    double returned = 0;           ///< part of an overlap that the substep takes back and that is not remembered, m
    Vec3 carried;                  ///< displacement of the body's surface in the substep on its path, m
    double stiffness = 0;          ///< maximum of both directions, N/m
    double inertia = 0;            ///< mass of the point over the substep squared, N/m
    double body_compliance = 0;    ///< of a body that moves, across the normal, at most, m/N
    Vec3 pull;                     ///< force that the spring had at the last substep's end, N: the push is along n
    Vec3 hold;                     ///< tangential stretch of the spring while it sticks, m

    bool acts = false;
    Vec3 felt;                   ///< force on the point in the substep that finish() ended, N
    Mat3 matrix = Mat3::zero();  ///< symmetric, not negative, N/m
    Vec3 load;

    /// Force on the point for that displacement relative to the body.
    [[nodiscard]] Vec3 force(Vec3 s) const { return load - matrix * s; }
    [[nodiscard]] Vec3 lead(std::span<const Vec3> node_moves, std::span<const BodyMove> body_moves) const;
};

inline bool moves_body(const TouchSpring& spring, std::span<const BodyInertia> bodies) {
    return spring.body != no_body && bodies[spring.body].moves;
}

/// Terms of the function that a solve minimises: of a spring that acts, of a body's moves; J.
double energy_of(const TouchSpring& spring, std::span<const Vec3> node_moves, std::span<const BodyMove> body_moves);
double energy_of(const BodyInertia& inertia, const BodyMove& move);
/// The same for a spring regardless of whether it acted in the solve: for a contact, which only pushes, without
/// friction.
double energy_pressed(const TouchSpring& spring, std::span<const Vec3> node_moves,
                      std::span<const BodyMove> body_moves);

/// One of these two ways to count a spring's energy.
using SpringEnergy = double (*)(const TouchSpring&, std::span<const Vec3>, std::span<const BodyMove>);

/// For each body, the fraction of the springs' push for these moves that it may get: 1 where the push moves it as in
/// the solve, less where a solve that has not converged left stiff springs with far more.
std::vector<double> fractions_of(std::span<const TouchSpring> springs, std::span<const Vec3> node_moves,
                                 std::span<const BodyMove> body_moves, std::span<const BodyInertia> inertias,
                                 const Substep& substep);

/// Change of the contacts' forces, N, the forces of contacts that act, and the forces of all contacts that might act:
/// the finer and the coarser measure.
struct SpringChange {
    double change = 0, acting = 0, near = 0;
};
/// Determines whether a contact acts, and how its friction does, for that relative displacement (m). `is_predicted`:
/// the moves are by inertia alone and no measure of forces; the forces of the last substep are.
void choose_contact(TouchSpring& spring, Vec3 s, bool is_predicted, SpringChange& sum);
/// After a substep: returns what is left of a tangential stretch (m) that the contact cannot hold with that push (N);
/// stores whether it sticks. `h`: of the substep, s.
Vec3 held_stretch(TouchSpring& spring, Vec3 stretch, double push, double h);
/// Of a contact or tie between sheets and ropes, N/m: over the inertia of the heavier point (`mass`, kg), or of the
/// load on it by `force` (N), in a substep of h seconds. `gravity`: m/s².
double contact_stiffness(double mass, double force, double h, double gravity, const ThinContactSettings& settings);
/// What a contact remembers of that push, N: all but what `returned` took.
double kept_push(const TouchSpring& spring, double push);
/// The part of v along a plane.
inline Vec3 across(Vec3 v, Vec3 normal) { return v - dot(v, normal) * normal; }

/// Contacts and attachments of one deformable as springs with memory. A spring starts with its force of the last
/// substep, so the force grows until the point no longer moves: with a finite stiffness it acts like a hard contact
/// (method of multipliers, one iteration a substep; stable from the node's own stiffness on). What is held inside
/// something forgets it (forgets_depth). Friction is a spring along the plane that slips at Coulomb's limit.
class TouchSprings {
public:
    /// Begins a substep: `radius` and `material` of the deformable; `node_stiffness`: stiffness of the node's
    /// neighbours together, N/m. Contacts that may close in the substep count, but none of a node with a body that it
    /// is attached to.
    void begin(const Nodes& nodes, std::span<const NodeContact> contacts, std::span<const TouchedBody> bodies,
               const Substep& substep, std::span<const double> node_stiffness);
    /// After begin(): adds a contact of a point of a line.
    void add(const Nodes& nodes, const SegmentContact& contact, std::span<const TouchedBody> bodies,
             const Substep& substep, std::span<const double> node_stiffness);
    /// After begin(): adds a contact of a point of a sheet. It is softer than that of a node, as the solver includes
    /// only each node's own part of it.
    void add(const Nodes& nodes, const SheetContact& contact, std::span<const TouchedBody> bodies,
             const Substep& substep);
    /// Determines which springs act, and how friction does, for these moves. True where that has changed enough for a
    /// further solve. `is_predicted`: as of choose_contact().
    bool choose(std::span<const Vec3> node_moves, std::span<const BodyMove> body_moves, bool is_predicted);
    /// Continues with the last forces of the contacts of another deformable of as many nodes.
    void go_on_from(const TouchSprings& other) { memory_ = other.memory_; }
    /// Pushes the bodies, and stores forces and anchors. Changes moves of nodes that came in where no spring acted.
    /// `fractions`: as of fractions_of(), or none.
    void finish(std::span<Vec3> node_moves, std::span<const BodyMove> body_moves, const Substep& substep,
                std::span<TouchedBody> bodies, std::span<const double> fractions = {});

    [[nodiscard]] std::span<const TouchSpring> springs() const { return springs_; }
    [[nodiscard]] bool any_acts() const { return std::ranges::any_of(springs_, &TouchSpring::acts); }

    double radius = 1e-3;                                       ///< m
    Material material;                                          ///< of the deformable's surface
    double tolerance = ThinContactSettings{}.change_tolerance;  ///< relative change of the forces that needs no solve,
                                                                ///< set before begin()
    /// Expects of a sliding point the further slip that the excess of its friction over the limit would make: for few
    /// solves, where the secant alone comes too slowly to its slip.
    bool predicts_slip = false;
    /// Remembers the less of a force the deeper its node has come into a body: for sheets. Ropes need all of it: one of
    /// 100 kg that lies in a light box would go on through it.
    bool forgets_depth = false;
    std::vector<Attachment> attachments;           ///< that still hold
    std::vector<std::uint32_t> attachment_bodies;  ///< index of each in the list of bodies, set before begin()

private:
    struct Memory {
        TouchFeature feature{};
        std::uint32_t slot = 0;
        bool is_attachment = false, sticks = true;
        Vec3 normal, pull, hold;
    };
    struct Place {
        Vec3 center;
        Mat3 rotation;
        Vec3 displacement;             // of the centre in the substep, m
        Mat3 back = Mat3::identity();  // what turns directions of its end to those of its start
        /// Displacement in the substep of the point that is there then, m.
        [[nodiscard]] Vec3 displacement_of(Vec3 arm) const { return displacement + arm - back * arm; }
    };
    static Place place_of(const TouchedBody& body, const Substep& substep);
    // Sets the stiffness of a contact at a point, once its nodes and weights are known. Without stiffness of nodes: by
    // inertia and load.
    void complete(const Nodes& nodes, const NodeContact& plane, std::span<const TouchedBody> bodies,
                  const Substep& substep, std::span<const double> node_stiffness, TouchSpring& spring);
    void bring_back(const Substep& substep, TouchSpring& spring) const;
    void forget_contradictions(std::span<const TouchedBody> bodies, const Substep& substep, std::size_t node_count);
    void soften(const Substep& substep, double compliance, bool is_with_body, TouchSpring& spring) const;
    [[nodiscard]] bool is_attached(std::uint32_t node, std::uint32_t body) const;
    // False where the contact is new.
    bool recall(const TouchedBody& body, const ThinContactSettings& settings, TouchSpring& spring) const;
    static bool stop(TouchSpring& spring, std::span<Vec3> node_moves, std::span<BodyMove> body_moves,
                     std::span<const TouchedBody> bodies, double h);

    std::vector<TouchSpring> springs_;
    std::vector<Memory> memory_;  // by feature
    double max_load_ = 0;         // mass of the nodes and of the bodies beside them that move, kg
    std::vector<Place> places_;   // of the bodies, at the substep's end
    std::vector<Vec3> leads_;     // of the springs, by the solve's moves
};

}  // namespace embody::physics::deformable
