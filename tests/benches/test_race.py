#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`embody bench race` as a person or a program calls it. Checks no times: the bench itself measures these.

Usage: test_race.py EMBODY
"""
import json
import math
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

EMBODY = ""


def race(*words: str, program: str = "") -> subprocess.CompletedProcess:
    return subprocess.run([program or EMBODY, "bench", "race", *words], capture_output=True, text=True, timeout=120)


class Race(unittest.TestCase):
    def test_wrong_words_are_named(self):
        for words in (("--scene", "no_such_scene"), ("--peer", "no_such_engine"), ("--threads", "0"), ("--steps", "-1"),
                      ("--repeats", "many"), ("--no-such-option",), ("a_word",)):
            result = race(*words)
            self.assertEqual(result.returncode, 2, (words, result.stderr))
            self.assertIn(words[-1], result.stderr)
            self.assertEqual(result.stdout, "")

    def test_says_so_where_it_was_not_built(self):
        with tempfile.TemporaryDirectory() as folder:
            alone = pathlib.Path(folder) / "embody"
            shutil.copy(EMBODY, alone)
            result = race("--steps", "1", program=str(alone))
            self.assertEqual(result.returncode, 1)
            self.assertIn("was not built", result.stderr)

    def test_help_has_an_example(self):
        result = race("--help")
        self.assertEqual(result.returncode, 0)
        self.assertIn("Example:\n  embody bench race", result.stdout)

    def test_every_engine_answers_with_finite_numbers(self):
        result = race("--scene", "tall_stack", "--steps", "5", "--repeats", "1", "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        answer = json.loads(result.stdout)
        self.assertEqual((answer["suite"], answer["clock"], answer["sleep"]), ("race", "cpu", False))
        (scene,) = answer["scenes"]
        self.assertEqual((scene["scene"], scene["bodies"], scene["steps"]), ("tall_stack", 30, 5))
        engines = scene["engines"]
        self.assertEqual(engines[0]["engine"], "embody")
        self.assertGreater(len(engines), 1)
        for engine in engines:
            end = engine["end"]
            self.assertEqual(end["state"], "right", engine)
            self.assertTrue(math.isfinite(end["kinetic_energy"]), engine)
            # 30 cubes of a tonne, centres from 0.5 to 29.5 m; the column has sunk by less than half a cube in 5 steps.
            self.assertAlmostEqual(end["potential_energy"], 1000 * 9.81 * 450, delta=1000 * 9.81 * 30 * 0.5)
            self.assertLess(abs(end["top_gap"]), 0.5, engine)
            self.assertLessEqual(engine["p50_ms"], engine["p99_ms"])
            self.assertLessEqual(engine["p99_ms"], engine["max_ms"])
        for peer in engines[1:]:
            self.assertAlmostEqual(peer["embody_over_mean"], engines[0]["mean_ms"] / peer["mean_ms"])

    def test_the_same_answer_in_each_repeat(self):
        words = ("--scene", "table1_g", "--steps", "90", "--json")
        once, twice = (json.loads(race(*words, "--repeats", n).stdout) for n in ("1", "2"))
        for a, b in zip(once["scenes"][0]["engines"], twice["scenes"][0]["engines"], strict=True):
            self.assertEqual(a["end"], b["end"], a["engine"])

    def test_only_the_chosen_peer_runs_and_the_table_names_it(self):
        # Any peer that was found.
        names = [e["engine"] for e in json.loads(race("--scene", "mass_ratio_2", "--steps", "1", "--repeats", "1", "--json").stdout)["scenes"][0]["engines"]]
        result = race("--scene", "mass_ratio_2", "--peer", names[-1], "--steps", "2", "--repeats", "1", "--stages")
        self.assertEqual(result.returncode, 0, result.stderr)
        rows = [line.split()[0] for line in result.stdout.splitlines() if "overlap" in line]
        self.assertEqual(rows, ["embody", names[-1]])
        self.assertIn("stages of embody:", result.stdout)


if __name__ == "__main__":
    EMBODY = sys.argv.pop(1)
    unittest.main()
