#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Shows that the tests which the comments of solver settings name fail with other values.

Usage: try_settings.py [--build FOLDER] [--tests FILTER] [PREFIX ...]   (default: build/release, the tests that each names)
For each setting whose path starts with a PREFIX (`collision`, `constraint.joint`, ...): runs the tests that its comment
names with ten times the value, then with a tenth, each within its range, and prints which fail. Lists at the end the
settings whose tests detect neither. --tests runs these tests (a googletest filter) for all settings instead, to find
some that do. It takes minutes, so it is not one of the tests.
"""
import argparse
import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent


def named_tests() -> dict:
    """The tests that the comment of each setting names, by the setting's path."""
    listed = subprocess.run([sys.executable, ROOT / "tools" / "check_settings.py", "--list"], capture_output=True, text=True)
    found = {}
    for line in listed.stdout.splitlines():
        parts = re.match(r"([a-z_0-9.]+)\s+\w+: (.*)", line)
        if parts:
            tests = re.findall(r"\b([A-Z]\w+\.\w+)\b", parts[2])
            found[parts[1]] = {test for test in tests if test != "Settings.AreNoticed"}
    return found


def other_values(value: float, low: float, high: float, is_integer: bool) -> list:
    """Ten times and a tenth of the value, within the range."""
    values = []
    for wanted in (10 * value, value / 10):
        other = min(max(wanted, low), high)
        if is_integer:
            other = int(other) if int(other) != value else int(min(value + 1, high))
        if other != value:
            values.append(other)
    return values


def failures(build: pathlib.Path, path: str, value: float, tests: str) -> list:
    """The tests that fail with the value, of all programs that step worlds."""
    failed = []
    environment = dict(os.environ, EMBODY_SETTING=f"{path}={value!r}")
    for program in ("test_physics", "test_validation"):
        command = [build / "tests" / program, f"--gtest_filter={tests}", "--gtest_brief=1"]
        try:
            ended = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=300, check=False)
        except subprocess.TimeoutExpired:
            return failed + [f"{program} takes longer than five minutes"]
        if ended.returncode != 0:
            failed += re.findall(r"\[  FAILED  \] (\S+?),? ", ended.stdout)[:3] or [f"{program} ends with {ended.returncode}"]
    return sorted(set(failed))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build" / "release")
    parser.add_argument("--tests", help="a googletest filter")
    parser.add_argument("prefix", nargs="*")
    options = parser.parse_args()

    listing = subprocess.run([options.build / "tests" / "test_validation", "--gtest_filter=SettingLists.ArePrinted"],
                             capture_output=True, text=True, check=True)
    by_path, todo = named_tests(), []
    for path, *numbers in re.findall(r"^setting (\S+) (\S+) (\S+) (\S+) ([01])$", listing.stdout, re.M):
        tests = by_path.get(path, set())
        wanted = options.tests or ":".join(f"{test}:*/{test}/*" for test in sorted(tests))
        if wanted and (not options.prefix or any(path.startswith(prefix) for prefix in options.prefix)):
            value, low, high = map(float, numbers[:3])
            todo.append((path, other_values(value, low, high, numbers[3] == "1"), wanted))

    def try_one(path: str, values: list, tests: str) -> list:
        for value in values:
            failed = failures(options.build, path, value, tests)
            if failed:
                return [f"{value:g}", *failed]
        return []

    unnoticed = []
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for (path, *_), found in zip(todo, pool.map(lambda one: try_one(*one), todo)):
            print(f"{path:44} {' '.join(found) or 'nothing fails'}", flush=True)
            if not found:
                unnoticed.append(path)
    print(f"{len(todo)} settings tried, {len(unnoticed)} that no test notices: {' '.join(unnoticed)}")
    return 1 if unnoticed or not todo else 0


if __name__ == "__main__":
    sys.exit(main())
