// SPDX-License-Identifier: MIT
//
// Stretch and shear as in D. Baraff and A. Witkin, "Large steps in cloth simulation" (1998), section 4, with F = (f g)
// the images of the unit steps along warp and weft: energy per area ½ k ((|f| - 1)² + (|g| - 1)²) + ½ s (f·g)². Of
// their second derivative we keep the positive part: the stress of a stretched triangle stiffens it across; that of a
// compressed one would make it buckle and is left out of the matrix, not out of the force.
#include "physics/deformable/cloth/cloth_sheet.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "physics/deformable/contact/free_motion.h"

namespace embody::physics::deformable {

namespace {

// A plate that swings in a fluid with the amplitude X has 4 KC^(-1/3) times the drag of a steady stream, KC = 2π X/D,
// by the vortices that grow at its edges of each swing (J. M. R. Graham, "The forces on sharp-edged cylinders in
// oscillatory flow at low Keulegan-Carpenter numbers", 1980; 8 KC^(-1/3), beside the 2 of a steady stream). With the
// travel s since the last turn in the place of X this factor of (D/s)^(1/3), a number, takes as much energy a swing.
// Test: ClothSheet.AirTakesTheEnergyOfASwingThatYoungVorticesTake.
constexpr double young_vortex_drag = 2.02;

constexpr std::uint32_t not_far = ~std::uint32_t{0};  // of elements that lie near or on the diagonal

Mat3 symmetric_outer(Vec3 a) { return outer(a, a); }

// The nearest positive semidefinite matrix of [a b; b c].
void make_positive(double& a, double& b, double& c) {
    const double mean = (a + c) / 2, half = (a - c) / 2, radius = std::sqrt(half * half + b * b);
    const double low = mean - radius, high = mean + radius;
    if (low >= 0) return;
    if (high <= 0 || radius == 0) {
        a = b = c = 0;
        return;
    }
    // high · e eᵀ with e the eigenvector of high: (1 + [half b; b -half] / radius) / 2.
    a = high * (1 + half / radius) / 2;
    c = high * (1 - half / radius) / 2;
    b = high * b / radius / 2;
}

// Twice the area over the length of the hems, m: of a strip its width. Of a sheet without hems the root of its area.
double mean_width(const std::vector<ClothTriangle>& triangles, const BendElements& bend,
                  const std::vector<Vec3>& nodes) {
    double area = 0, hems = 0;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        area += triangles[t].area;
        for (std::size_t k = 0; k < 3; ++k) {
            if (bend.triangles[t].hinge[k] == BendTriangle::no_hinge)
                hems += length(nodes[triangles[t].node[(k + 1) % 3]] - nodes[triangles[t].node[(k + 2) % 3]]);
        }
    }
    return hems > 0 ? 2 * area / hems : std::sqrt(area);
}

}  // namespace

// Without tension its triangles are smaller: gradients along the threads by the stretch, areas that it acts on by its
// square.
void ClothSheet::prestretch() {
    const double stretch = cloth_.prestretch;
    for (ClothTriangle& triangle : triangles_) {
        for (double& gradient : triangle.warp) gradient *= stretch;
        for (double& gradient : triangle.weft) gradient *= stretch;
    }
    cloth_.stretch_stiffness /= stretch * stretch;
    cloth_.shear_stiffness /= stretch * stretch;
    stretch_stiffness_ = cloth_.stretch_stiffness;
    shear_stiffness_ = cloth_.shear_stiffness;
}

void ClothSheet::find_stiffness_by_mass() {
    std::vector<double> stiffness(nodes_.mass.size(), 0);
    for (const ClothTriangle& triangle : triangles_) {
        for (std::size_t k = 0; k < 3; ++k) {
            stiffness[triangle.node[k]] +=
                triangle.area * (triangle.warp[k] * triangle.warp[k] + triangle.weft[k] * triangle.weft[k]);
        }
    }
    for (std::size_t i = 0; i < stiffness.size(); ++i)
        stiffness_by_mass_ = std::max(stiffness_by_mass_, stiffness[i] / nodes_.mass[i]);
}

