// SPDX-License-Identifier: MIT
//
// Compares physical kinds with labels that others gave to words.
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

/// A thing with a known physical kind.
struct LabelledWord {
    std::string word;                             ///< its usual name
    std::vector<attributes::PhysicalKind> kinds;  ///< any of these is right
};

/// Reads a table with the columns words (several separated by ";": the first is taken) and kinds (several separated by
/// ";": each is right), kinds of the registry. Refuses unknown kinds and a table without rows.
Result<std::vector<LabelledWord>> read_labelled_words(const std::filesystem::path& file);

/// A word whose kind is wrong.
struct KindMistake {
    LabelledWord label;
    attributes::PhysicalKind kind = attributes::PhysicalKind::rigid;  ///< our answer
    std::string category;                                             ///< its reason
};

struct KindEvaluation {
    std::size_t words = 0;
    std::vector<KindMistake> mistakes;
    std::map<attributes::PhysicalKind, std::pair<std::size_t, std::size_t>>
        by_label;  ///< first right kind: words, right ones

    [[nodiscard]] double accuracy() const;  ///< fraction of the words
};

/// The kind of each word, used as the name of a model without other facts.
KindEvaluation evaluate_kinds(const attributes::Taxonomy& taxonomy, const std::vector<LabelledWord>& words);

}  // namespace embody::evaluation
