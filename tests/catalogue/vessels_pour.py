#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Real vessels hold water and pour it: mugs, cups and bowls of the catalogue, with the hulls of the import.

Usage: vessels_pour.py EMBODY DATABASE
Over a tray each stands full for 3 s, is turned by 100 degrees in 1.75 s and held there for 1.5 s.
"""
import json
import math
import pathlib
import subprocess
import sys
import tempfile

STANDS, TURNS, WAITS = 3.0, 1.75, 1.5  # s
TURN = math.radians(100)
LIFT = 0.12  # height of the vessel over the tray, m
# The cylinder of water that fits in: its radius, the distance of its axis from the centre of the model's box (a handle
# moves it), its height as a fraction of the model's.
VESSELS = {
    ("mug", "sweethome3d:Kator Legaz#coffee-mug"): (0.030, -0.015, 0.6),
    ("cup", "sweethome3d:Blend Swap CC-0#plasticCup"): (0.025, 0.0, 0.6),
    ("bowl", "sweethome3d:Scopia#bowl"): (0.060, 0.0, 0.4),
}


def tray() -> dict:
    side, rim = 0.5, 0.05
    sides = [{"type": "box", "half_extents": [0.02, rim, side], "position": [sign * side, rim, 0]} for sign in (-1, 1)]
    ends = [{"type": "box", "half_extents": [side, rim, 0.02], "position": [0, rim, sign * side]} for sign in (-1, 1)]
    floor = {"type": "box", "half_extents": [side, 0.05, side], "position": [0, -0.05, 0]}
    return {"index": 1, "name": "Tray", "shape": {"type": "compound", "children": [floor, *sides, *ends]}, "attributes": {"kind": "static"}}


def scene_of(model: dict, radius: float, aside: float, filled: float) -> dict:
    height = model["size"][1]
    half = filled * height / 2
    return {"embody_scene": 1, "entities": [
        tray(),
        {"index": 2, "name": "Vessel", "model": model["key"], "pose": {"position": [0, LIFT, 0]}, "attributes": {"kinematic": True}},
        {"index": 3, "name": "Water", "shape": {"type": "cylinder", "radius": radius, "half_height": half}, "category": "water",
         "pose": {"position": [0, LIFT + 0.1 * height + half, aside]}, "attributes": {"kind": "fluid", "particle_budget": 3000}},
    ], "actions": [
        {"name": "turn", "receiver": {"index": 2}, "trigger": {"type": "time", "time": STANDS},
         "effect": {"type": "set_velocity", "linear": [0, 0, 0], "angular": [0, 0, -TURN / TURNS]}},
        {"name": "stop", "receiver": {"index": 2}, "trigger": {"type": "time", "time": STANDS + TURNS},
         "effect": {"type": "set_velocity", "linear": [0, 0, 0], "angular": [0, 0, 0]}},
    ]}


def recorded(embody: str, database: str, scene: dict) -> list:
    with tempfile.TemporaryDirectory() as folder:
        file, record = pathlib.Path(folder) / "scene.json", pathlib.Path(folder) / "record.jsonl"
        file.write_text(json.dumps(scene))
        words = [embody, "simulate", "--database", database, "--seconds", str(STANDS + TURNS + WAITS), "--rate", "4", "--record", record, "--json", file]
        subprocess.run(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True)
        return [{e["index"]: e for e in json.loads(line)["entities"]} for line in record.read_text().splitlines()[1:]]


def turned_back(rotation: list, v: list) -> list:
    x, y, z, w = -rotation[0], -rotation[1], -rotation[2], rotation[3]
    t = [2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])]
    return [v[0] + w * t[0] + y * t[2] - z * t[1], v[1] + w * t[1] + z * t[0] - x * t[2], v[2] + w * t[2] + x * t[1] - y * t[0]]


def inside(frame: dict, size: list) -> int:
    """Number of particles inside the vessel's box, while it stands."""
    vessel, flat = frame[2], frame[3]["points"]
    count = 0
    for p in zip(flat[0::3], flat[1::3], flat[2::3]):
        x, y, z = turned_back(vessel["rotation"], [p[axis] - vessel["position"][axis] for axis in range(3)])
        count += abs(x) < size[0] / 2 and 0 < y < size[1] and abs(z) < size[2] / 2
    return count


def on_tray(frame: dict) -> int:
    flat = frame[3]["points"]
    return sum(abs(x) < 0.5 and abs(z) < 0.5 and -0.01 < y < 0.05 for x, y, z in zip(flat[0::3], flat[1::3], flat[2::3]))


def main() -> int:
    embody, database = sys.argv[1:3]
    wrong = []
    for (word, key), (radius, aside, filled) in VESSELS.items():
        found = subprocess.run([embody, "search", "--database", database, "--limit", "60", "--json", word],
                               stdout=subprocess.PIPE, text=True, check=True)
        model = next((m for m in json.loads(found.stdout)["models"] if m["key"] == key), None)
        if model is None:
            wrong.append(f"{key} is not in the database")
            continue
        frames = recorded(embody, database, scene_of(model, radius, aside, filled))
        total = len(frames[0][3]["points"]) // 3
        held, left, caught = (share / total for share in (inside(frames[int(4 * STANDS)], model["size"]), inside(frames[-1], model["size"]), on_tray(frames[-1])))
        print(f"{key}: of {total} drops {held:.1%} held, {left:.1%} left when turned, {caught:.1%} on the tray")
        if held < 0.99:
            wrong.append(f"{key} loses {1 - held:.1%} standing")
        if left > 0.25:
            wrong.append(f"{key} keeps {left:.1%} turned by 100 degrees")
        if left + caught < 0.98:
            wrong.append(f"{key}: {1 - left - caught:.1%} went elsewhere")
    for line in wrong:
        print("wrong:", line)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
