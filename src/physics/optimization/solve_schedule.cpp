// SPDX-License-Identifier: MIT
//
// Greedy edge colouring of the contact graph (as E. Catto's "Solver2D", 2024, and R. Tonge's "Iterative rigid body
// solvers", GDC 2013, use it), by masks of 64 colours a body.
#include "physics/optimization/solve_schedule.h"

#include <algorithm>
#include <array>
#include <bit>

namespace embody::physics::optimization {

namespace {

constexpr std::uint32_t max_points = Manifold::max_points;
constexpr std::uint32_t widest_batch = 16;  // contacts; whatever the processor has, so that the order is the same

// The lowest colour that neither body has, of colours with a batch to fill if there are any; contacts without a colour
// are left for another iteration of 64 colours.
std::uint32_t colour_stages(std::span<const std::uint32_t> order, std::span<const ContactSummary> contacts,
                            std::span<const BodyState> bodies, SolveSchedule& s) {
    constexpr std::uint32_t colours = 64, no_stage = 0xFFFFFFFFu;
    s.colours.resize(std::max(s.colours.size(), bodies.size()));
    std::fill(s.stage_of.begin(), s.stage_of.end(), no_stage);
    std::uint32_t count = 0;
    std::size_t left = order.size();
    for (std::uint32_t base = 0; left > 0; base += colours) {
        std::array<std::uint32_t, colours> members{};
        std::uint64_t open = 0;  // colours with a batch that is not full
        for (const std::uint32_t i : order) s.colours[contacts[i].a] = s.colours[contacts[i].b] = 0;
        for (std::size_t k = 0; k < order.size(); ++k) {
            if (s.stage_of[k] != no_stage) continue;
            const ContactSummary& c = contacts[order[k]];
            const bool a_moves = is_movable(bodies[c.a]), b_moves = is_movable(bodies[c.b]);
            const std::uint64_t used = (a_moves ? s.colours[c.a] : 0) | (b_moves ? s.colours[c.b] : 0);
            if (~used == 0) continue;
            const std::uint64_t fitting = ~used & open ? ~used & open : ~used;
            const auto colour = static_cast<std::uint32_t>(std::countr_zero(fitting));
            const std::uint64_t is_open = ++members[colour] % widest_batch != 0 ? 1 : 0;
            open = (open & ~(std::uint64_t{1} << colour)) | is_open << colour;
            if (a_moves) s.colours[c.a] |= std::uint64_t{1} << colour;
            if (b_moves) s.colours[c.b] |= std::uint64_t{1} << colour;
            s.stage_of[k] = base + colour;
            count = std::max(count, base + colour + 1);
            --left;
        }
    }
    return count;
}

}  // namespace

void build_schedule(std::span<const std::uint32_t> order, std::span<const ContactSummary> contacts,
                    std::span<const BodyState> bodies, int lanes, SolveSchedule& s) {
    s.stage_of.resize(order.size());
    const std::uint32_t stages = colour_stages(order, contacts, bodies, s);

    // By stage, in a stage contacts that carried a load first, and by falling number of points: one counting sort.
    constexpr std::uint32_t kinds = 2 * max_points;
    const auto key_of = [&](std::size_t k) {
        const ContactSummary& contact = contacts[order[k]];
        return s.stage_of[k] * kinds + (contact.was_loaded ? 0 : max_points) + (max_points - contact.count);
    };
    s.first_of_key.assign(stages * kinds + 1, 0);
    for (std::size_t k = 0; k < order.size(); ++k) ++s.first_of_key[key_of(k) + 1];
    for (std::size_t i = 1; i < s.first_of_key.size(); ++i) s.first_of_key[i] += s.first_of_key[i - 1];
    s.contacts.resize(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) s.contacts[s.first_of_key[key_of(k)]++] = order[k];

    // Each stage is cut into batches. After the sort a key's entry is the index at which the next key begins.
    s.batches.clear();
    s.stages.clear();
    std::uint32_t first = 0;
    for (std::uint32_t stage = 0; stage < stages; ++stage) {
        const std::uint32_t end = s.first_of_key[(stage + 1) * kinds - 1];
        const auto first_batch = static_cast<std::uint32_t>(s.batches.size());
        for (; first < end; first += static_cast<std::uint32_t>(lanes)) {
            const std::uint32_t count = std::min<std::uint32_t>(static_cast<std::uint32_t>(lanes), end - first);
            std::uint8_t points = 0;
            for (std::uint32_t i = first; i < first + count; ++i) {
                points = std::max(points, contacts[s.contacts[i]].count);
            }
            s.batches.push_back({first, static_cast<std::uint8_t>(count), points});
        }
        first = end;
        s.stages.push_back({first_batch, static_cast<std::uint32_t>(s.batches.size()) - first_batch});
    }
}

}  // namespace embody::physics::optimization