// The equations are of floats: beyond some millions of a node's inertia m/h² its stiffness, rounded, hides that, and
// the equations are no longer definite; sheets of 3e8 N/m had numbers that are none within a second. A sheet of 0.2
// kg/m² in a mesh of 25 mm has up to 1.9 MN/m so, which 500 N/m draw out by 0.03 %.
void ClothSheet::limit_stiffness(double h) {
    constexpr double max_ratio = 1 << 22;  // of that inertia, 1. Test: StiffCloth.IsTameHoweverStiff
    const double most = max_ratio / (h * h * stiffness_by_mass_);
    cloth_.stretch_stiffness = std::min(stretch_stiffness_, most);
    cloth_.shear_stiffness = std::min(shear_stiffness_, most);
}

ClothSheet::ClothSheet(const DeformableDefinition& definition)
    : ClothSheet(definition, make_bend_elements(definition.nodes, std::get<Cloth>(definition.matter))) {}

ClothSheet::ClothSheet(const DeformableDefinition& definition, const BendElements& bend)
    : cloth_(std::get<Cloth>(definition.matter)),
      triangles_(make_cloth_triangles(definition.nodes, cloth_)),
      bending_(make_bending_rows(bend, definition.nodes.size())),
      bend_memory_(bend, definition.nodes.size(), cloth_.bend_friction, cloth_.bend_yield),
      gas_(definition),
      tear_(definition.nodes, cloth_, triangles_) {
    const std::size_t count = definition.nodes.size();
    nodes_.mass.assign(count, 0);
    for (const ClothTriangle& triangle : triangles_) {
        for (const std::uint32_t node : triangle.node) nodes_.mass[node] += cloth_.area_density * triangle.area / 3;
    }
    prestretch();
    find_stiffness_by_mass();
    Vec3 center;
    double mass = 0;
    for (std::size_t i = 0; i < count; ++i) {
        nodes_.position.push_back(transform_point(definition.pose, definition.nodes[i]));
        nodes_.inverse_mass.push_back(1 / nodes_.mass[i]);
        center += nodes_.mass[i] * nodes_.position[i];
        mass += nodes_.mass[i];
    }
    center = center / mass;
    for (const Vec3 position : nodes_.position)
        nodes_.mean_velocity.push_back(definition.linear_velocity +
                                       cross(definition.angular_velocity, position - center));
    fixed_.assign(count, 0);
    for (const std::uint32_t node : definition.pinned) {
        nodes_.inverse_mass[node] = 0;
        nodes_.mean_velocity[node] = {};
        fixed_[node] = 1;
    }
    nodes_.velocity = nodes_.mean_velocity;
    for (double& value : bending_.value) value *= cloth_.bend_stiffness;
    air_travel_.assign(triangles_.size(), 0);
    width_ = mean_width(triangles_, bend, definition.nodes);
    springs_.radius = definition.contact_radius;
    springs_.material = definition.material;
    springs_.attachments = definition.attachments;
    springs_.predicts_slip = springs_.forgets_depth = true;
    make_pattern(bending_);
    layers_.emplace(cloth_.triangles, definition.nodes);
}

// Blocks between corners of a triangle, numbers between the nodes that only bending couples.
void ClothSheet::make_pattern(const ScalarRows& bending) {
    const std::size_t count = nodes_.size();
    std::vector<std::map<std::uint32_t, std::uint32_t>> neighbours(count);
    for (const ClothTriangle& triangle : triangles_) {
        for (const std::uint32_t a : triangle.node) {
            for (const std::uint32_t b : triangle.node) {
                if (a != b) neighbours[a][b] = 0;
            }
        }
    }
    std::vector<std::vector<std::uint32_t>> near(count), far(count);
    far_element_.assign(bending.column.size(), not_far);
    for (std::size_t i = 0; i < count; ++i) {
        for (auto& [other, which] : neighbours[i]) {
            which = static_cast<std::uint32_t>(near[i].size());
            near[i].push_back(other);
        }
        near_bending_.resize(near_bending_.size() + near[i].size(), 0);
        double* near_bending = near_bending_.data() + near_bending_.size() - near[i].size();
        for (std::uint32_t k = bending.start[i]; k < bending.start[i + 1]; ++k) {
            const auto neighbour = neighbours[i].find(bending.column[k]);
            if (neighbour != neighbours[i].end()) {
                near_bending[neighbour->second] = bending.value[k];
            } else if (bending.column[k] != i) {
                far_element_[k] = static_cast<std::uint32_t>(far[i].size());
                far[i].push_back(bending.column[k]);
            }
        }
    }
    matrix_.set_pattern(near, far);

    std::vector<std::vector<Corner>> corners(count);
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t node = triangles_[t].node[k];
            Corner corner{t, k, {}};
            for (std::size_t other = 0; other < 3; ++other) {
                if (other != k) corner.element[other] = neighbours[node].at(triangles_[t].node[other]);
            }
            corners[node].push_back(corner);
        }
    }
    corner_start_.push_back(0);
    for (const auto& of_node : corners) {
        corners_.insert(corners_.end(), of_node.begin(), of_node.end());
        corner_start_.push_back(static_cast<std::uint32_t>(corners_.size()));
    }
}

