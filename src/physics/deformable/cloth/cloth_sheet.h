// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <optional>

#include "foundation/task_pool.h"
#include "physics/deformable/cloth/bend_memory.h"
#include "physics/deformable/cloth/cloth_layers.h"
#include "physics/deformable/cloth/cloth_mesh.h"
#include "physics/deformable/cloth/cloth_solver.h"
#include "physics/deformable/cloth/sheet_gas.h"
#include "physics/deformable/cloth/sheet_tear.h"
#include "physics/deformable/contact/nodes.h"
#include "physics/deformable/contact/touch_springs.h"
#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

/// Cloth that moves: membrane of warp, weft and shear, bending, air, contacts, by backward Euler with linear
/// solves for the elastic forces (docs/physics/cloth.md).
class ClothSheet {
public:
    /// `definition` is valid and its matter is cloth.
    explicit ClothSheet(const DeformableDefinition& definition);

    // A substep: sheets and ropes that touch each other are solved together (docs/physics/cloth.md).
    /// Finds system() and touch() for the part, about its place at the part's start. `attachment_bodies`: where the
    /// attachments hold in `bodies`.
    void begin(const Substep& substep, std::span<const NodeContact> contacts, std::span<const SheetContact> between,
               std::span<const std::uint32_t> attachment_bodies, std::span<const TouchedBody> bodies,
               TaskPool& workers);
    /// Finds system() about these moves (m), as in Newton's method. None: the place at the part's start.
    void linearize(const Substep& substep, std::span<const Vec3> moves, TaskPool& workers);
    /// What stretch, shear and gas take more for these moves than system() says, J: none of what they take less.
    [[nodiscard]] double unforeseen_energy(std::span<const Vec3> moves, TaskPool& workers);
    /// The sheet's equations for the solve, those of the last linearize(), valid until the next begin().
    [[nodiscard]] SheetSystem system() {
        return {&matrix_, rhs_, small_load_, fixed_, gas_.gradient(), gas_.compression()};
    }
    [[nodiscard]] TouchSprings& touch() { return springs_; }
    [[nodiscard]] ClothLayers& layers() { return *layers_; }
    [[nodiscard]] const ClothLayers& layers() const { return *layers_; }
    /// Where it may touch itself in the part, by the motion of its nodes.
    [[nodiscard]] std::vector<ThinCandidate> near_layers(const Substep& substep, TaskPool& workers);
    /// Stiffness of each node alone by these equations, N/m.
    [[nodiscard]] std::span<const double> node_stiffness() const { return node_stiffness_; }
    /// Ends it with these moves (m), which touch() was solved with, and changes them where the solve could not know.
    /// Pushes the bodies.
    void finish(const Substep& substep, std::span<Vec3> moves, std::span<const BodyMove> body_moves,
                std::span<TouchedBody> bodies);
    /// Whether nothing but weight, air, liquids and other sheets and ropes acts on it.
    [[nodiscard]] bool is_free() const;
    /// What weight, air and liquids give each node in a substep with these moves, N s; notes what the liquids give.
    /// Before finish(), once.
    std::vector<Vec3> take_impulses(const Substep& substep, std::span<const Vec3> moves);
    /// Moves the nodes by these moves (m): the end of the substep.
    void move_nodes(std::span<const Vec3> moves, const Substep& substep, TaskPool& workers);
    /// Stops it for good where it is.
    void freeze();
    /// Each edge of its triangles once.
    [[nodiscard]] std::span<const std::array<std::uint32_t, 2>> edges() const { return layers_->edges(); }
    /// Mean, m.
    [[nodiscard]] double edge_length() const { return layers_->edge_length(); }

