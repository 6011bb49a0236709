// SPDX-License-Identifier: MIT
//
// Source: T. Kane, D. Levinson, "Dynamics: theory and applications", 1985 (impulses in systems with constraints);
// factors of bodies and joints as in joint_system.cpp.
#include "physics/constraint/impact/impact_joints.h"

#include <algorithm>

namespace embody::physics::constraint {

void ImpactJoints::clear() {
    bodies_.clear();
    places_.clear();
}

int ImpactJoints::number_of(std::uint32_t body) const {
    const auto found = std::lower_bound(bodies_.begin(), bodies_.end(), body);
    return found != bodies_.end() && *found == body ? static_cast<int>(found - bodies_.begin()) : -1;
}

void ImpactJoints::set(const JointedList& list, const View& view) {
    bodies_.assign(list.bodies.begin(), list.bodies.end());
    places_.clear();
    for (const std::uint32_t index : list.joints) {
        const Joint& joint = view.joints[index];
        const auto pose_of = [&](std::uint32_t body) -> Transform {
            return {view.bodies[body].center, view.bodies[body].rotation};
        };
        const JointGeometry geometry =
            pose_joint(joint, joint.a_is_world ? Transform{} : pose_of(joint.a), pose_of(joint.b)).geometry;
        places_.push_back({.joint = index,
                           .a = joint.a_is_world ? -1 : number_of(joint.a),
                           .b = number_of(joint.b),
                           .rows = make_rows(joint, geometry),
                           .arm_b = geometry.arm_b});
    }
    choose_matrix();
    factor(view);
}

// The matrix of this structure: as analysed before, or in the place of the one that was not used for the longest time.
void ImpactJoints::choose_matrix() {
    edges_.clear();
    for (std::size_t i = 0; i < places_.size(); ++i) {
        Place& place = places_[i];
        const auto add_edge = [&](std::int32_t body) {
            const auto edge = static_cast<std::uint32_t>(edges_.size());
            const auto node = static_cast<std::uint16_t>(bodies_.size() + i);
            if (body >= 0) edges_.push_back({node, static_cast<std::uint16_t>(body)});
            return edge;
        };
        place.edge_a = add_edge(place.a);
        place.edge_b = add_edge(place.b);
    }
    const std::size_t nodes = bodies_.size() + places_.size();
    unknowns_.resize(nodes);
    const auto is_it = [&](const Analysed& a) {
        return a.bodies == bodies_.size() && a.nodes == nodes && a.edges == edges_;
    };
    auto found = std::find_if(analysed_.begin(), analysed_.end(), is_it);
    if (found == analysed_.end()) {
        const auto is_older = [](const Analysed& a, const Analysed& b) { return a.last_use < b.last_use; };
        found = analysed_.size() < max_analysed ? analysed_.emplace(analysed_.end())
                                                : std::min_element(analysed_.begin(), analysed_.end(), is_older);
        found->bodies = bodies_.size();
        found->nodes = nodes;
        found->edges = edges_;
        found->matrix.analyse(nodes, edges_, places_.size());
    }
    found->last_use = ++uses_;
    chosen_ = static_cast<std::size_t>(found - analysed_.begin());
}

void ImpactJoints::factor(const View& view) {
    matrix().clear();
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const BodyConstants& c = view.constants[bodies_[i]];
        const Mat3 inertia = c.is_isotropic ? c.inertia : rotate_tensor(view.bodies[bodies_[i]].rotation, c.inertia);
        add_to(matrix().diagonal(i), Mat3::identity() * c.mass, Mat3::zero(), Mat3::zero(), inertia);
    }
    for (std::size_t i = 0; i < places_.size(); ++i) put_joint(i, view);
    matrix().factor();
}

void ImpactJoints::put_joint(std::size_t number, const View& view) {
    const Place& place = places_[number];
    const Joint& joint = view.joints[place.joint];
    Block6& own = matrix().diagonal(bodies_.size() + number);
    for (int row = 0; row < max_joint_rows; ++row) own.column[row][row] = -1;
    for (int row = 0; row < place.rows.count; ++row) {
        const JointRow& j = place.rows.rows[static_cast<std::size_t>(row)];
        own.column[row][row] = -view.settings.regularisation * row_response(joint, j, view.bodies);
        const auto put = [&](std::int32_t body, std::uint32_t edge, const Vec6& numbers) {
            if (body < 0) return;
            const bool joint_has_rows = matrix().row_end(edge) == 0;
            for (Block6* block : {&matrix().lower(edge), &matrix().upper(edge)}) {
                for (int i = 0; i < 6; ++i) {
                    (joint_has_rows ? block->column[i][row] : block->column[row][i]) = numbers.value[i];
                }
            }
        };
        put(place.a, place.edge_a, make_vec6(j.linear, j.angular_a));
        put(place.b, place.edge_b, make_vec6(-j.linear, -j.angular_b));
    }
}

void ImpactJoints::project(const View& view) {
    std::fill(unknowns_.begin(), unknowns_.end(), Vec6{});
    for (std::size_t i = 0; i < places_.size(); ++i) {
        const Joint& joint = view.joints[places_[i].joint];
        for (int row = 0; row < places_[i].rows.count; ++row) {
            unknowns_[bodies_.size() + i].value[row] =
                row_speed(joint, places_[i].rows.rows[static_cast<std::size_t>(row)], view.bodies);
        }
    }
    matrix().solve(unknowns_);
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        view.bodies[bodies_[i]].linear_velocity += unknowns_[i].linear();
        view.bodies[bodies_[i]].angular_velocity += unknowns_[i].angular();
    }
}

std::span<const Vec6> ImpactJoints::respond(std::span<const Push> pushes) {
    std::fill(unknowns_.begin(), unknowns_.end(), Vec6{});
    for (const Push& push : pushes) {
        const int number = number_of(push.body);
        if (number < 0) continue;
        Vec6& sum = unknowns_[static_cast<std::size_t>(number)];
        sum = make_vec6(sum.linear() + push.impulse, sum.angular() + cross(push.arm, push.impulse));
    }
    matrix().solve(unknowns_);
    return std::span(unknowns_).first(bodies_.size());
}

void ImpactJoints::add_to_totals(std::span<const Push> pushes, const View& view) {
    respond(pushes);
    for (std::size_t i = 0; i < places_.size(); ++i) {
        const Place& place = places_[i];
        Vec3 linear, angular;
        for (int row = 0; row < place.rows.count; ++row) {
            const JointRow& j = place.rows.rows[static_cast<std::size_t>(row)];
            linear += j.linear * unknowns_[bodies_.size() + i].value[row];
            angular += j.angular_b * unknowns_[bodies_.size() + i].value[row];
        }
        Joint& joint = view.joints[place.joint];
        joint.total_linear += linear;
        joint.total_angular += angular - cross(place.arm_b, linear);
    }
}

}  // namespace embody::physics::constraint
