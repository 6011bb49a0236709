// SPDX-License-Identifier: MIT
#include "evaluation/kind_evaluation.h"

#include <algorithm>

#include "attributes/registry.h"
#include "evaluation/found_category.h"
#include "evaluation/table_reader.h"

namespace embody::evaluation {

Result<std::vector<LabelledWord>> read_labelled_words(const std::filesystem::path& file) {
    std::vector<LabelledWord> words;
    const auto read = read_table(file, {"words", "kinds"}, 2, [&](const TableRow& row) -> Result<void> {
        const std::vector<std::string> names = split_cell(row.cells[0]);
        if (names.empty()) return Error{"words", "is empty"};
        LabelledWord label{names.front(), {}};
        for (const std::string& kind : split_cell(row.cells[1])) {
            if (auto known = attributes::validate("kind", kind); !known)
                return Error{"kinds", known.error().why, known.error().remedy};
            label.kinds.push_back(*attributes::kind_from_text(kind));
        }
        if (label.kinds.empty()) return Error{"kinds", "is empty"};
        words.push_back(std::move(label));
        return {};
    });
    if (!read) return read.error();
    if (words.empty()) return Error{file.string(), "holds no rows", "give a table of labelled words"};
    return words;
}

double KindEvaluation::accuracy() const {
    return words == 0 ? 0 : static_cast<double>(words - mistakes.size()) / static_cast<double>(words);
}

KindEvaluation evaluate_kinds(const attributes::Taxonomy& taxonomy, const std::vector<LabelledWord>& words) {
    KindEvaluation evaluation;
    evaluation.words = words.size();
    for (const LabelledWord& label : words) {
        attributes::ModelFacts facts;
        facts.name = label.word;
        const attributes::AttributeSet set = resolve(taxonomy, facts);
        const attributes::PhysicalKind kind = kind_of(set);
        const bool right = std::ranges::find(label.kinds, kind) != label.kinds.end();
        auto& [all, right_ones] = evaluation.by_label[label.kinds.front()];
        ++all;
        right_ones += right ? 1 : 0;
        if (!right) evaluation.mistakes.push_back({label, kind, found_category(set)});
    }
    return evaluation;
}

}  // namespace embody::evaluation
