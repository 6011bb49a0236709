#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Cloths that land on real models that stand fast: random models of the catalogue, sheets of random size, weight and mesh.

Usage: cloths_land.py EMBODY DATABASE [--first SEED] [--count N]
No step may give a cloth more than a hundredth of what it had at first and 0.2 J.
"""
import argparse
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile

SECONDS = 2
MAX_GAIN, MAX_REST = 0.01, 0.2  # of the energy at first, and J: light sheets on small tools still gain tenths of a joule
SMALLEST, LARGEST = 0.25, 2.2  # m, of the models


def scene_of(model: dict, chance: random.Random) -> dict:
    width, height, depth = model["size"]
    half = [max(0.15, min(0.8, size / 2 * chance.uniform(0.7, 1.6))) for size in (width, depth)]
    turn = chance.uniform(0, math.pi)
    return {"embody_scene": 1, "entities": [
        {"index": 1, "name": "Floor", "shape": {"type": "plane"}},
        {"index": 2, "name": "Model", "model": model["key"], "attributes": {"kind": "static"}},
        {"index": 3, "name": "Cloth", "shape": {"type": "box", "half_extents": [half[0], 0.001, half[1]]},
         "pose": {"position": [chance.uniform(-0.1, 0.1), height + 0.05, chance.uniform(-0.1, 0.1)],
                  "rotation": [0, math.sin(turn / 2), 0, math.cos(turn / 2)]},
         "attributes": {"kind": "cloth", "area_density": chance.choice([0.1, 0.2, 0.4, 0.8, 1.5]),
                        "cloth_nodes": chance.choice([300, 500, 700]), "friction_static": 0.6,
                        "friction_dynamic": chance.choice([0.2, 0.4, 0.55])}},
    ]}


def energies(embody: str, database: str, scene: dict) -> list:
    """Of the cloth, J, after each step from the second on: the first is that of a step that begins at rest."""
    with tempfile.TemporaryDirectory() as folder:
        file, record = pathlib.Path(folder) / "scene.json", pathlib.Path(folder) / "record.jsonl"
        file.write_text(json.dumps(scene))
        words = [embody, "simulate", "--database", database, "--seconds", str(SECONDS), "--rate", "60", "--energy", "--record", record, file]
        subprocess.run(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True)
        return [json.loads(line)["energy"]["total"] for line in record.read_text().splitlines()[3:]]


def main() -> int:
    options = argparse.ArgumentParser()
    options.add_argument("embody")
    options.add_argument("database")
    options.add_argument("--first", type=int, default=0)
    options.add_argument("--count", type=int, default=16)
    options = options.parse_args()
    found = subprocess.run([options.embody, "search", "--database", options.database, "--limit", "1000", "--json"],
                           stdout=subprocess.PIPE, text=True, check=True)
    models = sorted((m for m in json.loads(found.stdout)["models"] if SMALLEST < max(m["size"]) < LARGEST), key=lambda m: m["key"])
    wrong = [] if len(models) > 100 else [f"only {len(models)} models are in the database"]
    for seed in range(options.first, options.first + options.count) if models else []:
        chance = random.Random(seed)
        model = chance.choice(models)
        energy = energies(options.embody, options.database, scene_of(model, chance))
        if not all(math.isfinite(now) and now > 0 for now in energy):
            wrong.append(f"seed {seed}: a cloth on {model['key']} has numbers that are none")
            continue
        lowest, gain = energy[0], 0
        for now in energy:
            gain = max(gain, now - lowest)
            lowest = min(lowest, now)
        print(f"{seed} {model['key']}: {energy[0]:.3f} J at first, {energy[-1]:.3f} J at last, gained {gain:.4f} J", flush=True)
        if not gain <= MAX_GAIN * energy[0] + MAX_REST:
            wrong.append(f"seed {seed}: a cloth on {model['key']} gained {gain:.3f} J")
    for line in wrong:
        print("wrong:", line)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
