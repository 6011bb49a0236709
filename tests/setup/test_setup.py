#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""How ./run and ./test call CMake: ./run leaves the tests out, ./test includes them, and nothing is built twice;
and with which words ./run starts the server.

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


# A stand-in for the program, which notes its words and what the list says that it is given.
PROGRAM_STAND_IN = """#!/bin/bash
printf '%s\\n' "$@" >"$CALLS"
while [ $# -gt 0 ]; do
    if [ "$1" = --fill-list ]; then cat "$2" >"$CALLS.list"; fi
    shift
done
"""


class HowTheStudioIsServed(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.calls = self.folder / "calls"
        self.data = self.folder / "data"
        self.data.mkdir()
        (self.folder / "build").mkdir()
        self.stand_in("embody", PROGRAM_STAND_IN)

    def stand_in(self, name, text):
        (self.folder / name).write_text(text)
        (self.folder / name).chmod(0o755)

    def serve(self, *words):
        """The program's words after serve_studio, and the lines of its list."""
        (self.folder / "calls.list").write_text("")
        environment = os.environ | {"PATH": f"{self.folder}:{os.environ['PATH']}", "CALLS": str(self.calls)}
        ended = subprocess.run(["bash", "-u", "-c", 'root=$1; . "$2"; shift 2; serve_studio "$@"', "bash", str(self.folder),
                                str(ROOT / "tools" / "setup.sh"), str(self.folder / "embody"), str(self.data), *words],
                               env=environment, capture_output=True, text=True, timeout=60)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        return self.calls.read_text().split(), (self.folder / "calls.list").read_text().splitlines()

    def test_the_first_start_gives_the_server_the_list_of_catalogues(self):
        self.stand_in("apt-get", "#!/bin/sh\nexit 1\n")
        words, lines = self.serve("serve", "--open")
        self.assertEqual(words[:3], ["serve", "--open", "--fill-list"])
        self.assertEqual(words[4:], ["--fill-mark", str(self.data / "catalogues-imported")])
        if not pathlib.Path("/usr/share/sweethome3d/sweethome3d.jar").exists():
            self.assertTrue(lines[-1].startswith("# ") and "tries again" in lines[-1], lines)
        self.assertTrue(all(line.endswith(".sh3f") for line in lines[:-1]), lines)

    def test_what_is_downloaded_is_on_the_list(self):
        jar = "usr/share/sweethome3d/sweethome3d.jar"
        self.stand_in("apt-get", "#!/bin/sh\ntouch sweethome3d_1.deb\n")
        self.stand_in("dpkg-deb", f'#!/bin/sh\nmkdir -p "$3/{os.path.dirname(jar)}"\ntouch "$3/{jar}"\n')
        _, lines = self.serve("serve")
        self.assertTrue(lines[-1].endswith("/sweethome3d.jar"), lines)
        self.assertTrue(pathlib.Path(lines[-1]).exists())

    def test_later_starts_and_other_databases_fill_nothing(self):
        self.assertEqual(self.serve("serve", "--database", "mine.sqlite")[0], ["serve", "--database", "mine.sqlite"])
        (self.data / "catalogues-imported").touch()
        self.assertEqual(self.serve("serve", "--open")[0], ["serve", "--open"])


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
