// SPDX-License-Identifier: MIT
#include "evaluation/kind_evaluation.h"

#include <gtest/gtest.h>

#include <fstream>

#include "attributes/physical_kind.h"
#include "evaluation/table_reader.h"
#include "folders.h"

namespace embody::evaluation {
namespace {

Result<std::vector<LabelledWord>> read(const std::string& text) {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    const auto file = std::filesystem::path(testing::TempDir()) / (std::string(test->name()) + ".csv");
    std::ofstream(file) << text;
    return read_labelled_words(file);
}

TEST(TableCells, AreSplitAtSemicolons) {
    EXPECT_EQ(split_cell(" a ;b c;; d"), (std::vector<std::string>{"a", "b c", "d"}));
    EXPECT_TRUE(split_cell("").empty());
    EXPECT_TRUE(split_cell(" ; ").empty());
}

TEST(LabelledWords, RefuseWhatIsNoKind) {
    EXPECT_TRUE(read("words,kinds\nchair;seat,rigid;static\n").ok());
    EXPECT_NE(read("words,kinds\nchair,solid\n").error().message().find("line 2: kinds"), std::string::npos);
    EXPECT_NE(read("words,kinds\n,rigid\n").error().message().find("words: is empty"), std::string::npos);
    EXPECT_NE(read("words,kinds\n").error().message().find("holds no rows"), std::string::npos);
}

TEST(KindEvaluation, CountsWhatIsRightAndNamesWhatIsNot) {
    const auto taxonomy = attributes::Taxonomy::load(source_folder() / "data/taxonomy");
    ASSERT_TRUE(taxonomy.ok()) << taxonomy.error().message();
    const auto words = read("words,kinds\nhoney,fluid\nchair,rigid;static\nsand,granular\nanvil,fluid\n");
    const KindEvaluation evaluation = evaluate_kinds(**taxonomy, *words);
    EXPECT_EQ(evaluation.words, 4u);
    EXPECT_EQ(evaluation.accuracy(), 0.75);
    ASSERT_EQ(evaluation.mistakes.size(), 1u);
    EXPECT_EQ(evaluation.mistakes[0].label.word, "anvil");
    EXPECT_EQ(evaluation.by_label.at(attributes::PhysicalKind::fluid), (std::pair<std::size_t, std::size_t>{2, 1}));
}

}  // namespace
}  // namespace embody::evaluation
