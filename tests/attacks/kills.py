#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Programs killed (SIGKILL) at random times while they write: import, `set`, the saving of a scene, edits of two clients. Acknowledged
changes are there afterwards, every file is complete, and the same command can continue.

Usage: kills.py EMBODY [--kills N] [--seed S] [--only ACT]   (the short form is 24; ACT is one of import_models, set_values, save_scene, edit)
"""
import argparse
import json
import os
import pathlib
import random
import signal
import sqlite3
import subprocess
import sys
import tempfile
import threading
import time

import sample_files as samples

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "server"))
from viewer import Server, Viewer

MODELS = 120
# A floor and many boxes, so that a scene takes some time to write.
BOXES = [{"index": i + 1, "shape": {"type": "box", "half_extents": [0.1, 0.1, 0.1]}, "pose": {"position": [i, 1, 0]}} for i in range(400)]


def rows(database: pathlib.Path, question: str) -> list:
    """Checks the integrity of a database."""
    connection = sqlite3.connect(database)
    try:
        assert connection.execute("PRAGMA integrity_check").fetchone() == ("ok",), "integrity_check"
        assert connection.execute("PRAGMA foreign_key_check").fetchone() is None, "foreign_key_check"
        if not connection.execute("PRAGMA user_version").fetchone()[0]:
            return []
        return connection.execute(question).fetchall()
    finally:
        connection.close()


class Trial:
    def __init__(self, embody: str, folder: pathlib.Path, chance: random.Random):
        self.embody, self.folder, self.chance = embody, folder, chance
        self.database = folder / "models.sqlite"
        self.models = folder / "models"
        self.models.mkdir()
        self.generation = 0
        # How long a command takes without a kill; kills fall within this time.
        self.takes: dict = {}

    def kill_within(self, name: str, words: list) -> tuple:
        """Starts the command and kills it at a random time; returns its exit code (negative: killed) and its output."""
        began = time.monotonic()
        process = subprocess.Popen([self.embody, *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        try:
            out, error = process.communicate(timeout=self.takes.get(name, 0.3) * self.chance.uniform(0, 1.1))
        except subprocess.TimeoutExpired:
            process.kill()
            out, error = process.communicate()
        else:
            # The command ended by itself after this time.
            self.takes[name] = max(time.monotonic() - began, 0.02)
        assert process.returncode in (0, -signal.SIGKILL), f"{name} ended with {process.returncode}: {error.decode()[-300:]}"
        return process.returncode, out.decode()

    def new_files(self):
        self.generation += 1
        for i in range(MODELS):
            (self.models / f"m{i}.obj").write_bytes(samples.obj(height=1 + 0.0001 * (i + MODELS * self.generation)))

    def import_models(self):
        """A killed import loses no model that was there, and the next import continues."""
        question = "SELECT key FROM model JOIN model_geometry AS g ON g.model = id JOIN model_thumbnail AS t ON t.model = id JOIN model_knowledge AS k ON k.model = id"
        before = set(rows(self.database, question)) if self.database.exists() else set()
        if self.generation == 0 or len([key for key in before if key[0].startswith("file:")]) >= MODELS * self.generation and self.generation < 3:
            self.new_files()
        elif self.generation == 3 and self.chance.random() < 0.2:
            # Start with an empty database, because otherwise nothing is left to import.
            for file in self.folder.glob("models.sqlite*"):
                file.unlink()
            before, self.generation = set(), 0
            self.new_files()
        code, _ = self.kill_within("import", ["import", "--database", str(self.database), str(self.models)])
        after = set(rows(self.database, question)) if self.database.exists() else set()
        assert before <= after, f"{len(before - after)} models were lost"
        if self.database.exists():
            count = rows(self.database, "SELECT count(*) FROM model")
            assert not count or count[0][0] == len(after), "a model lacks a part"
        return code

    def set_values(self):
        """A change applies to all models or to none, and an acknowledged one stays."""
        mass = round(self.chance.uniform(1, 100), 3)
        if not rows(self.database, "SELECT 1 FROM model") if self.database.exists() else True:
            return self.import_models()
        question = "SELECT value, count(*) FROM manual_attribute WHERE name = 'mass' GROUP BY value"
        before = rows(self.database, question)
        batches = rows(self.database, "SELECT count(*) FROM manual_batch")[0][0]
        code, _ = self.kill_within("set", ["set", "--database", str(self.database), "--all", "--skip", f"mass={mass}"])
        after = rows(self.database, question)
        after_batches = rows(self.database, "SELECT count(*) FROM manual_batch")[0][0]
        is_done = any(json.loads(value) == mass or str(mass) in value for value, _ in after)
        assert is_done or after == before, f"half an act: {before} and then {after}"
        assert after_batches == batches + (1 if is_done else 0), "the audit does not tell what was done"
        assert code != 0 or is_done, f"mass={mass} was acknowledged and is not there: {after}"
        return code

    def scene_file(self, title: str) -> pathlib.Path:
        scene = self.folder / "scene.json"
        scene.write_text(json.dumps({"embody_scene": 1, "title": title, "entities": BOXES}))
        return scene

    def save_scene(self):
        """Each saved scene is complete and at least as new as the last acknowledged one."""
        return self.served()

    def edit(self):
        """Every acknowledged edit of two clients is offered by the next server and opened by it, and nothing that nobody asked for."""
        server = Server(self.embody, str(self.database), str(self.scene_file("Killed")))
        try:
            acknowledged, asked = [0, 0], [0, 0]

            def build(who: int):
                viewer = None
                try:
                    viewer = Viewer(server.port)
                    viewer.do("hello", person=f"person {who}")
                    while True:
                        asked[who] += 1
                        # The first moves many, so that the journal soon outgrows the document and is written anew.
                        moved = [1 + who, *range(100, len(BOXES) + 1)] if who == 0 else [1 + who]
                        viewer.do("entity.transform", poses=[{"index": index, "position": [0, asked[who], 0]} for index in moved], merge=f"drag {who}")
                        acknowledged[who] = asked[who]
                except (OSError, ConnectionError):
                    if viewer:
                        viewer.close()

            people = [threading.Thread(target=build, args=(who,)) for who in range(2)]
            for person in people:
                person.start()
            # At first, or when the journal is written anew: a second after its first sync at the earliest.
            time.sleep(self.chance.uniform(0.02, 0.3) if self.chance.random() < 0.7 else self.chance.uniform(1.2, 3))
            server.process.kill()
            server.process.wait()
            for person in people:
                person.join()
            server.restart()
            viewer = Viewer(server.port)
            offered = viewer.do("hello")["recovered"]
            assert len(offered) == (1 if sum(acknowledged) else len(offered)) and len(offered) <= 1, f"{acknowledged} acknowledged, offered: {offered}"
            if offered:
                assert offered[0]["title"] == "Killed" and offered[0]["edits"] >= sum(acknowledged), offered
                viewer.do("scene.load", name=offered[0]["name"])
                entities = viewer.do("hello")["scene"]["entities"]
                assert len(entities) == len(BOXES), "half a scene"
                for who in range(2):
                    height = entities[who]["pose"]["position"][1]
                    least = acknowledged[who] or min(1, asked[who])
                    assert who == 1 or all(entity["pose"]["position"][1] == height for entity in entities[99:]) or height == 1, "half an edit"
                    assert least <= height <= max(asked[who], 1), f"client {who} is at {height}, acknowledged was {acknowledged[who]}, asked {asked[who]}"
            viewer.close()
        finally:
            if server.process.poll() is None:
                server.process.kill()
            server.close()
        return -signal.SIGKILL

    def served(self):
        server = Server(self.embody, str(self.database), str(self.scene_file("Killed")))
        home = pathlib.Path(server.home.name)
        acknowledged = 0
        try:
            viewer = Viewer(server.port)
            viewer.do("hello")
            until = time.monotonic() + self.chance.uniform(0, 0.4)
            number = 0
            while time.monotonic() < until:
                number += 1
                viewer.do("entity.transform", poses=[{"index": 1, "position": [0, number, 0]}])
                viewer.do("scene.save", name="kept")
                acknowledged = number
            # Kill in the middle of the next save, whose answer nobody reads.
            viewer.ask("entity.transform", poses=[{"index": 1, "position": [0, number + 1, 0]}])
            viewer.ask("scene.save", name="kept")
            time.sleep(self.chance.uniform(0, 0.03))
            server.process.kill()
            server.process.wait()
            viewer.close()
            files = [file for file in home.rglob("*.json") if file.match("scenes/kept.json")]
            for file in files:
                document = json.loads(file.read_text())
                assert len(document["entities"]) == len(BOXES), "half a scene"
                height = document["entities"][0]["pose"]["position"][1]
                assert height in (acknowledged, acknowledged + 1), f"saved at {height}, acknowledged was {acknowledged}"
            assert files or not acknowledged, "a saved scene is not there"
        finally:
            if server.process.poll() is None:
                server.process.kill()
            server.close()
        return -signal.SIGKILL


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("embody")
    parser.add_argument("--kills", type=int, default=24)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", choices=["import_models", "set_values", "save_scene", "edit"])
    options = parser.parse_args()
    chance = random.Random(options.seed)
    began = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        trial = Trial(options.embody, pathlib.Path(folder), chance)
        acts = [trial.import_models, trial.set_values, trial.save_scene, trial.edit]
        if options.only:
            acts = [act for act in acts if act.__name__ == options.only]
        counts: dict = {}
        runs = 0
        # The commands in turn until there were as many kills as wanted; some commands end before their kill.
        while sum(killed for killed, _ in counts.values()) < options.kills and runs < 20 * options.kills:
            act = acts[runs % len(acts)]
            runs += 1
            try:
                code = act()
            except AssertionError as error:
                print(f"{act.__name__}, run {runs} of seed {options.seed}: {error}")
                return 1
            killed, whole = counts.get(act.__name__, (0, 0))
            counts[act.__name__] = (killed + (code != 0), whole + (code == 0))
        for name, (killed, whole) in counts.items():
            print(f"{name}: {killed} killed, {whole} ended before")
        # The files that are left can be used.
        if trial.generation == 0:
            trial.new_files()
        ended = subprocess.run([options.embody, "import", "--database", str(trial.database), str(trial.models)], capture_output=True, text=True)
        if ended.returncode != 0:
            print(f"the last import ended with {ended.returncode}: {ended.stderr[-300:]}")
            return 1
        expected = {"models", "scene.json", "models.sqlite", "models.sqlite-wal", "models.sqlite-shm", "models.sqlite-uploads"}
        left = {file.name for file in trial.folder.iterdir()} - expected
        if left:
            print(f"left behind: {left}")
            return 1
    print(f"{sum(killed for killed, _ in counts.values())} kills in {time.monotonic() - began:.1f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
