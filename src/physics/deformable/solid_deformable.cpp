// SPDX-License-Identifier: MIT
#include "physics/deformable/solid_deformable.h"

#include <algorithm>

#include "geometry/tetrahedra/tetrahedral_mesh.h"

namespace embody::physics {

namespace {

constexpr float tolerance = 1e-3f;  // of the residual, in the preconditioner's norm
constexpr int most_rounds = 60;

double dot(std::span<const Vec3f> a, std::span<const Vec3f> b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += embody::dot(to_vec3(a[i]), to_vec3(b[i]));
    return sum;
}

void add_scaled(std::span<Vec3f> to, float factor, std::span<const Vec3f> what) {
    for (std::size_t i = 0; i < to.size(); ++i)
        to[i] = {to[i].x + factor * what[i].x, to[i].y + factor * what[i].y, to[i].z + factor * what[i].z};
}

}  // namespace

SolidDeformable::SolidDeformable(const DeformableDefinition& definition)
    : elements_(std::get<SoftSolid>(definition.matter), definition.nodes),
      damping_(std::get<SoftSolid>(definition.matter).rayleigh_damping),
      rest_(definition.nodes) {
    place_nodes(definition);
    find_surface();
    elements_.reset_rotations(normalized(definition.pose.rotation));
    const std::size_t count = nodes_.size();
    for (auto* vector : {&start_, &pushes_, &unsettled_, &force_}) vector->resize(count);
    for (auto* vector : {&residual_, &move_, &direction_, &product_, &correction_}) vector->resize(count);
    touched_place_.assign(count, untouched);
    factor_.analyse(rest_, elements_.edges());
}

void SolidDeformable::place_nodes(const DeformableDefinition& definition) {
    const double density = std::get<SoftSolid>(definition.matter).density;
    Vec3 center;
    double whole = 0;
    for (std::size_t i = 0; i < definition.nodes.size(); ++i) {
        const double mass = density * elements_.node_volumes()[i];
        nodes_.position.push_back(transform_point(definition.pose, definition.nodes[i]));
        nodes_.mass.push_back(mass);
        nodes_.inverse_mass.push_back(1 / mass);
        center += mass * nodes_.position.back();
        whole += mass;
    }
    center = center / whole;
    for (const Vec3 p : nodes_.position)
        nodes_.mean_velocity.push_back(definition.linear_velocity + cross(definition.angular_velocity, p - center));
    for (const std::uint32_t node : definition.pinned) {
        nodes_.inverse_mass[node] = 0;
        nodes_.mean_velocity[node] = {};
    }
    is_free_ = definition.pinned.empty();
    nodes_.velocity = nodes_.mean_velocity;
}

void SolidDeformable::find_surface() {
    std::vector<geometry::Tetrahedron> corners(elements_.corners().begin(), elements_.corners().end());
    for (const auto& face : geometry::find_tetrahedral_topology(corners).outer_faces) {
        surface_.push_back(face.corners);
        surface_nodes_.insert(surface_nodes_.end(), face.corners.begin(), face.corners.end());
    }
    std::ranges::sort(surface_nodes_);
    surface_nodes_.erase(std::unique(surface_nodes_.begin(), surface_nodes_.end()), surface_nodes_.end());
}

Bounds SolidDeformable::bounds() const {
    Bounds bounds;
    for (const Vec3 p : nodes_.position) bounds.add(p);
    return bounds;
}

// H₀ = M/h² + (1 + β/h) K; pinned nodes stand apart.
void SolidDeformable::make_factor(double h) {
    factor_h_ = h;
    std::vector<Mat3> diagonal(nodes_.size(), Mat3::zero()), blocks(elements_.edges().size(), Mat3::zero());
    elements_.add_rest_stiffness(1 + damping_ / h, diagonal, blocks);
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        const double inertia = nodes_.mass[i] / (h * h);
        diagonal[i] += Mat3::diagonal({inertia, inertia, inertia});
    }
    for (std::size_t e = 0; e < blocks.size(); ++e) {
        const auto [a, b] = elements_.edges()[e];
        if (!(nodes_.inverse_mass[a] > 0 && nodes_.inverse_mass[b] > 0)) blocks[e] = Mat3::zero();
    }
    factor_.factor(diagonal, elements_.edges(), blocks);
    touched_place_.assign(nodes_.size(), untouched);
    touched_.clear();
}

