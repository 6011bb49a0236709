#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Fails on an #include that docs/architecture.md does not allow.

Usage: check_layers.py [ROOT]   (default: the folder above this file)
"""
import pathlib
import re
import sys

ALWAYS = {"foundation", "math"}
HEAVY = ("boost/", "assimp/", "embree", "sqlite3.h", "CLI/", "nlohmann/json.hpp")


def read_table(architecture: pathlib.Path) -> dict[str, set[str]]:
    """Rows `| `layer` | `a`, `b` |` of the section "Who may include whom"."""
    section = architecture.read_text().split("## Who may include whom", 1)[1].split("\n## ", 1)[0]
    table = {}
    for line in section.splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        names = [re.findall(r"`([^`]+)`", cell) for cell in cells]
        if line.startswith("|") and names[0] and not names[0][0].endswith(".h"):
            table[names[0][0]] = set(names[1]) if len(names) > 1 else set()
    return table


def read_few(architecture: pathlib.Path) -> dict[str, set[str]]:
    """Rows `| `file` | only `layer`, `file` |` of the same section: headers that only some of their layer's readers may include."""
    section = architecture.read_text().split("## Who may include whom", 1)[1].split("\n## ", 1)[0]
    rows = re.findall(r"^\| `([^`]+\.h)` \| only (.*) \|$", section, re.MULTILINE)
    return {header: set(re.findall(r"`([^`]+)`", readers)) for header, readers in rows}


def layer_of(path: str, layers: list[str]) -> str | None:
    """The most specific layer that holds the path (relative to src/, or scenes/…, benches/…)."""
    best = [layer for layer in layers if path.startswith(layer + "/")]
    return max(best, key=len) if best else None


def main() -> int:
    root = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent.parent
    table = read_table(root / "docs" / "architecture.md")
    few = read_few(root / "docs" / "architecture.md")
    layers = list(table)
    wrong, checked = [], 0
    files = [(p, p.relative_to(root / "src").as_posix()) for p in (root / "src").rglob("*") if p.suffix in (".h", ".cpp")]
    files += [(p, p.relative_to(root).as_posix()) for folder in ("scenes", "benches")
              for p in (root / folder).rglob("*") if p.suffix in (".h", ".cpp")]
    for path, name in sorted(files):
        own = layer_of(name, layers)
        if own is None:
            wrong.append(f"{name}: belongs to no layer of docs/architecture.md")
            continue
        allowed = table[own] | {own} | (ALWAYS if own != "foundation" else set()) | {"foundation"}
        if own == "math":
            allowed = {"math", "foundation"}
        for number, line in enumerate(path.read_text().splitlines(), 1):
            match = re.match(r'\s*#\s*include\s+(["<])([^">]+)[">]', line)
            if not match:
                continue
            included = match.group(2)
            if path.suffix == ".h" and included.startswith(HEAVY):
                wrong.append(f"{name}:{number}: a header includes the heavy library {included}")
            if match.group(1) == "<":
                continue
            checked += 1
            other = layer_of(included, layers)
            if other is None:
                wrong.append(f'{name}:{number}: "{included}" is in no layer (include by the path below src/)')
            elif other not in allowed:
                wrong.append(f"{name}:{number}: {own} must not include {other} ({included})")
            elif included in few and not {own, name} & few[included]:
                wrong.append(f"{name}:{number}: {included} is for {', '.join(sorted(few[included]))} only")
    for line in wrong:
        print(line)
    print(f"{len(files)} files, {checked} includes, {len(wrong)} wrong")
    if checked == 0:
        print("nothing was checked: is this the right folder?")
        return 1
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
