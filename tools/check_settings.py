#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks the comments of the constants of the physics.

Usage: check_settings.py [--list] [ROOT]   (default: the folder above this file)
- Each setting of src/physics/definitions/settings has a comment with "Source: ...", "Bench: scene",
  "Test: Suite.Name, Suite.Name", of which each exists. WorldSettings, which users set, are not checked.
  Each is reached from SolverSettings.
- Each other named numerical constant in src/physics has a comment that says what it bounds: on its line, on the line
  where its declaration ends, or on the line above it or above the constants before it. Sentinels and tags need none.
--list prints the path of each setting and its source.
"""
import argparse
import pathlib
import re
import sys

MEMBER = re.compile(r"^    (?:bool|float|double|int|std::u?int\d+_t|std::size_t) (\w+) = [^;]*;", re.M)
GROUP = re.compile(r"^    (\w+Settings) (\w+);", re.M)
STRUCT = re.compile(r"^struct (\w+) \{", re.M)
TEST = re.compile(r"^TEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\s*\)", re.M)
NAMED = re.compile(r"\b(\w+\.\w+)\b")
SELF_EXPLAINING = re.compile(r"constexpr \S+ (?:pi|none|never|lanes|width|no_\w+|\w+_tag) =|= 0x[0-9A-F]+|= [a-zA-Z_:<>() ]+;")
CONSTANT = re.compile(r"^\s*(?:inline |static )*constexpr (?:float|double|int|std::u?int\d+_t|std::size_t)\s+\w+\s*=")


def comment_above(lines: list, at: int) -> str:
    """The comment block that ends above line `at`."""
    above = []
    while at > 0 and lines[at - 1].lstrip().startswith("//"):
        at -= 1
        above.insert(0, lines[at].lstrip().lstrip("/").strip())
    return " ".join(above)


def check_settings(path: pathlib.Path, tests: set, wrong: list, settings: list):
    lines = path.read_text().splitlines()
    struct = ""
    for at, line in enumerate(lines):
        begins = STRUCT.match(line)
        struct = begins[1] if begins else struct
        member = MEMBER.match(line)
        if not member:
            continue
        comment = comment_above(lines, at)
        where = f"{path.name}:{at + 1}: {member[1]}"
        origin = re.search(r"\b(Source|Test|Bench): (.+)", comment)
        if not origin:
            wrong.append(f"{where} has no source: write Source:, Test: or Bench: into the comment above it")
            continue
        settings.append((struct, member[1], comment[origin.start():]))
        for named in re.findall(r"Tests?: ((?:\w+\.\w+(?:, )?)+)", comment):
            for test in NAMED.findall(named):
                if test not in tests:
                    wrong.append(f"{where} names the test {test}, which does not exist")


def paths_of_structs(folder: pathlib.Path) -> dict:
    """Where each struct of settings is within SolverSettings: `constraint.joint.`."""
    members = {}
    for path in folder.glob("*_settings.h"):
        struct = ""
        for line in path.read_text().splitlines():
            begins, group = STRUCT.match(line), GROUP.match(line)
            struct = begins[1] if begins else struct
            if group:
                members.setdefault(struct, []).append(group.groups())
    paths, todo = {}, [("SolverSettings", "")]
    while todo:
        struct, path = todo.pop()
        paths[struct] = path
        todo += [(inner, f"{path}{name}.") for inner, name in members.get(struct, [])]
    return paths


def check_constants(path: pathlib.Path, name: str, wrong: list):
    lines = path.read_text().splitlines()
    explained = False  # whether the constant right above has a comment of its own or is covered by an earlier one
    for at, line in enumerate(lines):
        if not CONSTANT.match(line):
            explained = False
            continue
        end = at
        while ";" not in lines[end] and end + 1 < len(lines):
            end += 1
        on_line = any("//" in each for each in lines[at:end + 1])
        explained = explained or on_line or SELF_EXPLAINING.search(line) or (at > 0 and lines[at - 1].lstrip().startswith("//"))
        if not explained:
            wrong.append(f"{name}:{at + 1}: a number without a comment: {line.strip()}")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--list", action="store_true", help="print the settings")
    parser.add_argument("root", nargs="?", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent.parent)
    options = parser.parse_args()

    tests = set()
    for path in (options.root / "tests").rglob("*.cpp"):
        tests |= {f"{suite}.{name}" for suite, name in TEST.findall(path.read_text())}
    physics = options.root / "src" / "physics"
    of_settings = [path for path in sorted((physics / "definitions" / "settings").glob("*_settings.h")) if path.stem != "solver_settings"]
    wrong, settings = [], []
    for path in of_settings:
        check_settings(path, tests, wrong, settings)
    for path in sorted(physics.rglob("*")):
        if path.suffix in (".h", ".cpp") and path not in of_settings:
            check_constants(path, path.relative_to(options.root).as_posix(), wrong)

    paths = paths_of_structs(physics / "definitions" / "settings")
    wrong += [f"{struct}: {name} is not reached from SolverSettings" for struct, name, _ in settings if struct not in paths]
    if options.list:
        for struct, name, origin in settings:
            print(f"{paths.get(struct, struct + ' ') + name:52} {origin}")
    for line in wrong:
        print(line)
    if not settings or not tests:
        print("nothing was found: is this the right folder?")
        return 1
    print(f"{len(settings)} settings, {len(wrong)} faults")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
