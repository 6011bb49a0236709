#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The demo scenes come to rest on the real models: what a new user sees first must not tremble, creep or fall over.

Usage: demo_scenes_rest.py EMBODY DATABASE SCENE.json…
Found so: dining chairs of the furnished room that rocked from foot to foot for ever, 4 cm away after 20 s.
"""
import json
import pathlib
import subprocess
import sys
import tempfile


def main() -> int:
    embody, database, *scenes = sys.argv[1:]
    wrong = []
    for scene in scenes:
        name = pathlib.Path(scene).stem
        with tempfile.TemporaryDirectory() as folder:
            record = pathlib.Path(folder) / "record.jsonl"
            words = [embody, "simulate", "--database", database, "--seconds", "12", "--rate", "1", "--record", record, "--json", scene]
            done = subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
            if done.returncode != 0:
                wrong.append(f"{name}: exit code {done.returncode}")
                continue
            lines = [json.loads(line) for line in record.read_text().splitlines()]
        report = json.loads(done.stdout)
        print(f"{name}: {report['asleep']} asleep, {report['active']} active, {report['wants_to_sleep']} want to sleep, limits {report['limits']}")
        if report["active"] or report["wants_to_sleep"]:
            names = {entity["index"]: entity["name"] for entity in lines[0]["entities"]}
            moving = [names.get(e["index"], e["index"]) for e in lines[-1]["entities"] if any(e["linear_velocity"])]
            wrong.append(f"{name}: did not come to rest within 12 s: {moving}")
        restless = [e["index"] for e in lines[-1]["entities"] if e["state"] == "active" and "points" in e]
        if restless:
            wrong.append(f"{name}: entities {restless} are awake after 12 s")
        if report["limits"]:
            wrong.append(f"{name}: limits {report['limits']} were reached")
    for line in wrong:
        print("wrong:", line)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
