// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace embody::attributes::wordnet {

/// The table file: this header, then arrays of 32-bit numbers in the processor's order (the file never leaves the build
/// tree), then the text. In this order:
///   lemma_text[lemmas + 1], lemma_senses[lemmas + 1] (uppermost bit of an entry: mostly an adjective),
///   senses[senses] (synset, tag count), hypernym_begin[synsets + 1], hypernyms[hypernyms],
///   kinds[synsets], names[synsets] (lemma), marks[synsets], exception_text[exceptions + 1],
///   exception_lemma[exceptions], text.
struct TableHeader {
    std::uint32_t magic;
    std::uint32_t version;
    std::uint32_t lemmas, senses, synsets, hypernyms, exceptions;
    std::uint32_t text_words;                   ///< length of the text in 32-bit words, filled up with zeros
    std::uint32_t checksum_low, checksum_high;  ///< of all that follows
};
static_assert(sizeof(TableHeader) == 40);

constexpr std::uint32_t table_magic = 0x4E574D45;  // "EMWN"
constexpr std::uint32_t table_version = 1;
constexpr std::size_t header_words = sizeof(TableHeader) / sizeof(std::uint32_t);
constexpr std::uint32_t adjective_bit = 0x80000000U;

/// Bits of a synset's mark: number of the sense in its name (bits 0 to 7), lexicographer file (8 to 15), then the two
/// below.
constexpr std::uint32_t physical_bit = 1U << 16;
constexpr std::uint32_t instance_bit = 1U << 17;

/// Words after the header; 64 bits, so that no count can overflow it.
constexpr std::uint64_t body_words(const TableHeader& h) {
    return 2 * (std::uint64_t{h.lemmas} + 1) + 2 * std::uint64_t{h.senses} + (std::uint64_t{h.synsets} + 1) +
           h.hypernyms + 3 * std::uint64_t{h.synsets} + (2 * std::uint64_t{h.exceptions} + 1) + h.text_words;
}

/// FNV-1a over 32-bit words.
constexpr std::uint64_t checksum_of(std::span<const std::uint32_t> words) {
    std::uint64_t hash = 0xCBF29CE484222325U;
    for (const std::uint32_t word : words) hash = (hash ^ word) * 0x100000001B3U;
    return hash;
}

}  // namespace embody::attributes::wordnet
