// SPDX-License-Identifier: MIT
#include "attributes/wordnet/noun_table.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "attributes/wordnet/table_layout.h"

namespace embody::attributes::wordnet {
namespace {

constexpr const char* build_again = "build again: the target embody_wordnet_table writes it from Debian's wordnet-base";

// Index of a text in an ascending list; `text_of` returns the text of an index.
template <class TextOf>
std::optional<std::uint32_t> find_text(std::uint32_t count, std::string_view wanted, TextOf&& text_of) {
    std::uint32_t low = 0, high = count;
    while (low < high) {
        const std::uint32_t middle = low + (high - low) / 2;
        const int order = text_of(middle).compare(wanted);
        if (order == 0) return middle;
        if (order < 0)
            low = middle + 1;
        else
            high = middle;
    }
    return std::nullopt;
}

Result<std::vector<std::uint32_t>> read_words(const std::filesystem::path& file) {
    std::error_code failure;
    const auto size = std::filesystem::file_size(file, failure);
    if (failure) return Error{file.string(), "WordNet's nouns are not there: " + failure.message(), build_again};
    std::ifstream stream(file, std::ios::binary);
    std::vector<std::uint32_t> words(size / sizeof(std::uint32_t));
    stream.read(reinterpret_cast<char*>(words.data()),
                static_cast<std::streamsize>(words.size() * sizeof(std::uint32_t)));
    if (!stream)
        return Error{file.string(), "cannot be read", "look at its permissions, or " + std::string(build_again)};
    if (size % sizeof(std::uint32_t) != 0) return Error{file.string(), "is cut off", build_again};
    return words;
}

// The rules of detachment of morphy(7WN) for nouns.
constexpr std::array<std::pair<std::string_view, std::string_view>, 8> detachments{{{"s", ""},
                                                                                    {"ses", "s"},
                                                                                    {"xes", "x"},
                                                                                    {"zes", "z"},
                                                                                    {"ches", "ch"},
                                                                                    {"shes", "sh"},
                                                                                    {"men", "man"},
                                                                                    {"ies", "y"}}};

}  // namespace

Result<NounTable> NounTable::load(const std::filesystem::path& file) {
    auto words = read_words(file);
    if (!words) return words.error();
    NounTable table;
    table.words_ = std::move(*words);

    // Nothing is read before the checksum shows that the file is complete and unchanged.
    TableHeader header{};
    if (table.words_.size() < header_words) return Error{file.string(), "is cut off", build_again};
    std::memcpy(&header, table.words_.data(), sizeof header);
    if (header.magic != table_magic) return Error{file.string(), "is no table of WordNet's nouns", build_again};
    if (header.version != table_version) {
        return Error{file.string(),
                     "has version " + std::to_string(header.version) + ", this program reads version " +
                         std::to_string(table_version),
                     build_again};
    }
    std::span<const std::uint32_t> rest = std::span(table.words_).subspan(header_words);
    const std::uint64_t sum = checksum_of(rest);
    if (rest.size() != body_words(header) || header.checksum_low != static_cast<std::uint32_t>(sum) ||
        header.checksum_high != static_cast<std::uint32_t>(sum >> 32)) {
        return Error{file.string(), "is cut off or was changed (its checksum differs)", build_again};
    }

    const auto take = [&rest](std::size_t count) {
        const auto taken = rest.first(count);
        rest = rest.subspan(count);
        return taken;
    };
    table.lemma_text_ = take(header.lemmas + 1);
    table.lemma_senses_ = take(header.lemmas + 1);
    static_assert(sizeof(NounSense) == 2 * sizeof(std::uint32_t));
    table.senses_ = {reinterpret_cast<const NounSense*>(take(2 * header.senses).data()), header.senses};
    table.hypernym_begin_ = take(header.synsets + 1);
    table.hypernyms_ = take(header.hypernyms);
    table.kinds_ = take(header.synsets);
    table.names_ = take(header.synsets);
    table.marks_ = take(header.synsets);
    table.exception_text_ = take(header.exceptions + 1);
    table.exception_lemma_ = take(header.exceptions);
    table.text_ = {reinterpret_cast<const char*>(rest.data()), rest.size_bytes()};
    return table;
}

std::uint32_t NounTable::synset_count() const { return static_cast<std::uint32_t>(kinds_.size()); }
std::uint32_t NounTable::lemma_count() const { return static_cast<std::uint32_t>(lemma_text_.size()) - 1; }

std::string_view NounTable::text(LemmaIndex lemma) const {
    return text_.substr(lemma_text_[lemma], lemma_text_[lemma + 1] - lemma_text_[lemma]);
}
std::string_view NounTable::exception_text(std::uint32_t exception) const {
    return text_.substr(exception_text_[exception], exception_text_[exception + 1] - exception_text_[exception]);
}

std::span<const NounSense> NounTable::senses(LemmaIndex lemma) const {
    const std::uint32_t first = lemma_senses_[lemma] & ~adjective_bit;
    return senses_.subspan(first, (lemma_senses_[lemma + 1] & ~adjective_bit) - first);
}
bool NounTable::is_mostly_adjective(LemmaIndex lemma) const { return (lemma_senses_[lemma] & adjective_bit) != 0; }

std::optional<LemmaIndex> NounTable::find_lemma(std::string_view text) const {
    return find_text(lemma_count(), text, [this](std::uint32_t i) { return this->text(i); });
}

std::optional<LemmaIndex> NounTable::find_inflected(std::string_view text) const {
    if (const auto lemma = find_lemma(text)) return lemma;
    const auto exception = find_text(static_cast<std::uint32_t>(exception_lemma_.size()), text,
                                     [this](std::uint32_t i) { return exception_text(i); });
    if (exception) return exception_lemma_[*exception];

    // An irregular last word of several: "bread_knives".
    const std::size_t last = text.rfind('_');
    if (last != std::string_view::npos) {
        const auto irregular = find_text(static_cast<std::uint32_t>(exception_lemma_.size()), text.substr(last + 1),
                                         [this](std::uint32_t i) { return exception_text(i); });
        if (irregular) {
            const std::string base =
                std::string(text.substr(0, last + 1)) + std::string(this->text(exception_lemma_[*irregular]));
            if (const auto lemma = find_lemma(base)) return lemma;
        }
    }
    for (const auto& [ending, instead] : detachments) {
        // "ss" is no plural, and the rest must still be a word.
        if (!text.ends_with(ending) || text.ends_with("ss") || text.size() < ending.size() + 2) continue;
        const std::string base = std::string(text.substr(0, text.size() - ending.size())) + std::string(instead);
        if (const auto lemma = find_lemma(base)) return lemma;
    }
    return std::nullopt;
}

std::optional<SynsetIndex> NounTable::find_synset(std::string_view name) const {
    const std::size_t dot = name.rfind(".n.");
    if (dot == std::string_view::npos || name.size() != dot + 5) return std::nullopt;
    std::uint32_t number = 0;
    for (const char c : name.substr(dot + 3)) {
        if (c < '0' || c > '9') return std::nullopt;
        number = 10 * number + static_cast<std::uint32_t>(c - '0');
    }
    const auto lemma = find_lemma(name.substr(0, dot));
    if (!lemma || number < 1 || number > senses(*lemma).size()) return std::nullopt;
    return senses(*lemma)[number - 1].synset;
}

std::string NounTable::name(SynsetIndex synset) const {
    char number[8];
    std::snprintf(number, sizeof number, ".n.%02u", marks_[synset] & 0xFFU);
    return std::string(text(names_[synset])) + number;
}

std::span<const SynsetIndex> NounTable::hypernyms(SynsetIndex synset) const {
    return hypernyms_.subspan(hypernym_begin_[synset], hypernym_begin_[synset + 1] - hypernym_begin_[synset]);
}
std::uint32_t NounTable::count_of_kind(SynsetIndex synset) const { return kinds_[synset]; }
bool NounTable::is_physical(SynsetIndex synset) const { return (marks_[synset] & physical_bit) != 0; }
bool NounTable::is_instance(SynsetIndex synset) const { return (marks_[synset] & instance_bit) != 0; }
Topic NounTable::topic(SynsetIndex synset) const { return static_cast<Topic>((marks_[synset] >> 8) & 0xFFU); }

}  // namespace embody::attributes::wordnet
