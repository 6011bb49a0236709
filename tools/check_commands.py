#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Fails where a command of a session is not in docs/protocol.md, or where that file or the Studio's types name a command that does not exist.

Commands are the rows {"family.verb", function, need} in src/scene/session/commands and src/server.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROTOCOL = "docs/protocol.md"
MESSAGES = "studio/src/connection/messages.ts"
NAME = r"(hello|[a-z]+\.[a-z_]+)"


def main() -> int:
    known = set()
    for folder in ("src/scene/session/commands", "src/server"):
        for file in sorted((ROOT / folder).rglob("*.cpp")):
            known.update(re.findall(rf'\{{"{NAME}",\s*&?\w+(?:,\s*Need::\w+)?\}}', file.read_text()))
            known.update(re.findall(rf'command == "{NAME}"', file.read_text()))
    text = (ROOT / PROTOCOL).read_text()
    rows = [line.split("|")[1] for line in text.splitlines() if line.startswith("| `")]
    described = {name for row in rows for name in re.findall(rf"`{NAME}`", row)}
    typed = set(re.findall(rf'^  "?{NAME}"?: \[', (ROOT / MESSAGES).read_text(), re.MULTILINE))
    problems = [f"{PROTOCOL}: has no row for the command `{name}`" for name in sorted(known - described)]
    problems += [f"{PROTOCOL}: there is no command `{name}`" for name in sorted(described - known)]
    problems += [f"{MESSAGES}: there is no command {name}" for name in sorted(typed - known)]
    for problem in problems:
        print(problem)
    print(f"{len(known)} commands, of which the Studio sends {len(typed)}; {len(problems)} problems")
    return 1 if problems or not known else 0


if __name__ == "__main__":
    sys.exit(main())
