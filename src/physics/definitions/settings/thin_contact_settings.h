// SPDX-License-Identifier: MIT
#pragma once

#include "physics/definitions/settings/setting_list.h"

namespace embody::physics {

/// Contacts, attachments and ties of sheets and ropes as springs with memory (src/physics/deformable/contact).
struct ThinContactSettings {
    /// Stiffness of a contact over that of the node's neighbours, or over the inertia of the heavier point. Source:
    /// docs/physics/cloth.md: the method of multipliers is stable from 1 on, and converges faster the stiffer it is.
    /// Test: Settings.AreNoticed.
    double stiffness_factor = 20;
    /// The same over the inertia of the load on a point. Test: Settings.AreNoticed.
    double load_stiffness_factor = 4;
    /// Stiffness of all contacts of a sheet's nodes with a body that moves together, over its inertia. Source:
    /// docs/physics/cloth.md, "What lies on a sheet": stable where it is above recovery_fraction. Test:
    /// ThingsOnSheets.StandStill.
    double body_stiffness_factor = 100;
    /// The same over the inertia of a body in which a node begins, at that place. Test: Settings.AreNoticed.
    double recovery_stiffness_factor = 2;
    /// Stiffness of what bears a body that deformables push, over the inertia of all that they are solved with. Test:
    /// Settings.AreNoticed.
    double support_stiffness_factor = 10;
    /// Speed at which a node that begins inside something is pushed out, m/s. Test:
    /// BeginsInside.ARopeBelowTheFloorIsLiftedByItsDepth.
    double recovery_speed = 0.2;
    /// Fraction of an overlap of sheets and ropes, and of a sheet's nodes that bear a body, that is corrected in a
    /// substep. Source: R. Bridson, R. Fedkiw, J. Anderson, "Robust treatment of collisions, contact and friction for
    /// cloth animation", 2002, correct at most a tenth a step. Test: Settings.AreNoticed.
    double recovery_fraction = 0.2;
    /// Stiffness of a contact of sheets and ropes over that of the softer side's nodes where half the distance that
    /// they keep is left; it grows with depth over distance. Test: Settings.AreNoticed.
    double depth_stiffness_factor = 0.3;
    /// Depth, over that distance, up to which it grows. Test: Settings.AreNoticed.
    double max_stiff_depth = 0.95;
    /// Overlap with faces that leave a node no room, in contact radii, from which on it remembers no force of theirs.
    /// Test: ClothSheet.FacesThatLeaveItNoRoomPushItNoHarderFromStepToStep.
    double memory_depth = 0.2;
    /// Barycentric weight above which a node bears the load on a contact. Test: Settings.AreNoticed.
    double min_load_weight = 0.1;
    /// Fraction of the load of a contact that is remembered from substep to substep. Test: Settings.AreNoticed.
    double load_memory = 0.9;
    /// Change of the contacts' forces, over the forces, below which no further solve is made. Test:
    /// Settings.AreNoticed.
    double change_tolerance = 0.05;
    /// Cosine of the turn of a contact's normal up to which the contact keeps its force: another face is another
    /// contact. Test: Settings.AreNoticed.
    double same_normal_cosine = 0.8;
    /// The same turn up to which a point of a sheet or rope remembers on which side of another it is. Test:
    /// Settings.AreNoticed.
    double same_side_cosine = 0.5;
    /// Depth of a point on the wrong side beyond which it has gone through for good, over the sum of both radii. Test:
    /// Settings.AreNoticed.
    double max_wrong_side_radii = 3;
    /// Cosine between normals below which a node touches a further triangle of the same sheet. Test:
    /// Settings.AreNoticed.
    double other_normal_cosine = 0.5;
    /// Cosine between normals above which the nodes of two edges already keep the edges apart. Test:
    /// Settings.AreNoticed.
    double held_edge_cosine = 0.7;
    /// Maximum energy that springs give a body, over that of its solved move. Test: BeginsInside.ARopeShootsNoBoxAway.
    double max_energy_ratio = 4;
    /// Speed up to which springs may push a body without that limit, m/s. Test: BeginsInside.ARopeShootsNoBoxAway.
    double free_push_speed = 0.5;
    /// Push on a body that is borne, over its weight, up to which the next rigid step takes it as a constant force.
    /// Test: LightBodies.UnderHeavySheetsGainNoEnergy.
    double max_push_in_weights = 10;
    /// Minimum of the acceleration that stands for gravity, m/s²: forces are turned into loads by it, and accuracy is
    /// measured by it. Test: Settings.AreNoticed.
    double min_gravity = 1;
    /// Iterations that restore the momenta of what nothing holds. Test: Settings.AreNoticed.
    int momentum_iterations = 5;
    /// Turn in a substep beyond which they are not restored, rad: the arms' motion is then no longer linear. Test:
    /// Settings.AreNoticed.
    double max_momentum_turn = 0.1;
};

template <>
inline constexpr auto settings_of<ThinContactSettings> = std::tuple{
    Setting{"stiffness_factor", &ThinContactSettings::stiffness_factor, 1, 1e4},
    Setting{"load_stiffness_factor", &ThinContactSettings::load_stiffness_factor, 0, 1e4},
    Setting{"body_stiffness_factor", &ThinContactSettings::body_stiffness_factor, 0, 1e4},
    Setting{"recovery_stiffness_factor", &ThinContactSettings::recovery_stiffness_factor, 1e-3, 1e4},
    Setting{"support_stiffness_factor", &ThinContactSettings::support_stiffness_factor, 1e-3, 1e4},
    Setting{"recovery_speed", &ThinContactSettings::recovery_speed, 0, 1e3, "m/s"},
    Setting{"recovery_fraction", &ThinContactSettings::recovery_fraction, 0, 1},
    Setting{"depth_stiffness_factor", &ThinContactSettings::depth_stiffness_factor, 0, 1e3},
    Setting{"max_stiff_depth", &ThinContactSettings::max_stiff_depth, 0, 0.999},
    Setting{"memory_depth", &ThinContactSettings::memory_depth, 1e-6, 1e3},
    Setting{"min_load_weight", &ThinContactSettings::min_load_weight, 0, 1},
    Setting{"load_memory", &ThinContactSettings::load_memory, 0, 1},
    Setting{"change_tolerance", &ThinContactSettings::change_tolerance, 0, 1},
    Setting{"same_normal_cosine", &ThinContactSettings::same_normal_cosine, 0, 1},
    Setting{"same_side_cosine", &ThinContactSettings::same_side_cosine, 0, 1},
    Setting{"max_wrong_side_radii", &ThinContactSettings::max_wrong_side_radii, 0, 1e3},
    Setting{"other_normal_cosine", &ThinContactSettings::other_normal_cosine, -1, 1},
    Setting{"held_edge_cosine", &ThinContactSettings::held_edge_cosine, -1, 1},
    Setting{"max_energy_ratio", &ThinContactSettings::max_energy_ratio, 1, 1e6},
    Setting{"free_push_speed", &ThinContactSettings::free_push_speed, 0, 1e3, "m/s"},
    Setting{"max_push_in_weights", &ThinContactSettings::max_push_in_weights, 0, 1e6},
    Setting{"min_gravity", &ThinContactSettings::min_gravity, 1e-3, 1e3, "m/s²"},
    Setting{"momentum_iterations", &ThinContactSettings::momentum_iterations, 0, 1000},
    Setting{"max_momentum_turn", &ThinContactSettings::max_momentum_turn, 0, 1, "rad"},
};
static_assert(setting_count<ThinContactSettings> == member_count<ThinContactSettings>(), "a setting is in no list");

/// How contacts of sheets and ropes are found (src/physics/stages/deformable).
struct ThinSearchSettings {
    /// Distance from the ends of a sheet's edge or triangle, over its length or as a weight, within which the ends'
    /// contacts suffice. Test: Settings.AreNoticed.
    double sheet_end_fraction = 0.02;
    /// The same for a rope's segment, whose capsules reach over their ends. Test: Settings.AreNoticed.
    double segment_end_fraction = 0.05;
    /// Maximum height by which a body may stand out between two nodes whose planes hold it, in contact radii. Test:
    /// Settings.AreNoticed.
    double max_bulge_radii = 0.8;
    /// Angle between such planes up to which they belong to one face, rad, however short the edge. Test:
    /// Settings.AreNoticed.
    double max_plane_angle = 0.5;
    /// Cosine between a triangle's normal and the edges of a body's corner above which that corner does not poke into
    /// it. Test: Settings.AreNoticed.
    double corner_cosine = 0.3;
    /// Cosine between the normal of a solid and the reversed normal of a body from which on a node between them feels
    /// the solid alone. Test: ClothOnSolid.ABoxLiesOnABlanketOnAMattress.
    double covered_cosine = 0.5;
    /// Fraction that is left after a substep of the force with which a sheet that has left a solid still pushes it.
    /// Test: Settings.AreNoticed.
    double push_memory = 0.5;
};

template <>
inline constexpr auto settings_of<ThinSearchSettings> = std::tuple{
    Setting{"sheet_end_fraction", &ThinSearchSettings::sheet_end_fraction, 0, 0.3},
    Setting{"segment_end_fraction", &ThinSearchSettings::segment_end_fraction, 0, 0.5},
    Setting{"max_bulge_radii", &ThinSearchSettings::max_bulge_radii, 0, 100},
    Setting{"max_plane_angle", &ThinSearchSettings::max_plane_angle, 0, 2, "rad"},
    Setting{"corner_cosine", &ThinSearchSettings::corner_cosine, 0, 1},
    Setting{"covered_cosine", &ThinSearchSettings::covered_cosine, 0, 1},
    Setting{"push_memory", &ThinSearchSettings::push_memory, 0, 0.999},
};
static_assert(setting_count<ThinSearchSettings> == member_count<ThinSearchSettings>(), "a setting is in no list");

}  // namespace embody::physics