void SolidDeformable::begin_substep(double h, Vec3 gravity) {
    h_ = h;
    gravity_ = gravity;
    if (factor_h_ != h) make_factor(h);
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        // The definition tells the velocity at the start, not the mean before it.
        if (is_new_ && nodes_.inverse_mass[i] > 0) nodes_.mean_velocity[i] -= (h / 2) * gravity;
        start_[i] = nodes_.position[i];
        nodes_.position[i] += h * nodes_.mean_velocity[i];
        pushes_[i] = {};
        unsettled_[i] = {};
    }
    is_new_ = false;
}

void SolidDeformable::push(std::uint32_t node, Vec3 force) {
    pushes_[node] += force;
    unsettled_[node] += force;
}

// correction = Q L⁻ᵀ L⁻¹ Qᵀ residual
void SolidDeformable::precondition(TaskPool& workers) {
    const auto& rotations = elements_.node_rotations();
    for (std::size_t i = 0; i < nodes_.size(); ++i)
        correction_[i] = to_vec3f(rotate_inverse(rotations[i], to_vec3(residual_[i])));
    factor_.solve(correction_, workers);
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        correction_[i] = nodes_.inverse_mass[i] > 0 ? to_vec3f(rotate(rotations[i], to_vec3(correction_[i]))) : Vec3f{};
    }
}

int SolidDeformable::solve(TaskPool& workers) {
    // With x = x_old + h u the inertial force leaves gravity alone: r = M g + pushes + f(x, u).
    for (std::size_t i = 0; i < nodes_.size(); ++i) force_[i] = nodes_.mass[i] * gravity_ + pushes_[i];
    elements_.linearise(nodes_.position, nodes_.mean_velocity, force_);
    const bool is_pinned = !is_free_;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        residual_[i] = is_pinned && !(nodes_.inverse_mass[i] > 0) ? Vec3f{} : to_vec3f(force_[i]);
        move_[i] = {};
        unsettled_[i] = {};
    }

    // (M/h² + (1 + β/h) K_R) d = r by conjugate gradients.
    const auto stiffness_factor = static_cast<float>(1 + damping_ / h_);
    precondition(workers);
    direction_ = correction_;
    double size = dot(residual_, correction_);
    const double enough = size * static_cast<double>(tolerance * tolerance);
    int round = 0;
    for (; round < most_rounds && size > enough && size > 0; ++round) {
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            const auto inertia = static_cast<float>(nodes_.mass[i] / (h_ * h_));
            product_[i] = {inertia * direction_[i].x, inertia * direction_[i].y, inertia * direction_[i].z};
        }
        elements_.add_stiffness(stiffness_factor, direction_, product_);
        if (is_pinned) {
            for (std::size_t i = 0; i < nodes_.size(); ++i) {
                if (!(nodes_.inverse_mass[i] > 0)) product_[i] = {};
            }
        }
        const double curvature = dot(direction_, product_);
        if (!(curvature > 0)) break;
        const auto step = static_cast<float>(size / curvature);
        add_scaled(move_, step, direction_);
        add_scaled(residual_, -step, product_);
        precondition(workers);
        const double next = dot(residual_, correction_);
        add_scaled(correction_, static_cast<float>(next / size), direction_);
        std::swap(direction_, correction_);
        size = next;
    }
    for (std::size_t i = 0; i < nodes_.size(); ++i) nodes_.position[i] += to_vec3(move_[i]);
    return round;
}

void SolidDeformable::settle(TaskPool& workers) {
    for (std::size_t i = 0; i < nodes_.size(); ++i) residual_[i] = to_vec3f(unsettled_[i]);
    precondition(workers);
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        nodes_.position[i] += to_vec3(correction_[i]);
        unsettled_[i] = {};
    }
}

