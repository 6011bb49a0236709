// SPDX-License-Identifier: MIT
#include "physics/deformable/cloth/node_fans.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "physics/definitions/deformable_primitives.h"

namespace embody::physics::deformable {
namespace {

const std::vector<std::array<std::uint32_t, 3>>& triangles_of(const DeformableDefinition& sheet) {
    return std::get<Cloth>(sheet.matter).triangles;
}

TEST(NodeFans, GoAroundANode) {
    const DeformableDefinition disc = cloth_disc(1, 0.5);
    const NodeFans fans(triangles_of(disc), disc.nodes.size());
    const std::vector<NodeFan> middle = fans.around(0);
    ASSERT_EQ(middle.size(), 1u);
    EXPECT_TRUE(middle[0].is_closed());
    EXPECT_EQ(middle[0].triangles.size(), fans.triangles_of(0).size());
    for (std::size_t k = 0; k < middle[0].triangles.size(); ++k) {
        const auto& corners = triangles_of(disc)[middle[0].triangles[k]];
        for (const std::uint32_t spoke : {middle[0].spokes[k], middle[0].spokes[k + 1]})
            EXPECT_NE(std::ranges::find(corners, spoke), corners.end()) << "the triangle lies between its spokes";
    }
    const std::vector<NodeFan> hem = fans.around(static_cast<std::uint32_t>(disc.nodes.size() - 1));
    ASSERT_EQ(hem.size(), 1u);
    EXPECT_FALSE(hem[0].is_closed());
}

TEST(NodeFans, ComeApartWhereTheyAreCut) {
    const DeformableDefinition disc = cloth_disc(1, 0.5);
    const NodeFans fans(triangles_of(disc), disc.nodes.size());
    const std::vector<std::uint32_t> spokes = fans.around(0)[0].spokes;
    const std::vector<SheetEdge> one{edge_between(0, spokes[0])}, two{one[0], edge_between(0, spokes[3])};
    EXPECT_TRUE(fans.split(one, {}).empty()) << "an edge within the sheet joins both sides at its ends";
    const std::vector<TornCorner> torn = fans.split(two, {});
    ASSERT_EQ(torn.size(), 3u);
    for (const TornCorner& corner : torn) EXPECT_EQ(corner.node, disc.nodes.size());

    std::vector<std::uint8_t> held(disc.nodes.size(), 0);
    held[0] = 1;
    EXPECT_TRUE(fans.split(two, held).empty()) << "what is held stays one";

    DeformableDefinition slit = disc;
    ASSERT_TRUE(tear(slit, torn).ok());
    EXPECT_EQ(slit.nodes.size(), disc.nodes.size() + 1);
    EXPECT_TRUE(validate(slit).ok());
    const NodeFans after(triangles_of(slit), slit.nodes.size());
    EXPECT_FALSE(after.around(spokes[0])[0].is_closed()) << "the slit ends there";
}

// Three sheets that meet in one edge: no turn around its nodes has an order.
TEST(NodeFans, HaveNoOrderAtAnEdgeOfThreeTriangles) {
    const std::vector<std::array<std::uint32_t, 3>> book{{0, 1, 2}, {0, 1, 3}, {0, 1, 4}};
    const NodeFans fans(book, 5);
    EXPECT_TRUE(fans.around(0).empty());
    EXPECT_TRUE(fans.split(std::vector<SheetEdge>{edge_between(0, 1)}, {}).empty());
    EXPECT_EQ(fans.around(2).size(), 1u);
}

}  // namespace
}  // namespace embody::physics::deformable
