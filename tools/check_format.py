#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Fails where clang-format (with .clang-format) would change a C++ source.

Usage: check_format.py [CLANG_FORMAT]
"""
import pathlib
import subprocess
import sys


def main() -> int:
    clang_format = sys.argv[1] if len(sys.argv) > 1 else "clang-format"
    root = pathlib.Path(__file__).resolve().parent.parent
    files = sorted(p for folder in ("src", "scenes", "tests", "benches")
                   for p in (root / folder).rglob("*") if p.suffix in (".h", ".cpp"))
    if not files:
        print("no sources found")
        return 1
    result = subprocess.run([clang_format, "--dry-run", "--Werror", *map(str, files)], stderr=subprocess.PIPE, text=True)
    wrong = sorted({line.split(":", 1)[0] for line in result.stderr.splitlines() if "[-Wclang-format-violations]" in line})
    for path in wrong:
        print(f"{pathlib.Path(path).relative_to(root)}: not formatted; run {clang_format} -i on it")
    print(f"{len(files)} files, {len(wrong)} not formatted")
    return result.returncode


if __name__ == "__main__":
    sys.exit(main())
