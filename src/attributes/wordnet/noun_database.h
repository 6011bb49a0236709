// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "foundation/result.h"

namespace embody::attributes::wordnet {

/// The nouns of WordNet as in its text files, with indices in place of file offsets.
struct NounDatabase {
    struct Sense {
        std::uint32_t synset = 0;
        std::uint32_t tag_count = 0;  ///< how often the tagged texts (SemCor) use this meaning
    };
    struct Lemma {
        std::string text;  ///< lower case, words joined by '_', such as "coffee_table"
        bool mostly_adjective =
            false;  ///< the tagged texts use it as an adjective at least as often as as a noun: "modern"
        std::vector<Sense> senses;  ///< the usual one first
    };
    struct Synset {
        std::string first_word;               ///< as written, such as "Eiffel_Tower"
        std::uint8_t lexicographer_file = 0;  ///< 3 tops, 4 act, 5 animal, 6 artifact, 7 attribute, 8 body, 13 food …
        bool is_instance = false;             ///< a named individual, such as the Eiffel Tower
        std::vector<std::uint32_t> hypernyms;  ///< of kinds, or of the individual
    };
    std::vector<Lemma> lemmas;  ///< ascending by text
    std::vector<Synset> synsets;
    std::vector<std::pair<std::string, std::string>> exceptions;  ///< inflected form, base form: "oxen", "ox"
};

/// Reads index.noun, data.noun, noun.exc, and cntlist.rev and index.adj if they exist (without them there are no
/// counts, and no word counts as an adjective). The error names file and line.
Result<NounDatabase> read_noun_database(const std::filesystem::path& folder);

}  // namespace embody::attributes::wordnet
