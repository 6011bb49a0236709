#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`embody bench simbenchmark`, `scaling`, `tanks` and `decomposition` as a person or a program calls them.

Usage: test_suites.py EMBODY
"""
import json
import math
import subprocess
import sys
import tempfile
import unittest

EMBODY = ""


def bench(*words: str) -> subprocess.CompletedProcess:
    return subprocess.run([EMBODY, "bench", *words], capture_output=True, text=True, timeout=120)


class Suites(unittest.TestCase):
    def test_wrong_words_are_named(self):
        for suite in ("simbenchmark", "scaling", "tanks"):
            result = bench(suite, "--scene", "no_such_scene")
            self.assertEqual(result.returncode, 1)
            self.assertIn("no_such_scene", result.stderr)
        for words in (("scaling", "--bodies", "999"), ("scaling", "--bodies", "many"), ("no_such_suite",)):
            result = bench(*words)
            self.assertEqual(result.returncode, 2, words)
            self.assertIn(words[-1], result.stderr)

    def test_simbenchmark_stands_beside_the_published_figures(self):
        result = bench("simbenchmark", "--scene", "bouncing", "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        answer = json.loads(result.stdout)
        self.assertEqual([row["time_step"] for row in answer["scenes"]], [0.01, 0.001])
        for row, published in zip(answer["scenes"], (185.953, 0.0186204), strict=True):
            self.assertEqual(row["published"], {"error": published, "engine": "RaiSim"})
            self.assertTrue(math.isfinite(row["error"]))
            self.assertAlmostEqual(row["over_published"], row["error"] / published)
            self.assertEqual(row["verdict"], "better" if row["error"] <= published else "worse")
            self.assertAlmostEqual(row["steps"] * row["time_step"], 20)

    def test_scaling_prints_a_row_a_size(self):
        result = bench("scaling", "--scene", "columns_asleep", "--bodies", "1000")
        self.assertEqual(result.returncode, 0, result.stderr)
        (row,) = [line.split() for line in result.stdout.splitlines() if line.startswith("columns_asleep")]
        self.assertEqual((row[1], row[2], row[-1]), ("1000", "0", "right"))

    def test_tanks_lose_energy_and_no_water(self):
        result = bench("tanks", "--scene", "slosh", "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        (tank,) = json.loads(result.stdout)["tanks"]
        self.assertEqual((tank["tank"], tank["end_state"], tank["lost"]), ("slosh", "right", 0))
        times, energies = [moment[0] for moment in tank["moments"]], [moment[1] for moment in tank["moments"]]
        self.assertEqual(len(times), 241)
        self.assertAlmostEqual(times[-1], 60)
        self.assertLess(energies[-1], 0.1 * energies[0])

    def test_decomposition_measures_a_model_of_the_database(self):
        with tempfile.TemporaryDirectory() as folder:
            database = ("decomposition", "--database", folder + "/models.sqlite", "--json")
            empty = bench(*database)
            self.assertEqual(empty.returncode, 1)
            self.assertIn("embody import", empty.stderr)
            self.assertEqual(bench(*database, "--scene", "no_such_model").returncode, 1)
            result = bench(*database, "--scene", "primitive:box")
            self.assertEqual(result.returncode, 0, result.stderr)
            (row,) = json.loads(result.stdout)["models"]
            self.assertEqual(row["hulls"], 1)
            self.assertLess(row["added_m"], 1e-3)
            self.assertLess(row["left_out_m"], 1e-3)


if __name__ == "__main__":
    EMBODY = sys.argv.pop(1)
    unittest.main()
