#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Real hollow models work: mugs and cups hold a ball, chairs carry a box, tables leave room beneath.

Usage: hollow_things_hold.py EMBODY DATABASE
Each model is dropped into a scene of its own as imported: shape, mass and friction are automatic.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

FLOOR = {"index": 1, "name": "Floor", "shape": {"type": "plane"}}


def end_of(embody: str, database: str, entities: list, seconds: float) -> dict:
    """The last recorded position and rotation of each entity by its index."""
    with tempfile.TemporaryDirectory() as folder:
        scene, record = pathlib.Path(folder) / "scene.json", pathlib.Path(folder) / "record.jsonl"
        scene.write_text(json.dumps({"embody_scene": 1, "entities": [FLOOR, *entities]}))
        words = [embody, "simulate", "--database", database, "--seconds", str(seconds), "--rate", "1", "--record", record, "--json", scene]
        subprocess.run(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True)
        last = json.loads(record.read_text().splitlines()[-1])
    return {entity["index"]: entity for entity in last["entities"]}


def main() -> int:
    embody, database = sys.argv[1:3]
    wrong, tried = [], 0

    def find(word: str, names: set) -> list:
        found = subprocess.run([embody, "search", "--database", database, "--limit", "60", "--json", word], stdout=subprocess.PIPE, text=True, check=True)
        return [model for model in json.loads(found.stdout)["models"] if model["name"] in names]

    # A small ball above the centre comes to rest inside; a handle moves the hollow away from the centre of the box.
    for model in find("mug", {"Coffee mug"}) + find("cup", {"Plastic cup"}):
        width, height, depth = model["size"]
        held = False
        for aside in (0, 0.015, -0.015):
            across_x = width > depth
            place = [aside if across_x else 0, height + 0.03, 0 if across_x else aside]
            ball = {"index": 3, "name": "Ball", "shape": {"type": "sphere", "radius": 0.012}, "pose": {"position": place}}
            end = end_of(embody, database, [{"index": 2, "name": "Vessel", "model": model["key"]}, ball], 4)
            held = held or 0.012 < end[3]["position"][1] < 0.7 * height
        tried += 1
        print(f"{model['name']}: {'holds' if held else 'does not hold'} a ball")
        if not held:
            wrong.append(f"{model['key']} holds no ball")

    # A box of 4 kg that is released just above the seat stays there, well above the floor and well below the back's
    # top.
    for model in find("chair", {"Chair"})[:8]:
        height = model["size"][1]
        box = {"index": 3, "name": "Box", "shape": {"type": "box", "half_extents": [0.08, 0.08, 0.08]},
               "pose": {"position": [0, 0.55 * height + 0.09, 0.02]}, "attributes": {"mass": 4, "restitution": 0}}
        end = end_of(embody, database, [{"index": 2, "name": "Chair", "model": model["key"]}, box], 4)
        seat = end[3]["position"][1] - 0.08
        tried += 1
        print(f"{model['key']}: seat at {seat:.2f} of {height:.2f} m")
        if not 0.3 * height < seat < 0.65 * height:
            wrong.append(f"{model['key']}: a box ended {seat:.2f} m above the floor")

    # A box half as high as the table slides through beneath without a contact.
    for model in find("table", {"Table", "Wooden table"})[:4]:
        width, height, _ = model["size"]
        ball = {"index": 3, "name": "Ball", "shape": {"type": "sphere", "radius": 0.2 * height}, "linear_velocity": [3, 0, 0],
                "pose": {"position": [-width, 0.2 * height, 0]}, "attributes": {"friction_static": 0, "friction_dynamic": 0, "friction_rolling": 0}}
        end = end_of(embody, database, [{"index": 2, "name": "Table", "model": model["key"], "attributes": {"mass": 500}}, ball], 3)
        through = end[3]["position"][0] > width / 2
        tried += 1
        print(f"{model['key']}: {'room beneath' if through else 'no room beneath'}")
        if not through:
            wrong.append(f"{model['key']}: a ball of {0.4 * height:.2f} m does not roll through beneath")

    if tried < 6:
        wrong.append(f"only {tried} models were there to try")
    for line in wrong:
        print("wrong:", line)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
