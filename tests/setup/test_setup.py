#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""How ./run and ./test call CMake: ./run leaves the tests out, ./test includes them, and nothing is built twice.

Usage: test_setup.py CMAKE NINJA
"""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]

# A stand-in for cmake that records the tests' option and writes the files of a configuration; it fails where FAIL is
# set.
CMAKE_STAND_IN = """#!/bin/bash
option=${!#}
echo "${option#-DEMBODY_TESTS=}" >>"$CALLS"
mkdir -p build/release
echo "EMBODY_TESTS:BOOL=${option#-DEMBODY_TESTS=}" >build/release/CMakeCache.txt
if [ -n "$FAIL" ]; then touch -d "+1 minute" build/release/CMakeCache.txt; exit 1; fi
touch -d "-1 minute" build/release/CMakeCache.txt
touch build/release/build.ninja
"""


class WhenCMakeIsCalled(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        (self.folder / "cmake").write_text(CMAKE_STAND_IN)
        (self.folder / "cmake").chmod(0o755)
        self.calls = self.folder / "calls"

    def configure(self, *arguments, fail=False):
        """The tests' option in each call of cmake that one configure_program makes."""
        self.calls.write_text("")
        environment = os.environ | {"PATH": f"{self.folder}:{os.environ['PATH']}", "CALLS": str(self.calls), "FAIL": "1" if fail else ""}
        ended = subprocess.run(["bash", "-u", "-c", 'root=$1; . "$2"; shift 2; configure_program release "$@"', "bash", str(self.folder),
                                str(ROOT / "tools" / "setup.sh"), *arguments], env=environment, capture_output=True)
        self.assertEqual(ended.returncode, 1 if fail else 0, ended.stderr)
        return self.calls.read_text().split()

    def test_run_leaves_the_tests_out_once(self):
        self.assertEqual(self.configure(), ["OFF"])
        self.assertEqual(self.configure(), [])

    def test_test_adds_the_tests_and_run_keeps_them(self):
        self.configure()
        self.assertEqual(self.configure("with-tests"), ["ON"])
        self.assertEqual(self.configure("with-tests"), [])
        self.assertEqual(self.configure(), [])

    def test_run_works_after_tests_could_not_be_added(self):
        self.configure()
        self.configure("with-tests", fail=True)
        self.assertEqual(self.configure(), ["OFF"])

    def test_a_failed_configuration_is_tried_again(self):
        self.configure("with-tests", fail=True)
        self.assertEqual(self.configure("with-tests"), ["ON"])


class WhatIsBuilt(unittest.TestCase):
    def test_the_programs_are_built_alike_with_and_without_tests(self):
        folder = self.enterContext(tempfile.TemporaryDirectory())
        commands = {}
        for tests in ("OFF", "ON"):
            subprocess.run([cmake, "--preset", "release", "-B", folder, f"-DEMBODY_TESTS={tests}"], cwd=ROOT, check=True,
                           capture_output=True)
            commands[tests] = subprocess.run([ninja, "-C", folder, "-t", "commands", "embody", "embody-import-worker"], check=True,
                                             capture_output=True, text=True).stdout.splitlines()
        self.assertGreater(len(commands["OFF"]), 100)
        self.assertEqual(commands["OFF"], commands["ON"])


if __name__ == "__main__":
    cmake, ninja = sys.argv[1:3]
    unittest.main(argv=sys.argv[:1])
