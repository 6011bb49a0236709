// SPDX-License-Identifier: MIT
#include "physics/stages/deformable/thin_group_part.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "foundation/task_pool.h"
#include "physics/definitions/step_report.h"
#include "physics/definitions/world_settings.h"
#include "physics/deformable/contact/free_motion.h"
#include "physics/stages/access.h"
#include "physics/stages/deformable/round_contacts.h"
#include "physics/state/deformable_state.h"
#include "physics/state/event_state.h"
#include "physics/state/rigid_state.h"

namespace embody::physics::stages {

ThinSurface surface_of(const DeformableRecord& record, std::vector<std::array<std::uint32_t, 2>>& segments) {
    ThinSurface surface;
    surface.nodes = &record.nodes();
    surface.radius = record.definition.contact_radius;
    if (record.cloth()) {
        const Cloth& cloth = std::get<Cloth>(record.definition.matter);
        surface.triangles = cloth.triangles;
        surface.edges = record.cloth()->edges();
        surface.edge_length = record.cloth()->edge_length();
        surface.stars = &record.cloth()->layers().stars();
        surface.radius = std::max(surface.radius, cloth.thickness / 2);
        return surface;
    }
    constexpr double min_length = 1e-6;  // m: length of the cells of a grid
    double sum = 0;
    segments.clear();
    const std::vector<Vec3>& nodes = surface.nodes->position;
    for (std::uint32_t s = 0; s + 1 < nodes.size(); ++s) {
        sum += length(nodes[s + 1] - nodes[s]);
        // A segment by its number; a broken one is only a node.
        segments.push_back({s, record.rope()->is_broken(s) ? s : s + 1});
    }
    surface.edges = segments;
    surface.edge_length = std::max(sum / static_cast<double>(nodes.size() - 1), min_length);
    return surface;
}

Substep substep_of(const DeformableAccess& world, const DeformableRecord& record, double h, double time) {
    Substep substep{.h = h, .time = time};
    substep.gravity = record.acceleration(world.settings.gravity);
    substep.wind = wind_at(world.settings, world.report.time);
    substep.air_density = world.settings.air_density;
    substep.surface_pairs = &world.rigid.surface_pairs;
    substep.settings = world.settings.solver.deformable;
    return substep;
}

void note_breaks(const DeformableAccess& world, const DeformableRecord& record) {
    const std::vector<Vec3>& nodes = record.nodes().position;
    for (const auto& [segment, tension] : record.rope()->new_breaks()) {
        const DeformableHandle rope = world.deformables.records.handle_at(record.slot);
        world.events.rope_breaks.push_back(
            {rope, record.definition.user_data, segment, tension, (nodes[segment] + nodes[segment + 1]) / 2});
    }
}

ThinGroupPart::ThinGroupPart(const DeformableAccess& world, const ThinGroup& group, std::span<ThinDeformable> thin,
                             double h, double time)
    : world_(world), group_(group), h_(h), place_(group.members.size()) {
    for (const bool is_sheet : {true, false}) {
        for (std::size_t i = 0; i < group.members.size(); ++i) {
            ThinDeformable& one = thin[group.members[i]];
            if ((one.record->cloth() != nullptr) != is_sheet) continue;
            place_[i] = static_cast<std::uint32_t>(members_.size());
            Member& member = members_.emplace_back();
            member.thin = &one;
            member.substep = substep_of(world, *one.record, h, time);
            member.first = moves_.size();
            member.count = one.record->nodes().size();
            member.mean_velocity = one.record->nodes().mean_velocity;
            member.last_substep = one.record->nodes().substep;
            one.record->begin_substep(h, world.settings.gravity, group.members.size() == 1);
            for (const Vec3 velocity : one.record->nodes().mean_velocity) moves_.push_back(h * velocity);
        }
        if (is_sheet) sheets_ = members_.size();
    }
}

void ThinGroupPart::begin_members(std::span<const TouchedBody> bodies) {
    seen_.resize(members_.size());
    for (std::size_t m = 0; m < members_.size(); ++m) {
        Member& member = members_[m];
        const ThinDeformable& thin = *member.thin;
        DeformableRecord& record = member.record();
        if (record.cloth()) {
            record.cloth()->set_attachments(thin.attachments);
            record.cloth()->begin(member.substep, thin.contacts, thin.sheet_contacts, thin.attachment_bodies, bodies,
                                  world_.workers);
            member.touch = record.cloth()->touch();
        } else {
            record.rope()->set_attachments(thin.attachments);
            record.rope()->set_clamps(record.definition.clamps);
            follow_round_bodies(member.substep, bodies, *member.thin);
            record.rope()->begin(member.substep, thin.contacts, thin.segment_contacts, thin.attachment_bodies, bodies);
            member.touch = record.rope()->touch();
        }
        seen_[m] = {surface_of(record, member.segments),
                    record.slot,
                    static_cast<std::uint32_t>(member.first),
                    std::vector<double>(member.count, 0),
                    record.cloth() ? record.cloth()->node_stiffness() : record.rope()->node_stiffness(),
                    record.cloth() ? std::span<const Mat3>() : record.rope()->directed_stiffness()};
    }
}

// Weight of bodies on each node, as if evenly spread over all nodes that they may touch.
void ThinGroupPart::load_nodes(std::span<const TouchedBody> bodies) {
    std::vector<double> touched(bodies.size(), 0);
    const auto bears = [&](const TouchSpring& spring) {
        return !spring.is_attachment && spring.body < bodies.size() && bodies[spring.body].inverse_mass > 0;
    };
    for (const Member& member : members_) {
        for (const TouchSpring& spring : member.touch.springs()) {
            if (bears(spring)) touched[spring.body] += spring.count;
        }
    }
    for (std::size_t m = 0; m < members_.size(); ++m) {
        for (const TouchSpring& spring : members_[m].touch.springs()) {
            if (!bears(spring)) continue;
            const double load = 1 / (bodies[spring.body].inverse_mass * touched[spring.body]);
            for (std::size_t k = 0; k < static_cast<std::size_t>(spring.count); ++k)
                seen_[m].load[spring.node[k]] = std::max(seen_[m].load[spring.node[k]], load);
        }
    }
}

double ThinGroupPart::mass_of_members() const {
    double mass = 0;
    for (const ThinMember& member : seen_) {
        for (const double of_node : member.surface.nodes->mass) mass += of_node;
    }
    return mass;
}

// Of all members and the bodies near them, kg.
double ThinGroupPart::carried_mass(std::span<const TouchedBody> bodies) const {
    double mass = mass_of_members();
    for (const TouchedBody& body : bodies) {
        if (body.inverse_mass > 0) mass += 1 / body.inverse_mass;
    }
    return mass;
}

void ThinGroupPart::begin_pairs(std::span<const TouchedBody> bodies) {
    const double gravity = length(world_.settings.gravity);
    double pull = gravity;  // the strongest
    for (const Member& member : members_) pull = std::max(pull, length(member.substep.gravity));
    met_ = group_.pairs;
    for (ThinPair& pair : met_) {
        pair.a = place_[pair.a];
        pair.b = place_[pair.b];
        const Member& member = members_[pair.a];
        ClothSheet* sheet = pair.a == pair.b ? member.record().cloth() : nullptr;
        if (sheet != nullptr) {
            pair.candidates = sheet->near_layers(member.substep, world_.workers);
            const ThinSurface& surface = seen_[pair.a].surface;
            leave_out_held(surface, surface, pair.held, pair.candidates);
        }
        guarded_.push_back({pair.a, pair.b, sheet != nullptr ? &sheet->layers() : nullptr, pair.held});
    }
    const ThinContactSettings& settings = world_.settings.solver.deformable.thin_contact;
    pairs_.begin(seen_, met_, world_.deformables.thin_contacts, {h_, pull, carried_mass(bodies), settings});
    std::vector<PlacedTie> ties;
    for (const ThinTie& tie : group_.ties) {
        const Member &own = members_[place_[tie.member]], &other = members_[place_[tie.other]];
        DeformableRecord& record = own.record();
        ties.push_back({&record.nodes(), &other.record().nodes(), static_cast<std::uint32_t>(own.first),
                        static_cast<std::uint32_t>(other.first), &record.definition.ties[tie.index],
                        &record.tie_pulls[tie.index]});
    }
    ties_.begin(ties, h_, gravity, settings);
}

void ThinGroupPart::begin_supports(std::span<const TouchedBody> bodies) {
    std::vector<TouchSpring> touching;
    for (const Member& member : members_)
        touching.insert(touching.end(), member.touch.springs().begin(), member.touch.springs().end());
    supports_.begin(touching, bodies, mass_of_members(), members_[0].substep);
    supports_.choose(body_moves_, true, 0);
}

void ThinGroupPart::begin(std::span<const TouchedBody> bodies) {
    body_moves_.assign(bodies.size(), {});
    begin_members(bodies);
    load_nodes(bodies);
    begin_pairs(bodies);
    begin_supports(bodies);
    for (Member& member : members_) member.touch.choose(part(moves_, member), body_moves_, true);
    pairs_.choose(moves_, true);
    // Starts from rest or from inertia, whichever is closer to the solution, as RopeLine does.
    for (const Member& member : ropes()) {
        const std::span<Vec3> moves = part(moves_, member);
        const std::vector<Vec3> rest(moves.size());
        const RopeLine& rope = *member.record().rope();
        if (rope.energy(member.substep, rest) < rope.energy(member.substep, moves))
            std::ranges::copy(rest, moves.begin());
    }
}

void ThinGroupPart::gather_springs() {
    springs_.clear();
    for (const Member& member : members_) {
        for (TouchSpring spring : member.touch.springs()) {
            for (std::size_t k = 0; k < static_cast<std::size_t>(spring.count); ++k)
                spring.node[k] += static_cast<std::uint32_t>(member.first);
            springs_.push_back(spring);
        }
    }
    springs_.insert(springs_.end(), pairs_.springs().begin(), pairs_.springs().end());
    springs_.insert(springs_.end(), ties_.springs().begin(), ties_.springs().end());
    springs_.insert(springs_.end(), supports_.springs().begin(), supports_.springs().end());
}

// True where the springs that act have changed. Those of the last solve (`is_last`) stay as they were in it, so that
// both sides have the same force.
bool ThinGroupPart::choose_again(bool is_last) {
    bool has_changed = false;
    std::vector<TouchSprings> touch;
    for (const Member& member : members_) {
        touch.push_back(member.touch);
        has_changed |= touch.back().choose(part(moves_, member), body_moves_, false);
    }
    PairSprings pairs = pairs_;
    has_changed |= pairs.choose(moves_, false);
    SupportSprings supports = supports_;
    has_changed |= supports.choose(body_moves_, false, world_.settings.solver.deformable.thin_contact.change_tolerance);
    if (!has_changed || is_last) return has_changed;
    for (std::size_t m = 0; m < members_.size(); ++m) members_[m].touch = std::move(touch[m]);
    pairs_ = std::move(pairs);
    supports_ = std::move(supports);
    return true;
}

// The last solve's forces of nodes, and what bears the bodies under these.
void ThinGroupPart::settle_bodies(std::span<const BodyInertia> inertias) {
    const DeformableSettings& settings = world_.settings.solver.deformable;
    for (int i = 0; i < settings.cloth.max_solves; ++i) {
        SupportSprings next = supports_;
        if (!next.choose(body_moves_, false, settings.thin_contact.change_tolerance)) break;
        supports_ = std::move(next);
        gather_springs();
        balance_bodies(springs_, inertias, moves_, body_moves_);
    }
}

// Contacts for one more solve of what would pass through each other by the solved moves.
void ThinGroupPart::add_contacts(std::span<const ThinMeeting> meetings) {
    pairs_.add(seen_, met_, meetings, moves_);
    for (Member& member : members_) member.touch.choose(part(moves_, member), body_moves_, false);
    pairs_.choose(moves_, false);
}

// A contact holds the features that meet along one normal: they must not go far past each other.
bool ThinGroupPart::is_too_fast(const ThinMeeting& meeting) const {
    const std::uint32_t a = met_[meeting.pair].a, b = met_[meeting.pair].b;
    const ThinMember &first = seen_[meeting.candidate.is_swapped ? b : a],
                     &second = seen_[meeting.candidate.is_swapped ? a : b];
    const double edge = std::min(first.surface.edge_length, second.surface.edge_length);
    Vec3 passed;
    for (int k = 0; k < meeting.points.count; ++k) {
        const auto at = static_cast<std::size_t>(k);
        const ThinMember& own = k < meeting.points.count_first ? first : second;
        passed += meeting.points.weight[at] * moves_[own.first + meeting.points.node[at]];
    }
    return length(passed) > world_.settings.solver.deformable.cloth.max_layer_travel * edge;
}

// Of the nodes, 1/kg, for what the guard must hold: those on a body move last.
std::vector<double> ThinGroupPart::compliances() const {
    std::vector<double> compliances;
    for (const Member& member : members_) {
        const std::vector<double>& own = member.record().nodes().inverse_mass;
        compliances.insert(compliances.end(), own.begin(), own.end());
        for (const TouchSpring& spring : member.touch.springs()) {
            for (std::size_t k = 0; k < static_cast<std::size_t>(spring.count) && spring.acts; ++k) {
                compliances[member.first + spring.node[k]] =
                    world_.settings.solver.deformable.cloth.compliance_on_body * own[spring.node[k]];
            }
        }
    }
    return compliances;
}

// The function that the solves minimise: inertia, elastic energy, damping and springs of the moves, J.
double ThinGroupPart::energy(std::span<const SheetSystem> sheets, std::span<const BodyInertia> inertias,
                             SpringEnergy spring_energy) {
    double sum = 0;
    for (std::size_t m = 0; m < sheets_; ++m) sum += energy_of(sheets[m], part(moves_, members_[m]));
    for (const Member& member : ropes()) sum += member.record().rope()->energy(member.substep, part(moves_, member));
    for (std::size_t b = 0; b < inertias.size(); ++b) sum += energy_of(inertias[b], body_moves_[b]);
    for (const TouchSpring& spring : springs_) sum += spring_energy(spring, moves_, body_moves_);
    return sum;
}

// Ropes are not linear: a line search from the last moves towards those of the solve, as far as the energy falls.
// Returns the displacement of the fastest node of a rope, over a segment's length.
double ThinGroupPart::go_as_far_as_it_pays(std::span<const SheetSystem> sheets, std::span<const BodyInertia> inertias) {
    constexpr double rounding = 1e-6;  // of the energy: sheets are solved in floats
    const double min_fraction = world_.settings.solver.deformable.rope.min_step_fraction;
    const std::vector<Vec3> full = std::exchange(moves_, from_);
    const std::vector<BodyMove> body_full = std::exchange(body_moves_, body_from_);
    const double before = energy(sheets, inertias, energy_of), enough = before + rounding * std::fabs(before);
    for (double fraction = 1; fraction > min_fraction; fraction /= 2) {
        for (std::size_t i = 0; i < moves_.size(); ++i) moves_[i] = from_[i] + fraction * (full[i] - from_[i]);
        for (std::size_t b = 0; b < body_moves_.size(); ++b) {
            const BodyMove& from = body_from_[b];
            body_moves_[b] = {from.shift + fraction * (body_full[b].shift - from.shift),
                              from.turn + fraction * (body_full[b].turn - from.turn)};
        }
        if (energy(sheets, inertias, energy_of) <= enough) break;
    }
    double travel = 0;
    for (const Member& member : ropes()) {
        member.record().rope()->predict(member.substep, part(from_, member), part(moves_, member));
        for (std::size_t i = member.first; i < member.first + member.count; ++i)
            travel = std::max(travel, length(moves_[i] - from_[i]) / member.record().rope()->segment_length());
    }
    return travel;
}

bool ThinGroupPart::are_finite() const {
    return std::ranges::all_of(moves_, [](Vec3 move) { return is_finite(move); }) &&
           std::ranges::all_of(body_moves_,
                               [](const BodyMove& move) { return is_finite(move.shift) && is_finite(move.turn); });
}

// Of all together by conjugate gradients; directly of a rope that touches itself alone: far places of it are then as
// stiff against each other as what lies between them is soft. Returns as of ClothSolver::solve().
int ThinGroupPart::solve_linear(std::span<const SheetSystem> sheets, std::span<const LineSystem> lines,
                                std::span<const BodyInertia> inertias) {
    if (!is_rope_alone())
        return world_.deformables.pair_solver.solve(sheets, lines, springs_, inertias, moves_, body_moves_,
                                                    world_.workers);
    const bool is_solved = members_[0].record().rope()->solve_linear(springs_, inertias, moves_, body_moves_);
    return is_solved ? 1 : ClothSolver::not_finite;
}

// Ropes about their last moves, as in Newton's method, and sheets where these were not foreseen.
ThinGroupPart::Outcome ThinGroupPart::solve(std::span<const TouchedBody> bodies, bool is_shortest) {
    const DeformableSettings& settings = world_.settings.solver.deformable;
    const double move_tolerance = settings.rope.move_tolerance_together;  // of a segment's length
    const int max_solves = has_ropes() ? settings.rope.max_iterations : settings.cloth.max_solves;
    world_.deformables.pair_solver.set(settings.cloth);
    const std::vector<BodyInertia> inertias = inertias_of(bodies, h_);
    std::vector<SheetSystem> sheets;
    for (std::size_t m = 0; m < sheets_; ++m) sheets.push_back(members_[m].record().cloth()->system());
    int meeting_solves = 0;
    // Of solves with ropes that do not converge, the moves with the least energy of contacts as they then press.
    double least = std::numeric_limits<double>::infinity();
    std::vector<Vec3> best_moves;
    std::vector<BodyMove> best_body_moves;
    for (int solves = 1;; ++solves) {
        std::vector<LineSystem> lines;
        for (const Member& member : ropes())
            lines.push_back(member.record().rope()->linearize(member.substep, part(moves_, member)));
        gather_springs();
        from_ = moves_;
        body_from_ = body_moves_;
        const int iterations = solve_linear(sheets, lines, inertias);
        if (iterations == ClothSolver::not_finite || !are_finite()) return Outcome::not_finite;
        if (!is_shortest && (iterations == ClothSolver::indefinite || is_struck(bodies))) return Outcome::too_fast;
        const double travel = has_ropes() ? go_as_far_as_it_pays(sheets, inertias) : 0;
        const bool is_last_solve = solves >= max_solves;
        bool has_changed = choose_again(is_last_solve) || travel >= move_tolerance;
        const Stretch stretch = linearize_again(is_last_solve, !is_shortest, bodies);
        if (stretch == Stretch::too_far) return Outcome::too_fast;
        if (stretch == Stretch::unforeseen) {
            has_changed = true;
            least = std::numeric_limits<double>::infinity();  // that of other equations
        }
        if (has_changed && has_ropes()) {
            if (const double left = energy(sheets, inertias, energy_pressed); left < least) {
                least = left;
                best_moves = moves_;
                best_body_moves = body_moves_;
            } else if (is_last_solve) {
                moves_ = best_moves;
                body_moves_ = best_body_moves;
                choose_again(false);
                gather_springs();
            }
        }
        if (has_changed && !is_last_solve) continue;
        if (is_rope_alone()) go_as_far_as_energy_lasts(inertias);
        settle_bodies(inertias);
        const std::vector<ThinMeeting> meetings = CrossingGuard(seen_, guarded_, world_.workers).find(moves_);
        if (meetings.empty()) return Outcome::solved;
        const bool is_last = meeting_solves++ == settings.cloth.max_meeting_solves;
        if (!is_shortest &&
            (is_last || std::ranges::any_of(meetings, [&](const auto& meeting) { return is_too_fast(meeting); })))
            return Outcome::too_fast;
        if (is_last) return Outcome::solved;
        add_contacts(meetings);
        least = std::numeric_limits<double>::infinity();
    }
}

// Nodes that others hold; these move by the moves that were found.
std::vector<TouchSpring> ThinGroupPart::springs_of_others(const Member& member) const {
    std::vector<TouchSpring> held;
    for (const std::span<const TouchSpring> springs : {pairs_.springs(), ties_.springs()}) {
        for (const TouchSpring& spring : springs) {
            if (!spring.acts) continue;
            TouchSpring own{.count = 0, .acts = true, .matrix = spring.matrix, .load = spring.load};
            for (std::size_t k = 0; k < static_cast<std::size_t>(spring.count); ++k) {
                const std::uint32_t node = spring.node[k];
                if (node < member.first || node >= member.first + member.count) {
                    own.load -= spring.weight[k] * (spring.matrix * moves_[node]);
                    continue;
                }
                const auto at = static_cast<std::size_t>(own.count++);
                own.node[at] = node - static_cast<std::uint32_t>(member.first);
                own.weight[at] = spring.weight[k];
            }
            if (own.count > 0) held.push_back(own);
        }
    }
    return held;
}

// Momenta of what nothing else holds: of all together, as the forces of a solve that has not converged are no measure
// of what one gets from another (ropes that met at 20 m/s got 1e6 times their energy by it); one that no other pulls or
// pushes by itself.
void ThinGroupPart::keep_momenta() {
    std::vector<std::uint8_t> is_joined(members_.size(), 0);
    std::vector<std::uint32_t> member_of(moves_.size());
    for (std::uint32_t m = 0; m < members_.size(); ++m)
        std::fill_n(member_of.begin() + static_cast<std::ptrdiff_t>(members_[m].first), members_[m].count, m);
    for (const std::span<const TouchSpring> springs : {pairs_.springs(), ties_.springs()}) {
        for (const TouchSpring& spring : springs) {
            for (int k = 1; spring.acts && k < spring.count; ++k) {
                const std::uint32_t a = member_of[spring.node[0]],
                                    b = member_of[spring.node[static_cast<std::size_t>(k)]];
                if (a != b) is_joined[a] = is_joined[b] = 1;
            }
        }
    }
    std::vector<FreePart> joined;
    bool are_joined_free = true;
    for (std::size_t m = 0; m < members_.size(); ++m) {
        const Member& member = members_[m];
        DeformableRecord& record = member.record();
        const bool is_clamped = record.rope() && record.rope()->has_clamps();  // it is solved once more
        const bool is_free = !is_clamped && (record.cloth() ? record.cloth()->is_free() : record.rope()->is_free());
        if (is_joined[m] != 0) are_joined_free &= is_free;
        if (is_clamped) continue;
        const std::span<Vec3> moves = part(moves_, member);
        FreePart own{&record.nodes(),
                     record.cloth() ? record.cloth()->take_impulses(member.substep, moves)
                                    : record.rope()->take_impulses(member.substep, moves),
                     moves};
        if (!is_free) continue;
        if (is_joined[m] != 0)
            joined.push_back(std::move(own));
        else
            deformable::keep_momenta(std::span(&own, 1), h_, member.substep.settings.thin_contact);
    }
    if (are_joined_free && !joined.empty())
        deformable::keep_momenta(joined, h_, members_[0].substep.settings.thin_contact);
}

// A clamped rope is solved once more alone: the common solve does not include its twist.
void ThinGroupPart::end(std::span<TouchedBody> bodies) {
    const std::vector<double> fractions =
        fractions_of(springs_, moves_, body_moves_, inertias_of(bodies, h_), members_[0].substep);
    const std::vector<double> compliance = compliances();
    pairs_.finish(moves_, world_.deformables.thin_contacts);
    ties_.finish(moves_);
    for (Member& member : members_) {
        if (ClothSheet* sheet = member.record().cloth())
            sheet->touch() = std::move(member.touch);
        else if (RopeLine* rope = member.record().rope(); !rope->has_clamps())
            rope->touch() = std::move(member.touch);
    }
    keep_momenta();
    for (Member& member : members_) {
        const std::span<Vec3> moves = part(moves_, member);
        if (ClothSheet* sheet = member.record().cloth())
            sheet->finish(member.substep, moves, body_moves_, bodies);
        else if (RopeLine* rope = member.record().rope(); !rope->has_clamps())
            rope->finish(member.substep, moves, body_moves_, bodies, fractions);
    }
    supports_.finish(body_moves_, h_, bodies, has_ropes() ? std::span(fractions) : std::span<const double>());
    if (is_rope_alone()) shorten_moves();
    CrossingGuard(seen_, guarded_, world_.workers).hold(compliance, moves_);
    for (Member& member : members_) {
        const std::span<const Vec3> moves = part(moves_, member);
        if (ClothSheet* sheet = member.record().cloth()) {
            sheet->move_nodes(moves, member.substep, world_.workers);
            continue;
        }
        RopeLine* rope = member.record().rope();
        if (rope->has_clamps())
            rope->advance(member.substep, member.thin->contacts, member.thin->segment_contacts,
                          member.thin->attachment_bodies, bodies, springs_of_others(member));
        else
            rope->move_nodes(moves, h_);
        note_breaks(world_, member.record());
    }
}

// A shorter part begins with other mean velocities.
void ThinGroupPart::take_back() {
    for (Member& member : members_)
        member.record().set_mean_velocities(std::move(member.mean_velocity), member.last_substep);
}

bool ThinGroupPart::advance(std::span<TouchedBody> bodies, bool is_shortest) {
    const bool is_sheet_alone = members_.size() == 1 && sheets_ == 1;
    if (is_sheet_alone && members_[0].record().cloth()->is_frozen()) return true;
    begin(bodies);
    const Outcome outcome = solve(bodies, is_shortest);
    if (outcome == Outcome::too_fast) {
        take_back();
        return false;
    }
    if (outcome == Outcome::solved) {
        end(bodies);
        return true;
    }
    // Numbers that are none: who has them freezes by itself.
    if (is_sheet_alone) members_[0].record().cloth()->freeze();
    for (Member& member : members_) {
        if (is_sheet_alone) break;
        if (member.record().rope()) {
            advance_rope(*member.thin, member.substep, bodies);
            note_breaks(world_, member.record());
        } else {
            const ThinGroup alone{.members = {0}, .pairs = {}, .ties = {}};
            ThinGroupPart(world_, alone, std::span(member.thin, 1), h_, member.substep.time).advance(bodies, true);
        }
    }
    return true;
}

}  // namespace embody::physics::stages