// `moves`: of the nodes, or none.
ClothSheet::Images ClothSheet::images_of(const ClothTriangle& triangle, std::span<const Vec3> moves) const {
    Images images;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t node = triangle.node[k];
        const Vec3 x = moves.empty() ? nodes_.position[node] : nodes_.position[node] + moves[node];
        images.f += triangle.warp[k] * x;
        images.g += triangle.weft[k] * x;
    }
    return images;
}

// Of stretch and shear per area, J/m².
double ClothSheet::energy_of(const Images& images) const {
    const double warp = length(images.f) - 1, weft = length(images.g) - 1, angle = dot(images.f, images.g);
    return (cloth_.stretch_stiffness * (warp * warp + weft * weft) + cloth_.shear_stiffness * angle * angle) / 2;
}

// Derivatives of that energy by f and g, N/m.
ClothSheet::Images ClothSheet::stress_of(const Images& images) const {
    const auto stretched = [&](Vec3 image, Vec3 along) {
        return cloth_.stretch_stiffness * (length(image) - 1) * along;
    };
    const Vec3 f_along = normalized(images.f, {1, 0, 0}), g_along = normalized(images.g, any_perpendicular(f_along));
    const double shear = cloth_.shear_stiffness * dot(images.f, images.g);
    return {stretched(images.f, f_along) + shear * images.g, stretched(images.g, g_along) + shear * images.f};
}

// By the equations, without damping.
ClothSheet::Images ClothSheet::stress_change(const Strain& strain, const Images& change) const {
    const double shear = cloth_.shear_stiffness * (dot(strain.g, change.f) + dot(strain.f, change.g));
    return {strain.warp * dot(strain.f_displacement, change.f) * strain.f_displacement + shear * strain.g +
                strain.across_ff * change.f + strain.across_fg * change.g,
            strain.weft * dot(strain.g_displacement, change.g) * strain.g_displacement + shear * strain.f +
                strain.across_fg * change.f + strain.across_gg * change.g};
}

// Takes the damping of the motion as one piece out: the equations are linear, so a turn stretches in them.
void ClothSheet::undamp(const ClothTriangle& triangle, double damping, Strain& strain) const {
    Images turned;
    for (std::size_t k = 0; k < 3; ++k) {
        turned.f += triangle.warp[k] * turned_[triangle.node[k]];
        turned.g += triangle.weft[k] * turned_[triangle.node[k]];
    }
    const double stretch = damping * cloth_.stretch_stiffness;
    const double shear = damping * cloth_.shear_stiffness * (dot(strain.g, turned.f) + dot(strain.f, turned.g));
    strain.f_stress -= stretch * dot(strain.f_displacement, turned.f) * strain.f_displacement + shear * strain.g;
    strain.g_stress -= stretch * dot(strain.g_displacement, turned.g) * strain.g_displacement + shear * strain.f;
}

