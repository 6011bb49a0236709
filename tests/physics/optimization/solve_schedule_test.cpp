// SPDX-License-Identifier: MIT
#include "physics/optimization/solve_schedule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "foundation/random.h"

namespace embody::physics::optimization {
namespace {

struct Graph {
    std::vector<BodyState> bodies;
    std::vector<ContactSummary> contacts;
    std::vector<std::uint32_t> order;
};

// Body 0 is immovable and takes part in a third of the contacts.
Graph random_graph(std::uint32_t bodies, std::uint32_t contacts) {
    Graph graph;
    graph.bodies.resize(bodies);
    for (std::uint32_t i = 1; i < bodies; ++i) graph.bodies[i].inverse_mass = 1;
    Random random(5);
    while (graph.contacts.size() < contacts) {
        const auto pick = [&] { return static_cast<std::uint32_t>(random.between(1, bodies - 0.001)); };
        ContactSummary contact;
        contact.a = graph.contacts.size() % 3 == 0 ? 0 : pick();
        contact.b = pick();
        contact.count = static_cast<std::uint8_t>(1 + graph.contacts.size() % 4);
        if (contact.a != contact.b) graph.contacts.push_back(contact);
    }
    graph.order.resize(contacts);
    std::iota(graph.order.begin(), graph.order.end(), 0u);
    return graph;
}

TEST(SolveSchedule, HoldsEachContactOnceInStagesOfDifferentBodies) {
    const Graph graph = random_graph(60, 900);
    SolveSchedule schedule;
    build_schedule(graph.order, graph.contacts, graph.bodies, 8, schedule);
    std::vector<std::uint32_t> sorted = schedule.contacts;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(sorted, graph.order);
    for (const auto& stage : schedule.stages) {
        std::set<std::uint32_t> met;
        ASSERT_GT(stage.batch_count, 0u);
        for (std::uint32_t i = 0; i < stage.batch_count; ++i) {
            const auto& batch = schedule.batches[stage.first_batch + i];
            ASSERT_LE(batch.count, 8);
            for (std::uint32_t k = 0; k < batch.count; ++k) {
                const ContactSummary& contact = graph.contacts[schedule.contacts[batch.first + k]];
                EXPECT_LE(contact.count, batch.points);
                for (const std::uint32_t body : {contact.a, contact.b}) {
                    if (body != 0) {
                        EXPECT_TRUE(met.insert(body).second) << "body " << body << " twice in a stage";
                    }
                }
            }
        }
    }
}

TEST(SolveSchedule, TakesMoreThanSixtyFourColoursWhereOneBodyMeetsMany) {
    Graph graph = random_graph(202, 1);
    graph.contacts.clear();
    graph.order.clear();
    for (std::uint32_t i = 2; i < 202; ++i) {
        ContactSummary contact;
        contact.a = 1;
        contact.b = i;
        contact.count = 1;
        graph.order.push_back(static_cast<std::uint32_t>(graph.contacts.size()));
        graph.contacts.push_back(contact);
    }
    SolveSchedule schedule;
    build_schedule(graph.order, graph.contacts, graph.bodies, 16, schedule);
    EXPECT_EQ(schedule.contacts.size(), 200u);
    EXPECT_EQ(schedule.stages.size(), 200u);
}

TEST(SolveSchedule, IsEmptyWithoutContacts) {
    const Graph graph = random_graph(3, 1);
    SolveSchedule schedule;
    build_schedule({}, graph.contacts, graph.bodies, 16, schedule);
    EXPECT_TRUE(schedule.batches.empty());
    EXPECT_TRUE(schedule.stages.empty());
}

}  // namespace
}  // namespace embody::physics::optimization
