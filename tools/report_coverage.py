#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Prints which lines and branches of src/ were executed, by folder, from the counters of a build with EMBODY_COVERAGE.

Usage: report_coverage.py [--missing] BUILD [FOLDER…]     FOLDER: of src/, for example physics or physics/fluid; default: all of it
Counters of all runs since they were last removed (find BUILD -name '*.gcda' -delete) add up. A line or branch of a header that several
translation units have counts once, and as executed if any of them executed it. Sources that were compiled but not executed count with all
their lines. Branches that only an exception takes are not counted, nor those of lines without code, such as a closing brace, where the
compiler destroys objects after an exception (gcovr's --exclude-throw-branches and --exclude-unreachable-branches).
--missing: also lists the lines with branches that were not executed.
"""
import argparse
import collections
import concurrent.futures
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile


def read_notes(notes: pathlib.Path) -> list:
    """gcov's report of one translation unit: its files with lines and branches."""
    with tempfile.TemporaryDirectory() as scratch:
        # Without counters gcov reads the notes alone: nothing was executed.
        result = subprocess.run(["gcov", "--json-format", "--stdout", "--branch-probabilities", str(notes)], cwd=scratch,
                                capture_output=True, check=False)
    files = []
    for line in result.stdout.splitlines():
        if line.startswith(b"{"):
            files += json.loads(line)["files"]
    return files


def has_code(text: str) -> bool:
    """Whether a line has more than braces, parentheses and semicolons."""
    return re.sub(r"//.*", "", text).strip(" (){};") != ""


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--missing", action="store_true")
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("folders", nargs="*", default=[""])
    options = parser.parse_args()
    source = pathlib.Path(__file__).resolve().parent.parent / "src"
    options.build = options.build.resolve()
    notes = sorted(options.build.rglob("*.gcno"))
    if not notes:
        print(f"{options.build} has no counters: build it with the preset `coverage`")
        return 1

    # By file: whether each line was executed; by line and number of the branch: whether it was.
    lines, branches, texts = collections.defaultdict(dict), collections.defaultdict(dict), {}
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for files in pool.map(read_notes, notes):
            for file in files:
                path = pathlib.Path(os.path.normpath(options.build / file["file"]))
                if not path.is_relative_to(source):
                    continue
                name = path.relative_to(source).as_posix()
                if name not in texts:
                    texts[name] = path.read_text(encoding="utf-8").split("\n")
                for line in file["lines"]:
                    number = line["line_number"]
                    lines[name][number] = lines[name].get(number, False) or line["count"] > 0
                    if not has_code(texts[name][number - 1]):
                        continue
                    taken = [branch for branch in line["branches"] if not branch["throw"]]
                    for i, branch in enumerate(taken):
                        key = (number, i)
                        branches[name][key] = branches[name].get(key, False) or branch["count"] > 0

    def row(title: str, names: list) -> None:
        ran = sum(sum(lines[name].values()) for name in names)
        count = sum(len(lines[name]) for name in names)
        taken = sum(sum(branches[name].values()) for name in names)
        there = sum(len(branches[name]) for name in names)
        print(f"{title:36} {ran:7} of {count:7} lines {100 * ran / max(count, 1):5.1f} %   "
              f"{taken:7} of {there:7} branches {100 * taken / max(there, 1):5.1f} %")

    def print_missing(name: str) -> None:
        missing = collections.Counter(number for (number, _), ran in branches[name].items() if not ran)
        for number, count in sorted(missing.items()):
            print(f"{name}:{number}: {count} did not run: {texts[name][number - 1].strip()}")

    for wanted in options.folders:
        names = [name for name in lines if name.startswith(wanted)]
        by_folder = collections.defaultdict(list)
        for name in names:
            by_folder[name.rsplit("/", 1)[0]].append(name)
            if options.missing:
                print_missing(name)
        for folder in sorted(by_folder):
            row(folder, by_folder[folder])
        row(f"src/{wanted}", names)
    return 0


if __name__ == "__main__":
    sys.exit(main())
