// SPDX-License-Identifier: MIT
#pragma once

#include "physics/definitions/settings/setting_list.h"

namespace embody::physics {

/// Contacts, attachments and ties of sheets and ropes as springs with memory (src/physics/deformable/contact).
struct ThinContactSettings {
    /// Stiffness of a contact over what the node's neighbours resist with, or over the inertia of the heavier point.
    /// Source: the method of multipliers, one round a substep, is stable from 1 on and converges the faster the
    /// stiffer. Test: Settings.AreNoticed.
    double stiffness_factor = 20;
    /// The same over the inertia of what weighs on a point. Test: Settings.AreNoticed.
    double load_stiffness_factor = 4;
    /// The same over the inertia of a body in which something begins, at that place. Test:
    /// BeginsInside.AHeavyRopeDoesNotKickALightBox.
    double recovery_stiffness_factor = 2;
    /// Speed at which what begins inside of something is parted from it, m/s. Test:
    /// BeginsInside.ARopeBelowTheFloorIsLiftedByItsDepth.
    double recovery_speed = 0.2;
    /// Share of an overlap of sheets and ropes that is parted in a substep. Source: R. Bridson, R. Fedkiw, J. Anderson,
    /// "Robust treatment of collisions, contact and friction for cloth animation", 2002, part a tenth a step. Test:
    /// Settings.AreNoticed.
    double recovery_fraction = 0.2;
    /// Overlap of a sheet's own layers, of both radii, from which on they remember no force: what is held within each
    /// other would push ever harder. Test: Settings.AreNoticed.
    double memory_depth = 0.2;
    /// Weight above which a node bears what lies on a contact. Test: Settings.AreNoticed.
    double min_load_weight = 0.1;
    /// Share of the load that a contact has borne which it remembers from substep to substep. Test:
    /// Settings.AreNoticed.
    double load_memory = 0.9;
    /// Share of the contacts' forces below which a change of them is not worth a further solve. Test:
    /// Settings.AreNoticed.
    double change_tolerance = 0.05;
    /// Cosine of the turn of a contact's normal up to which it goes on with its force: another face is another contact.
    /// Test: Settings.AreNoticed.
    double same_normal_cosine = 0.8;
    /// The same up to which a point of a sheet or rope knows on which side of another it is. Test: Settings.AreNoticed.
    double same_side_cosine = 0.5;
    /// Way of a point on the wrong side beyond which it has gone through for good, of both radii. Test:
    /// Settings.AreNoticed.
    double max_wrong_side_radii = 3;
    /// Cosine between normals below which a node touches a further triangle of the same sheet. Test:
    /// Settings.AreNoticed.
    double other_normal_cosine = 0.5;
    /// Cosine between normals above which nodes of two edges hold these off each other already. Test:
    /// Settings.AreNoticed.
    double held_edge_cosine = 0.7;
    /// Energy that a body may get of springs over that of its move in the solve. Test:
    /// RopeOnBodies.NoMassAndNoArmMakesEnergy.
    double max_energy_ratio = 4;
    /// Speed by which springs may push a body without that, m/s. Test: Settings.AreNoticed.
    double free_push_speed = 0.5;
    /// Acceleration that stands for gravity where that is weaker, m/s²: by it loads are told from forces, and accuracy
    /// is measured. Test: Settings.AreNoticed.
    double min_gravity = 1;
    /// Rounds that give what nothing holds its momenta back. Test: Settings.AreNoticed.
    int momentum_iterations = 5;
    /// Turn in a substep beyond which they do not, rad: arms turn along a line no longer. Test: Settings.AreNoticed.
    double max_momentum_turn = 0.1;
};

template <>
inline constexpr auto settings_of<ThinContactSettings> = std::tuple{
    Setting{"stiffness_factor", &ThinContactSettings::stiffness_factor, 1, 1e4},
    Setting{"load_stiffness_factor", &ThinContactSettings::load_stiffness_factor, 0, 1e4},
    Setting{"recovery_stiffness_factor", &ThinContactSettings::recovery_stiffness_factor, 1e-3, 1e4},
    Setting{"recovery_speed", &ThinContactSettings::recovery_speed, 0, 1e3, "m/s"},
    Setting{"recovery_fraction", &ThinContactSettings::recovery_fraction, 0, 1},
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
    Setting{"min_gravity", &ThinContactSettings::min_gravity, 1e-3, 1e3, "m/s²"},
    Setting{"momentum_iterations", &ThinContactSettings::momentum_iterations, 0, 1000},
    Setting{"max_momentum_turn", &ThinContactSettings::max_momentum_turn, 0, 1, "rad"},
};
static_assert(setting_count<ThinContactSettings> == member_count<ThinContactSettings>(), "a setting is in no list");

/// Which contacts of sheets and ropes there are (src/physics/stages/deformable).
struct ThinSearchSettings {
    /// Distance from the ends of a sheet's edge or triangle, of its length or as a weight, within which the contacts of
    /// the ends hold. Test: Settings.AreNoticed.
    double sheet_end_fraction = 0.02;
    /// The same of a rope's segment, whose capsules reach over their ends. Test: Settings.AreNoticed.
    double segment_end_fraction = 0.05;
    /// How far a body may look out between two nodes whose planes hold it, of the contact radius. Test:
    /// Settings.AreNoticed.
    double max_bulge_radii = 0.8;
    /// Angle between such planes up to which they are of one face, rad, however short the edge. Test:
    /// Settings.AreNoticed.
    double max_plane_angle = 0.5;
    /// Cosine between a triangle's normal and the edges of a body's corner above which that corner does not poke into
    /// it. Test: Settings.AreNoticed.
    double corner_cosine = 0.3;
    /// Cosine between the normals of a solid and, turned round, a body from which on a node between them feels the
    /// solid alone. Test: ClothOnSolid.ABoxLiesOnABlanketOnAMattress.
    double covered_cosine = 0.5;
    /// Share a substep of what a sheet that has left a solid still pushes it with. Test: Settings.AreNoticed.
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
