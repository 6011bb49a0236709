// SPDX-License-Identifier: MIT
#include "attributes/physical_kind.h"

#include <gtest/gtest.h>

#include <set>

#include "attributes/registry.h"

namespace embody::attributes {
namespace {

TEST(PhysicalKind, OtherTextIsNone) {
    for (const char* text : {"", "Rigid", "rigid ", "static_body", "liquid", "kinematic", "0"})
        EXPECT_FALSE(kind_from_text(text)) << text;
    EXPECT_FALSE(kind_from_value(1.0));
    EXPECT_FALSE(kind_from_value(true));
    EXPECT_FALSE(kind_from_value(std::string("liquid")));
}

// Files and databases hold these words: they must not change.
TEST(PhysicalKind, HasTheTextThatFilesHold) {
    const std::vector<std::string> texts{"static", "rigid", "articulated", "soft",  "cloth",
                                         "rope",   "fluid", "granular",    "visual"};
    ASSERT_EQ(texts.size(), physical_kinds.size());
    for (std::size_t i = 0; i < texts.size(); ++i) EXPECT_EQ(to_text(physical_kinds[i]), texts[i]);
    EXPECT_EQ(describe("kind")->choices, texts);
    for (const PhysicalKind kind : physical_kinds) {
        EXPECT_EQ(kind_from_text(to_text(kind)), kind);
        EXPECT_EQ(kind_from_value(to_value(kind)), kind);
        EXPECT_TRUE(validate("kind", to_value(kind)).ok());
    }
}

TEST(PhysicalKind, OfASetIsRigidWhereItSaysNothing) {
    AttributeSet set;
    EXPECT_EQ(kind_of(set), PhysicalKind::rigid);
    EXPECT_EQ(describe("kind")->standard, to_value(PhysicalKind::rigid));
    for (const PhysicalKind kind : physical_kinds) {
        set.put({"kind", to_value(kind), {}, {}, "test", AttributeLevel::manual});
        EXPECT_EQ(kind_of(set), kind);
    }
}

TEST(PhysicalKind, HasALetterOfItsOwnUnlessItIsOnlyDrawn) {
    std::set<char> letters;
    for (const PhysicalKind kind : physical_kinds) {
        const std::string_view own = traits_of(kind).letters;
        if (kind == PhysicalKind::visual) {
            EXPECT_TRUE(own.empty());
            continue;
        }
        ASSERT_FALSE(own.empty()) << to_text(kind);
        EXPECT_TRUE(letters.insert(own.front()).second) << to_text(kind);
    }
    // Every further letter of a kind is the own letter of another kind.
    EXPECT_EQ(std::string(every_kind.data()).size(), letters.size());
    for (const PhysicalKind kind : physical_kinds)
        for (const char letter : traits_of(kind).letters) EXPECT_TRUE(letters.contains(letter)) << to_text(kind);
}

TEST(PhysicalKind, BendsOrFlowsOrKeepsItsForm) {
    const auto those = [](bool (*is)(PhysicalKind)) {
        std::string names;
        for (const PhysicalKind kind : physical_kinds)
            if (is(kind)) names += to_text(kind) + " ";
        return names;
    };
    EXPECT_EQ(those(is_thin), "cloth rope ");
    EXPECT_EQ(those(is_deformable), "soft cloth rope ");
    EXPECT_EQ(those(flows), "fluid granular ");
    EXPECT_EQ(those(changes_form), "soft cloth rope fluid granular ");
}

}  // namespace
}  // namespace embody::attributes
