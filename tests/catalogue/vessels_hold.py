#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Real vessels that stand fast hold water as they are: tubs, basins, bowls, glasses and vases of the catalogue.

Usage: vessels_hold.py EMBODY DATABASE
Each stands half a metre over the floor with a box of water laid over it. What the box has beside the vessel falls in
the first second; from then on no more than one drop in 200 leaves.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

FIRST, LAST = 2, 8  # s
LIFT = 0.5  # m
VESSELS = [
    ("bathtub", "sweethome3d:Blend Swap CC-BY#bath_jay_hardy"),
    ("bathtub", "sweethome3d:Scopia#corner_bathtub"),
    ("bathtub", "sweethome3d:Scopia#islandBath"),
    ("basin", "sweethome3d:Scopia#basin"),
    ("bowl", "sweethome3d:Scopia#bowl"),
    ("bowl", "sweethome3d:Kator Legaz#bowl"),
    ("glass", "sweethome3d:Kator Legaz#highball-glass"),
    ("vase", "sweethome3d:Scopia#vase1"),
]


def scene_of(model: dict) -> dict:
    width, height, depth = model["size"]
    water = {"type": "box", "half_extents": [0.25 * width, 0.12 * height, 0.25 * depth]}
    return {"embody_scene": 1, "entities": [
        {"index": 1, "name": "Floor", "shape": {"type": "plane"}},
        {"index": 2, "name": "Vessel", "model": model["key"], "pose": {"position": [0, LIFT, 0]}, "attributes": {"kind": "static"}},
        {"index": 3, "name": "Water", "shape": water, "category": "water", "pose": {"position": [0, LIFT + 0.55 * height, 0]},
         "attributes": {"kind": "fluid", "particle_budget": 6000}},
    ]}


def held(embody: str, database: str, model: dict) -> list:
    """The number of particles within the vessel's box in each second."""
    with tempfile.TemporaryDirectory() as folder:
        file, record = pathlib.Path(folder) / "scene.json", pathlib.Path(folder) / "record.jsonl"
        file.write_text(json.dumps(scene_of(model)))
        words = [embody, "simulate", "--database", database, "--seconds", str(LAST), "--rate", "1", "--record", record, "--json", file]
        subprocess.run(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True)
        counts = []
        for line in record.read_text().splitlines()[1:]:
            flat = next(e for e in json.loads(line)["entities"] if e["index"] == 3)["points"]
            half = [model["size"][axis] / 2 + 0.01 for axis in (0, 2)]
            counts.append(sum(abs(x) < half[0] and abs(z) < half[1] and y > LIFT - 0.005 for x, y, z in zip(flat[0::3], flat[1::3], flat[2::3])))
        return counts


def main() -> int:
    embody, database = sys.argv[1:3]
    wrong = []
    for word, key in VESSELS:
        found = subprocess.run([embody, "search", "--database", database, "--limit", "60", "--json", word],
                               stdout=subprocess.PIPE, text=True, check=True)
        model = next((m for m in json.loads(found.stdout)["models"] if m["key"] == key), None)
        if model is None:
            wrong.append(f"{key} is not in the database")
            continue
        counts = held(embody, database, model)
        print(f"{key}: of {counts[0]} drops {counts[FIRST]} after {FIRST} s and {counts[LAST]} after {LAST} s")
        if counts[FIRST] < 0.9 * counts[0]:
            wrong.append(f"{key} does not hold {1 - counts[FIRST] / counts[0]:.1%} of what is poured into it")
        if counts[LAST] < 0.995 * counts[FIRST]:
            wrong.append(f"{key} loses {1 - counts[LAST] / counts[FIRST]:.1%} standing")
    for line in wrong:
        print("wrong:", line)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
