// SPDX-License-Identifier: MIT
// docs/physics/coupling.md, "Liquids and what bends". At a face with the liquid's velocity u and mass M, shares of
// velocity v, mass m, volume fraction φ and drag c (all in this part of a step), l of the control volume liquid and
// the impulse density of the pressure P that differs by ΔP (h²: the face's area):
//
//   M (u − u*) = −h² l ΔP + Σ c (v − u),    m (v − v*) = −h² φ ΔP + c (u − v)
//
// With a = 1/(m + c), q = m a, r = c a: v = q v* + r u − h² φ a ΔP, and with G = M + Σ c q and W = l + Σ r φ
//
//   u = (M u* + Σ c q v* − h² W ΔP)/G,    flow of both = l u + Σ φ v = W u + Σ φ q v* − h² Σ φ² a ΔP.
//
// The particles at a face have s M, less than M at the surface. They take s of the drag, so the points have it with s c
// for c: a and r, too.
#include "physics/fluid/obstacles/immersed_points.h"

#include <algorithm>
#include <cmath>

#include "physics/fluid/particles/transfer.h"
#include "physics/fluid/pressure/pressure_system.h"

namespace embody::physics::fluid {

namespace {

// Least fraction of a control volume that counts as liquid: keeps mobilities finite where a solid fills it.
constexpr double min_liquid = 0.01;  // of the volume

std::array<float, 3> to_place(Vec3 p) {
    return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

// Whether all faces and centres around a place are in active tiles.
bool is_on_grid(const FluidGrid& grid, Vec3 p) {
    Cell low{}, high{};
    for (int axis = 0; axis < 3; ++axis) {
        const double at = std::floor(p[axis] / grid.cell_size()) - grid.lower()[axis];
        if (!(at >= 2) || !(at < grid.size()[axis] - 2)) return false;
        low[axis] = static_cast<int>(at) - 1;
        high[axis] = static_cast<int>(at) + 1;
    }
    for (int k = 0; k < 8; ++k) {
        if (!grid.is_active({k & 1 ? high[0] : low[0], k & 2 ? high[1] : low[1], k & 4 ? high[2] : low[2]}))
            return false;
    }
    return true;
}

}  // namespace

void ImmersedPoints::begin(std::span<ImmersedPoint> points, Vec3 origin) {
    origin_ = origin;
    points_ = points;
    places_.clear();
    velocities_.clear();
    for (ImmersedPoint& point : points_) {
        point.impulse = point.drag = point.dragged = {};
        point.end = point.position;
        places_.push_back(point.position - origin);
        velocities_.push_back(point.velocity);
    }
}

void ImmersedPoints::add_reach(double dt, double cell_size, std::vector<Bounds>& boxes) const {
    // Neighbours in the list are so in space: a box for some together.
    constexpr std::size_t together = 64;  // points
    for (std::size_t first = 0; first < points_.size(); first += together) {
        Bounds box;
        double fastest = 0;
        for (std::size_t i = first; i < std::min(first + together, points_.size()); ++i) {
            box.add(places_[i]);
            fastest = std::max(fastest, length(velocities_[i]));
        }
        boxes.push_back(enlarged(box, fastest * dt + 2 * cell_size));
    }
}

// The weights of the faces around a point that rigid obstacles leave open, along each axis together one: at rest the
// pressure's gradient is the same at all of them. Returns whether there are any.
bool ImmersedPoints::add_parts(std::uint32_t point, FluidGrid& grid) {
    const std::array<float, 3> place = to_place(places_[point]);
    bool has_any = false;
    for (int axis = 0; axis < 3; ++axis) {
        const FaceWeights around = face_weights(grid, place.data(), axis);
        double sum = 0;
        for (const FaceWeight& face : around) sum += grid.open[axis][face.cell] > 0 ? face.weight : 0;
        if (!(sum > 0)) continue;
        for (const FaceWeight& face : around) {
            if (!(grid.open[axis][face.cell] > 0) || !(face.weight > 0)) continue;
            std::int32_t& index = face_at_[static_cast<std::size_t>(axis)][static_cast<std::size_t>(face.cell)];
            if (index < 0) {
                index = static_cast<std::int32_t>(faces_.size());
                faces_.push_back({.axis = axis, .cell = face.cell, .open = grid.open[axis][face.cell]});
            }
            parts_.push_back({point, static_cast<std::uint32_t>(index), face.weight / sum});
            has_any = true;
        }
    }
    return has_any;
}

// What the point fills has no room for particles.
void ImmersedPoints::spread_volume(std::uint32_t point, FluidGrid& grid) {
    const double h = grid.cell_size();
    Cell corner{};
    Vec3 upper;
    for (int axis = 0; axis < 3; ++axis) {
        const double at = places_[point][axis] / h - grid.lower()[axis] - 0.5;
        corner[axis] = static_cast<int>(std::floor(at));
        upper[axis] = at - corner[axis];
    }
    for (int k = 0; k < 8; ++k) {
        Cell c = corner;
        double weight = points_[point].volume / (h * h * h);
        for (int axis = 0; axis < 3; ++axis) {
            const bool is_upper = k >> axis & 1;
            c[axis] += is_upper;
            weight *= is_upper ? upper[axis] : 1 - upper[axis];
        }
        float& room = grid.room[grid.index(c)];
        room = std::max(0.0f, room - static_cast<float>(weight));
        grid.immersed_cells.push_back(grid.index(c));
    }
}

void ImmersedPoints::measure(double dt, FluidGrid& grid) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::vector<std::int32_t>& at = face_at_[axis];
        for (const Face& face : faces_) {
            if (face.axis == static_cast<int>(axis)) at[static_cast<std::size_t>(face.cell)] = -1;
        }
        if (!is_empty() && at.size() < grid.open[axis].size()) at.resize(grid.open[axis].size(), -1);
    }
    faces_.clear();
    parts_.clear();
    on_grid_.clear();
    impulses_.assign(points_.size(), {});
    grid.immersed_cells.clear();
    cell_ = grid.cell_size();
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
        places_[i] += velocities_[i] * (dt / 2);
        if (!is_on_grid(grid, places_[i]) || !add_parts(i, grid)) continue;
        on_grid_.push_back(i);
        spread_volume(i, grid);
    }
    std::ranges::sort(grid.immersed_cells);
    grid.immersed_cells.erase(std::unique(grid.immersed_cells.begin(), grid.immersed_cells.end()),
                              grid.immersed_cells.end());
}