    /// Instead of the definition's.
    void set_attachments(const std::vector<Attachment>& attachments) { springs_.attachments = attachments; }
    [[nodiscard]] Nodes& nodes() { return nodes_; }
    [[nodiscard]] const Nodes& nodes() const { return nodes_; }
    [[nodiscard]] const std::vector<ClothTriangle>& triangles() const { return triangles_; }
    /// Takes contacts over from another sheet whose nodes these are, and what its triangles keep where they are as
    /// many.
    void go_on_from(const ClothSheet& other);
    [[nodiscard]] const SheetTear& tear() const { return tear_; }
    /// What its triangles pull with now.
    [[nodiscard]] std::vector<SheetStress> stress() const;
    /// Gas inside.
    [[nodiscard]] const SheetGas& gas() const { return gas_; }
    /// Present energy of stretch, shear and bending, of its friction, and of gas, J.
    [[nodiscard]] double elastic_energy() const;
    [[nodiscard]] BendMemory& bend_memory() { return bend_memory_; }
    [[nodiscard]] const BendMemory& bend_memory() const { return bend_memory_; }
    /// Contacts and attachments of the last substep.
    [[nodiscard]] std::span<const TouchSpring> springs() const { return springs_.springs(); }
    /// True once a number was none: it stays where it last was.
    [[nodiscard]] bool is_frozen() const { return is_frozen_; }

private:
    // Position of a triangle's elements in a node's row of the matrix.
    struct Corner {
        std::uint32_t triangle = 0, corner = 0;
        std::array<std::uint32_t, 3> element{};  // of the row's near elements; own: the diagonal
    };
    // Of a triangle where the equations are made: F's columns and the derivatives of the energy per area by them.
    struct Strain {
        Vec3 f, g;                                           // images of the unit steps along warp and weft
        Vec3 f_displacement, g_displacement;                 // their directions
        Vec3 f_stress, g_stress;                             // by the equations at the part's start, N/m
        double warp = 0, weft = 0;                           // stiffness along f_displacement, g_displacement, N/m
        double across_ff = 0, across_fg = 0, across_gg = 0;  // stiffness by stress, N/m
    };
    // Images of the unit steps along warp and weft.
    struct Images {
        Vec3 f, g;
    };
    [[nodiscard]] Images images_of(const ClothTriangle& triangle, std::span<const Vec3> moves) const;
    [[nodiscard]] Images stress_of(const Images& images) const;
    [[nodiscard]] Images stress_change(const Strain& strain, const Images& change) const;
    [[nodiscard]] double energy_of(const Images& images) const;

    ClothSheet(const DeformableDefinition& definition, const BendElements& bend);
    void make_pattern(const ScalarRows& bending);
    [[nodiscard]] Vec3 normal_of(const ClothTriangle& triangle, std::span<const Vec3> moves) const;
    [[nodiscard]] std::vector<Vec3> normals() const;
    [[nodiscard]] double travel_with(std::size_t triangle, double added) const;
    [[nodiscard]] double young_drag(std::size_t triangle, double added) const;
    void foresee_bending(const Substep& substep, std::span<const Vec3> moves, TaskPool& workers);
    void prestretch();
    void find_stiffness_by_mass();
    void limit_stiffness(double h);
    [[nodiscard]] std::vector<Vec3> whole_moves(double h) const;
    void undamp(const ClothTriangle& triangle, double damping, Strain& strain) const;
    void find_strains(const Substep& substep, std::span<const Vec3> moves, TaskPool& workers);
    void fill_rows(const Substep& substep, TaskPool& workers);
    void fill_row(std::size_t i, const Substep& substep, std::vector<Block>& near);
    // Distance of layers: as if a body of no thickness lay between them.
    [[nodiscard]] double apart() const { return std::max(cloth_.thickness, 2 * springs_.radius); }

    Cloth cloth_;                                         // with the stiffness that is solved
    double stretch_stiffness_ = 0, shear_stiffness_ = 0;  // of the definition, N/m
    double stiffness_by_mass_ = 0;                        // greatest of a node, of a sheet of 1 N/m, 1/kg
    Nodes nodes_;
    std::vector<ClothTriangle> triangles_;
    ScalarRows bending_;  // times bend stiffness, N/m
    BendMemory bend_memory_;
    SheetGas gas_;
    SheetTear tear_;
    ClothMatrix matrix_;
    std::vector<std::uint32_t> corner_start_;
    std::vector<Corner> corners_;
    std::vector<double> near_bending_;        // of the blocks between neighbours
    std::vector<std::uint32_t> far_element_;  // of bending_'s elements: the index of each among the row's far elements
    TouchSprings springs_;
    double width_ = 0;                // twice the area over the length of its hems, m
    std::vector<double> air_travel_;  // of each triangle through the air along its normal since it last turned round, m
    std::optional<ClothLayers> layers_;
    std::vector<std::uint8_t> fixed_;

    // Of the substep.
    std::vector<Strain> strains_;
    std::vector<Vec3> rhs_, weight_, small_load_, air_, winds_, moves_;
    std::vector<Vec3> turned_;  // of a sheet with gas: moves of its motion as one piece
    std::vector<double> node_stiffness_, unforeseen_;
    double friction_stiffness_ = ClothSettings{}.friction_stiffness;
    std::vector<Vec3> foreseen_;  // moves about which bend_memory_ was asked
    std::vector<std::array<Vec3, 2>> normals_;
    bool is_frozen_ = false;
};

}  // namespace embody::physics::deformable
