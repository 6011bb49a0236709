// SPDX-License-Identifier: MIT
// Each attribute of the registry is tested from end to end: set by a command, shown, kept by a file, reset. The test
// names no attribute, so that a new one is tested without a change here.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "attributes/attribute_json.h"
#include "attributes/physical_kind.h"
#include "attributes/registry.h"
#include "scene/file/scene_file.h"
#include "scene/live_scene.h"
#include "scene/sample_documents.h"

namespace embody::scene {
namespace {

using attributes::AttributeDescription;
using attributes::AttributeValue;
using nlohmann::json;

/// A value other than the default, where there is one.
AttributeValue another_value(const AttributeDescription& attribute) {
    if (!attribute.choices.empty()) return attribute.choices.back();
    if (const bool* truth = std::get_if<bool>(&attribute.standard)) return !*truth;
    const double* number = std::get_if<double>(&attribute.standard);
    if (!number) return attribute.standard;
    if (std::isinf(*number)) return 1.0;
    const double half = (*number == 0 ? attribute.high.value_or(2) : *number) / 2;
    return attribute.whole ? std::floor(half) : half;
}

class EveryAttribute : public samples::LiveSession {
protected:
    [[nodiscard]] json row_of(const std::string& name) {
        const json rows = run("entity.attributes", {{"index", samples::thing}})["attributes"];
        for (const json& row : rows)
            if (row["name"] == name) return row;
        return nullptr;
    }
};

TEST_F(EveryAttribute, IsSetShownSavedAndTakenBack) {
    open(samples::floor_and_box());
    for (const AttributeDescription& attribute : attributes::registry()) {
        // The collision shape is the primitive itself.
        if (attribute.name == "collision_shape") continue;
        SCOPED_TRACE(attribute.name);
        const json value = attributes::to_json(another_value(attribute));
        run("entity.set_attribute", {{"indices", {samples::thing}}, {"name", attribute.name}, {"value", value}});
        const json row = row_of(attribute.name);
        ASSERT_FALSE(row.is_null());
        EXPECT_EQ(row["value"], value);
        EXPECT_EQ(row["unit"], attribute.unit);
        EXPECT_EQ(row["label"], attribute.label);
        EXPECT_EQ(row["kind_label"], attribute.kind_label);
        EXPECT_FALSE(attribute.kind_label.empty());
        const auto read = document_from_json(document_to_json(session_->document()));
        ASSERT_TRUE(read.ok()) << read.error().message();
        EXPECT_EQ(read.value().find(samples::thing)->attributes.at(attribute.name), another_value(attribute));
        run("edit.undo");
        EXPECT_FALSE(session_->document().find(samples::thing)->attributes.contains(attribute.name));
    }
}

}  // namespace
}  // namespace embody::scene