void ImmersedPoints::leave(FluidGrid& grid) {
    grid.immersed_cells.clear();
    for (auto* conductance : {&grid.liquid_conductance, &grid.solid_conductance}) {
        for (auto& field : *conductance) field.clear();
    }
}

ImmersedPoints::Response ImmersedPoints::response_of(const FacePart& part) const {
    const double inverse = points_[part.point].inverse_mass;
    if (!(inverse > 0)) return {};
    const double mass = part.weight / inverse, drag = faces_[part.face].filled * part.drag, a = 1 / (mass + drag);
    return {a, mass * a, drag * a};
}

// By all that is known of it. A part of the point is held by what moves all its parts alike, with the liquid that they
// hold: by its mass alone, one at a face without liquid would fly off, and one that holds liquid would not be held.
double ImmersedPoints::speed_before(const FacePart& part) const {
    const ImmersedPoint& point = points_[part.point];
    const Face& face = faces_[part.face];
    const double speed = velocities_[part.point][face.axis] + point.acceleration[face.axis] * dt_;
    if (!(point.inverse_mass > 0)) return speed;
    const double mass = part.weight / point.inverse_mass,
                 fraction = (mass + part.bound) / (1 / point.inverse_mass + bound_[part.point][face.axis]);
    return speed + (point.support[face.axis] * dt_ * fraction + face.filled * part.lag) / mass;
}

// Points of sheets around which there is no particle have neither drag nor pressure; of solids the pressure goes on
// within.
void ImmersedPoints::leave_out_dry(const FluidGrid& grid) {
    std::vector<std::uint8_t> stays(points_.size(), 0), is_used(faces_.size(), 0);
    for (const FacePart& part : parts_) {
        const Face& face = faces_[part.face];
        if (points_[part.point].form.form != DragForm::sheet || grid.known[face.axis][face.cell]) stays[part.point] = 1;
    }
    std::erase_if(parts_, [&](const FacePart& part) { return stays[part.point] == 0; });
    std::erase_if(on_grid_, [&](std::uint32_t point) { return stays[point] == 0; });
    for (const FacePart& part : parts_) is_used[part.face] = 1;
    std::vector<std::uint32_t> place(faces_.size());
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < faces_.size(); ++i) {
        std::int32_t& at = face_at_[static_cast<std::size_t>(faces_[i].axis)][static_cast<std::size_t>(faces_[i].cell)];
        at = is_used[i] != 0 ? static_cast<std::int32_t>(count) : -1;
        place[i] = count;
        if (is_used[i] != 0) faces_[count++] = faces_[i];
    }
    faces_.resize(count);
    for (FacePart& part : parts_) part.face = place[part.face];
}

