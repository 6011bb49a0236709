// SPDX-License-Identifier: MIT
// The vocabulary: a superset of KHR_physics_rigid_bodies, UsdPhysics with its PhysX and OmniPhysics schemas, MJCF and
// SDFormat. A row names the kinds that it concerns by their letters in the table of kinds (traits_of); things that are
// only drawn have the identity attributes.
#include "attributes/registry_table.h"

#include "attributes/model_facts.h"
#include "attributes/physical_kind.h"

#include <limits>
#include <utility>

namespace embody::attributes {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr const char* all_kinds = every_kind.data();

std::vector<std::string> names_of_kinds() {
    std::vector<std::string> names;
    for (const PhysicalKind kind : physical_kinds) names.push_back(to_text(kind));
    return names;
}

std::string help_of_kinds() {
    std::string meanings;
    for (const PhysicalKind kind : physical_kinds)
        meanings += (meanings.empty() ? "" : ", ") + to_text(kind) + " " + std::string(traits_of(kind).meaning);
    return "What the thing is for physics: " + meanings + ".";
}

using Rows = std::vector<AttributeDescription>;

// The texts of most rows; kind and type come from the group and the builder below.
struct Text {
    const char* name;
    const char* applies_to;
    const char* label;
    const char* help;
};

// Adds a note to the help of an attribute that is kept, shown and exported, but does not yet change the simulation.
std::string with_note(const char* help, bool simulated) {
    return simulated ? std::string(help) : std::string(help) + " Stored and exported, not simulated yet.";
}

struct Group {
    Rows& rows;
    const char* kind;
    const char* label;
    bool simulated = true;

    /// For attributes that are kept, shown and exported, but do not yet change the simulation.
    [[nodiscard]] Group unsimulated() const { return {rows, kind, label, false}; }

