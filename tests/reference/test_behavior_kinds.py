# SPDX-License-Identifier: MIT
"""behavior_kinds.py on a small table: which rows it keeps, their words and kinds."""

import csv
import pathlib
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).parent
TABLE = """synset,prune,is_custom,objectType
chair.n.01,0,0,rigidBody
towel.n.01,1,0,cloth
gravel.n.01,0,0,macroPhysicalSubstance
dust.n.01,0,0,visualSubstance
water__glass.n.01,0,1,rigidBody
chair.n.99,0,0,rigidBody
"""


class BehaviorKinds(unittest.TestCase):
    def test_keeps_what_can_be_compared(self):
        with tempfile.TemporaryDirectory() as folder:
            synsets, out = pathlib.Path(folder) / "synsets.csv", pathlib.Path(folder) / "kinds.csv"
            synsets.write_text(TABLE, encoding="utf-8")
            run = subprocess.run(
                [sys.executable, HERE / "behavior_kinds.py", synsets, out], capture_output=True, text=True, check=True
            )
            with open(out, encoding="utf-8", newline="") as file:
                rows = {row["synset"]: row for row in csv.DictReader(file)}
        self.assertEqual(sorted(rows), ["chair.n.01", "gravel.n.01", "towel.n.01"])
        self.assertEqual(rows["chair.n.01"]["words"], "chair")
        self.assertEqual(rows["chair.n.01"]["kinds"], "static;rigid;articulated")
        self.assertEqual(rows["gravel.n.01"]["kinds"], "granular")
        self.assertEqual((rows["towel.n.01"]["kinds"], rows["towel.n.01"]["pruned"]), ("cloth", "1"))
        self.assertIn("1 left out: a synset of BEHAVIOR's own", run.stdout)
        self.assertIn("1 left out: no noun of WordNet 3.0", run.stdout)
        self.assertIn("1 left out: type visualSubstance", run.stdout)


if __name__ == "__main__":
    unittest.main()