void ImmersedPoints::find_conductance(double dt, const Mixture& liquids, FluidGrid& grid) {
    leave_out_dry(grid);
    if (parts_.empty()) return leave(grid);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grid.liquid_conductance[axis] = grid.open[axis];
        grid.solid_conductance[axis].assign(grid.open[axis].size(), 0);
    }
    const double density = liquids.first().density;
    particle_mass_ = density * liquids.first().particle_volume;
    const double volume = cell_ * cell_ * cell_;

    // The slip of each point, and its drag by as much of it as is wet. Shares follow each other by point.
    std::size_t next = 0;
    for (const std::uint32_t point : on_grid_) {
        const std::size_t first = next;
        Vec3 speed, weights;
        for (; next < parts_.size() && parts_[next].point == point; ++next) {
            const FacePart& part = parts_[next];
            const Face& face = faces_[part.face];
            if (!grid.known[face.axis][face.cell]) continue;
            speed[face.axis] += part.weight * grid.velocity[face.axis][face.cell];
            weights[face.axis] += part.weight;
        }
        Vec3 slip;
        for (int axis = 0; axis < 3; ++axis) {
            if (weights[axis] > 0) slip[axis] = speed[axis] / weights[axis] - velocities_[point][axis];
        }
        const std::array<float, 3> place = to_place(places_[point]);
        float gradient[3];
        const double filled = sample_center(grid, grid.density, place.data(), gradient);
        const double room = std::max<double>(sample_center(grid, grid.room, place.data(), gradient), min_liquid);
        const double wet = std::clamp(filled / room, 0.0, 1.0);
        const auto [rho, viscosity] = liquids.around(grid, place.data());
        const ImmersedDrag drag = drag_of(points_[point].form, slip, {rho, viscosity});
        for (std::size_t s = first; s < next; ++s) {
            FacePart& part = parts_[s];
            const Face& face = faces_[part.face];
            if (!grid.known[face.axis][face.cell]) continue;
            part.drag = part.weight * wet * dt * drag.along[face.axis];
            part.lag = -part.weight * wet * dt * drag.less[face.axis];
        }
    }

    for (Face& face : faces_) face.liquid = face.open;
    for (const FacePart& part : parts_) faces_[part.face].liquid -= fraction_of(part);
    for (Face& face : faces_) {
        face.liquid = std::max(face.liquid, min_liquid);
        face.mass = density * grid.relative_density(face.axis, face.cell) * volume * face.liquid;
        face.filled = std::min(1.0, grid.mass[face.axis][face.cell] * particle_mass_ / face.mass);
        face.through = face.liquid;
    }
    for (const FacePart& part : parts_) {
        Face& face = faces_[part.face];
        const double fraction = fraction_of(part);
        const Response response = response_of(part);
        face.held += part.drag * response.q;
        face.drag += part.drag;
        face.dragged += response.r * fraction;
        face.yields += fraction * fraction * response.a;
    }
    // Over those of liquid alone, h² / (ρ h³).
    for (Face& face : faces_) {
        const double rho = density * grid.relative_density(face.axis, face.cell);
        face.through += face.dragged;
        const double by_mass = rho * volume / (face.mass + face.held);
        grid.liquid_conductance[face.axis][face.cell] = static_cast<float>(face.through * face.liquid * by_mass);
        grid.solid_conductance[face.axis][face.cell] =
            static_cast<float>(face.through * face.dragged * by_mass + rho * volume * face.yields);
    }
}

std::vector<std::int32_t> ImmersedPoints::rows(const FluidGrid& grid) const {
    std::vector<std::int32_t> rows(points_.size(), -1);
    for (const FacePart& part : parts_) {
        const Face& face = faces_[part.face];
        for (const int at : {face.cell, face.cell - grid.stride(face.axis)})
            rows[part.point] = std::max(rows[part.point], grid.row[at]);
    }
    return rows;
}

// What has no pressure flies on with the velocity of its particles, and is left to what the points then hold.
void ImmersedPoints::start(const FluidGrid& grid) {
    for (FacePart& part : parts_) {
        Face& face = faces_[part.face];
        if (grid.row[face.cell] >= 0 || grid.row[face.cell - grid.stride(face.axis)] >= 0) continue;
        points_[part.point].drag[face.axis] += part.drag;
        part.drag = part.lag = 0;
        face.held = face.drag = face.dragged = 0;
    }
    for (Face& face : faces_) face.start = grid.velocity[face.axis][face.cell];
    bound_.assign(points_.size(), {});
    for (FacePart& part : parts_) {
        const Face& face = faces_[part.face];
        if (!(part.drag > 0)) continue;
        part.bound = face.filled * part.drag * face.mass / (face.drag + face.mass);
        bound_[part.point][face.axis] += part.bound;
    }
}

