// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstring>
#include <fstream>
#include <map>

#include "attributes/wordnet/noun_table.h"
#include "attributes/wordnet/table_layout.h"

namespace embody::attributes::wordnet {
namespace {

using Numbers = std::vector<std::uint32_t>;

std::string lower_case(std::string text) {
    std::ranges::transform(text, text.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
    return text;
}

// Spelling without hyphens, dots and apostrophes: "t-shirt" is found as "t_shirt", "jew's_harp" as "jews_harp".
std::string plain_spelling(std::string_view text) {
    std::string plain;
    for (const char c : text) {
        if (c == '-' || c == '/') plain += '_';
        if (c != '\'' && c != '.' && c != '-' && c != '/') plain += c;
    }
    return plain;
}

// The lemmas and their plain spellings, where no other lemma has that spelling.
std::vector<NounDatabase::Lemma> with_plain_spellings(const std::vector<NounDatabase::Lemma>& lemmas) {
    std::map<std::string, const NounDatabase::Lemma*> added;
    const auto known = [&](const std::string& text) {
        return std::ranges::binary_search(lemmas, text, {}, &NounDatabase::Lemma::text);
    };
    for (const NounDatabase::Lemma& lemma : lemmas) {
        const std::string plain = plain_spelling(lemma.text);
        if (!plain.empty() && plain != lemma.text && !known(plain)) added.emplace(plain, &lemma);
    }
    std::vector<NounDatabase::Lemma> all = lemmas;
    for (const auto& [text, lemma] : added) {
        all.push_back(*lemma);
        all.back().text = text;
    }
    std::ranges::sort(all, {}, &NounDatabase::Lemma::text);
    return all;
}

// Number of kinds of each synset, counted once where two paths lead to it; and whether a synset is a kind of
// physical_entity. Some artifacts are not, since WordNet puts them under places or signs: bleachers, a buoy.
struct Kinds {
    Numbers counts;
    std::vector<bool> is_physical;
};
Kinds count_kinds(const NounDatabase& nouns) {
    const std::size_t count = nouns.synsets.size();
    Kinds kinds{Numbers(count, 0), std::vector<bool>(count, false)};
    std::vector<std::size_t> seen(count, count);
    Numbers above;
    for (std::size_t start = 0; start < count; ++start) {
        above.assign(1, static_cast<std::uint32_t>(start));
        seen[start] = start;
        constexpr std::uint8_t artifact_file = 6;
        if (nouns.synsets[start].lexicographer_file == artifact_file) kinds.is_physical[start] = true;
        while (!above.empty()) {
            const std::uint32_t current = above.back();
            above.pop_back();
            ++kinds.counts[current];
            if (nouns.synsets[current].first_word == "physical_entity") kinds.is_physical[start] = true;
            for (const std::uint32_t hypernym : nouns.synsets[current].hypernyms) {
                if (seen[hypernym] == start) continue;
                seen[hypernym] = start;
                above.push_back(hypernym);
            }
        }
    }
    return kinds;
}

class Writer {
public:
    explicit Writer(const NounDatabase& nouns)
        : nouns_(nouns), lemmas_(with_plain_spellings(nouns.lemmas)), kinds_(count_kinds(nouns)) {}

    Result<Numbers> write() {
        header_.magic = table_magic;
        header_.version = table_version;
        header_.lemmas = static_cast<std::uint32_t>(lemmas_.size());
        header_.synsets = static_cast<std::uint32_t>(nouns_.synsets.size());
        body_.assign(header_words, 0);
        add_lemmas();
        add_hypernyms();
        if (auto added = add_names(); !added) return added.error();
        add_exceptions();
        add_text();
        const std::uint64_t sum = checksum_of(std::span(body_).subspan(header_words));
        header_.checksum_low = static_cast<std::uint32_t>(sum);
        header_.checksum_high = static_cast<std::uint32_t>(sum >> 32);
        std::memcpy(body_.data(), &header_, sizeof header_);
        return body_;
    }

private:
    std::uint32_t begin_text(std::string_view added) {
        const auto begin = static_cast<std::uint32_t>(text_.size());
        text_ += added;
        return begin;
    }
    void append(const Numbers& numbers) { body_.insert(body_.end(), numbers.begin(), numbers.end()); }

    void add_lemmas() {
        Numbers texts, firsts, senses;
        for (const NounDatabase::Lemma& lemma : lemmas_) {
            texts.push_back(begin_text(lemma.text));
            firsts.push_back(header_.senses | (lemma.mostly_adjective ? adjective_bit : 0));
            for (const NounDatabase::Sense& sense : lemma.senses) {
                senses.push_back(sense.synset);
                senses.push_back(sense.tag_count);
            }
            header_.senses += static_cast<std::uint32_t>(lemma.senses.size());
        }
        texts.push_back(begin_text(""));
        firsts.push_back(header_.senses);
        append(texts);
        append(firsts);
        append(senses);
    }

    void add_hypernyms() {
        Numbers firsts, all;
        for (const NounDatabase::Synset& synset : nouns_.synsets) {
            firsts.push_back(static_cast<std::uint32_t>(all.size()));
            all.insert(all.end(), synset.hypernyms.begin(), synset.hypernyms.end());
        }
        firsts.push_back(static_cast<std::uint32_t>(all.size()));
        header_.hypernyms = static_cast<std::uint32_t>(all.size());
        append(firsts);
        append(all);
        append(kinds_.counts);
    }

    // "chair.n.01": the synset's first word, and the number of that word's sense.
    Result<void> add_names() {
        Numbers names, marks;
        for (std::uint32_t i = 0; i < nouns_.synsets.size(); ++i) {
            const NounDatabase::Synset& synset = nouns_.synsets[i];
            const std::string word = lower_case(synset.first_word);
            const auto lemma = std::ranges::lower_bound(lemmas_, word, {}, &NounDatabase::Lemma::text);
            if (lemma == lemmas_.end() || lemma->text != word) {
                return Error{"data.noun", synset.first_word + " is not in index.noun"};
            }
            const auto sense = std::ranges::find(lemma->senses, i, &NounDatabase::Sense::synset);
            if (sense == lemma->senses.end()) {
                return Error{"index.noun", word + " lacks one of its meanings in data.noun"};
            }
            names.push_back(static_cast<std::uint32_t>(lemma - lemmas_.begin()));
            marks.push_back(static_cast<std::uint32_t>(sense - lemma->senses.begin() + 1) |
                            (std::uint32_t{synset.lexicographer_file} << 8) |
                            (kinds_.is_physical[i] ? physical_bit : 0) | (synset.is_instance ? instance_bit : 0));
        }
        append(names);
        append(marks);
        return {};
    }

    // The exceptions whose base form is a lemma, ascending by the inflected form.
    void add_exceptions() {
        std::map<std::string, std::uint32_t> bases;
        for (const auto& [inflected, base] : nouns_.exceptions) {
            const auto lemma = std::ranges::lower_bound(lemmas_, base, {}, &NounDatabase::Lemma::text);
            if (lemma != lemmas_.end() && lemma->text == base) {
                bases.emplace(plain_spelling(inflected), static_cast<std::uint32_t>(lemma - lemmas_.begin()));
            }
        }
        Numbers texts, lemmas;
        for (const auto& [inflected, lemma] : bases) {
            texts.push_back(begin_text(inflected));
            lemmas.push_back(lemma);
        }
        texts.push_back(begin_text(""));
        header_.exceptions = static_cast<std::uint32_t>(lemmas.size());
        append(texts);
        append(lemmas);
    }

    void add_text() {
        Numbers text((text_.size() + 3) / 4, 0);
        std::memcpy(text.data(), text_.data(), text_.size());
        header_.text_words = static_cast<std::uint32_t>(text.size());
        append(text);
    }

    const NounDatabase& nouns_;
    std::vector<NounDatabase::Lemma> lemmas_;
    Kinds kinds_;
    TableHeader header_{};
    Numbers body_;
    std::string text_;
};

}  // namespace

Result<void> write_noun_table(const NounDatabase& nouns, const std::filesystem::path& file) {
    const auto words = Writer(nouns).write();
    if (!words) return words.error();
    std::ofstream stream(file, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(words->data()),
                 static_cast<std::streamsize>(words->size() * sizeof(std::uint32_t)));
    if (!stream.flush()) return Error{file.string(), "cannot be written", "is the disk full or the folder missing?"};
    return {};
}

}  // namespace embody::attributes::wordnet
