#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Counts the headers of src/physics that a file of tests/ includes directly, by folder, and lists the others.

Usage: check_tested_headers.py [--least PERCENT] [--quiet] [ROOT]   (default: the folder above this file)
Fails where the fraction of included headers is below PERCENT. A folder's namespace.h declares nothing and is not counted. That a test
includes a header does not show that it is tested well; a header that no test includes is tested only through others.
"""
import argparse
import collections
import pathlib
import re
import sys

INCLUDE = re.compile(r'^\s*#include\s+"([^"]+)"', re.M)


def included(folder: pathlib.Path) -> set:
    """The headers that the C++ files below the folder include."""
    found = set()
    for path in folder.rglob("*"):
        if path.suffix in (".h", ".cpp"):
            found.update(INCLUDE.findall(path.read_text()))
    return found


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--least", type=float, default=0, help="percent of the headers that tests have to include")
    parser.add_argument("--quiet", action="store_true", help="do not list the headers that no test includes")
    parser.add_argument("root", nargs="?", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent.parent)
    options = parser.parse_args()

    by_tests = included(options.root / "tests")
    all_of, tested_of, missing = collections.Counter(), collections.Counter(), []
    for path in sorted((options.root / "src" / "physics").rglob("*.h")):
        if path.name == "namespace.h":
            continue
        header = path.relative_to(options.root / "src").as_posix()
        room = header.split("/")[1]
        all_of[room] += 1
        if header in by_tests:
            tested_of[room] += 1
        else:
            missing.append(header)
    if not all_of:
        print("nothing was found: is this the right folder?")
        return 1
    if not options.quiet:
        for header in missing:
            print(f"no test includes {header}")
    for room in sorted(all_of):
        print(f"{room:13} {tested_of[room]:3} of {all_of[room]:3} headers  {100 * tested_of[room] / all_of[room]:3.0f} %")
    share = 100 * tested_of.total() / all_of.total()
    print(f"{'physics':13} {tested_of.total():3} of {all_of.total():3} headers  {share:3.0f} %")
    if share < options.least:
        print(f"below the {options.least:g} % that are asked for")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