void ClothSheet::find_strains(const Substep& substep, std::span<const Vec3> moves, TaskPool& workers) {
    constexpr double min_stretch = 1e-9;  // length over that at rest: keeps its inverse finite
    strains_.resize(triangles_.size());
    air_.resize(triangles_.size());
    winds_.resize(triangles_.size());
    const auto work = [&](int, IndexRange range) {
        const double damping = cloth_.rayleigh_damping / substep.h;
        for (std::size_t t = range.first; t < range.last; ++t) {
            const ClothTriangle& triangle = triangles_[t];
            Strain& strain = strains_[t];
            const Images start = images_of(triangle, {}), images = moves.empty() ? start : images_of(triangle, moves);
            strain.f = images.f;
            strain.g = images.g;
            const double f = length(strain.f), g = length(strain.g), angle = dot(strain.f, strain.g);
            strain.f_displacement = normalized(strain.f, {1, 0, 0});
            strain.g_displacement = normalized(strain.g, any_perpendicular(strain.f_displacement));
            const double k = cloth_.stretch_stiffness, s = cloth_.shear_stiffness;
            // The second derivative of ½ (|f| - 1)² is f̂ f̂ᵀ / |f| + (1 - 1/|f|) 1.
            strain.across_ff = f > 0 ? k * (1 - 1 / f) : -k;
            strain.across_gg = g > 0 ? k * (1 - 1 / g) : -k;
            strain.across_fg = s * angle;
            strain.warp = k * std::min(1.0, 1 / std::max(f, min_stretch));
            strain.weft = k * std::min(1.0, 1 / std::max(g, min_stretch));
            make_positive(strain.across_ff, strain.across_fg, strain.across_gg);
            const Images stress = stress_of(images),
                         change = stress_change(strain, {start.f - images.f, start.g - images.g});
            strain.f_stress = stress.f + change.f;
            strain.g_stress = stress.g + change.g;
            if (!turned_.empty()) undamp(triangle, damping, strain);

            // Drag by the air that blows through the triangle: ρ/2 C A |v·n| (v·n) n, a third of it a node.
            Vec3 velocity;
            for (const std::uint32_t node : triangle.node) velocity += nodes_.mean_velocity[node] / 3;
            const Vec3 normal = normalized(cross(start.f, start.g));
            winds_[t] = substep.wind.at((nodes_.position[triangle.node[0]] + nodes_.position[triangle.node[1]] +
                                         nodes_.position[triangle.node[2]]) /
                                        3);
            const double through = dot(velocity - winds_[t], normal);
            const double drag = cloth_.drag_coefficient * young_drag(t, substep.h * through);
            air_[t] = std::sqrt(substep.air_density * drag * triangle.area * std::fabs(through) / 6) * normal;
        }
    };
    parallel_for(workers, triangles_.size(), triangles_.size() >= 1000, work);
}

Vec3 ClothSheet::normal_of(const ClothTriangle& triangle, std::span<const Vec3> moves) const {
    const Images images = images_of(triangle, moves);
    return normalized(cross(images.f, images.g));
}

// What friction and folds do about these moves, or those of the present velocity.
void ClothSheet::foresee_bending(const Substep& substep, std::span<const Vec3> moves, TaskPool& workers) {
    if (!bend_memory_.is_active()) return;
    friction_stiffness_ = substep.settings.cloth.friction_stiffness;
    foreseen_.assign(moves.begin(), moves.end());
    if (moves.empty()) {
        for (const Vec3 velocity : nodes_.mean_velocity) foreseen_.push_back(substep.h * velocity);
    }
    normals_.resize(triangles_.size());
    parallel_for(workers, normals_.size(), normals_.size() >= 1000, [&](int, IndexRange range) {
        for (std::size_t t = range.first; t < range.last; ++t)
            normals_[t] = {normal_of(triangles_[t], {}), normal_of(triangles_[t], foreseen_)};
    });
    bend_memory_.foresee(nodes_.position, foreseen_, normals_, friction_stiffness_, workers);
}

// Travel through the air since it last turned round, m, with what comes to it.
double ClothSheet::travel_with(std::size_t triangle, double added) const {
    const double travel = air_travel_[triangle];
    return travel * added < 0 ? added : travel + added;
}

// Drag over that in a steady stream.
double ClothSheet::young_drag(std::size_t triangle, double added) const {
    const double travel = std::fabs(travel_with(triangle, added));
    return travel > 0 ? std::max(1.0, young_vortex_drag * std::cbrt(width_ / travel)) : 1;
}