void ImmersedPoints::predict(double dt, FluidGrid& grid) {
    dt_ = dt;
    for (Face& face : faces_) face.momentum = face.solid_flow = 0;
    for (const FacePart& part : parts_) {
        Face& face = faces_[part.face];
        const Response response = response_of(part);
        const double speed = speed_before(part);
        face.momentum += part.drag * response.q * speed - part.lag;
        face.solid_flow += fraction_of(part) * response.q * speed;
    }
    for (Face& face : faces_) {
        float& velocity = grid.velocity[face.axis][face.cell];
        velocity = static_cast<float>((face.mass * face.start + face.momentum) / (face.mass + face.held));
        face.speed = velocity;
    }
}

void ImmersedPoints::add_outflow(const FluidGrid& grid, std::span<double> flow) const {
    // The grid's faces count as if all that is open had the liquid's velocity.
    for (const Face& face : faces_) {
        const double more = (face.through - face.open) * face.speed + face.solid_flow;
        const int above = grid.row[face.cell], below = grid.row[face.cell - grid.stride(face.axis)];
        if (above >= 0) flow[static_cast<std::size_t>(above)] -= more * cell_ * cell_;
        if (below >= 0) flow[static_cast<std::size_t>(below)] += more * cell_ * cell_;
    }
}

void ImmersedPoints::find_impulses(const PressureSystem& system, std::span<const double> impulse,
                                   const FluidGrid& grid) {
    const double area = cell_ * cell_;
    for (Face& face : faces_) {
        const int upper = face.cell, lower = face.cell - grid.stride(face.axis);
        const int above = grid.row[upper], below = grid.row[lower];
        face.step = 0;
        if (above < 0 && below < 0) continue;
        const double p_above = above < 0 ? 0.0 : impulse[static_cast<std::size_t>(above)];
        const double p_below = below < 0 ? 0.0 : impulse[static_cast<std::size_t>(below)];
        face.step = p_above - p_below;
        // The liquid's gradient ends at the surface.
        double gap = 1;
        if (above < 0) gap = system.gap_fraction(grid.surface[lower], grid.surface[upper]);
        if (below < 0) gap = system.gap_fraction(grid.surface[upper], grid.surface[lower]);
        face.speed -= area * face.step * (face.liquid / gap + face.dragged) / (face.mass + face.held);
    }
    impulses_.assign(points_.size(), {});
    after_.assign(points_.size(), {});
    std::vector<Vec3> mass(points_.size());
    for (const FacePart& part : parts_) {
        const Face& face = faces_[part.face];
        const double drag = face.filled * part.drag, speed = speed_after(part);
        impulses_[part.point][face.axis] += push_on(part) + drag * (face.speed - speed) + face.filled * part.lag;
        if (!(points_[part.point].inverse_mass > 0)) continue;
        const double own = part.weight / points_[part.point].inverse_mass + part.bound;
        mass[part.point][face.axis] += own;
        after_[part.point][face.axis] += own * speed;
    }
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            if (mass[i][axis] > 0)
                after_[i][axis] /= mass[i][axis];
            else
                after_[i][axis] = end_velocity(i)[axis];
        }
    }
}

// By the pressure, N s.
double ImmersedPoints::push_on(const FacePart& part) const {
    return -cell_ * cell_ * fraction_of(part) * faces_[part.face].step;
}

double ImmersedPoints::speed_after(const FacePart& part) const {
    const Response response = response_of(part);
    return response.q * speed_before(part) + response.r * faces_[part.face].speed + response.a * push_on(part);
}

void ImmersedPoints::apply_pressure(FluidGrid& grid) {
    for (const Face& face : faces_) {
        if (grid.row[face.cell] < 0 && grid.row[face.cell - grid.stride(face.axis)] < 0) continue;
        grid.velocity[face.axis][face.cell] = static_cast<float>(face.speed);
    }
    for (const FacePart& part : parts_) {
        const Face& face = faces_[part.face];
        ImmersedPoint& point = points_[part.point];
        const double drag = face.filled * part.drag;
        point.drag[face.axis] += drag;
        point.dragged[face.axis] += drag * (face.speed - speed_after(part));
    }
}

void ImmersedPoints::advance(double dt) {
    dt_ = dt;
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
        ImmersedPoint& point = points_[i];
        point.impulse += impulses_[i];
        velocities_[i] = end_velocity(i);
        places_[i] += velocities_[i] * (dt / 2);
        point.end = places_[i] + origin_;
    }
}

}  // namespace embody::physics::fluid
