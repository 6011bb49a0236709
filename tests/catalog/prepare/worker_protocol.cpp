// SPDX-License-Identifier: MIT
#include "catalog/prepare/worker_protocol.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>

namespace embody::catalog {
namespace {

ImportItem an_item() {
    ImportItem item{.key = "k",
                    .archive = "a.zip",
                    .path = "p.obj",
                    .icon_path = "i.png",
                    .name = "Chair",
                    .source = "s",
                    .licence = "l",
                    .author = "w",
                    .category = "c",
                    .tags = {"x", "y"}};
    item.stated_size = {1, 2, 3};
    item.stated_rotation[3] = 0.5;
    item.recolors = {{"oak", {0.5, 0.25, 0.125}}};
    item.movable = false;
    item.door_or_window = true;
    return item;
}

PreparedModel a_model() {
    PreparedModel model;
    model.geometry = {1, 2, 3};
    model.thumbnail = {4, 5};
    model.hull_points = {{1, 2, 3}, {4, 5, 6}};
    model.convex_parts = {16, 0.01, 0.002, 0.3, {{{1, 2, 3}, {4, 5, 6}}, {{7, 8, 9}}}};
    model.facts.name = "Chair";
    model.facts.material_names = {"oak"};
    model.facts.movable = true;
    model.facts.geometry.size = {1, 2, 3};
    model.facts.geometry.volume = 0.25;
    model.facts.geometry.volume_method = "m";
    model.facts.geometry.fitted_shape = "box";
    model.facts.geometry.unit_inertia = Mat3::diagonal({1, 2, 3});
    geometry::SolidAndShell form;
    form.shell = {6, {0, 0.5, 0}, Mat3::diagonal({1, 1, 1})};
    form.solid = {1, {0, 0.5, 0}, Mat3::diagonal({2, 2, 2})};
    model.facts.geometry.parts = {{"oak", form}};
    model.content_hash = 42;
    model.vertices = 7;
    model.quality = 3;
    model.warnings = {"w"};
    return model;
}

TEST(WorkerProtocol, RefusesHeadersOfAnythingElse) {
    std::vector<std::uint8_t> good = frame(FrameKind::item, to_bytes(an_item()));
    EXPECT_TRUE(read_frame_header(good));
    for (std::size_t length = 0; length < frame_header_size; ++length) {
        EXPECT_FALSE(read_frame_header(std::span(good).first(length)));
    }
    for (const std::size_t at : {0u, 4u, 8u, 15u}) {
        std::vector<std::uint8_t> bad = good;
        bad[at] ^= 0x80;
        EXPECT_FALSE(read_frame_header(bad)) << at;
    }
    good[frame_header_size] ^= 1;
    EXPECT_FALSE(payload_of(good));
    EXPECT_FALSE(payload_of(std::span(good).first(10)));
}

TEST(WorkerProtocol, RefusesPayloadsOfEveryWrongLength) {
    const auto item = to_bytes(an_item()), model = to_bytes(a_model());
    for (std::size_t length = 0; length < item.size(); ++length)
        EXPECT_FALSE(item_from_bytes(std::span(item).first(length)));
    for (std::size_t length = 0; length < model.size(); ++length)
        EXPECT_FALSE(model_from_bytes(std::span(model).first(length)));
    auto longer = model;
    longer.push_back(0);
    EXPECT_FALSE(model_from_bytes(longer));
}

TEST(WorkerProtocol, RefusesImpossibleModels) {
    const auto refuses = [](auto change) {
        PreparedModel model = a_model();
        change(model);
        return !model_from_bytes(to_bytes(model)).ok();
    };
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(refuses([](PreparedModel&) {}));
    EXPECT_TRUE(refuses([](PreparedModel& m) { m.facts.geometry.volume = nan; }));
    EXPECT_TRUE(refuses([](PreparedModel& m) { m.facts.geometry.size.y = -1; }));
    EXPECT_TRUE(refuses([](PreparedModel& m) { m.facts.geometry.unit_inertia.y.z = nan; }));
    EXPECT_TRUE(refuses([](PreparedModel& m) { m.facts.geometry.parts[0].form.shell.volume = nan; }));
    EXPECT_TRUE(refuses([](PreparedModel& m) { m.facts.geometry.parts.resize(33); }));
    EXPECT_TRUE(refuses([](PreparedModel& m) { m.facts.geometry.fitted_shape = "donut"; }));
    EXPECT_TRUE(refuses([](PreparedModel& m) { m.facts.geometry.fitted_pose.rotation = {2, 0, 0, 0}; }));
    EXPECT_TRUE(refuses([](PreparedModel& m) { m.hull_points[0].x = std::numeric_limits<float>::infinity(); }));
    EXPECT_TRUE(refuses([](PreparedModel& m) { m.hull_points.resize(257); }));
    EXPECT_TRUE(refuses([](PreparedModel& m) { m.convex_parts.max_hulls = -1; }));
    EXPECT_TRUE(refuses([](PreparedModel& m) { m.convex_parts.concavity = nan; }));
    EXPECT_TRUE(refuses([](PreparedModel& m) { m.convex_parts.hulls.resize(257); }));
    EXPECT_TRUE(refuses([](PreparedModel& m) { m.convex_parts.hulls[0].resize(65); }));
    EXPECT_TRUE(refuses([](PreparedModel& m) { m.convex_parts.hulls[0][0].y = std::nanf(""); }));
    EXPECT_TRUE(refuses([](PreparedModel& m) { m.quality = 4; }));
    EXPECT_TRUE(refuses([](PreparedModel& m) { m.geometry.clear(); }));
    EXPECT_TRUE(refuses([](PreparedModel& m) { m.thumbnail.resize(5 << 20); }));
}

TEST(WorkerProtocol, ARefusalWithoutAReasonIsAnErrorOfTheWorker) {
    EXPECT_EQ(error_from_bytes(to_bytes(Error{"chair.obj", ""})).where, "import worker");
    EXPECT_FALSE(error_from_bytes(to_bytes(Error{"chair.obj", ""})).why.empty());
}

TEST(WorkerProtocol, SurvivesRandomPayloads) {
    std::mt19937 random(5);
    const auto whole = to_bytes(a_model());
    for (int trial = 0; trial < 20000; ++trial) {
        auto damaged = whole;
        for (int k = 0; k < 3; ++k) damaged[random() % damaged.size()] = static_cast<std::uint8_t>(random());
        const auto model = model_from_bytes(damaged);
        if (model) {
            EXPECT_LE(model->hull_points.size(), 256u);
        }
        (void)error_from_bytes(damaged);
    }
}

TEST(WorkerProtocol, CarriesEverything) {
    const auto item = item_from_bytes(to_bytes(an_item()));
    ASSERT_TRUE(item);
    EXPECT_EQ(to_bytes(*item), to_bytes(an_item()));
    EXPECT_EQ(item->tags, an_item().tags);
    EXPECT_EQ(item->stated_size, an_item().stated_size);
    EXPECT_EQ(item->recolors, an_item().recolors);
    EXPECT_EQ(item->movable, std::optional(false));
    const auto model = model_from_bytes(to_bytes(a_model()));
    ASSERT_TRUE(model);
    EXPECT_EQ(to_bytes(*model), to_bytes(a_model()));
    EXPECT_EQ(model->hull_points[1], (Vec3f{4, 5, 6}));
    EXPECT_EQ(model->convex_parts.hulls, a_model().convex_parts.hulls);
    EXPECT_EQ(model->content_hash, 42u);
    const Error error = error_from_bytes(to_bytes(Error{"where", "why", "remedy"}));
    EXPECT_EQ(error.message(), "where: why (remedy)");
}

}  // namespace
}  // namespace embody::catalog
