#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Fails where two classes have the same name: the linker would merge them without an error (one definition rule).

Usage: check_names.py [ROOT]   (default: the folder above this file)
Checks all classes, structs, unions and enumerations at namespace scope below src/ that are not in an unnamed namespace. A nested type has
the outer one in its name.
"""
import pathlib
import re
import sys

TOKEN = re.compile(r"""//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])+'|\#[^\n]*(?:\\\n[^\n]*)*|\[\[.*?\]\]|\w+|::|[{};()<>=:,]""", re.S)
KINDS = {"class", "struct", "union", "enum"}


def without_template_and_alignment(head: list[str]) -> list[str]:
    """The declaration without "template <…>" and "alignas(…)", whose punctuation would hide that it declares a type."""
    kept, i = [], 0
    while i < len(head):
        opening, closing = ("<", ">") if head[i] == "template" else ("(", ")")
        if head[i] not in ("template", "alignas") or head[i + 1:i + 2] != [opening]:
            kept.append(head[i])
            i += 1
            continue
        depth, i = 1, i + 2
        while depth and i < len(head):
            depth += {opening: 1, closing: -1}.get(head[i], 0)
            i += 1
    return kept


def definitions(text: str):
    """Qualified names of the types that the text defines at namespace scope."""
    tokens = [t.group(0) for t in TOKEN.finditer(text) if t.group(0)[0] not in "#\"'" and t.group(0)[:2] not in ("//", "/*", 'R"', "[[")]
    scopes = []          # of each open brace: a namespace's name, "" for an unnamed one, None for any other brace
    start = 0            # start of the current declaration
    for i, token in enumerate(tokens):
        if token == ";":
            start = i + 1
        elif token == "}":
            if scopes:
                scopes.pop()
            start = i + 1
        elif token == "{":
            head = without_template_and_alignment(tokens[start:i])
            start = i + 1
            if "namespace" in head and "using" not in head:
                scopes.append("::".join(t for t in head[head.index("namespace") + 1:] if t not in ("::", "inline")))
                continue
            if None not in scopes and "" not in scopes and "(" not in head and "=" not in head:
                places = [k for k, t in enumerate(head) if t in KINDS]
                # "template <class T> struct X" defines X, "struct X::Y" a member of X; a specialisation is named by its arguments.
                rest = [t for t in head[places[-1] + 1:] if t != "final"] if places else []
                rest = rest[:rest.index(":")] if ":" in rest else rest      # without its base classes
                name = rest[:1]
                while len(rest) > len(name) + 1 and rest[len(name)] == "::":
                    name = rest[:len(name) + 2]
                if name and re.match(r"[A-Za-z_]", name[0]) and "<" not in rest:
                    yield "::".join([s for s in scopes if s] + [t for t in name if t != "::"])
            scopes.append(None)


def main() -> int:
    root = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent.parent
    found, wrong = {}, 0
    for path in sorted((root / "src").rglob("*")):
        if path.suffix not in (".h", ".cpp"):
            continue
        for name in definitions(path.read_text()):
            place = path.relative_to(root).as_posix()
            if found.setdefault(name, place) != place:
                print(f"{place}: {name} is defined in {found[name]}, too; rename one, or put it into an unnamed namespace")
                wrong += 1
    print(f"{len(found)} types, {wrong} of them twice")
    if not found:
        print("nothing was found: is this the right folder?")
    return 1 if wrong or not found else 0


if __name__ == "__main__":
    sys.exit(main())
