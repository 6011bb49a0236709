// SPDX-License-Identifier: MIT
// Reads the text files of WordNet 3.0 as its manual pages wndb(5WN), senseidx(5WN) and cntlist(5WN) describe them.
#include "attributes/wordnet/noun_database.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <optional>
#include <unordered_map>

namespace embody::attributes::wordnet {
namespace {

namespace fs = std::filesystem;

constexpr const char* remedy = "reinstall Debian's package wordnet-base";

// The fields of a line, one after the other; remembers that one was missing or no number.
class Fields {
public:
    explicit Fields(std::string_view line) : rest_(line) {}

    std::string_view word() {
        rest_.remove_prefix(std::min(rest_.find_first_not_of(' '), rest_.size()));
        const std::string_view found = rest_.substr(0, rest_.find(' '));
        rest_.remove_prefix(found.size());
        good_ = good_ && !found.empty();
        return found;
    }
    std::uint32_t number(int base = 10) {
        const std::string_view text = word();
        std::uint32_t value = 0;
        const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value, base);
        good_ = good_ && failure == std::errc{} && end == text.data() + text.size();
        return good_ ? value : 0;
    }
    void skip(std::uint32_t count) {
        for (std::uint32_t i = 0; i < count && good_; ++i) word();
    }
    [[nodiscard]] bool good() const { return good_; }

private:
    std::string_view rest_;
    bool good_ = true;
};

Error broken_line(const fs::path& file, std::size_t line) {
    return {file.string() + ": line " + std::to_string(line), "is not as WordNet 3.0 writes it", remedy};
}

// Calls `read` with each line after the licence at the top, whose lines begin with a space.
template <class Read>
Result<void> read_lines(const fs::path& file, Read&& read) {
    std::ifstream stream(file);
    if (!stream) return Error{file.string(), "cannot be read", "install Debian's package wordnet-base"};
    std::string line;
    for (std::size_t number = 1; std::getline(stream, line); ++number) {
        if (line.empty() || line.front() == ' ') continue;
        Fields fields(line);
        if (!read(fields) || !fields.good()) return broken_line(file, number);
    }
    return {};
}

using OffsetMap = std::unordered_map<std::uint32_t, std::uint32_t>;  // file offset → index of the synset

// offset lex_filenum ss_type w_cnt (word lex_id)… p_cnt (symbol offset pos source/target)… | gloss
Result<void> read_synsets(const fs::path& file, NounDatabase& nouns, OffsetMap& by_offset) {
    auto read = read_lines(file, [&](Fields& fields) {
        NounDatabase::Synset synset;
        const std::uint32_t offset = fields.number();
        synset.lexicographer_file = static_cast<std::uint8_t>(fields.number());
        fields.word();
        const std::uint32_t words = fields.number(16);
        synset.first_word = fields.word();
        if (words < 1 || words > 255) return false;
        fields.skip(2 * words - 1);
        const std::uint32_t pointers = fields.number();
        for (std::uint32_t i = 0; i < pointers && fields.good(); ++i) {
            const std::string_view symbol = fields.word();
            const std::uint32_t target = fields.number();
            fields.skip(2);
            if (symbol == "@" || symbol == "@i") synset.hypernyms.push_back(target);
            if (symbol == "@i") synset.is_instance = true;
        }
        by_offset.emplace(offset, static_cast<std::uint32_t>(nouns.synsets.size()));
        nouns.synsets.push_back(std::move(synset));
        return true;
    });
    if (!read) return read;

    // Offsets become indices once all are known.
    for (NounDatabase::Synset& synset : nouns.synsets) {
        for (std::uint32_t& target : synset.hypernyms) {
            const auto found = by_offset.find(target);
            if (found == by_offset.end()) {
                return Error{file.string(), synset.first_word + " points to a synset that is not there", remedy};
            }
            target = found->second;
        }
    }
    return {};
}

// lemma pos synset_cnt p_cnt symbol… sense_cnt tagsense_cnt offset…
Result<void> read_lemmas(const fs::path& file, NounDatabase& nouns, const OffsetMap& by_offset) {
    auto read = read_lines(file, [&](Fields& fields) {
        NounDatabase::Lemma lemma;
        lemma.text = fields.word();
        fields.word();
        const std::uint32_t count = fields.number();
        fields.skip(fields.number());
        fields.skip(2);
        for (std::uint32_t i = 0; i < count && fields.good(); ++i) {
            const auto found = by_offset.find(fields.number());
            if (found == by_offset.end()) return false;
            lemma.senses.push_back({found->second, 0});
        }
        nouns.lemmas.push_back(std::move(lemma));
        return true;
    });
    std::ranges::sort(nouns.lemmas, {}, &NounDatabase::Lemma::text);
    return read;
}

NounDatabase::Lemma* find_lemma(NounDatabase& nouns, std::string_view text) {
    const auto found = std::ranges::lower_bound(nouns.lemmas, text, {}, &NounDatabase::Lemma::text);
    return found != nouns.lemmas.end() && found->text == text ? &*found : nullptr;
}

// sense_key sense_number tag_count; the key is lemma%ss_type:…, type 1 a noun, 3 and 5 an adjective.
Result<void> read_counts(const fs::path& file, NounDatabase& nouns,
                         std::unordered_map<std::string, std::uint32_t>& adjective_counts) {
    return read_lines(file, [&](Fields& fields) {
        const std::string_view key = fields.word();
        const std::uint32_t sense = fields.number();
        const std::uint32_t count = fields.number();
        const std::size_t percent = key.rfind('%');
        if (percent == std::string_view::npos || percent + 1 >= key.size()) return false;
        const std::string_view text = key.substr(0, percent);
        const char type = key[percent + 1];
        if (type == '3' || type == '5') adjective_counts[std::string(text)] += count;
        if (type != '1') return true;
        NounDatabase::Lemma* lemma = find_lemma(nouns, text);
        if (lemma != nullptr && sense >= 1 && sense <= lemma->senses.size()) lemma->senses[sense - 1].tag_count = count;
        return true;
    });
}

Result<void> read_adjectives(const fs::path& file, NounDatabase& nouns,
                             const std::unordered_map<std::string, std::uint32_t>& adjective_counts) {
    return read_lines(file, [&](Fields& fields) {
        const std::string text(fields.word());
        NounDatabase::Lemma* lemma = find_lemma(nouns, text);
        if (lemma == nullptr) return true;
        std::uint32_t as_noun = 0;
        for (const NounDatabase::Sense& sense : lemma->senses) as_noun += sense.tag_count;
        const auto found = adjective_counts.find(text);
        lemma->mostly_adjective = (found != adjective_counts.end() ? found->second : 0) >= as_noun;
        return true;
    });
}

Result<void> read_exceptions(const fs::path& file, NounDatabase& nouns) {
    return read_lines(file, [&](Fields& fields) {
        const std::string inflected(fields.word());
        nouns.exceptions.emplace_back(inflected, fields.word());
        return true;
    });
}

}  // namespace

Result<NounDatabase> read_noun_database(const fs::path& folder) {
    NounDatabase nouns;
    OffsetMap by_offset;
    if (auto read = read_synsets(folder / "data.noun", nouns, by_offset); !read) return read.error();
    if (auto read = read_lemmas(folder / "index.noun", nouns, by_offset); !read) return read.error();
    if (auto read = read_exceptions(folder / "noun.exc", nouns); !read) return read.error();

    std::unordered_map<std::string, std::uint32_t> adjective_counts;
    if (fs::exists(folder / "cntlist.rev")) {
        if (auto read = read_counts(folder / "cntlist.rev", nouns, adjective_counts); !read) return read.error();
    }
    if (fs::exists(folder / "index.adj")) {
        if (auto read = read_adjectives(folder / "index.adj", nouns, adjective_counts); !read) return read.error();
    }
    return nouns;
}

}  // namespace embody::attributes::wordnet
