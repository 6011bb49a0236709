// SPDX-License-Identifier: MIT
// docs/physics/coupling.md, "Liquids and what bends". A fixed point x = g(x) for the impulses x of elastic forces on
// the nodes in a part of a step: the pressure's solve with x finds the liquid's impulses and with them the nodes'
// velocity v_f; the sheet's equations with these, each node with the liquid B that it holds, find its velocity v. Then
// g(x) − x = (m + B) (v − v_f), which the norm of 1/(m + B) makes an energy.
#include "physics/stages/fluid/sheet_response.h"

#include <algorithm>
#include <utility>

#include "physics/definitions/world_settings.h"
#include "physics/state/deformable_state.h"

namespace embody::physics::stages {

namespace {

void add_to_nodes(const ImmersedPlace& place, Vec3 value, std::vector<Vec3>& nodes) {
    for (std::size_t k = 0; k < place.count; ++k) nodes[place.node[k]] += place.weight[k] * value;
}

Vec3 alike(double value) { return {value, value, value}; }

// Contacts hold a sheet beside its own elastic forces, and only the step of the deformables knows them.
bool touches_anything(const DeformableRecord& record) {
    return !record.touched_bodies.empty() || !record.touched_deformables.empty() || !record.surface_pushes.empty() ||
           !record.definition.attachments.empty() || !record.definition.ties.empty();
}

}  // namespace

const Nodes& SheetResponse::nodes_of(const Sheet& sheet) const {
    return world_.immersed.records.at(sheet.part.slot).nodes();
}

Vec3 SheetResponse::pull_on(const Sheet& sheet) const {
    return world_.immersed.records.at(sheet.part.slot).acceleration(world_.settings.gravity);
}

SheetResponse::SheetResponse(const FluidAccess& world, ImmersedDeformables& immersed)
    : world_(world), immersed_(immersed) {
    for (const ImmersedDeformables::Part& part : immersed.parts) {
        const DeformableRecord& record = world.immersed.records.at(part.slot);
        if (!record.cloth() || record.is_asleep || record.cloth()->is_frozen() || touches_anything(record)) continue;
        if (part.first == part.last) continue;
        Sheet& sheet = sheets_.emplace_back();
        sheet.part = part;
        const Nodes& nodes = record.nodes();
        for (auto* vector : {&sheet.pressed, &sheet.supported, &sheet.impulse}) vector->assign(nodes.size(), {});
        // Begins with what they did in the last step.
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            if (nodes.inverse_mass[i] > 0)
                sheet.impulse[i] =
                    nodes.mass[i] * world.settings.time_step * (record.liquid.acceleration[i] - pull_on(sheet));
        }
    }
}

void SheetResponse::bind(Sheet& sheet, const ImmersedPoints& found) const {
    sheet.bound.assign(sheet.impulse.size(), {});
    sheet.bound_of_point.clear();
    for (std::size_t i = sheet.part.first; i < sheet.part.last; ++i) {
        sheet.bound_of_point.push_back(found.bound(static_cast<std::uint32_t>(i)));
        add_to_nodes(immersed_.places[i], sheet.bound_of_point.back(), sheet.bound);
    }
}

// Each point has of its nodes' impulses what moves all of them alike with the liquid that they hold.
void SheetResponse::set_supports(const Sheet& sheet, double dt) {
    const Nodes& nodes = nodes_of(sheet);
    for (std::size_t i = sheet.part.first; i < sheet.part.last; ++i) {
        const ImmersedPlace& place = immersed_.places[i];
        ImmersedPoint& point = immersed_.points[i];
        point.support = {};
        if (!(point.inverse_mass > 0)) continue;
        const Vec3 own = alike(1 / point.inverse_mass) + sheet.bound_of_point[i - sheet.part.first];
        for (std::size_t k = 0; k < place.count; ++k) {
            const std::uint32_t node = place.node[k];
            if (!(nodes.inverse_mass[node] > 0)) continue;
            const Vec3 all = alike(nodes.mass[node]) + sheet.bound[node];
            for (int axis = 0; axis < 3; ++axis)
                point.support[axis] += sheet.impulse[node][axis] * (place.weight[k] * own[axis] / (all[axis] * dt));
        }
    }
}