Mat3 SolidDeformable::compliance(std::uint32_t i, std::uint32_t j) {
    const auto place_of = [&](std::uint32_t node) {
        if (touched_place_[node] == untouched) {
            touched_place_[node] = static_cast<std::uint32_t>(touched_.size());
            TouchedNode touched{factor_.columns(node), {}};
            const bool is_pinned = !(nodes_.inverse_mass[node] > 0);
            for (const TouchedNode& other : touched_)
                touched.blocks.push_back(factor_.inverse_block(touched.columns, other.columns));
            touched.blocks.push_back(is_pinned ? Mat3::zero()
                                               : factor_.inverse_block(touched.columns, touched.columns));
            touched_.push_back(std::move(touched));
        }
        return touched_place_[node];
    };
    const std::uint32_t a = place_of(i), b = place_of(j);
    return a >= b ? touched_[a].blocks[b] : transpose(touched_[b].blocks[a]);
}

void SolidDeformable::finish() {
    if (is_free_) keep_momenta();
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        const Vec3 mean = (nodes_.position[i] - start_[i]) / h_, last = nodes_.mean_velocity[i];
        nodes_.velocity[i] = mean + 0.5 * (mean - last);
        nodes_.mean_velocity[i] = mean;
    }
}

// Inner forces neither move nor turn the whole. A solve that ends early does, and so do forces that are found where the
// nodes come to but act where they came from; a small move and turn of the whole takes that back.
void SolidDeformable::keep_momenta() {
    Vec3 center, wanted, wanted_turning;
    double whole = 0;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        center += nodes_.mass[i] * start_[i];
        whole += nodes_.mass[i];
    }
    center = center / whole;
    Vec3 has, has_turning;  // h times the momenta
    Mat3 inertia = Mat3::zero();
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        const double mass = nodes_.mass[i];
        const Vec3 arm = start_[i] - center, way = nodes_.position[i] - start_[i];
        const Vec3 free_way = h_ * nodes_.mean_velocity[i] + (h_ * h_) * (gravity_ + pushes_[i] / mass);
        has += mass * way;
        wanted += mass * free_way;
        has_turning += mass * cross(arm, way);
        wanted_turning += mass * cross(arm, free_way);
        inertia += mass * (length_squared(arm) * Mat3::identity() - outer(arm, arm));
    }
    const Vec3 shift = (wanted - has) / whole;
    const Vec3 turn = embody::solve(inertia, wanted_turning - has_turning);
    for (std::size_t i = 0; i < nodes_.size(); ++i) nodes_.position[i] += shift + cross(turn, start_[i] - center);
}

void SolidDeformable::set_motion(std::span<const Vec3> positions, std::span<const Vec3> velocities, Quat rotation) {
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        nodes_.position[i] = positions[i];
        nodes_.mean_velocity[i] = nodes_.velocity[i] = nodes_.inverse_mass[i] > 0 ? velocities[i] : Vec3{};
    }
    elements_.reset_rotations(rotation);
    is_new_ = true;
}

void SolidDeformable::rest() {
    std::ranges::fill(nodes_.mean_velocity, Vec3{});
    std::ranges::fill(nodes_.velocity, Vec3{});
}

void SolidDeformable::stop_at(std::span<const Vec3> positions) {
    std::ranges::copy(positions, nodes_.position.begin());
    rest();
}

bool SolidDeformable::is_finite() const {
    return std::ranges::all_of(nodes_.position, [](Vec3 p) { return embody::is_finite(p); });
}

Conserved SolidDeformable::conserved(Vec3 gravity) const {
    Conserved sum;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        if (!(nodes_.inverse_mass[i] > 0)) continue;
        const double mass = nodes_.mass[i];
        const Vec3 v = nodes_.velocity[i], x = nodes_.position[i];
        sum.kinetic_energy += mass / 2 * length_squared(v);
        sum.potential_energy -= mass * embody::dot(gravity, x);
        sum.linear_momentum += mass * v;
        sum.angular_momentum += cross(x, mass * v);
    }
    sum.potential_energy += elements_.energy(nodes_.position);
    return sum;
}

}  // namespace embody::physics
