// SPDX-License-Identifier: MIT
#include "evaluation/mass_evaluation.h"
#include "folders.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

namespace embody::evaluation {
namespace {

std::filesystem::path written(const std::string& text) {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    std::filesystem::path file = std::filesystem::path(testing::TempDir()) / (std::string(test->name()) + ".csv");
    std::ofstream(file) << text;
    return file;
}

constexpr const char* header = "id,name,category,dim_x_m,dim_y_m,dim_z_m,mass_kg,mesh_volume_m3,note\n";

std::unique_ptr<attributes::Taxonomy> taxonomy() {
    auto loaded = attributes::Taxonomy::load(source_folder() / "data/taxonomy");
    EXPECT_TRUE(loaded.ok()) << loaded.error().message();
    return std::move(*loaded);
}

TEST(MeasuredObjects, AreReadWithQuotesOptionalAndFurtherColumns) {
    const auto file = written(std::string(header) +
                              "a:1,\"chair, oak\",chair; furniture,0.5,0.9,0.5,6.5,,x\n"
                              "b:2,apple,apple,0.08,0.08,0.08,0.2,0.00024,\n");
    const auto objects = read_measured_objects(file);
    ASSERT_TRUE(objects.ok()) << objects.error().message();
    ASSERT_EQ(objects->size(), 2u);
    EXPECT_EQ(objects->front().name, "chair, oak");
    EXPECT_EQ(objects->front().source(), "a");
    EXPECT_FALSE(objects->front().mesh_volume);
    EXPECT_EQ(objects->back().mesh_volume, 0.00024);

    const auto facts = facts_of(objects->front(), Told::everything);
    EXPECT_EQ(facts.name, "chair, oak");
    EXPECT_EQ(facts.tags, (std::vector<std::string>{"chair", "furniture"}));
    EXPECT_TRUE(facts.size_is_stated);
    EXPECT_EQ(facts_of(objects->front(), Told::category).name, "chair");
    EXPECT_TRUE(facts_of(objects->front(), Told::name).tags.empty());
    EXPECT_TRUE(facts_of(objects->back(), Told::everything).geometry.closed);
}

TEST(MeasuredObjects, WhatIsWrongIsNamedByFileLineAndColumn) {
    const auto message_of = [](const std::string& text) {
        return read_measured_objects(written(text)).error().message();
    };
    EXPECT_NE(message_of(std::string(header) + "a:1,x,y,1,1,1,1,,\na:2,x,y,1,0,1,1,,\n").find("line 3: dim_y_m"),
              std::string::npos);
    for (const char* mass : {"nan", "-1", "inf", "", "2kg"}) {
        EXPECT_NE(
            message_of(std::string(header) + "a:1,x,y,1,1,1," + mass + ",,\n").find("mass_kg: must be a positive"),
            std::string::npos);
    }
    EXPECT_NE(message_of("id,name\na:1,x\n").find("no column \"category\""), std::string::npos);
    EXPECT_NE(message_of(header).find("holds no rows"), std::string::npos);
    EXPECT_NE(message_of("").find(".csv"), std::string::npos);
    EXPECT_NE(message_of(std::string(header) + "a:1,x\n").find("line"), std::string::npos);
    EXPECT_NE(read_measured_objects("/nonexistent.csv").error().message().find("is not a file"), std::string::npos);
}

TEST(MassEvaluation, FiguresFollowTheirDefinitions) {
    const auto known = taxonomy();
    MeasuredObject chair{"a:1", "chair", "chair", {0.5, 0.9, 0.5}, {}, 1};
    const MassEvaluation once = evaluate_mass(*known, {chair}, Told::everything);
    ASSERT_EQ(once.predictions.size(), 1u);
    const MassPrediction& predicted = once.predictions.front();

    // One object twice as heavy as predicted, one a quarter as heavy, one outside every interval.
    std::vector<MeasuredObject> objects(3, chair);
    objects[0].mass = predicted.mass * 2;
    objects[1].mass = predicted.mass / 4;
    objects[1].id = "b:1";
    objects[2].mass = predicted.high * 1.001;
    const MassEvaluation evaluation = evaluate_mass(*known, objects, Told::everything);
    const double third = std::log(predicted.high * 1.001 / predicted.mass);
    EXPECT_NEAR(evaluation.all.alde, (std::log(2) + std::log(4) + third) / 3, 1e-12);
    EXPECT_NEAR(evaluation.all.bias, (-std::log(2) + std::log(4) - third) / 3, 1e-12);
    EXPECT_NEAR(evaluation.all.mnre, (0.5 + 0.25 + std::exp(-third)) / 3, 1e-12);
    EXPECT_LE(evaluation.all.alde_low, evaluation.all.alde);
    EXPECT_GE(evaluation.all.alde_high, evaluation.all.alde);
    EXPECT_EQ(evaluation.by_source.at("a").objects, 2u);
    EXPECT_EQ(evaluation.by_source.at("b").coverage_80, predicted.mass / 4 >= predicted.low ? 1 : 0);
    EXPECT_NEAR(std::abs(evaluation.predictions.front().log_error()), std::log(4), 1e-12) << "worst first";
}

TEST(MassEvaluation, ThePredictorNeverSeesTheMass) {
    const auto known = taxonomy();
    const auto objects = read_measured_objects(
        written(std::string(header) + "a:1,lamp,lamp,0.3,0.5,0.3,1,,\na:2,lamp,lamp,0.3,0.5,0.3,900,,\n"));
    const MassEvaluation evaluation = evaluate_mass(*known, *objects, Told::everything);
    EXPECT_EQ(evaluation.predictions[0].mass, evaluation.predictions[1].mass);
}

TEST(MassEvaluation, AnUnseenWordFindsAnotherCategory) {
    const auto known = taxonomy();
    const MeasuredObject apple{"a:1", "apple", "apple", {0.08, 0.08, 0.08}, {}, 0.2};
    const MassEvaluation seen = evaluate_mass(*known, {apple}, Told::everything);
    const MassEvaluation unseen = evaluate_mass(*known, {apple}, Told::everything, Words::unseen);
    EXPECT_EQ(seen.predictions.front().category, "apple");
    EXPECT_NE(unseen.predictions.front().category, "apple");
    EXPECT_GT(unseen.predictions.front().high / unseen.predictions.front().low,
              seen.predictions.front().high / seen.predictions.front().low);
    EXPECT_EQ(evaluate_mass(*known, {apple}, Told::everything).predictions.front().category, "apple")
        << "the taxonomy itself forgets nothing";
}

}  // namespace
}  // namespace embody::evaluation
