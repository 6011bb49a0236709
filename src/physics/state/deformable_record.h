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

/// What a node of a sheet or rope pushes a triangle of a solid.
struct SurfacePush {
    std::uint32_t slot = 0, node = 0;         ///< the solid's, the sheet's
    std::array<std::uint32_t, 3> triangle{};  ///< nodes of the solid
    std::array<double, 3> weight{};           ///< of these where it touches
    Vec3 force;                               ///< on the solid, N
};

/// A deformable with what its contacts and its sleep need.
struct DeformableRecord {
    DeformableDefinition definition;
    std::variant<std::unique_ptr<SolidDeformable>, std::unique_ptr<ClothSheet>, std::unique_ptr<RopeLine>> matter;
    std::unique_ptr<CollisionShape> node_ball;              ///< of its contact radius
    std::vector<std::unique_ptr<CollisionShape>> capsules;  ///< of a rope's segments at rest, one a length
    std::vector<std::uint32_t> segment_capsule;             ///< by segment: index of its capsule
    std::vector<SolidContact> contacts;                     ///< a solid's of the last step
    std::vector<std::uint32_t> touched_bodies;              ///< slots: those that it pushed in the last step
    std::vector<std::uint32_t> touched_deformables;         ///< slots
    /// A body that it pushed, as it then was.
    struct Support {
        BodyHandle body;
        std::uint32_t version = 0;
    };
    std::vector<Support> supports;
    std::vector<SurfacePush> surface_pushes;  ///< a sheet's or rope's, of its last substep
    std::vector<Vec3> tie_pulls;              ///< by tie: of the last substep, on its node, N
    std::uint32_t slot = 0;                   ///< its own, while it moves
    double quiet_time = 0;                    ///< s
    std::vector<Vec3> quiet_places;           ///< of a sheet's or rope's nodes when that began
    bool is_asleep = false;
    std::vector<Vec3> last_positions;  ///< last finite ones, to freeze it at

    // The matter where it is of that kind; else null.
    [[nodiscard]] SolidDeformable* solid() const { return of_kind<SolidDeformable>(); }
    [[nodiscard]] ClothSheet* cloth() const { return of_kind<ClothSheet>(); }
    [[nodiscard]] RopeLine* rope() const { return of_kind<RopeLine>(); }

    [[nodiscard]] const Nodes& nodes() const;
    [[nodiscard]] Bounds bounds() const;
    [[nodiscard]] bool is_finite() const;
    [[nodiscard]] Conserved conserved(Vec3 gravity) const;
    /// What gravity (m/s², the world's) and its constant force give each node, m/s².
    [[nodiscard]] Vec3 acceleration(Vec3 gravity) const;
    /// Whether both are solids of the same tetrahedra.
    [[nodiscard]] bool has_tetrahedra_of(const DeformableRecord& other) const;
    /// Not far from how the whole is turned.
    [[nodiscard]] Quat rotation() const;
    /// Puts its nodes to places (m) with velocities (m/s), one a node; `rotation` as above. Pinned ones get no
    /// velocity.
    void set_motion(std::span<const Vec3> positions, std::span<const Vec3> velocities, Quat rotation);
    /// Takes all velocities away.
    void rest();
    /// Takes it back to where its nodes were, at rest.
    void stop_at(std::span<const Vec3> positions);

private:
    template <class Matter>
    [[nodiscard]] Matter* of_kind() const {
        const auto* found = std::get_if<std::unique_ptr<Matter>>(&matter);
        return found == nullptr ? nullptr : found->get();
    }
};

/// Of a valid definition. Fails where a shape for its contacts cannot be made.
Result<DeformableRecord> make_deformable_record(const DeformableDefinition& definition);

}  // namespace embody::physics::state
