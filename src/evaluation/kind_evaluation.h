// SPDX-License-Identifier: MIT
//
// Physical kinds beside labels that others gave to words.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "attributes/physical_kind.h"
#include "attributes/resolver.h"
#include "foundation/result.h"

namespace embody::evaluation {

/// A thing whose physical kind somebody knows.
struct LabelledWord {
    std::string word;                             ///< its usual name
    std::vector<attributes::PhysicalKind> kinds;  ///< any of these is right
};

/// Reads a table with the columns words (several separated by ";": the first is taken) and kinds (likewise: all are
/// right), kinds of the registry. Refuses unknown kinds and a table without rows.
Result<std::vector<LabelledWord>> read_labelled_words(const std::filesystem::path& file);

/// A word whose kind is wrong.
struct KindMistake {
    LabelledWord label;
    attributes::PhysicalKind kind = attributes::PhysicalKind::rigid;  ///< what we think
    std::string category;                                             ///< why
};

struct KindEvaluation {
    std::size_t words = 0;
    std::vector<KindMistake> mistakes;
    std::map<attributes::PhysicalKind, std::pair<std::size_t, std::size_t>>
        by_label;  ///< first right kind: words, right ones

    [[nodiscard]] double accuracy() const;  ///< share of the words
};

/// The kind of each word as the name of a model of which nothing else is known.
KindEvaluation evaluate_kinds(const attributes::Taxonomy& taxonomy, const std::vector<LabelledWord>& words);

}  // namespace embody::evaluation