// `near`: to work with.
void ClothSheet::fill_row(std::size_t i, const Substep& substep, std::vector<Block>& near) {
    const double h = substep.h, damping = cloth_.rayleigh_damping / h, damped = 1 + damping;
    const double damping_stretch = damping * cloth_.stretch_stiffness, shear = damped * cloth_.shear_stiffness;  // N/m
    const double inertia = nodes_.mass[i] / (h * h);
    const double friction = bend_memory_.added_stiffness(friction_stiffness_), bent = damped + friction;
    Mat3 own = Mat3::diagonal({inertia, inertia, inertia});
    Vec3 load = nodes_.mass[i] / h * nodes_.mean_velocity[i] + weight_[i];

    if (!nodes_.flow.empty()) {
        own += Mat3::diagonal(nodes_.flow[i].drag / h);
        load += nodes_.flow[i].force({}, substep.time + h);
    }

    const std::size_t first = matrix_.near_first(i);
    near.resize(matrix_.near_first(i + 1) - first);
    for (std::size_t k = 0; k < near.size(); ++k) {
        const double b = bent * near_bending_[first + k];
        near[k] = to_block(Mat3::diagonal({b, b, b}));
    }
    for (std::uint32_t k = bending_.start[i]; k < bending_.start[i + 1]; ++k) {
        load -= bending_.value[k] * nodes_.position[bending_.column[k]];
        if (friction > 0) load += friction * bending_.value[k] * foreseen_[bending_.column[k]];
        if (bending_.column[k] == i) own += bent * bending_.value[k] * Mat3::identity();
        if (far_element_[k] != not_far)
            matrix_.set_far(i, far_element_[k], static_cast<float>(bent * bending_.value[k]));
    }
    if (bend_memory_.is_active()) load += cloth_.bend_stiffness * bend_memory_.force_on(i);
    if (gas_.is_active()) load += gas_.force_on(i);
    for (std::uint32_t c = corner_start_[i]; c < corner_start_[i + 1]; ++c) {
        const Corner& corner = corners_[c];
        const ClothTriangle& triangle = triangles_[corner.triangle];
        const Strain& strain = strains_[corner.triangle];
        const double area = triangle.area, b = triangle.warp[corner.corner], d = triangle.weft[corner.corner];
        load -= area * (b * strain.f_stress + d * strain.g_stress);
        const Vec3 angle = b * strain.g + d * strain.f;  // derivative of f·g
        for (std::size_t other = 0; other < 3; ++other) {
            const double b2 = triangle.warp[other], d2 = triangle.weft[other];
            Mat3 block = (area * (strain.warp + damping_stretch) * b * b2) * symmetric_outer(strain.f_displacement) +
                         (area * (strain.weft + damping_stretch) * d * d2) * symmetric_outer(strain.g_displacement) +
                         (area * shear) * outer(angle, b2 * strain.g + d2 * strain.f);
            const double across =
                area * (strain.across_ff * b * b2 + strain.across_gg * d * d2 + strain.across_fg * (b * d2 + d * b2));
            block += across * Mat3::identity();
            if (other == corner.corner) {
                own += block;
                continue;
            }
            if (gas_.is_active()) block += gas_.block(triangle.node, corner.corner, other == (corner.corner + 1) % 3);
            near[corner.element[other]] += to_block(block);
        }
        const Vec3 air = air_[corner.triangle];
        own += (1 / h) * symmetric_outer(air);
        load += dot(air, winds_[corner.triangle]) * air;
    }
    for (std::size_t k = 0; k < near.size(); ++k) matrix_.set_near(i, k, near[k]);
    matrix_.diagonal[i] = to_block(own);
    node_stiffness_[i] = trace(own) / 3;
    rhs_[i] = load;
}

