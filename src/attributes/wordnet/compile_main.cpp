// SPDX-License-Identifier: MIT
// Build step: compiles WordNet's text files to the table that the program reads.
#include <cstdio>

#include "attributes/wordnet/noun_table.h"

int main(int count, char** words) {
    namespace wordnet = embody::attributes::wordnet;
    if (count != 3) {
        std::fputs("usage: embody-compile-wordnet FOLDER_OF_WORDNET TABLE\n", stderr);
        return 2;
    }
    const auto nouns = wordnet::read_noun_database(words[1]);
    if (!nouns) {
        std::fprintf(stderr, "%s\n", nouns.error().message().c_str());
        return 1;
    }
    if (const auto written = wordnet::write_noun_table(*nouns, words[2]); !written) {
        std::fprintf(stderr, "%s\n", written.error().message().c_str());
        return 1;
    }
    return 0;
}
