#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A server under load for a long time: clients that play, edit, save, undo, upload and view, imports of good and hostile files into the same
database, and fuzz targets in turn. Memory, open files, errors and response times are measured.

Usage: soak.py EMBODY FUZZERS [--minutes M] [--seed S]   (FUZZERS: the folder of the fuzz targets; tools/soak.sh calls this)
Fails where the server ends, an answer is wrong or missing, or memory or open files keep growing.
"""
import argparse
import http.client
import json
import os
import pathlib
import random
import sqlite3
import statistics
import subprocess
import sys
import tempfile
import threading
import time

import attack_models
import sample_files as samples

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "server"))
from viewer import Server, Viewer

# An answer that is not there after STALL will not come, s; an import may take as long as its model may
# (docs/import.md).
STALL, LONGEST_IMPORT = 60, 1000
# Allowed growth from the second fifth of the time to the last: caches are full by then, a leak goes on. Bytes, files.
MORE_MEMORY, MORE_FILES = 96 << 20, 24


class Soak:
    def __init__(self, options):
        self.options = options
        self.folder = tempfile.TemporaryDirectory()
        self.path = pathlib.Path(self.folder.name)
        self.database = self.path / "models.sqlite"
        floor = {"index": 1, "shape": {"type": "plane"}, "attributes": {"kind": "static"}}
        boxes = [{"index": i + 2, "shape": {"type": "box", "half_extents": [0.1, 0.1, 0.1]}, "pose": {"position": [0.3 * (i % 10), 0.2 + 0.3 * (i // 10), 0]}}
                 for i in range(100)]
        scene = self.path / "scene.json"
        scene.write_text(json.dumps({"embody_scene": 1, "title": "Soak", "entities": [floor, *boxes]}))
        self.server = Server(options.embody, str(self.database), str(scene))
        # The clock starts after the server, because its start and the first database take time.
        self.until = time.monotonic() + 60 * options.minutes
        self.wrong: list = []
        self.waits: dict = {}
        self.counts: dict = {}
        self.watched: list = []
        self.lock = threading.Lock()

    def is_over(self) -> bool:
        return time.monotonic() > self.until or len(self.wrong) > 20

    def fail(self, what: str):
        with self.lock:
            self.wrong.append(f"after {60 * self.options.minutes - (self.until - time.monotonic()):.0f} s: {what}")

    def timed(self, name: str, act):
        began = time.monotonic()
        result = act()
        with self.lock:
            self.waits.setdefault(name, []).append(time.monotonic() - began)
            self.counts[name] = self.counts.get(name, 0) + 1
        return result

    def viewer(self) -> Viewer:
        viewer = Viewer(self.server.port)
        viewer.socket.settimeout(STALL)
        viewer.do("hello")
        return viewer

    def play(self, chance: random.Random):
        """Plays, views, connects and disconnects."""
        while not self.is_over():
            viewer = self.viewer()
            for _ in range(chance.randrange(5, 15)):
                command = chance.choice(["simulation.play", "simulation.pause", "simulation.reset", "simulation.play"])
                self.timed(command, lambda: viewer.do(command))
                time.sleep(chance.uniform(0, 0.3))
                self.timed("entity.attributes", lambda: viewer.do("entity.attributes", index=chance.randrange(2, 100)))
            viewer.close()

    def edit(self, chance: random.Random):
        """Adds, moves, undoes, saves and removes entities; the scene keeps its size."""
        viewer = self.viewer()
        while not self.is_over():
            entity = {"shape": {"type": "sphere", "radius": 0.1}, "pose": {"position": [5, chance.uniform(1, 5), 5]}}
            index = self.timed("entity.add", lambda: viewer.do("entity.add", entity=entity))["index"]
            self.timed("entity.transform", lambda: viewer.do("entity.transform", poses=[{"index": index, "position": [5, 2, 5]}]))
            self.timed("entity.set_attribute", lambda: viewer.do("entity.set_attribute", indices=[index], name="mass", value=chance.uniform(1, 9)))
            self.timed("edit.undo", lambda: viewer.do("edit.undo"))
            self.timed("edit.redo", lambda: viewer.do("edit.redo"))
            name = f"soak {chance.randrange(5)}"
            saved = self.timed("scene.save", lambda: viewer.do("scene.save", name=name))
            self.timed("entity.remove", lambda: viewer.do("entity.remove", indices=[index]))
            document = json.loads(pathlib.Path(saved["path"]).read_text())
            if not any(one["index"] == index for one in document["entities"]):
                self.fail("a saved scene lacks what was there")
            time.sleep(chance.uniform(0, 0.2))
        viewer.close()

    def request(self, method: str, path: str, body: bytes | None = None, patience: float = STALL) -> tuple:
        connection = http.client.HTTPConnection("127.0.0.1", self.server.port, timeout=patience)
        connection.request(method, path, body)
        answer = connection.getresponse()
        content = answer.read()
        connection.close()
        return answer.status, content

    def look(self, chance: random.Random):
        while not self.is_over():
            path = chance.choice(["/api/health", "/scene.json", "/models/1/thumbnail.png", "/models/1/geometry.glb", "/nothing"])
            status, _ = self.timed("GET " + path, lambda: self.request("GET", path))
            if status != (404 if path == "/nothing" else 200):
                self.fail(f"GET {path} is answered {status}")
            time.sleep(chance.uniform(0, 0.1))

    def upload(self, chance: random.Random):
        number = 0
        while not self.is_over():
            number += 1
            content, right = samples.obj(height=1 + 0.0001 * number), 200
            name = "good.obj"
            if chance.random() < 0.5:
                extension, content = chance.choice([attack_models.obj_numbers, attack_models.ply_lists, attack_models.stl_sizes, attack_models.glb_lengths])(chance)
                name, right = "bad" + extension, None
            status, _ = self.timed("POST /import", lambda: self.request("POST", f"/import?name={name}", content, LONGEST_IMPORT))
            if status not in ((200, 422, 503) if right is None else (right,)):
                self.fail(f"the upload of {name} is answered {status}")
            time.sleep(chance.uniform(0, 0.5))

    def bring_in(self, chance: random.Random):
        """Imports with another program, into the database that is served."""
        models = self.path / "models"
        models.mkdir()
        number = 0
        while not self.is_over():
            for file in models.iterdir():
                file.unlink()
            for _ in range(10):
                number += 1
                (models / f"good{number}.obj").write_bytes(samples.obj(height=2 + 0.0001 * number))
                extension, content = chance.choice([attack_models.obj_paths, attack_models.ply_headers, attack_models.textured, attack_models.gltf_fields])(chance)
                (models / f"bad{number}{extension}").write_bytes(content)
            words = [self.options.embody, "import", "--json", "--workers", "1", "--database", str(self.database), str(models)]
            done = self.timed("embody import", lambda: subprocess.run(words, capture_output=True, timeout=10 * LONGEST_IMPORT))
            if done.returncode not in (0, 3):
                self.fail(f"embody import ended with {done.returncode}: {done.stderr[-300:]!r}")
            elif any("good" in failure["path"] for failure in json.loads(done.stdout)["failures"]):
                self.fail("a good file was refused")

    def fuzz(self, chance: random.Random):
        programs = sorted(program for program in self.options.fuzzers.glob("fuzz_*") if program.is_file() and os.access(program, os.X_OK))
        if not programs:
            return self.fail(f"no fuzz targets in {self.options.fuzzers}")
        # Each target runs several times per hour; none is interrupted by the end.
        turn = max(1.0, min(60.0, 60 * self.options.minutes / len(programs) / 3))
        while not self.is_over():
            for program in programs:
                if time.monotonic() + turn > self.until:
                    return
                corpus = HERE.parent / "fuzz/corpus" / program.name.removeprefix("fuzz_")
                words = ["nice", str(program), "--runs", "1000000000", "--seconds", str(turn), "--seed", str(chance.randrange(1 << 30)), "--keep", str(self.options.keep), str(corpus)]
                done = self.timed(program.name, lambda: subprocess.run(words, capture_output=True, text=True))
                print("  " + done.stdout.strip(), flush=True)
                if done.returncode != 0:
                    self.fail(f"{program.name} failed; its inputs are in {self.options.keep}: {done.stderr[-500:]}")

    def watch(self, _: random.Random):
        process = self.server.process
        while not self.is_over():
            if process.poll() is not None:
                return self.fail(f"the server ended with {process.returncode}")
            self.watched.append((self.server.memory(), len(os.listdir(f"/proc/{process.pid}/fd"))))
            time.sleep(0.5)

    def guarded(self, act, seed: int):
        try:
            act(random.Random(seed))
        except Exception as error:
            self.fail(f"{act.__name__}: {type(error).__name__}: {error}")

    def growth(self):
        if not self.watched:
            return self.wrong.append("the time was too short to watch anything")
        fifth = max(1, len(self.watched) // 5)
        for place, (name, most, unit) in enumerate((("memory", MORE_MEMORY, 1 << 20), ("open files", MORE_FILES, 1))):
            early = statistics.median(row[place] for row in self.watched[fifth:2 * fifth] or self.watched)
            late = statistics.median(row[place] for row in self.watched[-fifth:])
            print(f"{name}: {early / unit:.0f}, at the end {late / unit:.0f}, at most {max(row[place] for row in self.watched) / unit:.0f}{' MiB' if unit > 1 else ''}")
            if late - early > most:
                self.wrong.append(f"{name} went from {early} to {late}")

    def run(self) -> int:
        acts = [self.play, self.play, self.edit, self.look, self.upload, self.bring_in, self.fuzz, self.watch]
        threads = [threading.Thread(target=self.guarded, args=(act, self.options.seed + i)) for i, act in enumerate(acts)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.growth()
        code = self.server.close()
        if code != 0:
            self.wrong.append(f"the server ended with {code}")
        connection = sqlite3.connect(self.database)
        if connection.execute("PRAGMA integrity_check").fetchall() != [("ok",)]:
            self.wrong.append("integrity_check failed")
        print(f"{connection.execute('SELECT count(*) FROM model').fetchone()[0]} models in the database")
        connection.close()
        for name, waits in sorted(self.waits.items()):
            waits.sort()
            print(f"{name}: {len(waits)} times, median {1000 * waits[len(waits) // 2]:.1f} ms, 99 % {1000 * waits[len(waits) * 99 // 100]:.0f} ms, worst {1000 * waits[-1]:.0f} ms")
        for line in self.wrong:
            print("wrong:", line)
        self.folder.cleanup()
        return 1 if self.wrong else 0


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("embody")
    parser.add_argument("fuzzers", type=pathlib.Path)
    parser.add_argument("--minutes", type=float, default=0.5)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=pathlib.Path, default=pathlib.Path("fuzz-failures"))
    return Soak(parser.parse_args()).run()


if __name__ == "__main__":
    sys.exit(main())