    void number(const Text& text, const char* unit, double standard, double low, double high) const {
        AttributeDescription row = start(text, ValueType::number, unit, standard);
        row.low = low;
        if (high < infinity) row.high = high;
        rows.push_back(std::move(row));
    }
    void whole(const Text& text, double standard, double low, double high) const {
        number(text, "1", standard, low, high);
        rows.back().whole = true;
    }
    void word(const Text& text, const std::string& standard, std::vector<std::string> choices) const {
        AttributeDescription row = start(text, ValueType::word, "", standard);
        row.choices = std::move(choices);
        rows.push_back(std::move(row));
    }
    void truth(const Text& text, bool standard) const { rows.push_back(start(text, ValueType::truth, "", standard)); }
    void vector(const Text& text, const char* unit, double low, double high) const {
        AttributeDescription row = start(text, ValueType::vector, unit, Vec3{});
        row.low = low;
        row.high = high;
        rows.push_back(std::move(row));
    }
    void tensor(const Text& text, const char* unit, double low, double high) const {
        AttributeDescription row = start(text, ValueType::tensor, unit, Mat3::identity());
        row.low = low;
        row.high = high;
        rows.push_back(std::move(row));
    }
    /// The row that was added last grows with this power of the thing's size.
    void grows_with_size(int power) const { rows.back().size_power = power; }

private:
    [[nodiscard]] AttributeDescription start(const Text& text, ValueType type, const char* unit,
                                             AttributeValue standard) const {
        AttributeDescription row;
        row.name = text.name;
        row.kind = kind;
        row.kind_label = label;
        row.type = type;
        row.unit = unit;
        row.standard = std::move(standard);
        row.applies_to = text.applies_to;
        row.label = text.label;
        row.help = with_note(text.help, simulated);
        return row;
    }
};

void add_identity(Rows& rows) {
    const Group group{rows, "identity", "What it is"};
    const std::string help = help_of_kinds();
    group.word({"kind", all_kinds, "Physical kind", help.c_str()}, to_text(PhysicalKind::rigid), names_of_kinds());
    group.word({"category", all_kinds, "Category", "What the thing is, from the taxonomy."}, "object", {});
    group.word({"subcategory", all_kinds, "Subcategory", "What it is more exactly, where known."}, "", {});
    group.word({"synset", all_kinds, "WordNet synset", "Meaning in WordNet 3.0, such as chair.n.01, where known."}, "",
               {});
    group.number(
        {"category_confidence", all_kinds, "Confidence of the category",
         "How likely the category is right: by which source tells it, by how many steps WordNet leads to it, by "
         "what else the words could mean."},
        "1", 0, 0, 1);
    group.word({"placement", all_kinds, "Usual place", "Where such a thing usually stands or hangs."}, "floor",
               {"floor", "wall", "ceiling", "table", "ground", "free"});
    group.word({"front", all_kinds, "Front",
                "The side that faces the room when it stands or hangs at a wall, of the model as it is stored."},
               "+z", {"+z", "-z", "+x", "-x"});
    group.number({"scale_to_m", all_kinds, "Metres per unit", "Length of one unit of the stored geometry."}, "m", 1,
                 1e-4, 1e3);
}

void add_mass(Rows& rows) {
    const Group group{rows, "mass", "Mass"};
    group.number({"mass", "SRAVCPG", "Mass", "Mass of the whole thing; of a static one, what it would weigh if freed."},
                 "kg", 1, 1e-6, 1e9);
    group.grows_with_size(3);
    group.number({"density", "SRAVFG", "Material density", "Density of the material itself, without hollows."}, "kg/m³",
                 1000, 0.1, 22600);
    // The lower bounds of these two leave room for models that are kilometres long by mistake.
    group.number({"bulk_density", "SRAV", "Bulk density", "Mass divided by the volume of the bounding box."}, "kg/m³",
                 180, 1e-9, 22600);
    group.number({"fill_fraction", "SRAV", "Fill", "Share of the volume that material takes up; the rest is hollow."},
                 "1", 0.3, 1e-12, 1);
    group.number({"volume", "SRAVFG", "Volume", "Volume inside the surface."}, "m³", 1, 1e-12, 1e12);
    group.grows_with_size(3);
    group.number({"wall_thickness", "SRA", "Wall thickness", "Mean thickness of the walls of a hollow thing."}, "m",
                 0.003, 1e-4, 0.5);
    group.grows_with_size(1);
    group.vector(
        {"center_of_mass", "SRAV", "Centre of mass", "In the model's frame: origin at the centre of its base, Y up."},
        "m", -1e4, 1e4);
    group.grows_with_size(1);
    group.tensor({"inertia", "SRAV", "Moments of inertia", "About the centre of mass, in the model's axes."}, "kg m²",
                 -1e18, 1e18);
    group.grows_with_size(5);
}

void add_shape(Rows& rows) {
    const Group group{rows, "shape", "Collision shape"};
    group.word(
        {"collision_shape", "SRAVCPFG", "Collision shape",
         "What collides: a primitive that fits, the convex hull, several hulls for a hollow thing (decomposition), or "
         "the triangles of a static thing."},
        "convex_hull", {"box", "sphere", "capsule", "cylinder", "convex_hull", "decomposition", "trimesh"});
    group.whole({"max_hulls", "SRA", "Convex parts at most", "Limit on the hulls of a decomposition."}, 16, 1, 256);
    group.number({"hull_error", "SRA", "Decomposition error",
                  "Depth of hollows that the hulls of a decomposition may fill, where the limit on them allows."},
                 "m", usual_hull_error, 1e-4, 1);
    group.grows_with_size(1);
}

void add_surface(Rows& rows) {
    const Group group{rows, "surface", "Surface"};
    group.word(
        {"surface_material", all_kinds, "Surface material", "Material outside; density and friction follow from it."},
        "generic", {});
    group.number({"friction_static", "SRAVCPG", "Static friction", "Coulomb coefficient while the surfaces stick."},
                 "1", 0.5, 0, 2);
    group.number({"friction_dynamic", "SRAVCPG", "Sliding friction", "Coulomb coefficient while the surfaces slide."},
                 "1", 0.4, 0, 2);
    group.number({"friction_rolling", "SRAG", "Rolling resistance", "Lever arm of the resistance to rolling."}, "m",
                 5e-4, 0, 0.05);
    group.number(
        {"friction_torsional", "SRAG", "Spinning resistance", "Lever arm of the resistance to spinning on the spot."},
        "m", 5e-3, 0, 0.1);
    group.number({"restitution", "SRAVG", "Bounciness",
                  "Energetic coefficient of restitution: 0 stays down, 1 loses nothing."
                  " Soft things with 0 come back as their matter makes them."},
                 "1", 0.3, 0, 1);
    group.number({"restitution_threshold", "SRAVG", "Least bounce speed", "Slower impacts do not bounce."}, "m/s", 0, 0,
                 10);
    const std::vector<std::string> rules{"pair_table", "own",     "average", "geometric_mean",
                                         "minimum",    "maximum", "multiply"};
    group.word(
        {"friction_combine", "SRA", "Friction of a pair",
         "How the friction of two touching things becomes one: measured for the pair of materials, or by a rule."},
        "pair_table", rules);
    group.word(
        {"restitution_combine", "SRA", "Bounciness of a pair",
         "How the bounciness of two touching things becomes one: measured for the pair of materials, or by a rule."},
        "pair_table", rules);
}

void add_fracture(const Group& group) {
    group.truth({"breaks", "RA", "Breaks",
                 "A blow above its breaking impulse or breaking energy breaks it into pieces, where it can move."},
                false);
    group.number({"break_impulse", "RA", "Breaking impulse", "An impulse above this breaks it."}, "N s", infinity, 0,
                 infinity);
    group.number({"break_energy", "RA", "Breaking energy", "An impact energy above this breaks it."}, "J", infinity, 0,
                 infinity);
    // Soda-lime glass: twice its surface energy of 3.5 to 5.3 J/m² (S. Wiederhorn, J. Am. Ceram. Soc. 52, 1969).
    group.number({"fracture_energy", "RA", "Fracture energy",
                  "Energy of a square metre of crack: glass 8, porcelain 25, stone 50 to 100."},
                 "J/m²", 8, 0.1, 1e6);
    group.whole({"break_pieces", "RA", "Pieces at most", "Into how many pieces one blow breaks it at most."}, 24, 2,
                256);
}

void add_motion(Rows& rows) {
    const Group group{rows, "motion", "Motion"};
    group.number({"linear_damping", "RA", "Linear damping", "Share of the velocity lost a second."}, "1/s", 0, 0, 100);
    group.number({"angular_damping", "RA", "Angular damping", "Share of the spin lost a second."}, "1/s", 0.05, 0, 100);
    group.number({"gravity_factor", "RAVCP", "Gravity factor", "1 falls, 0 floats, -1 rises."}, "1", 1, -10, 10);
    group.number(
        {"sleep_energy_per_mass", "RA", "Sleep energy", "Quieter than this for half a second may fall asleep."}, "J/kg",
        4.5e-4, 0, 1);
    group.truth({"kinematic", "RA", "Moves by command", "Moves as its velocity says; nothing pushes it."}, false);
    group.truth({"continuous", "RA", "Continuous collision", "Swept against everything: for small fast things."},
                false);
    group.whole({"collision_group", all_kinds, "Collision group", "Bits of the groups that it belongs to."}, 1, 0,
                4294967295.0);
    group.whole({"collision_mask", all_kinds, "Collides with", "Bits of the groups that it collides with."},
                4294967295.0, 0, 4294967295.0);
    group.number({"drag_coefficient", "RAC", "Drag coefficient", "Of the drag of the air."}, "1", 1, 0, 3);
    group.number({"drag_area", "RA", "Drag area", "Area that meets the air."}, "m²", 0, 0, 1e8);
    group.grows_with_size(2);
    add_fracture(group);
}

void add_soft_and_cloth(Rows& rows) {
    const Group soft{rows, "soft", "Soft body"};
    soft.number({"youngs_modulus", "VC", "Young's modulus", "Stiffness of the material."}, "Pa", 1e5, 1e2, 1e12);
    soft.number({"poisson_ratio", "VC", "Poisson's ratio",
                 "Sideways shrinking when stretched; simulated within -0.9 and 0.495."},
                "1", 0.45, -0.999, 0.4999);
    soft.number({"damping_rayleigh", "VCP", "Internal damping", "Stiffness-proportional Rayleigh damping."}, "s", 0.01,
                0, 100);
    soft.number({"yield_stress", "V", "Yield stress", "Stress (von Mises) from which it stays deformed."}, "Pa",
                infinity, 0, infinity);
    soft.number({"internal_pressure", "VC", "Internal pressure",
                 "Of gas inside, above that of the air around; its form is the one that it has under this pressure. "
                 "Cloth with gas is a closed sheet: a beach ball, an air bed."},
                "Pa", 0, 0, 1e8);
    soft.whole({"soft_resolution", "V", "Resolution",
                "Elements across its thinnest extent: more are more exact and cost more. 0: as many as bending and "
                "twisting need."},
               0, 0, 12);
    const Group cloth{rows, "cloth", "Cloth"};
    cloth.number({"area_density", "C", "Area density", "Mass of a square metre."}, "kg/m²", 0.2, 1e-4, 1e3);
    cloth.number({"thickness", "C", "Thickness", "Of the cloth: its layers stay that far apart."}, "m", 5e-4, 1e-6,
                 0.1);
    cloth.number({"stretch_stiffness", "C", "Stretch stiffness", "Force per metre width and unit strain."}, "N/m", 500,
                 1e-3, 1e9);
    cloth.number({"shear_stiffness", "C", "Shear stiffness", "Force per metre width and unit shear."}, "N/m", 50, 1e-3,
                 1e9);
    cloth.number({"bend_stiffness", "C", "Bend stiffness", "Moment per metre width and curvature."}, "N m", 2e-5, 1e-9,
                 1e6);
    // HB/B of the six denims of table 5 of Journal of Textiles 2016, 4614168: 23 to 54 1/m, 44 in the mean.
    cloth.number({"bend_friction", "C", "Bending friction",
                  "Curvature that the friction between its threads holds: more folds stay and it comes to rest sooner. "
                  "Of woven cloth 20 to 60 (Kawabata's 2HB over 2B)."},
                 "1/m", 40, 0, 1e6);
    cloth.number({"bend_yield", "CP", "Fold limit",
                  "Curvature beyond which a bend stays for good, as in paper, foil, sheet metal and wire."},
                 "1/m", infinity, 0, infinity);
    cloth.whole({"cloth_nodes", "C", "Nodes",
                 "Points that the sheet is computed with: more fold finer and cost more. Not its real threads."},
                1000, 20, 20000);
    cloth.number({"tear_strength", "C", "Tear strength", "Tension at which a tear starts, as strip tests give it."},
                 "N/m", infinity, 0, infinity);
    cloth.number(
        {"tear_energy", "C", "Tear energy",
         "What a metre of tear takes to go on: twice the force that tears trousers of it. Without it a tear goes "
         "on by its tension, too."},
        "J/m", infinity, 0, infinity);
}

void add_rope(Rows& rows) {
    const Group rope{rows, "rope", "Rope"};
    rope.number({"linear_density", "P", "Linear density", "Mass of a metre."}, "kg/m", 0.07, 1e-6, 1e4);
    rope.number({"axial_stiffness", "P", "Axial stiffness EA", "Force per unit strain."}, "N", 1e4, 1e-3, 1e12);
    rope.number({"bend_rigidity", "P", "Bend rigidity EI", "Moment per curvature."}, "N m²", 1e-3, 1e-12, 1e9);
    rope.number({"twist_rigidity", "P", "Twist rigidity GJ",
                 "Moment per twist of a metre, between pins that are clamped; of a round rod EI / (1 + ν)."},
                "N m²", 1e-3, 1e-12, 1e9);
    rope.number({"break_tension", "P", "Breaking tension", "Tension that breaks it."}, "N", infinity, 0, infinity);
    rope.number({"slack", "P", "Slack",
                 "How much longer it is than the way between its ends: a slack one starts as an arc that hangs."},
                "1", 0, 0, 10);
    rope.whole({"rope_segments", "P", "Segments", "Straight pieces that it is computed with."}, 50, 2, 2000);
}

void add_fluid(Rows& rows) {
    const Group fluid{rows, "fluid", "Fluid"};
    fluid.number({"rest_density", "F", "Rest density", "Density of the liquid at rest; simulated as 1 or more."},
                 "kg/m³", 998, 0.01, 22600);
    fluid.number({"dynamic_viscosity", "F", "Viscosity", "Dynamic viscosity; simulated up to 10,000."}, "Pa s", 1e-3,
                 1e-7, 1e9);
    fluid.number({"yield_stress_fluid", "F", "Yield stress of the liquid",
                  "Stress below which it does not flow; simulated up to 10,000."},
                 "Pa", 0, 0, 1e9);
    fluid.whole(
        {"particle_budget", "F", "Most particles",
         "So many particles carry the liquid at most, save where fewer could not fill its form, or where it joins one "
         "of finer particles."},
        20000, 100, 400000);
    fluid.number(
        {"fluid_cell_size", "F", "Cell size",
         "Edge of the cells that the liquid is solved on, eight particles in each: finer is slower, and things "
         "thinner than a cell are not felt by its pressure."},
        "m", 0.02, 1e-3, 1);
    fluid.number({"absorption_red", "F", "Absorption of red light", "Of light at 650 nm, by a path of a metre."}, "1/m",
                 0.34, 0, 1e7);
    fluid.number({"absorption_green", "F", "Absorption of green light", "Of light at 550 nm, by a path of a metre."},
                 "1/m", 0.0565, 0, 1e7);
    fluid.number({"absorption_blue", "F", "Absorption of blue light", "Of light at 450 nm, by a path of a metre."},
                 "1/m", 0.0092, 0, 1e7);
    fluid.number({"turbidity", "F", "Scattering of light",
                  "Reduced scattering coefficient: clear water has next to none, milk thousands."},
                 "1/m", 0.03, 0, 1e7);
    fluid.number({"surface_tension", "F", "Surface tension",
                  "Against air; walls are met at a right angle. Simulated where fluid_cell_size is less than twice the "
                  "capillary length √(σ/(ρ g)), of water 5.4 mm: on coarser cells gravity is all that shows."},
                 "N/m", 0.072, 0, 10);
    const Group later = fluid.unsimulated();
    later.number({"contact_angle", "F", "Contact angle", "On a solid wall."}, "deg", 60, 0, 180);
}

void add_grain(Rows& rows) {
    const Group grain{rows, "grain", "Grains"};
    grain.number({"grain_density", "G", "Grain density", "Density of a single grain."}, "kg/m³", 2650, 0.1, 22600);
    grain.number({"grain_diameter", "G", "Grain diameter", "Median diameter of a grain."}, "m", 0.002, 1e-6, 1);
    grain.whole(
        {"grain_budget", "G", "Most grains",
         "As many grains are simulated at most; where there would be more, fewer and larger ones stand for them."},
        2000, 10, 20000);
    grain.number(
        {"simulated_diameter", "G", "Simulated grain diameter",
         "Diameter of the balls that stand for the grains: of a grain, or as large as \"Most grains\" asks for. "
         "The slope of a heap does not depend on it; an opening narrower than five of them is blocked."},
        "m", 0.01, 1e-3, 1);
    grain.number({"friction_angle", "G", "Friction angle",
                  "Slope at which a poured heap comes to rest; from 7 to 49 degrees; what is flatter or steeper is "
                  "simulated as these."},
                 "deg", 34, 0, 80);
    const Group later = grain.unsimulated();
    later.number({"cohesion", "G", "Cohesion", "Shear strength without load."}, "Pa", 0, 0, 1e7);
}

}  // namespace

std::vector<AttributeDescription> make_registry_table() {
    Rows rows;
    add_identity(rows);
    add_mass(rows);
    add_shape(rows);
    add_surface(rows);
    add_motion(rows);
    add_soft_and_cloth(rows);
    add_rope(rows);
    add_fluid(rows);
    add_grain(rows);
    return rows;
}

}  // namespace embody::attributes
