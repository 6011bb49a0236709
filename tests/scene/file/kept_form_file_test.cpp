// SPDX-License-Identifier: MIT
// Kept forms in scene files: written and read to the last bit, and broken ones refused by field.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "attributes/physical_kind.h"
#include "foundation/base64.h"
#include "foundation/random.h"
#include "scene/file/scene_file.h"
#include "scene/live_scene.h"
#include "scene/sample_documents.h"

namespace embody::scene {
namespace {

using nlohmann::json;
using samples::thing;

json packed(const std::vector<double>& values) {
    std::string bytes(values.size() * sizeof(double), '\0');
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return json::array({to_base64(bytes)});
}

json a_form(Random& random, std::size_t points) {
    std::vector<double> places;
    for (std::size_t i = 0; i < 3 * points; ++i) places.push_back(random.between(-1, 1));
    return {{"fingerprint", "0123456789abcdef"}, {"places", packed(places)}};
}

json scene_with(const json& kept) {
    Document document = samples::floor_and_box();
    document.entities[1].attributes["kind"] = to_value(attributes::PhysicalKind::soft);
    json scene = document_to_json(document);
    scene["entities"][1]["kept"] = kept;
    return scene;
}

std::string error_of(const json& kept) {
    const Result<Document> read = document_from_json(scene_with(kept));
    return read.ok() ? "accepted" : read.error().message();
}

TEST(KeptFormFile, IsReadAsWritten) {
    Random random(1);
    for (int i = 0; i < 200; ++i) {
        KeptForm form{.fingerprint = "00000000deadbeef", .cell_size = random.unit()};
        for (std::size_t k = 3 * (1 + random.below(50)); k > 0; --k)
            form.places.values.push_back(std::ldexp(random.between(-1, 1), static_cast<int>(random.below(40)) - 30));
        for (std::size_t k = 5 * random.below(20); k > 0; --k)
            form.plastic_strain.values.push_back(random.between(-0.5, 0.5));
        for (std::size_t k = 6 * random.below(20); k > 0; --k) form.bend.values.push_back(random.between(-50, 50));
        for (std::uint32_t k = 0; k < random.below(5); ++k) form.broken.push_back(3 * k);
        Document document = samples::floor_and_box();
        document.entities[1].kept = form;
        const std::string text = document_to_json(document).dump();
        const Result<Document> read = document_from_json(json::parse(text));
        ASSERT_TRUE(read.ok()) << read.error().message();
        ASSERT_TRUE(read.value().entities[1].kept);
        EXPECT_EQ(*read.value().entities[1].kept, form);
    }
}

TEST(KeptFormFile, OfOldScenesAndNullAreNone) {
    EXPECT_EQ(error_of(nullptr), "accepted");
    const Result<Document> read = document_from_json(document_to_json(samples::floor_and_box()));
    ASSERT_TRUE(read.ok());
    EXPECT_FALSE(read.value().find(thing)->kept);
    EXPECT_FALSE(document_to_json(samples::floor_and_box())["entities"][1].contains("kept"));
}

TEST(KeptFormFile, ThatIsBrokenIsRefusedByField) {
    Random random(2);
    const json good = a_form(random, 10);
    ASSERT_EQ(error_of(good), "accepted");
    const auto with = [&](const char* field, json value) {
        json broken = good;
        broken[field] = std::move(value);
        return error_of(broken);
    };
    const auto without = [&](const char* field) {
        json broken = good;
        broken.erase(field);
        return error_of(broken);
    };
    const std::string text = good["places"][0];
    const double infinite = std::numeric_limits<double>::infinity();
    const std::pair<std::string, std::string> cases[] = {
        {without("places"), "kept.places"},
        {without("fingerprint"), "kept.fingerprint"},
        {error_of(json::array()), "kept"},
        {error_of("kept"), "kept"},
        {with("form", 1), "kept.form"},
        {with("fingerprint", "0123456789ABCDEF"), "kept.fingerprint"},
        {with("fingerprint", ""), "kept.fingerprint"},
        {with("fingerprint", 7), "kept.fingerprint"},
        {with("places", text), "kept.places"},
        {with("places", json::array()), "kept.places"},
        {with("places", json::array({7})), "kept.places[0]"},
        {with("places", json::array({text.substr(0, text.size() - 1)})), "kept.places"},
        {with("places", json::array({text.substr(0, text.size() - 4)})), "kept.places"},
        {with("places", json::array({text, "===="})), "kept.places"},
        {with("places", json::array({text, "*"})), "kept.places"},
        {with("places", json::array({" " + text})), "kept.places"},
        {with("places", packed({1, 2})), "kept.places"},
        {with("places", packed({1, 2, std::nan("")})), "kept.places"},
        {with("places", packed({1, -infinite, 3})), "kept.places"},
        {with("places", packed({1, 2e6, 3})), "kept.places"},
        {with("plastic_strain", packed({1, 2, 3, 4})), "kept.plastic_strain"},
        {with("plastic_strain", packed({1, 2, 3, 4, std::nan("")})), "kept.plastic_strain"},
        {with("bend", packed({1, 2, 3, 4, 5})), "kept.bend"},
        {with("bend", packed({1, 2, 3, 4, 5, std::nan("")})), "kept.bend"},
        {with("broken", {3, 2}), "kept.broken"},
        {with("broken", {1.5}), "kept.broken[0]"},
        {with("broken", {-1}), "kept.broken[0]"},
        {with("broken", 3), "kept.broken"},
        {with("cell_size", -1), "kept.cell_size"},
        {with("cell_size", 2), "kept.cell_size"}};
    for (const auto& [error, field] : cases)
        EXPECT_TRUE(error.starts_with("entities[1]." + field + ":") || error.starts_with("entities[1]." + field + " "))
            << field << ": " << error;
}

TEST(KeptFormFile, WithTooManyNumbersIsRefused) {
    json lines = json::array();
    const std::string line(4 << 20, 'A');
    for (int i = 0; i < 17; ++i) lines.push_back(line);
    EXPECT_NE(error_of({{"fingerprint", "0123456789abcdef"}, {"places", lines}}).find("6000000 numbers"),
              std::string::npos);
}

// What only the mesh can tell does not keep a scene from being opened: it begins as modelled, and says so.
TEST(KeptFormFile, ThatBelongsToAnotherMeshIsLeftOutWithANote) {
    Random random(4);
    const auto simulation_of = [](const json& kept) {
        const Result<Document> read = document_from_json(scene_with(kept));
        EXPECT_TRUE(read.ok());
        return samples::make(read.value());
    };
    const auto modelled = simulation_of(nullptr);
    ASSERT_TRUE(modelled);
    ASSERT_TRUE(modelled->notes().empty());
    Document begun = document_from_json(scene_with(nullptr)).value();
    samples::step(*modelled, 60);
    const SharedOptional<KeptForm> good = modelled->kept_form(thing);
    ASSERT_TRUE(good);
    begun.entities[1].kept = good;
    const json written = document_to_json(begun)["entities"][1]["kept"];
    EXPECT_TRUE(simulation_of(written)->notes().empty());

    const auto expect_note = [&](const char* field, json value, const char* said) {
        json broken = written;
        broken[field] = std::move(value);
        const auto made = simulation_of(broken);
        ASSERT_TRUE(made);
        ASSERT_EQ(made->notes().size(), 1u) << field;
        EXPECT_NE(made->notes()[0].find(said), std::string::npos) << made->notes()[0];
        EXPECT_EQ(samples::points_of(*made), samples::points_of(*simulation_of(nullptr))) << field;
    };
    expect_note("fingerprint", "0123456789abcdef", "kept.fingerprint");
    expect_note("places", a_form(random, 10)["places"], "kept.places");
    expect_note("plastic_strain", packed({0, 0, 0, 0, 0}), "kept.plastic_strain");
    expect_note("bend", packed({0, 0, 0, 0, 0, 0}), "kept.bend");
    expect_note("broken", {1}, "kept.broken");
    expect_note("cell_size", 0.1, "kept.cell_size");
}

// Nodes that are nowhere near each other, strains beyond all bounds: it runs, and all stays finite.
TEST(KeptFormFile, OfWildNumbersIsSimulatedAndStaysFinite) {
    for (const auto kind :
         {attributes::PhysicalKind::soft, attributes::PhysicalKind::cloth, attributes::PhysicalKind::rope,
          attributes::PhysicalKind::granular, attributes::PhysicalKind::fluid}) {
        for (const double extent : {1.0, 1e3, 1e6}) {
            Random random(static_cast<std::uint64_t>(extent));
            Document document = samples::floor_and_box(2);
            document.entities[1].geometry =
                physics::ShapeDefinition{kind == attributes::PhysicalKind::cloth  ? physics::BoxShape{{0.5, 0.001, 0.5}}
                                         : kind == attributes::PhysicalKind::rope ? physics::BoxShape{{0.01, 0.5, 0.01}}
                                                                                  : physics::BoxShape{{0.2, 0.2, 0.2}}};
            document.entities[1].attributes = {{"kind", to_value(kind)}};
            if (kind == attributes::PhysicalKind::cloth) document.entities[1].attributes["cloth_nodes"] = 100.0;
            if (kind == attributes::PhysicalKind::fluid) document.entities[1].attributes["particle_budget"] = 500.0;
            if (kind == attributes::PhysicalKind::granular) document.entities[1].attributes["grain_budget"] = 100.0;
            const auto before = samples::make(document);
            ASSERT_TRUE(before);
            samples::step(*before, 90);
            ASSERT_TRUE(before->kept_form(thing));
            KeptForm wild = *before->kept_form(thing);
            for (double& number : wild.places.values) number = random.between(-extent, extent);
            for (double& number : wild.plastic_strain.values) number = random.between(-extent, extent);
            for (double& number : wild.bend.values) number = random.between(-extent, extent);
            document.entities[1].kept = wild;
            const auto made = samples::make(document);
            ASSERT_TRUE(made);
            samples::step(*made, 20);
            for (const Vec3 point : samples::points_of(*made))
                ASSERT_TRUE(is_finite(point)) << static_cast<int>(kind) << " " << extent;
        }
    }
}

}  // namespace
}  // namespace embody::scene
