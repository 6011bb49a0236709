// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "attributes/wordnet/noun_database.h"
#include "foundation/result.h"

namespace embody::attributes::wordnet {

/// Indices into the table; stable for one table file only.
using LemmaIndex = std::uint32_t;
using SynsetIndex = std::uint32_t;

/// One meaning of a lemma.
struct NounSense {
    SynsetIndex synset = 0;
    std::uint32_t tag_count = 0;  ///< how often tagged texts mean this
};

/// WordNet's lexicographer files that we use (lexnames(5WN)).
enum class Topic : std::uint8_t {
    tops = 3,
    act = 4,
    animal = 5,
    artifact = 6,
    body = 8,
    food = 13,
    object = 17,
    person = 18,
    plant = 20,
    substance = 27,
};

/// The nouns of WordNet 3.0 in one file of a few megabytes: lemmas, their synsets in the order of use, hypernyms,
/// irregular plurals. Read whole; every query is a binary search or an index.
class NounTable {
public:
    /// The error names the file and the remedy; a file that is cut, changed or of another version is refused.
    static Result<NounTable> load(const std::filesystem::path& file);

    /// The lemma with exactly this spelling (lower case, words joined by '_'), or without its hyphens, dots and
    /// apostrophes ("t_shirt").
    [[nodiscard]] std::optional<LemmaIndex> find_lemma(std::string_view text) const;
    /// As find_lemma; then tries base forms of an inflected last word: "oxen", "bread_knives", "boxes".
    [[nodiscard]] std::optional<LemmaIndex> find_inflected(std::string_view text) const;
    /// "chair.n.01": first sense of the lemma "chair".
    [[nodiscard]] std::optional<SynsetIndex> find_synset(std::string_view name) const;

    [[nodiscard]] std::string_view text(LemmaIndex lemma) const;
    /// The usual meaning first.
    [[nodiscard]] std::span<const NounSense> senses(LemmaIndex lemma) const;
    /// Whether the tagged texts use the word as an adjective at least as often as as a noun.
    [[nodiscard]] bool is_mostly_adjective(LemmaIndex lemma) const;

    /// Name of a synset: first lemma, n, and the number of that lemma's sense: "chair.n.01".
    [[nodiscard]] std::string name(SynsetIndex synset) const;
    [[nodiscard]] std::span<const SynsetIndex> hypernyms(SynsetIndex synset) const;
    /// Number of synsets that are this or a kind of it, itself included: small where the meaning is specific.
    [[nodiscard]] std::uint32_t count_of_kind(SynsetIndex synset) const;
    [[nodiscard]] bool is_physical(SynsetIndex synset) const;  ///< a kind of physical_entity.n.01, or an artifact
    [[nodiscard]] bool is_instance(SynsetIndex synset) const;  ///< a named individual
    [[nodiscard]] Topic topic(SynsetIndex synset) const;

    [[nodiscard]] std::uint32_t synset_count() const;
    [[nodiscard]] std::uint32_t lemma_count() const;

    NounTable(NounTable&&) = default;
    NounTable& operator=(NounTable&&) = default;

private:
    NounTable() = default;
    [[nodiscard]] std::string_view exception_text(std::uint32_t exception) const;

    std::vector<std::uint32_t> words_;  // the file
    // Views of it.
    std::span<const std::uint32_t> lemma_text_, lemma_senses_, hypernym_begin_, hypernyms_, kinds_, names_, marks_;
    std::span<const std::uint32_t> exception_text_, exception_lemma_;
    std::span<const NounSense> senses_;
    std::string_view text_;
};

/// Writes the table; the error names the file.
Result<void> write_noun_table(const NounDatabase& nouns, const std::filesystem::path& file);

}  // namespace embody::attributes::wordnet