void ClothSheet::fill_rows(const Substep& substep, TaskPool& workers) {
    const std::size_t count = nodes_.size();
    rhs_.resize(count);
    weight_.resize(count);
    small_load_.resize(count);
    node_stiffness_.resize(count);
    const double least = std::max(length(substep.gravity), substep.settings.thin_contact.min_gravity);  // m/s²
    for (std::size_t i = 0; i < count; ++i) {
        weight_[i] = nodes_.mass[i] * substep.gravity + nodes_.force_on(i);
        small_load_[i] = {0, nodes_.mass[i] * least, 0};
    }
    parallel_for(workers, count, count >= 1000, [&](int, IndexRange range) {
        std::vector<Block> near;
        for (std::size_t i = range.first; i < range.last; ++i) fill_row(i, substep, near);
    });
}

bool ClothSheet::is_free() const {
    return std::ranges::none_of(fixed_, [](std::uint8_t fixed) { return fixed != 0; }) && !springs_.any_acts();
}

std::vector<Vec3> ClothSheet::take_impulses(const Substep& substep, std::span<const Vec3> moves) {
    const double h = substep.h;
    const std::vector<Vec3> by_flow = impulses_of_flow(nodes_, moves, substep);
    std::vector<Vec3> all(nodes_.size());
    for (std::size_t i = 0; i < nodes_.size(); ++i) all[i] = h * weight_[i];
    for (std::size_t i = 0; i < by_flow.size(); ++i) {
        nodes_.flow_impulse[i] += by_flow[i];
        all[i] += by_flow[i];
    }
    for (std::size_t t = 0; t < triangles_.size(); ++t) {  // the air as it acted
        for (const std::uint32_t node : triangles_[t].node)
            all[node] += dot(air_[t], h * winds_[t] - moves[node]) * air_[t];
    }
    return all;
}

std::vector<ThinCandidate> ClothSheet::near_layers(const Substep& substep, TaskPool& workers) {
    const double h = substep.h;
    moves_.resize(nodes_.size());
    for (std::size_t i = 0; i < moves_.size(); ++i) moves_[i] = h * nodes_.mean_velocity[i];
    return layers_->near(nodes_, apart() + length(substep.gravity) * h * h, moves_, substep.settings.cloth, workers);
}

void ClothSheet::linearize(const Substep& substep, std::span<const Vec3> moves, TaskPool& workers) {
    find_strains(substep, moves, workers);
    foresee_bending(substep, moves, workers);
    if (gas_.is_active()) gas_.linearize(nodes_.position, moves);
    fill_rows(substep, workers);
}

double ClothSheet::unforeseen_energy(std::span<const Vec3> moves, TaskPool& workers) {
    unforeseen_.resize(triangles_.size());
    parallel_for(workers, triangles_.size(), triangles_.size() >= 1000, [&](int, IndexRange range) {
        for (std::size_t t = range.first; t < range.last; ++t) {
            const Strain& strain = strains_[t];
            const Images from{strain.f, strain.g}, to = images_of(triangles_[t], moves);
            const Images change{to.f - from.f, to.g - from.g};
            const Images stress = stress_of(from), added = stress_change(strain, change);
            const double foreseen =
                energy_of(from) + dot(stress.f + added.f / 2, change.f) + dot(stress.g + added.g / 2, change.g);
            unforeseen_[t] = triangles_[t].area * std::max(0.0, energy_of(to) - foreseen);
        }
    });
    const double of_gas = gas_.is_active() ? gas_.unforeseen_energy(nodes_.position, moves) : 0;
    return std::accumulate(unforeseen_.begin(), unforeseen_.end(), of_gas);
}

// By the present motion of the whole as one piece, m. Where gas pulls a sheet taut its tension is large beside its
// inertia. What the matrix leaves out of the stress of pressed triangles would then hold the sheet against turning.
std::vector<Vec3> ClothSheet::whole_moves(double h) const {
    const WholeMotion motion = motion_of_whole(nodes_);
    const double angle = h * length(motion.spin);
    const Quat turn = from_axis_angle(normalized(motion.spin, {0, 1, 0}), std::isfinite(angle) ? angle : 0);
    std::vector<Vec3> moves;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        const Vec3 arm = nodes_.position[i] - motion.center;
        moves.push_back(fixed_[i] != 0 ? Vec3{} : h * motion.velocity + rotate(turn, arm) - arm);
    }
    return moves;
}

