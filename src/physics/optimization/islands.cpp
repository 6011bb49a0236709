// SPDX-License-Identifier: MIT
//
// Islands by union-find (R. Tarjan, "Efficiency of a good but not linear set union algorithm", 1975), levels by breadth
// first search from the ground (K. Erleben, "Velocity-based shock propagation for multibody dynamics animation", 2007).
#include "physics/optimization/islands.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <vector>

namespace embody::physics::optimization {

namespace {

constexpr std::uint32_t none = 0xFFFFFFFFu;

class DisjointSets {
public:
    DisjointSets(std::size_t count, std::vector<std::uint32_t>& parent) : parent_(parent) {
        parent_.resize(count);
        std::iota(parent_.begin(), parent_.end(), 0U);
    }
    std::uint32_t find(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    // The smaller slot becomes the root: so roots do not depend on the order of unions.
    void unite(std::uint32_t i, std::uint32_t j) {
        i = find(i);
        j = find(j);
        if (i != j) parent_[std::max(i, j)] = std::min(i, j);
    }

private:
    std::vector<std::uint32_t>& parent_;
};

// Breadth first through the contacts, all immovable bodies first.
void find_levels(std::span<const BodyState> bodies, std::span<const ContactSummary> contacts, Islands::Memory& memory,
                 std::vector<std::uint32_t>& level) {
    level.assign(bodies.size(), no_level);

    // Lists the neighbours of each body by counting sort.
    std::vector<std::uint32_t>&first = memory.first, &next = memory.next, &neighbour = memory.neighbour;
    std::vector<std::uint32_t>& front = memory.front;
    first.assign(bodies.size() + 1, 0);
    neighbour.resize(2 * contacts.size());
    for (const ContactSummary& c : contacts) {
        if (c.is_idle) continue;
        ++first[c.a + 1];
        ++first[c.b + 1];
    }
    for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
    next.assign(first.begin(), first.end() - 1);
    for (const ContactSummary& c : contacts) {
        if (c.is_idle) continue;
        neighbour[next[c.a]++] = c.b;
        neighbour[next[c.b]++] = c.a;
    }

    front.clear();
    for (const ContactSummary& c : contacts) {
        for (const std::uint32_t body : {c.a, c.b}) {
            if (c.is_idle || is_movable(bodies[body]) || level[body] == 0) continue;
            level[body] = 0;
            front.push_back(body);
        }
    }
    for (std::size_t i = 0; i < front.size(); ++i) {
        const std::uint32_t body = front[i];
        for (std::uint32_t k = first[body]; k < first[body + 1]; ++k) {
            if (level[neighbour[k]] != no_level) continue;
            level[neighbour[k]] = level[body] + 1;
            front.push_back(neighbour[k]);
        }
    }
}

// Sorts `count` items into islands by counting; `island_of(i)` returns the island of item i, `none` if it has none.
template <class IslandOf, class SetFirst, class SetCount>
void distribute(std::size_t count, std::vector<Island>& list, std::vector<std::uint32_t>& items, IslandOf island_of,
                SetFirst first_of, SetCount count_of) {
    for (std::size_t i = 0; i < count; ++i) {
        if (island_of(i) != none) ++count_of(list[island_of(i)]);
    }
    std::uint32_t sum = 0;
    for (Island& island : list) {
        first_of(island) = sum;
        sum += count_of(island);
        count_of(island) = 0;
    }
    items.resize(sum);
    for (std::size_t i = 0; i < count; ++i) {
        if (island_of(i) == none) continue;
        Island& island = list[island_of(i)];
        items[first_of(island) + count_of(island)++] = static_cast<std::uint32_t>(i);
    }
}

// Sorts by counting; keeps the order of equals.
template <class LevelOf>
void sort_by_level(std::span<std::uint32_t> contacts, LevelOf level_of) {
    thread_local std::vector<std::uint32_t> unsorted, first_of_level;
    if (std::is_sorted(contacts.begin(), contacts.end(),
                       [&](std::uint32_t i, std::uint32_t j) { return level_of(i) < level_of(j); })) {
        return;
    }
    unsorted.assign(contacts.begin(), contacts.end());
    first_of_level.clear();
    for (const std::uint32_t i : unsorted) {
        const std::size_t next = std::size_t{level_of(i)} + 1;
        if (next >= first_of_level.size()) first_of_level.resize(next + 1, 0);
        ++first_of_level[next];
    }
    for (std::size_t i = 1; i < first_of_level.size(); ++i) first_of_level[i] += first_of_level[i - 1];
    for (const std::uint32_t i : unsorted) contacts[first_of_level[level_of(i)]++] = i;
}

void list_graph(std::span<const std::uint32_t> awake, std::span<const ContactSummary> contacts,
                std::span<const Joint> joints, ContactGraph& graph) {
    graph.bodies.assign(awake.begin(), awake.end());
    graph.contacts.clear();
    graph.joints.clear();
    for (const ContactSummary& c : contacts) {
        graph.contacts.push_back(c.is_idle ? ContactGraph::Ends{none, none} : ContactGraph::Ends{c.a, c.b});
    }
    for (const Joint& j : joints) graph.joints.push_back({j.a_is_world ? none : j.a, j.b});
}

}  // namespace

void build_islands(std::span<const std::uint32_t> awake, std::span<const BodyState> bodies,
                   std::span<const ContactSummary> contacts, std::span<const Joint> joints, Islands& islands) {
    std::swap(islands.graph, islands.last_graph);
    list_graph(awake, contacts, joints, islands.graph);
    if (islands.graph == islands.last_graph && islands.level.size() == bodies.size()) return;

    // Immovable bodies do not connect: two boxes on one floor are two islands.
    DisjointSets sets(bodies.size(), islands.memory.parent);
    for (const ContactSummary& c : contacts) {
        if (!c.is_idle && is_movable(bodies[c.a]) && is_movable(bodies[c.b])) sets.unite(c.a, c.b);
    }
    for (const Joint& j : joints) {
        if (!j.a_is_world && is_movable(bodies[j.a]) && is_movable(bodies[j.b])) sets.unite(j.a, j.b);
    }

    // Islands in the order of their smallest slot.
    std::vector<std::uint32_t>& island_of_root = islands.memory.island_of_root;
    island_of_root.assign(bodies.size(), none);
    islands.list.clear();
    for (const std::uint32_t body : awake) {
        std::uint32_t& island = island_of_root[sets.find(body)];
        if (island != none) continue;
        island = static_cast<std::uint32_t>(islands.list.size());
        islands.list.push_back({});
    }
    const auto island_of = [&](std::uint32_t body) { return island_of_root[sets.find(body)]; };
    distribute(
        awake.size(), islands.list, islands.bodies, [&](std::size_t i) { return island_of(awake[i]); },
        [](Island& i) -> std::uint32_t& { return i.first_body; },
        [](Island& i) -> std::uint32_t& { return i.body_count; });
    for (std::uint32_t& body : islands.bodies) body = awake[body];
    distribute(
        contacts.size(), islands.list, islands.contacts,
        [&](std::size_t i) {
            const ContactSummary& c = contacts[i];
            return c.is_idle ? none : island_of(is_movable(bodies[c.a]) ? c.a : c.b);
        },
        [](Island& i) -> std::uint32_t& { return i.first_contact; },
        [](Island& i) -> std::uint32_t& { return i.contact_count; });
    distribute(
        joints.size(), islands.list, islands.joints,
        [&](std::size_t i) {
            const Joint& j = joints[i];
            return island_of(is_movable(bodies[j.b]) ? j.b : j.a);
        },
        [](Island& i) -> std::uint32_t& { return i.first_joint; },
        [](Island& i) -> std::uint32_t& { return i.joint_count; });

    // Solve order: from the ground up; the contacts' own order breaks ties.
    find_levels(bodies, contacts, islands.memory, islands.level);
    std::uint32_t deepest = 0;
    for (const std::uint32_t body : awake) {
        if (islands.level[body] != no_level) deepest = std::max(deepest, islands.level[body]);
    }
    const auto contact_level = [&](std::uint32_t i) {
        const std::uint32_t level = std::min(islands.level[contacts[i].a], islands.level[contacts[i].b]);
        return std::min(level, deepest + 1);  // bodies without a connection to the ground come last
    };
    for (Island& island : islands.list) {
        sort_by_level(std::span(islands.contacts).subspan(island.first_contact, island.contact_count), contact_level);
        for (std::uint32_t k = 0; k < island.body_count; ++k) {
            const std::uint32_t level = islands.level[islands.bodies[island.first_body + k]];
            if (level != no_level) island.deepest_level = std::max(island.deepest_level, level);
        }
    }
}

}  // namespace embody::physics::optimization
