#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Fails where a file uses a name that none of its included headers declares.

Usage: check_includes.py [ROOT]   (default: the folder above this file)
Sources that are compiled together (cmake/unity.cmake) see the includes of the ones before them, so the compiler does not find the error.
The check covers types and functions that headers declare at namespace scope, where other files of the folder include these headers, and
the usual names of the standard library. It reads text, not C++: a reported line is wrong, but some errors are found only by the preset
`dev`, which compiles each file alone.
"""
import pathlib
import re
import sys

from check_names import TOKEN, definitions

STANDARD = {
    "vector": "vector", "string": "string", "string_view": "string_view string", "optional": "optional", "span": "span", "map": "map", "set": "set",
    "unordered_map": "unordered_map", "unordered_set": "unordered_set", "array": "array", "function": "functional", "variant": "variant",
    "unique_ptr": "memory", "shared_ptr": "memory", "make_unique": "memory", "make_shared": "memory", "deque": "deque", "tuple": "tuple",
    "filesystem": "filesystem", "chrono": "chrono", "thread": "thread", "mutex": "mutex", "atomic": "atomic", "numeric_limits": "limits",
    "condition_variable": "condition_variable", "ifstream": "fstream", "ofstream": "fstream", "ostringstream": "sstream",
    "istringstream": "sstream", "ranges": "algorithm ranges numeric span vector string string_view array map set", "clamp": "algorithm", "sort": "algorithm",
    "stable_sort": "algorithm", "lower_bound": "algorithm", "upper_bound": "algorithm", "any_of": "algorithm", "all_of": "algorithm",
    "none_of": "algorithm", "transform": "algorithm", "remove_if": "algorithm", "nth_element": "algorithm", "unique": "algorithm",
    "accumulate": "numeric", "iota": "numeric", "from_chars": "charconv", "to_chars": "charconv", "sqrt": "cmath", "abs": "cmath cstdlib",
    "isfinite": "cmath", "hypot": "cmath", "atan2": "cmath", "floor": "cmath", "ceil": "cmath", "numbers": "numbers", "bit_cast": "bit",
    "popcount": "bit", "countr_zero": "bit", "memcpy": "cstring", "memcmp": "cstring",
    "memset": "cstring", "strlen": "cstring", "mt19937": "random", "mt19937_64": "random"}
INCLUDE = re.compile(r'^\s*#\s*include\s+(["<])([^">]+)[">]', re.MULTILINE)
# A free function at namespace scope begins its line, or follows its attributes and type on it.
FUNCTION = re.compile(r"^(?!\s|return\b|using\b|#|//|namespace\b|struct\b|class\b|enum\b|template\b|typedef\b|public:|private:)[\w:<>,&*\[\] ]*?[\w>&*\]] [&*]?([a-z]\w*)\(", re.MULTILINE)
# A call, but not of a member or of a name with a namespace, and no declaration, which has a type before the name.
CALL = re.compile(r"(?:[;{}(,=!?+/|<-]|&&|\breturn|\belse)\s*\b([a-z]\w*)\(")


def main() -> int:
    root = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent.parent
    text, code, words = {}, {}, {}
    for folder, base in (("src", root / "src"), ("scenes", root), ("benches", root)):
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in (".h", ".cpp"):
                name = path.relative_to(base).as_posix()
                text[name] = path.read_text()
                # The text without comments and strings.
                code[name] = TOKEN.sub(lambda t: t.group(0) if t.group(0)[0] not in "\"'/#R" or t.group(0)[:2] not in ("//", "/*", 'R"')
                                       and t.group(0)[0] not in "\"'#" else " ", text[name])
                words[name] = set(re.findall(r"\w+", code[name]))
    included = {name: INCLUDE.findall(its) for name, its in text.items()}

    def closure(name, seen, standard):
        for kind, other in included[name]:
            if kind == "<":
                standard.add(other)
            elif other in included and other not in seen:
                seen.add(other)
                closure(other, seen, standard)

    declared = {}  # header files by the name that they declare
    for name, its in code.items():
        if name.endswith(".h"):
            for found in {n.split("::")[-1] for n in definitions(text[name])} | set(FUNCTION.findall(its)):
                declared.setdefault(found, set()).add(name)

    reached, standard_of, near = {}, {}, {}  # headers that a file includes, and those that any file of its folder includes
    for name in text:
        reached[name], standard_of[name] = {name}, set()
        closure(name, reached[name], standard_of[name])
        near.setdefault(name.rpartition("/")[0], set()).update(reached[name])

    wrong = checked = 0
    for name in sorted(text):
        seen, standard = reached[name], standard_of[name]
        known = set().union(*(words[other] for other in seen if other != name))
        # Names that the file declares itself, types or variables.
        own = set(re.findall(r"(?:struct|class|enum|auto|using|auto&|auto\*)\s+(\w+)", code[name])) | set(FUNCTION.findall(code[name]))
        named = set(re.findall(r"(?<![\w.>])([A-Z]\w*[a-z]\w*)\b", code[name])) | set(CALL.findall(code[name]))
        for found in sorted(named & declared.keys()):
            checked += 1
            if not declared[found] & seen and declared[found] <= near[name.rpartition("/")[0]] and found not in known | own:
                print(f'{name}: {found} is of "{min(declared[found])}", which it does not include')
                wrong += 1
        for found in sorted(set(re.findall(r"\bstd::(\w+)", code[name])) & STANDARD.keys()):
            checked += 1
            if not standard & set(STANDARD[found].split()):
                print(f"{name}: std::{found} is of <{STANDARD[found].split()[0]}>, which it does not include")
                wrong += 1
    print(f"{len(text)} files, {checked} names, {wrong} wrong")
    if checked == 0:
        print("nothing was checked: is this the right folder?")
    return 1 if wrong or not checked else 0


if __name__ == "__main__":
    sys.exit(main())
