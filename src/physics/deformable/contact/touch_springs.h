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
#include "physics/deformable/contact/touch_spring.h"
#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

/// A point between two neighbours of a line, over a plane of a body.
struct SegmentContact {
    std::uint32_t node = 0;       ///< the first; the second comes after it
    double along = 0.5;           ///< 0 … 1 from the first to the second
    NodeContact plane;            ///< `node` does not count
    double curvature_radius = 0;  ///< of a round body along the line, m; 0: it does not roll there
};

/// A point of a sheet between two or three of its nodes, over a plane of a body.
struct SheetContact {
    std::array<std::uint32_t, 3> node{};
    std::array<double, 3> weight{};
    int count = 2;
    TouchFeature feature{};
    NodeContact plane;  ///< `node` does not count
};

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
    /// Of each node with its neighbours, by direction, N/m, set before begin(): a rope gives way across its line by a
    /// thousandth of what it does along it. Empty: as begin() is told, in each direction.
    std::vector<Mat3> directed_stiffness;
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
    // What each node bears of bodies that move, kg.
    [[nodiscard]] std::vector<double> loads_of(std::span<const TouchedBody> bodies, std::size_t node_count) const;
    void bring_back(const Substep& substep, TouchSpring& spring) const;
    // After the spring of that contact.
    void add_rolling(const Nodes& nodes, const SegmentContact& contact, const Substep& substep);
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
    std::vector<double> loads_;   // as of loads_of(), where forgets_depth
    std::vector<Place> places_;   // of the bodies, at the substep's end
    std::vector<Vec3> leads_;     // of the springs, by the solve's moves
};

}  // namespace embody::physics::deformable
