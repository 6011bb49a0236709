// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "physics/constraint/joint/joint_system.h"
#include "physics/constraint/namespace.h"

namespace embody::physics::constraint {

/// How joints pass an impact on, in the same instant: an impulse f on jointed bodies changes their velocities by the Δv
/// of
///
///   M Δv − Jᵀ λ = f,   J Δv = 0      λ: impulses of the joints
///
/// which keeps momentum and all joints, and whose inverse is symmetric, so that the energy of a collision follows from
/// its impulse alone. Motors and springs take no part: their forces are finite. One factorisation serves all impulses.
class ImpactJoints {
public:
    using View = JointSystem::View;

    /// An impulse on a body, N s, at `arm` from its centre of mass, m.
    struct Push {
        std::uint32_t body = 0;
        Vec3 impulse, arm;
    };

    /// No body is jointed.
    void clear();
    /// These bodies and joints, at the places where they are at the impact; a joint whose other body is not in the list
    /// is held by that body with its pose and velocity then. Bodies ascend.
    void set(const JointedList& list, const View& view);

    [[nodiscard]] std::span<const std::uint32_t> bodies() const { return bodies_; }
    /// The body's place in bodies(), or −1.
    [[nodiscard]] int number_of(std::uint32_t body) const;

    /// Takes from the velocities what the joints forbid.
    void project(const View& view);
    /// Changes of the velocities of bodies(), in their order, if these pushes come at once; valid until the next call.
    /// Pushes on other bodies are ignored.
    std::span<const Vec6> respond(std::span<const Push> pushes);
    /// Adds the joints' impulses by the pushes to their totals of the step.
    void add_to_totals(std::span<const Push> pushes, const View& view);

    /// Maximum number of remembered structures of assemblies; analysing one again gives the same.
    static constexpr std::size_t max_analysed = 16;

private:
    struct Place {
        std::uint32_t joint = 0;      // index
        std::int32_t a = -1, b = -1;  // numbers of the bodies; −1: does not move
        std::uint32_t edge_a = 0, edge_b = 0;
        JointRows rows;
        Vec3 arm_b;  // from b's centre of mass to the joint
    };
    /// A matrix whose pattern is analysed. Assemblies of one structure use the same one.
    struct Analysed {
        std::size_t bodies = 0, nodes = 0;
        std::vector<BlockPattern::Edge> edges;
        BlockLu matrix;
        std::uint64_t last_use = 0;
    };
    void choose_matrix();
    void factor(const View& view);
    void put_joint(std::size_t number, const View& view);
    BlockLu& matrix() { return analysed_[chosen_].matrix; }

    std::vector<std::uint32_t> bodies_;
    std::vector<Place> places_;
    std::vector<BlockPattern::Edge> edges_;
    std::vector<Analysed> analysed_;  // at most max_analysed; those not used for the longest time make room
    std::size_t chosen_ = 0;          // of analysed_
    std::uint64_t uses_ = 0;
    std::vector<Vec6> unknowns_;  // changes of the bodies' velocities, impulses of the joints
};

}  // namespace embody::physics::constraint
