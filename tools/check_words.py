#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Fails where a name in one of name_folders has a word that docs/glossary.md replaces by the field's.

Usage: check_words.py [--comments] [ROOT]   (default: the folder above this file)
--comments: reads the comments of comment_folders, too, for those of the words that have no everyday use (all but
everyday_words).
"""
import pathlib
import re
import sys

name_folders = (
    "src/attributes",
    "src/catalog",
    "src/database",
    "src/evaluation",
    "src/interchange",
    "src/physics",
    "src/scene",
)
comment_folders = ("benches", "scenes", "src", "studio/src", "tests", "tools")
comment_of = {  # by the end of a file's name; strings come first, so that a comment within them is none
    ".h": r"//[^\n]*|/\*.*?\*/",
    ".cpp": r"//[^\n]*|/\*.*?\*/",
    ".ts": r"//[^\n]*|/\*.*?\*/",
    ".mjs": r"//[^\n]*|/\*.*?\*/",
    ".py": r"#[^\n]*",
    ".sh": r"#[^\n]*",
}
saved_names = {"least_approach_speed"}  # members that are named as their field in scene files
everyday_words = {"give", "patient", "share", "shares", "way", "ways"}  # banned in names alone


def banned_words(glossary: pathlib.Path) -> tuple[set[str], set[str]]:
    """Words in backticks of the table's last column; those that end in `_…` are banned as the start of a name."""
    words, starts = set(), set()
    for line in glossary.read_text().splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if not line.startswith("|") or len(cells) != 4 or cells[0] == "word":
            continue
        for cell in re.findall(r"`([^`]+)`(?!\s+of)", cells[3]):
            (starts.add(cell[:-2]) if cell.endswith("_…") else words.add(cell))
    return words, starts


def names_in(text: str) -> list[tuple[int, str]]:
    """Identifiers with their lines; comments, strings and includes left out."""
    def blank(match: re.Match) -> str:
        return re.sub(r"[^\n]", " ", match[0])
    code = re.sub(r"//[^\n]*|/\*.*?\*/|\"(?:\\.|[^\"\\\n])*\"|#include[^\n]*", blank, text, flags=re.DOTALL)
    return [(number, name) for number, line in enumerate(code.splitlines(), 1) for name in re.findall(r"[A-Za-z_]\w*", line)]


def comment_words_in(path: pathlib.Path) -> list[tuple[int, str]]:
    """Words of comments with their lines; names in backticks and quoted words left out."""
    text, words = path.read_text(), []
    for match in re.finditer(r"\"(?:\\.|[^\"\\\n])*\"|'\\?.'|(" + comment_of[path.suffix] + ")", text, re.DOTALL):
        for offset, line in enumerate((match[1] or "").splitlines(), text.count("\n", 0, match.start()) + 1):
            words += [(offset, word) for word in re.findall(r"[A-Za-z]+", re.sub(r"`[^`]*`|\"[^\"]*\"", "", line))]
    return words


def sources_in(root: pathlib.Path, folders: tuple[str, ...], ends: tuple[str, ...]) -> list[pathlib.Path]:
    return [p for folder in folders for p in sorted((root / folder).rglob("*")) if p.suffix in ends]


def words_of(name: str) -> set[str]:
    return {word.lower() for word in re.findall(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])", name)}


def main() -> int:
    arguments = [argument for argument in sys.argv[1:] if argument != "--comments"]
    reads_comments = len(arguments) < len(sys.argv) - 1
    root = pathlib.Path(arguments[0]) if arguments else pathlib.Path(__file__).resolve().parent.parent
    words, starts = banned_words(root / "docs" / "glossary.md")
    single = {word for word in words if "_" not in word}
    files = sources_in(root, name_folders, (".h", ".cpp"))
    commented = sources_in(root, comment_folders, tuple(comment_of)) if reads_comments else []
    wrong, checked = [], 0
    for path in files:
        for number, name in names_in(path.read_text()):
            checked += 1
            start = name.split("_", 1)[0] if "_" in name.rstrip("_") else ""
            if name not in saved_names and (name in words or words_of(name) & single or start in starts):
                wrong.append(f"{path.relative_to(root)}:{number}: {name}: see docs/glossary.md")
    for path in commented:
        for number, word in comment_words_in(path):
            if word.lower() in single - everyday_words:
                wrong.append(f"{path.relative_to(root)}:{number}: comment: {word}: see docs/glossary.md")
    for line in wrong:
        print(line)
    print(f"{len(files)} files, {checked} names, comments of {len(commented)} files, {len(words) + len(starts)} words, {len(wrong)} wrong")
    return 1 if wrong or checked == 0 or not words else 0


if __name__ == "__main__":
    sys.exit(main())
