// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "physics/deformable/cloth/cloth_sheet.h"
#include "physics/deformable/contact/free_motion.h"
#include "physics/deformable/rope/rope_line.h"

namespace embody::physics::deformable {

inline constexpr double gravity = 9.81;

/// A surface with that Coulomb coefficient, whether it sticks or slides.
inline Material sliding(double friction) { return {.friction_static = friction, .friction_dynamic = friction}; }

/// A body for deformables to touch, still at the start, without a world around it.
struct LooseBody {
    std::unique_ptr<CollisionShape> shape;
    TouchedBody body;
    LooseBody(const ShapeDefinition& definition, const Transform& pose, double friction)
        : shape(std::move(CollisionShape::create(definition)).value()) {
        body.shape = shape.get();
        body.material = sliding(friction);
        body.start = pose;
        body.start_center = pose.position;
    }
    /// Lets it move: a ball's mass, m in kg and r in m.
    void make_ball(double mass, double radius) {
        const double inverse_inertia = 1 / (0.4 * mass * radius * radius);
        body.inverse_mass = 1 / mass;
        body.inverse_inertia = Mat3::diagonal({inverse_inertia, inverse_inertia, inverse_inertia});
    }
};

/// A deformable alone with bodies, which gravity and its pushes move between steps of one substep each.
template <class Deformable>
struct DeformableScene {
    Deformable deformable;
    double radius;
    std::unique_ptr<CollisionShape> node_ball;
    std::vector<std::uint32_t> all_nodes;
    ClothSolver solver;
    TaskPool workers{1};
    Substep substep{.h = 1.0 / 60, .gravity = {0, -gravity, 0}, .air_density = 0};
    std::vector<NodeContact> contacts;
    std::vector<SegmentContact> segment_contacts;
    std::vector<TouchedBody> bodies;
    std::vector<std::uint32_t> attachments;

    explicit DeformableScene(const DeformableDefinition& definition)
        : deformable(definition),
          radius(definition.contact_radius),
          node_ball(std::move(CollisionShape::create(SphereShape{definition.contact_radius})).value()) {
        EXPECT_TRUE(validate(definition).ok()) << validate(definition).error().message();
        for (std::uint32_t i = 0; i < definition.nodes.size(); ++i) all_nodes.push_back(i);
    }
    void step() {
        contacts.clear();
        find_node_contacts(deformable.nodes(), all_nodes, *node_ball, radius, bodies, substep.h, substep.gravity,
                           contacts, workers);
        for (TouchedBody& body : bodies) body.shift = body.turn = body.impulse = body.angular_impulse = {};
        if constexpr (std::is_same_v<Deformable, RopeLine>)
            deformable.advance(substep, contacts, segment_contacts, attachments, bodies);
        else
            advance_sheet();
        for (TouchedBody& body : bodies) move_on(body);
    }
    // A sheet that meets neither itself nor others.
    void advance_sheet() {
        deformable.begin(substep, contacts, {}, attachments, bodies, workers);
        solver.set(substep.settings.cloth);
        std::vector<Vec3> moves;
        for (const Vec3 velocity : deformable.nodes().mean_velocity) moves.push_back(substep.h * velocity);
        std::vector<BodyMove> body_moves(bodies.size());
        TouchSprings& touch = deformable.touch();
        touch.choose(moves, body_moves, true);
        const std::vector<BodyInertia> inertias = inertias_of(bodies, substep.h);
        for (int solves = 1;; ++solves) {
            solver.solve(std::array{deformable.system()}, {}, touch.springs(), inertias, moves, body_moves, workers);
            // The last solve's springs stay as they were in it.
            TouchSprings next = touch;
            if (solves == substep.settings.cloth.max_solves || !next.choose(moves, body_moves, false)) break;
            touch = std::move(next);
        }
        const FreePart part{&deformable.nodes(), deformable.take_impulses(substep, moves), moves};
        if (deformable.is_free()) keep_momenta(std::span(&part, 1), substep.h, substep.settings.thin_contact);
        deformable.finish(substep, moves, body_moves, bodies);
        deformable.move_nodes(moves, substep, workers);
    }
    // What the rigid solver would do: gravity, and the path that the pushes gave.
    void move_on(TouchedBody& body) const {
        body.start.rotation = normalized(to_quat(body.rotation_at(substep.h)) * body.start.rotation);
        body.start_center = body.center_at(substep.h);
        body.start.position = body.start_center;
        if (body.inverse_mass == 0) return;
        body.path_velocity += body.velocity + substep.h * substep.gravity;
        body.path_turn = body.path_spin += body.spin;
        body.velocity = body.spin = {};
    }
    void run(double seconds) {
        for (int i = 0; i < std::lround(seconds / substep.h); ++i) step();
    }
    [[nodiscard]] Vec3 at(std::size_t node) const { return deformable.nodes().position[node]; }
    [[nodiscard]] double fastest() const {
        double most = 0;
        for (const Vec3 v : deformable.nodes().velocity) most = std::max(most, length(v));
        return most;
    }
    [[nodiscard]] double mass() const {
        double sum = 0;
        for (const double m : deformable.nodes().mass) sum += m;
        return sum;
    }
    [[nodiscard]] Vec3 momentum() const {
        Vec3 sum;
        const Nodes& nodes = deformable.nodes();
        for (std::size_t i = 0; i < nodes.size(); ++i) sum += nodes.mass[i] * nodes.mean_velocity[i];
        return sum;
    }
    [[nodiscard]] Vec3 angular_momentum() const {
        Vec3 center, sum;
        const Nodes& nodes = deformable.nodes();
        for (std::size_t i = 0; i < nodes.size(); ++i) center += (nodes.mass[i] / mass()) * nodes.position[i];
        for (std::size_t i = 0; i < nodes.size(); ++i)
            sum += nodes.mass[i] * cross(nodes.position[i] - center, nodes.mean_velocity[i]);
        return sum;
    }
};

}  // namespace embody::physics::deformable
