// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <variant>

#include "math/bounds.h"
#include "physics/definitions/step_report.h"
#include "physics/deformable/cloth/cloth_sheet.h"
#include "physics/deformable/rope/rope_line.h"
#include "physics/deformable/solid/solid_contacts.h"
#include "physics/state/namespace.h"

namespace embody::physics::state {

/// The force of a sheet's or rope's node on a triangle of a solid.
struct SurfacePush {
    std::uint32_t slot = 0, node = 0;         ///< of the solid; node of the sheet
    std::array<std::uint32_t, 3> triangle{};  ///< nodes of the solid
    std::array<double, 3> weight{};           ///< weights of these nodes at the contact
    Vec3 force;                               ///< on the solid, N
};

/// What a solid touches, since it came there.
struct SolidBounce {
    std::uint64_t partner = 0;  ///< as of SolidContact
    bool has_body = false;      ///< else the partner is a solid
    double pushes = 0;          ///< sum of the pushes of all substeps since then, N
    Vec3 normals, arms;         ///< of these, times the pushes: from the partner to the solid; from the solid's centre
    double approach = 0;        ///< speed at which it came, m/s; 0: too slow to bounce
    double speed = 0;           ///< away from the partner at the end of the last substep, m/s
    bool has_come_back = false;
};

/// What the step of the liquids before expects of a deformable's elastic forces and contacts
/// (docs/physics/coupling.md).
struct LiquidMemory {
    std::uint64_t step = 0;                   ///< last step in which a liquid touched it
    std::vector<Vec3> velocity;               ///< of the nodes when that step began, m/s
    std::vector<Vec3> force;                  ///< of the liquids on the nodes in the step before, N
    std::vector<Vec3> bound, bound_momentum;  ///< as of SeenDeformable, of all fluids in this step
    std::vector<Vec3> acceleration;           ///< that is expected of the nodes without the liquids, m/s²
    std::vector<Vec3> force_asleep;           ///< of the liquids on the nodes in the last step before it fell asleep, N
    bool wakes = false;                       ///< a liquid that it lies asleep in is not quiet any more
};

/// A deformable with the data for its contacts and its sleep.
struct DeformableRecord {
    DeformableDefinition definition;
    std::variant<std::unique_ptr<SolidDeformable>, std::unique_ptr<ClothSheet>, std::unique_ptr<RopeLine>> matter;
    std::unique_ptr<CollisionShape> node_ball;              ///< of its contact radius
    std::vector<std::unique_ptr<CollisionShape>> capsules;  ///< of a rope's segments at rest, one a length
    std::vector<std::uint32_t> segment_capsule;             ///< by segment: index of its capsule
    std::vector<SolidContact> contacts;                     ///< a solid's contacts of the last step
    std::vector<SolidBounce> bounces;                       ///< a solid's
    std::vector<std::uint32_t> touched_bodies;              ///< slots of bodies that it pushed in the last step
    std::vector<std::uint32_t> touched_deformables;         ///< slots
    /// The state of a body that it pushed, at that time.
    struct Support {
        BodyHandle body;
        std::uint32_t version = 0;
    };
    std::vector<Support> supports;
    std::vector<SurfacePush> surface_pushes;  ///< a sheet's or rope's, of its last substep
    std::vector<Vec3> tie_pulls;              ///< by tie: of the last substep, on its node, N
    std::uint32_t slot = 0;                   ///< its own slot, while it moves
    LiquidMemory liquid;
    double quiet_time = 0;           ///< s
    std::vector<Vec3> quiet_places;  ///< places of a sheet's or rope's nodes when the quiet time began
    bool is_asleep = false;
    std::vector<Vec3> last_positions;  ///< last finite positions, to freeze it at
    std::vector<TornCorner> torn;      ///< a sheet's; its definition is the torn one

    // The matter as that kind; null where it is of another kind.
    [[nodiscard]] SolidDeformable* solid() const { return of_kind<SolidDeformable>(); }
    [[nodiscard]] ClothSheet* cloth() const { return of_kind<ClothSheet>(); }
    [[nodiscard]] RopeLine* rope() const { return of_kind<RopeLine>(); }

    [[nodiscard]] const Nodes& nodes() const;
    [[nodiscard]] Bounds bounds() const;
    [[nodiscard]] bool is_finite() const;
    [[nodiscard]] Conserved conserved(Vec3 gravity) const;
    /// Acceleration of each node by gravity (m/s², the world's) and its constant force, m/s².
    [[nodiscard]] Vec3 acceleration(Vec3 gravity) const;
    /// Whether both are solids of the same tetrahedra.
    [[nodiscard]] bool has_tetrahedra_of(const DeformableRecord& other) const;
    /// Whether both are ropes, or sheets of the same triangles: for equal numbers of nodes, their edges are the same.
    [[nodiscard]] bool has_surface_of(const DeformableRecord& other) const;
    /// Approximate rotation of the whole.
    [[nodiscard]] Quat rotation() const;
    /// Puts its nodes to places (m) with velocities (m/s), one a node; `rotation` as above. Pinned ones get no
    /// velocity.
    void set_motion(std::span<const Vec3> positions, std::span<const Vec3> velocities, Quat rotation);
    /// Before a substep of h seconds of a sheet or rope, alone in its group or not; see change_substep().
    void begin_substep(double h, Vec3 gravity, bool is_alone);
    /// Of the nodes of a sheet or rope, one a node, m/s, over a substep of so many seconds.
    void set_mean_velocities(std::vector<Vec3> velocities, double substep);
    /// Sets the forces of liquids on the nodes, N; empty: none.
    void set_liquid_force(std::span<const Vec3> force);
    /// Sets the flow around a sheet's or rope's nodes; empty: none.
    void set_flow(std::vector<NodeFlow> flow);
    /// Sets all velocities to zero.
    void rest();
    /// Puts its nodes at these positions, at rest.
    void stop_at(std::span<const Vec3> positions);

private:
    /// Of a sheet or rope: whether nothing held, pushed or touched it in the last substep.
    [[nodiscard]] bool is_let_alone() const;
    template <class Matter>
    [[nodiscard]] Matter* of_kind() const {
        const auto* found = std::get_if<std::unique_ptr<Matter>>(&matter);
        return found == nullptr ? nullptr : found->get();
    }
};

/// The record of the same sheet with these corners torn: its nodes stay where they are and move as they do.
Result<DeformableRecord> make_torn_record(const DeformableRecord& record, std::span<const TornCorner> corners);

/// Makes the record of a valid definition. Fails where a shape for its contacts cannot be made.
Result<DeformableRecord> make_deformable_record(const DeformableDefinition& definition);

}  // namespace embody::physics::state