void ClothSheet::begin(const Substep& substep, std::span<const NodeContact> contacts,
                       std::span<const SheetContact> between, std::span<const std::uint32_t> attachment_bodies,
                       std::span<const TouchedBody> bodies, TaskPool& workers) {
    springs_.tolerance = substep.settings.thin_contact.change_tolerance;
    limit_stiffness(substep.h);
    if (gas_.is_active()) turned_ = whole_moves(substep.h);
    linearize(substep, turned_, workers);
    springs_.attachment_bodies.assign(attachment_bodies.begin(), attachment_bodies.end());
    springs_.begin(nodes_, contacts, bodies, substep, node_stiffness_);
    for (const SheetContact& contact : between) springs_.add(nodes_, contact, bodies, substep);
}

void ClothSheet::freeze() {
    is_frozen_ = true;
    for (std::size_t i = 0; i < nodes_.size(); ++i) nodes_.mean_velocity[i] = nodes_.velocity[i] = {};
}

void ClothSheet::finish(const Substep& substep, std::span<Vec3> moves, std::span<const BodyMove> body_moves,
                        std::span<TouchedBody> bodies) {
    springs_.finish(moves, body_moves, substep, bodies);
}

void ClothSheet::move_nodes(std::span<const Vec3> moves, const Substep& substep, TaskPool& workers) {
    set_velocities(nodes_, moves, substep.h);
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
        Vec3 added = -substep.h * winds_[t];
        for (const std::uint32_t node : triangles_[t].node) added += moves[node] / 3;
        air_travel_[t] = travel_with(t, dot(added, normal_of(triangles_[t], {})));
    }
    for (std::size_t i = 0; i < nodes_.size(); ++i) nodes_.position[i] += moves[i];
    if (bend_memory_.is_active()) bend_memory_.keep(nodes_.position, normals(), friction_stiffness_, workers);
}

// Of all triangles.
std::vector<Vec3> ClothSheet::normals() const {
    std::vector<Vec3> normals;
    for (const ClothTriangle& triangle : triangles_) normals.push_back(normal_of(triangle, {}));
    return normals;
}

void ClothSheet::go_on_from(const ClothSheet& other) {
    nodes_.substep = other.nodes_.substep;
    springs_.go_on_from(other.springs_);
    if (other.bend_memory_.is_active())
        bend_memory_.go_on_from(other.bend_memory_, nodes_.position, other.nodes_.position, normals());
    if (other.triangles_.size() == triangles_.size()) air_travel_ = other.air_travel_;
}

// `prestretch` has made the stiffness one of the form of the nodes.
std::vector<SheetStress> ClothSheet::stress() const {
    const double stretch = cloth_.prestretch * cloth_.prestretch * cloth_.stretch_stiffness;
    const double shear = cloth_.prestretch * cloth_.prestretch * cloth_.shear_stiffness;
    std::vector<SheetStress> all;
    all.reserve(triangles_.size());
    for (const ClothTriangle& triangle : triangles_) {
        const Images images = images_of(triangle, {}), pull = stress_of(images);
        all.push_back({.warp = stretch * (length(images.f) - 1),
                       .weft = stretch * (length(images.g) - 1),
                       .shear = shear * dot(images.f, images.g),
                       .energy = energy_of(images),
                       .pull = {{{dot(images.f, pull.f), dot(images.f, pull.g)},
                                 {dot(images.g, pull.f), dot(images.g, pull.g)}}}});
    }
    return all;
}

double ClothSheet::elastic_energy() const {
    double energy = 0;
    for (const ClothTriangle& triangle : triangles_) energy += triangle.area * energy_of(images_of(triangle, {}));
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        for (std::uint32_t k = bending_.start[i]; k < bending_.start[i + 1]; ++k)
            energy += bending_.value[k] / 2 * dot(nodes_.position[i], nodes_.position[bending_.column[k]]);
    }
    if (bend_memory_.is_active())
        energy += cloth_.bend_stiffness * bend_memory_.energy(nodes_.position, normals(), friction_stiffness_);
    if (gas_.is_active()) energy += gas_.energy(gas_.volume(nodes_.position));
    return energy;
}

}  // namespace embody::physics::deformable
