# SPDX-License-Identifier: MIT
"""Writes BEHAVIOR-1K's object types as a table of our kinds, to compare the taxonomy with.

    behavior_kinds.py SYNSETS.csv OUT.csv [--wordnet /usr/share/wordnet]

SYNSETS.csv is bddl/generated_data/synsets.csv of the repository StanfordVL/bddl (MIT). The table has the columns
synset, words (WordNet 3.0's lemmas, separated by ';'), type (BEHAVIOR's), kinds (ours that agree with it, separated
by ';') and pruned (1 where BEHAVIOR has no model of it). Prints what was left out and why.
"""

import argparse
import collections
import csv
import pathlib
import sys

# BEHAVIOR does not distinguish movable from fixed rigid bodies, so its rigid bodies agree with three of our kinds. Its
# physical substances are particles that are simulated one by one, fine (micro) or coarse (macro): piles of grains.
# Visual substances (dust, stains, paint) are coatings on another body: we have no such kind.
KINDS_OF_TYPE = {
    "rigidBody": ("static", "rigid", "articulated"),
    "softBody": ("soft",),
    "cloth": ("cloth",),
    "rope": ("rope",),
    "liquid": ("fluid",),
    "microPhysicalSubstance": ("granular",),
    "macroPhysicalSubstance": ("granular",),
}


def wordnet_nouns(folder):
    """Sense offsets by lemma, and the lemmas of each offset."""
    senses, lemmas = {}, {}
    with open(folder / "index.noun", encoding="ascii") as file:
        for fields in (line.split() for line in file if not line.startswith(" ")):
            senses[fields[0]] = fields[len(fields) - int(fields[2]) :]
    with open(folder / "data.noun", encoding="ascii") as file:
        for fields in (line.split("|")[0].split() for line in file if not line.startswith(" ")):
            lemmas[fields[0]] = [fields[4 + 2 * i].replace("_", " ").lower() for i in range(int(fields[3], 16))]
    return senses, lemmas


def words_of(synset, senses, lemmas):
    """WordNet's words for a key such as chair.n.01; empty where WordNet 3.0 has no such noun."""
    lemma, part, number = synset.rsplit(".", 2)
    offsets = senses.get(lemma.lower(), [])
    return lemmas[offsets[int(number) - 1]] if part == "n" and 1 <= int(number) <= len(offsets) else []


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("synsets", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--wordnet", type=pathlib.Path, default="/usr/share/wordnet")
    arguments = parser.parse_args()

    senses, lemmas = wordnet_nouns(arguments.wordnet)
    kept, left_out = [], collections.Counter()
    with open(arguments.synsets, encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            words = words_of(row["synset"], senses, lemmas)
            if row["is_custom"] == "1":
                left_out["a synset of BEHAVIOR's own"] += 1
            elif not words:
                left_out["no noun of WordNet 3.0"] += 1
            elif row["objectType"] not in KINDS_OF_TYPE:
                left_out[f"type {row['objectType']}"] += 1
            else:
                kinds = KINDS_OF_TYPE[row["objectType"]]
                kept.append((row["synset"], ";".join(words), row["objectType"], ";".join(kinds), row["prune"]))

    with open(arguments.out, "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("synset", "words", "type", "kinds", "pruned"))
        writer.writerows(sorted(kept))
    for kind, count in sorted(collections.Counter(row[2] for row in kept).items()):
        print(f"{count:5} {kind}")
    for reason, count in sorted(left_out.items()):
        print(f"{count:5} left out: {reason}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