// v_f, and the liquid's impulses on the nodes.
std::vector<Vec3> SheetResponse::free_velocities(Sheet& sheet, double h, const ImmersedPoints& found) const {
    const Nodes& nodes = nodes_of(sheet);
    const std::size_t count = nodes.size();
    sheet.by_liquid.assign(count, {});
    std::vector<Vec3> free(count);
    std::vector<double> mass(count, 0);
    for (std::size_t i = sheet.part.first; i < sheet.part.last; ++i) {
        const auto point = static_cast<std::uint32_t>(i);
        const ImmersedPlace& place = immersed_.places[i];
        add_to_nodes(place, found.given(point), sheet.by_liquid);
        if (!(immersed_.points[i].inverse_mass > 0)) continue;
        const double own = 1 / immersed_.points[i].inverse_mass;
        const Vec3 all = alike(own) + sheet.bound_of_point[i - sheet.part.first];
        add_to_nodes(place, scale(all, found.velocity_after(point)), free);
        for (std::size_t k = 0; k < place.count; ++k) mass[place.node[k]] += place.weight[k] * own;
    }
    for (std::size_t i = 0; i < count; ++i) {
        if (!(nodes.inverse_mass[i] > 0)) {
            free[i] = {};
            continue;
        }
        // What no point stands for is away from the liquid.
        const double dry = std::max(0.0, nodes.mass[i] - mass[i]);
        const Vec3 alone = nodes.mean_velocity[i] + h * pull_on(sheet) +
                           nodes.inverse_mass[i] * (sheet.supported[i] + sheet.impulse[i]);
        for (int axis = 0; axis < 3; ++axis)
            free[i][axis] = (free[i][axis] + dry * alone[axis]) / (mass[i] + dry + sheet.bound[i][axis]);
    }
    return free;
}

// The sheet's moves from the beginning of the step to the end of the part, h seconds later, from those found before in
// this part. False where numbers became non-finite.
bool SheetResponse::solve(Sheet& sheet, double h, const std::vector<Vec3>& free) const {
    DeformableRecord& record = world_.immersed.records.at(sheet.part.slot);
    const Nodes& nodes = record.nodes();
    const std::vector<Vec3> by_others = nodes.force;  // liquids that have moved before this one; may be empty
    std::vector<Vec3> force(nodes.size());
    std::vector<NodeFlow> flow(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        force[i] = nodes.force_on(i) + (sheet.pressed[i] + sheet.by_liquid[i]) / h;
        flow[i] = {sheet.bound[i] / h, free[i], {}};
        if (sheet.moves.size() == i) sheet.moves.push_back(h * nodes.mean_velocity[i]);
    }
    record.set_liquid_force(force);
    record.set_flow(std::move(flow));
    Substep substep{.h = h};
    substep.gravity = pull_on(sheet);
    substep.wind = wind_at(world_.settings, world_.report.time);
    substep.air_density = world_.settings.air_density;
    substep.settings = world_.settings.solver.deformable;
    record.cloth()->linearize(substep, {}, world_.workers);
    const SheetSystem system = record.cloth()->system();
    ClothSolver& solver = world_.immersed.pair_solver;
    solver.set(substep.settings.cloth);
    const int iterations = solver.solve(std::span(&system, 1), {}, {}, {}, sheet.moves, {}, world_.workers);
    record.set_liquid_force(by_others);
    record.set_flow({});
    return iterations != ClothSolver::not_finite;
}

// Whether the pressure is to be solved again with other impulses of the sheet.
bool SheetResponse::improve(Sheet& sheet, double dt, const ImmersedPoints& found) {
    const Nodes& nodes = nodes_of(sheet);
    const std::size_t count = nodes.size();
    const double h = elapsed_ + dt;
    const std::vector<Vec3> free = free_velocities(sheet, h, found);
    const FluidObstacleSettings& settings = world_.settings.solver.fluid.obstacles;
    if (solves_ >= settings.max_sheet_solves) return false;
    if (!solve(sheet, h, free)) return false;
    const double min_pull = world_.settings.solver.deformable.thin_contact.min_gravity;
    const double change = std::max(length(pull_on(sheet)), min_pull) * dt;  // m/s, by gravity
    std::vector<Vec3> error(count), weight(count);
    double found_energy = 0, limit = 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (!(nodes.inverse_mass[i] > 0)) continue;
        const Vec3 all = alike(nodes.mass[i]) + sheet.bound[i], difference = sheet.moves[i] / h - free[i];
        error[i] = scale(all, difference);
        weight[i] = {1 / all.x, 1 / all.y, 1 / all.z};
        found_energy += dot(error[i], difference);
        limit += (all.x + all.y + all.z) / 3 * change * change;
    }
    const double tolerance = settings.sheet_tolerance;
    if (found_energy <= tolerance * tolerance * limit) return false;
    sheet.impulse = sheet.mixing.next(sheet.impulse, error, weight);
    return true;
}

void SheetResponse::end_part(double dt) {
    for (Sheet& sheet : sheets_) {
        for (std::size_t i = 0; i < sheet.impulse.size(); ++i) {
            sheet.pressed[i] += sheet.by_liquid[i];
            sheet.supported[i] += sheet.impulse[i];
        }
        sheet.mixing.clear();
        sheet.moves.clear();
    }
    elapsed_ += dt;
    solves_ = 0;
    is_in_part_ = false;
}

bool SheetResponse::operator()(double dt, const ImmersedPoints& found) {
    const bool is_first = !std::exchange(is_in_part_, true);
    bool has_changed = false;
    if (!is_first) ++solves_;
    for (Sheet& sheet : sheets_) {
        if (is_first)
            bind(sheet, found);
        else if (!improve(sheet, dt, found))
            continue;
        set_supports(sheet, dt);
        has_changed = true;
    }
    if (!has_changed) end_part(dt);
    return has_changed;
}

}  // namespace embody::physics::stages
