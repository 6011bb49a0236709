#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Fails where a build used a header or library that ./run does not install on an empty Debian 12.

Usage: check_packages.py BUILD_FOLDER TARGET…

The files that Ninja records for the targets (inputs, headers of each object, link lines) must belong to packages that apt would install
for the groups `build` and `run` of packages.txt on an empty system. Packages with a `?command` do not count: they are not installed where
the command comes from elsewhere, and npm alone would install libssl-dev. Packages of the group `optional`, and those that they directly
depend on, may be used, too. Exit status 77: unknown on this machine (no dpkg or apt, or apt has no lists).
"""
import pathlib
import re
import shlex
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
EXIT_SKIPPED = 77


class CannotTell(Exception):
    """This machine cannot answer the question; packages.txt is not at fault."""


def output_of(*command: str) -> str:
    return subprocess.run(command, check=True, text=True, capture_output=True).stdout


def packages_of(*groups: str) -> list[str]:
    """Names below the [group] lines, without those that a `?command` may replace."""
    names, group = [], None
    for line in (ROOT / "packages.txt").read_text().splitlines():
        words = line.split("#", 1)[0].split()
        if words and words[0].startswith("["):
            group = words[0].strip("[]")
        elif len(words) == 1 and group in groups:
            names.append(words[0])
    return names


def closure(packages: list[str]) -> set[str]:
    """The packages that apt would install for these if nothing were installed."""
    try:
        plan = subprocess.run(["apt-get", "install", "--dry-run", "--no-install-recommends", "--option", "Dir::State::status=/dev/null",
                               *packages], text=True, capture_output=True)
    except FileNotFoundError as error:
        raise CannotTell("apt-get is not here") from error
    if plan.returncode != 0:
        if not output_of("apt-cache", "search", "--names-only", "^libc6-dev$"):
            raise CannotTell("apt has no lists of packages; fetch them: apt-get update")
        raise SystemExit(f"apt cannot install the groups build and run on an empty system:\n{plan.stdout}{plan.stderr}")
    return set(re.findall(r"^Inst (\S+)", plan.stdout, re.MULTILINE))


def optional_packages() -> set[str]:
    """The installed packages of the group `optional`, and those that they directly depend on."""
    allowed = set()
    for name in packages_of("optional"):
        status = subprocess.run(["dpkg-query", "--show", "--showformat=${Depends}", name], text=True, capture_output=True)
        if status.returncode == 0:
            allowed |= {name} | set(re.findall(r"(?:^|[,|])\s*([a-z0-9][a-z0-9+.-]*)", status.stdout))
    return allowed


def linked_by_name(build: pathlib.Path, targets: list[str]) -> dict[pathlib.Path, str]:
    """The files of -lNAME in the link lines, with the program that each is linked to."""
    found = {}
    for line in output_of("ninja", "-C", str(build), "-t", "commands", *targets).splitlines():
        if " -l" not in line:
            continue
        words = shlex.split(line)
        compiler = next((word for word in words if pathlib.Path(word).name in ("c++", "g++", "clang++")), "c++")
        program = words[words.index("-o") + 1]
        for name in {word[2:] for word in words if word.startswith("-l")}:
            for file in (f"lib{name}.so", f"lib{name}.a"):
                path = output_of(compiler, f"-print-file-name={file}").strip()
                if path.startswith("/"):
                    found[pathlib.Path(path)] = program
                    break
            else:
                raise SystemExit(f"{program}: the compiler does not find the library of -l{name}")
    return found


def used_files(build: pathlib.Path, targets: list[str]) -> dict[pathlib.Path, str]:
    """Every file outside the project that the targets were made from, with one object or program that used it."""
    inputs = output_of("ninja", "-C", str(build), "-t", "inputs", *targets).splitlines()
    used = {pathlib.Path(name): " ".join(targets) for name in inputs if name.startswith("/")}
    used |= linked_by_name(build, targets)
    objects = {name for name in inputs if name.endswith(".o")}
    noted, current = set(), ""
    for line in output_of("ninja", "-C", str(build), "-t", "deps").splitlines():
        if line and not line.startswith(" "):
            current = line.split(": #deps", 1)[0]
            noted.add(current)
        elif line and current in objects and line.strip().startswith("/"):
            used.setdefault(pathlib.Path(line.strip()), current)
    if objects - noted:
        raise SystemExit(f"{len(objects - noted)} objects were not built, as {sorted(objects - noted)[0]}: build {' '.join(targets)} first")
    return {path: user for path, user in used.items() if not path.is_relative_to(ROOT) and not path.is_relative_to(build)}


def owners_by_name(names: list[str]) -> dict[str, set[str]]:
    """The packages of the files that dpkg knows by these names."""
    found = {}
    try:
        # dpkg-query ends with 1 where it does not know one of the names.
        answer = subprocess.run(["dpkg-query", "--search", *names], text=True, capture_output=True).stdout
    except FileNotFoundError as error:
        raise CannotTell("dpkg is not here") from error
    for line in answer.splitlines():
        if not line.startswith("diversion "):
            packages, name = line.split(": ", 1)
            found.setdefault(name, set()).update(package.split(":")[0] for package in packages.split(", "))
    return found


def other_names(path: pathlib.Path) -> set[str]:
    """Names under which dpkg may know a file: with its links resolved, and without /usr, into which Debian 12 has merged /lib."""
    names = {str(path), str(path.parent.resolve() / path.name), str(path.resolve())}
    return names | {name.removeprefix("/usr") for name in names}


def owners(paths: list[pathlib.Path]) -> dict[pathlib.Path, set[str]]:
    """The packages of each file; empty where it belongs to no package."""
    by_name = owners_by_name([str(path) for path in paths])
    unknown = [path for path in paths if str(path) not in by_name]
    if unknown:
        by_name |= owners_by_name(sorted(set().union(*map(other_names, unknown))))
    return {path: set().union(*(by_name.get(name, set()) for name in {str(path)} | other_names(path))) for path in paths}


def main() -> int:
    if len(sys.argv) < 3:
        print(__doc__)
        return 2
    build, targets = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2:]
    used = used_files(build, targets)
    owned = owners(list(used))
    installed, optional = closure(packages_of("build", "run")), optional_packages()
    wrong = []
    for path, user in sorted(used.items()):
        packages = owned[path]
        if not packages:
            wrong.append(f"{path} belongs to no Debian package ({user}): use Debian's, or find it only where it is asked for")
        elif not packages & (installed | optional):
            wrong.append(f"{path} is of {', '.join(sorted(packages))} ({user}), which ./run does not install: "
                         "name it in the group build of packages.txt")
    for line in wrong:
        print(line)
    print(f"{len(used)} headers and libraries, {len(installed)} packages that ./run installs, {len(wrong)} wrong")
    if not used:
        print("nothing was checked: is this the right build folder?")
    return 1 if wrong or not used else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except CannotTell as reason:
        print(f"skipped: {reason}")
        sys.exit(EXIT_SKIPPED)
