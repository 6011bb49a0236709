#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Hostile files by the thousand, generated: models, archives, names, links, scenes, databases, and workers that were taken over.

Usage: attacks.py EMBODY [--size N] [--seed S] [--keep FOLDER] [part of a test's name …]
`--size 1` is the short form, of about 420 files; `--size N` has N times as many of each class. Required of all: no crash of the program,
the documented exit code, each refusal with file and reason, nothing written outside of the database, nothing read outside of the folder,
an end within the time limits, memory within the budget, and a database that passes integrity_check.
"""
import argparse
import json
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import threading
import time

import attack_archives
import attack_databases
import attack_models
import attack_scenes
import sample_files as samples
import worker_frames
from attack_models import SECRET

# An import or command of these sizes that has not ended by then hangs, s.
LONGEST = 1500
# Resident memory of the program itself, bytes; workers have limits of their own (docs/import.md).
MOST_MEMORY = 900 << 20
# Memory of a worker that runs alone, because a fraction of it was not enough: half of the machine's, bytes.
MOST_WORKER_MEMORY = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") // 2
STEERING = [chr(c) for c in (*range(0x20), *range(0x7F, 0xA0), *range(0x202A, 0x202F), *range(0x2066, 0x206A)) if c != 0x0A]


def run(words: list, wrong: list, codes=(0, 1, 3)) -> subprocess.CompletedProcess:
    """Runs the program and checks what holds for every command: exit code, no control characters, memory, an end in time."""
    process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    outputs = {}
    readers = [threading.Thread(target=lambda name=name, stream=stream: outputs.update({name: stream.read()}))
               for name, stream in (("out", process.stdout), ("err", process.stderr))]
    for reader in readers:
        reader.start()
    began, peak = time.monotonic(), 0
    status = pathlib.Path(f"/proc/{process.pid}/status")
    while True:
        ended, code, used = os.wait4(process.pid, os.WNOHANG)
        if ended:
            break
        try:
            peak = max([peak] + [1024 * int(line.split()[1]) for line in status.read_text().splitlines() if line.startswith("VmHWM")])
        except OSError:
            pass
        if time.monotonic() - began > LONGEST:
            process.kill()
            wrong.append(f"{words[1]} did not end within {LONGEST} s")
            _, code, used = os.wait4(process.pid, 0)
            break
        time.sleep(0.02)
    process.returncode = os.waitstatus_to_exitcode(code)
    for reader in readers:
        reader.join()
    done = subprocess.CompletedProcess(words, process.returncode, outputs["out"].decode("utf-8", "replace"), outputs["err"].decode("utf-8", "replace"))
    what = f"{words[1]} {words[-1]}"
    if done.returncode not in codes:
        wrong.append(f"{what}: ended with {done.returncode}: {done.stderr[-400:]!r}")
    if done.returncode == 1 and not (done.stderr.startswith("embody: ") or done.stdout):
        wrong.append(f"{what}: failed without a word: {done.stderr[:400]!r}")
    if any(sign in done.stderr for sign in STEERING):
        wrong.append(f"{what}: steers the terminal: {done.stderr[:400]!r}")
    if peak > MOST_MEMORY:
        wrong.append(f"{what}: took {peak >> 20} MiB")
    if 1024 * used.ru_maxrss > MOST_WORKER_MEMORY:
        wrong.append(f"{what}: a worker took {used.ru_maxrss >> 10} MiB")
    done.peak = peak
    return done


def listing(folder: pathlib.Path) -> dict:
    """Every file with its size, time and mode; links as they are."""
    found = {}
    for base, folders, files in os.walk(os.fsencode(folder)):
        for name in folders + files:
            entry = os.path.join(base, name)
            status = os.lstat(entry)
            found[entry] = (status.st_mode, 0 if os.path.isdir(entry) else (status.st_size, status.st_mtime_ns))
    return found


def check_database(embody: str, database: pathlib.Path, wrong: list):
    # sqlite3, the program, is no part of the packages; Python's module is.
    import sqlite3
    connection = sqlite3.connect(database)
    for pragma in ("integrity_check", "foreign_key_check"):
        rows = connection.execute(f"PRAGMA {pragma}").fetchall()
        if rows not in ([("ok",)], []):
            wrong.append(f"{pragma}: {rows[:3]}")
    connection.close()
    for part in database.parent.glob(database.name + "*"):
        if SECRET.encode() in part.read_bytes():
            wrong.append(f"{part.name} holds what lies outside of the folder")


class Yard:
    """A folder of hostile files, a folder that must not be read, and a database."""

    def __init__(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = pathlib.Path(self.folder.name).resolve()
        self.models = self.path / "models"
        self.outside = self.path / "outside"
        self.database = self.path / "data/models.sqlite"
        for folder in (self.models, self.outside, self.database.parent):
            folder.mkdir()
        secret = f"newmtl {SECRET}\nKd 1 0 0\n"
        (self.outside / "secret.mtl").write_text(secret)
        (self.outside / "secret.obj").write_bytes(b"usemtl " + SECRET.encode() + b"\n" + samples.obj())
        (self.outside / "secret.png").write_bytes(samples.png(before=samples.png_chunk(b"tEXt", SECRET.encode())))
        (self.outside / "secret.bin").write_bytes(samples.gltf_buffer())
        (self.outside / "secret.wrl").write_bytes(samples.vrml())
        (self.models / "textured.mtl").write_bytes(samples.mtl("wood.png"))
        (self.models / "wood.png").write_bytes(samples.png())
        self.good = 0

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.folder.cleanup()

    def put(self, name: str, content: bytes) -> pathlib.Path:
        file = self.models / name
        file.write_bytes(content)
        return file

    def put_good(self):
        """Good files between the hostile ones, which have to be imported."""
        self.good += 1
        self.put(f"good-{self.good:05}.obj", samples.obj(height=1 + 0.001 * self.good))

    def import_all(self, embody: str, wrong: list, what: str, *more: str):
        before = listing(self.models) | listing(self.outside)
        done = run([embody, "import", "--json", "--database", str(self.database), *more, str(self.models)], wrong, codes=(0, 3))
        if listing(self.models) | listing(self.outside) != before:
            wrong.append("the import changed something outside of its database")
        strangers = {entry.name for entry in self.path.iterdir()} - {"models", "outside", "data"}
        strangers |= {entry.name for entry in self.database.parent.iterdir()} - {"models.sqlite", "models.sqlite-wal", "models.sqlite-shm"}
        if strangers:
            wrong.append(f"the import left {strangers}")
        try:
            report = json.loads(done.stdout)
        except json.JSONDecodeError as error:
            wrong.append(f"the report is no JSON: {error}: {done.stdout[:200]!r}")
            return []
        failures = report["failures"]
        ended = sum("was ended by" in failure["why"] or "broke off" in failure["why"] for failure in failures)
        print(f"  {what}: {report['added']} added, {len(failures)} refused, of which {ended} ended their worker, {report['seconds']:.1f} s, {done.peak >> 20} MiB")
        if (done.returncode == 3) != bool(failures):
            wrong.append(f"exit code {done.returncode} with {len(failures)} failures")
        for failure in failures:
            if str(self.models) not in failure["path"] or len(failure["why"]) < len(str(self.models)) // 2:
                wrong.append(f"a refusal without file or reason: {failure}")
        refused = [f"{failure['path']}: {failure['why']}" for failure in failures if "/good-" in failure["path"]]
        if refused:
            wrong.append(f"good files were refused: {refused[:3]}")
        if report["added"] < self.good:
            wrong.append(f"{report['added']} of {self.good} good files came in")
        check_database(embody, self.database, wrong)
        return failures


def test_models(embody: str, size: int, chance: random.Random, wrong: list):
    with Yard() as yard:
        number = 0
        for make in attack_models.CLASSES:
            for _ in range(6 * size):
                extension, content = make(chance)
                number += 1
                yard.put(f"{make.__name__}-{number:05}{extension}", content)
            yard.put_good()
        yard.import_all(embody, wrong, f"{number} models")


def test_names_links_and_sizes(embody: str, size: int, chance: random.Random, wrong: list):
    with Yard() as yard:
        for i, name in enumerate(attack_models.FILE_NAMES * size):
            yard.put(f"{name}{i}{chance.choice(['.obj', '.stl', '.zip', '.OBJ'])}"[-250:], chance.choice([samples.obj(), b"v 1 2", b""]))
        for i, extension in enumerate([".obj", ".stl", ".ply", ".dae", ".gltf", ".glb", ".ac", ".wrl", ".zip", ".sh3f"]):
            file = yard.put(f"sparse{i}{extension}", b"PK\5\6" if extension in (".zip", ".sh3f") else samples.stl())
            os.truncate(file, 1 << 40)
        targets = ["../outside/secret.obj", "/etc/passwd", "/dev/zero", "/proc/self/mem", ".", "..", "/", "loop-a.obj", "nothing.obj", "../outside", "wood.png", "x" * 300]
        for i, target in enumerate(targets):
            (yard.models / f"link{i}.obj").symlink_to(target)
        (yard.models / "loop-a.obj").symlink_to("loop-b.obj")
        (yard.models / "loop-b.obj").symlink_to("loop-a.obj")
        (yard.models / "linked.mtl").symlink_to("../outside/secret.mtl")
        yard.put("uses-linked.obj", b"mtllib linked.mtl\nusemtl " + SECRET.encode()[:3] + b"\n" + samples.obj(height=3))
        os.mkfifo(yard.models / "pipe.obj")
        (yard.models / "folder.obj").mkdir()
        deep = yard.models
        for _ in range(100):
            deep /= "d"
        deep.mkdir(parents=True)
        (deep / "deep.obj").write_bytes(samples.obj(height=5))
        yard.put_good()
        failures = yard.import_all(embody, wrong, "names, links, sparse files of 1 TiB")
        for name in [f"sparse{i}" for i in range(10)] + ["link0", "link1"]:
            if not any(f"/{name}." in failure["path"] for failure in failures):
                wrong.append(f"{name} was not refused")


def test_archives(embody: str, size: int, chance: random.Random, wrong: list):
    with Yard() as yard:
        number = 0
        for make, extension in attack_archives.CLASSES.items():
            for _ in range(3 * size):
                number += 1
                yard.put(f"{make.__name__}-{number:05}{extension}", make(chance))
            yard.put_good()
        yard.put("millions.zip", attack_archives.millions())
        yard.import_all(embody, wrong, f"{number + 1} archives")


def check_scenes(embody: str, files: list, database: pathlib.Path, wrong: list) -> list:
    """The rows of `embody check`; after a crash each file of the batch is checked alone."""
    done = run([embody, "check", "--json", "--database", str(database), *map(str, files)], [] if len(files) > 1 else wrong, codes=(0, 1))
    if done.returncode in (0, 1):
        return json.loads(done.stdout)["scenes"]
    return [row for file in files for row in check_scenes(embody, [file], database, wrong)] if len(files) > 1 else []


def test_scenes(embody: str, size: int, chance: random.Random, wrong: list):
    with Yard() as yard:
        files = []
        for make in attack_scenes.CLASSES:
            for _ in range(12 * size):
                files.append(yard.put(f"{make.__name__}-{len(files):05}.json", make(chance)))
        rows = []
        for first in range(0, len(files), 50):
            rows += check_scenes(embody, files[first:first + 50], yard.database, wrong)
        right = [row["file"] for row in rows if "error" not in row]
        for row in rows:
            if "error" in row and not (row["error"].startswith(row["file"]) and len(row["error"]) > len(row["file"]) + 5):
                wrong.append(f"a refusal without file or reason: {row['error'][:300]!r}")
        # The other command reports a file that is no scene on standard error.
        refused = [row["file"] for row in rows if "error" in row]
        for file in chance.sample(refused, min(len(refused), 6 * size)):
            run([embody, "simulate", "--database", str(yard.database), "--seconds", "0.01", file], wrong, codes=(1,))
        print(f"  {len(rows)} scenes: {len(right)} right")
        if len(rows) != len(files):
            wrong.append(f"{len(rows)} of {len(files)} scenes were checked")


def test_databases(embody: str, size: int, chance: random.Random, wrong: list):
    with Yard() as yard:
        for _ in range(3):
            yard.put_good()
        yard.import_all(embody, wrong, "a whole database")
        good = yard.database
        scene = yard.path / "scene.json"
        told = 0
        number = len(attack_databases.STATEMENTS) + 12 * size
        for i in range(number):
            database = attack_databases.copy_of(good, yard.path / f"damaged{i}")
            attack_databases.damage(chance, database, i)
            before = database.read_bytes()
            # Start with a command that only reads, because one that writes may repair the database.
            scene.write_text(json.dumps({"embody_scene": 1, "entities": [{"model": f"primitive:box"}]}))
            commands = [["search", "good"], ["show", "good 00001"], ["check", str(scene)], ["set", "--all", "mass=2"], ["history"], ["import", str(yard.models)]]
            chosen = [commands[0], *chance.sample(commands[1:], 2)]
            for command, *words in chosen:
                done = run([embody, command, "--database", str(database), *words], wrong)
                told += done.returncode != 0
                if done.returncode == 1 and "embody: " in done.stderr and len(done.stderr) < 25:
                    wrong.append(f"{i}: {command}: a refusal without a reason: {done.stderr!r}")
            newer = i < len(attack_databases.STATEMENTS) and "user_version = 99" in attack_databases.STATEMENTS[i]
            if newer and database.read_bytes() != before:
                wrong.append("a database of a newer program was changed")
            shutil.rmtree(database.parent)
        print(f"  {number} damaged databases, {3 * number} commands, {told} refusals")


FAKE_WORKER = """#!{python}
import os, sys
sys.path.insert(0, {here!r})
import random, worker_frames as w
chance = random.Random({seed})
out = sys.stdout.buffer
def say(data):
    try:
        out.write(data); out.flush()
    except BrokenPipeError:
        sys.exit(0)
answer = open({answer!r}, "rb").read()
def damaged():
    data = bytearray(answer)
    for _ in range(chance.choice([1, 3, 30])):
        data[chance.randrange(len(data))] = chance.randrange(256)
    return bytes(data[:chance.choice([len(data), chance.randrange(len(data))])])
kind = {kind}
if kind != 0: say(w.frame(w.READY))
if kind > 1: w.read_frame(sys.stdin.buffer)
if kind == 0: say(os.urandom(chance.randrange(1, 5000)))
elif kind == 1: say(w.frame(w.PREPARED, answer) * 3)
elif kind == 2: say(w.frame(chance.choice([0, 2, 6, 99, 1]), answer))
elif kind == 3: say(w.frame(w.PREPARED, answer, checksum=chance.randrange(1 << 64)))
elif kind == 4: say(w.frame(w.PREPARED, answer, length=chance.choice([0xFFFFFFFF, 1 << 28, (1 << 28) + 1, 0, 5])))
elif kind == 5: say(w.frame(w.PREPARED, damaged()))
elif kind == 6: say(w.frame(w.FAILED, w.failed("\\x1b[2J" * 100, "/etc/passwd\\n\\x9b" * 1000)))
elif kind == 7: say(w.frame(w.FAILED, damaged()))
elif kind == 8: say(w.frame(w.OUT_OF_MEMORY, os.urandom(50)))
elif kind == 9: say(bytes(200 << 20))
elif kind == 10: say(w.frame(w.PREPARED, answer, magic=b"EMBX")) if chance.random() < .5 else say(w.frame(w.PREPARED, answer, version=chance.choice([0, 3, 5, 0xFFFFFFFF])))
elif kind == 11: os.kill(os.getpid(), chance.choice([4, 6, 9, 11]))
"""


def test_workers(embody: str, size: int, chance: random.Random, wrong: list):
    """Runs the program with a worker that answers as a hijacked one could."""
    built = pathlib.Path(embody).resolve()
    with Yard() as yard:
        good = yard.put("good.obj", samples.obj())
        answer = yard.path / "answer"
        answer.write_bytes(worker_frames.prepare(built.parent / "embody-import-worker", good))
        place = yard.path / "program"
        place.mkdir()
        try:
            os.link(built, place / "embody")
        except OSError:
            shutil.copy(built, place / "embody")
        worker = place / "embody-import-worker"
        counts: dict = {}
        for i in range(14 * size):
            worker.write_text(FAKE_WORKER.format(python=sys.executable, here=str(pathlib.Path(__file__).resolve().parent), seed=chance.randrange(1 << 30),
                                                 answer=str(answer), kind=i % 12))
            worker.chmod(0o755)
            database = yard.path / "lied.sqlite"
            done = run([str(place / "embody"), "import", "--json", "--again", "--database", str(database), str(good)], wrong, codes=(0, 1, 3))
            counts[done.returncode] = counts.get(done.returncode, 0) + 1
            check_database(embody, database, wrong)
        print(f"  {14 * size} lying workers; exit codes {counts}")


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("embody")
    parser.add_argument("--size", type=int, default=1)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("tests", nargs="*")
    options = parser.parse_args()
    failed = 0
    for name, test in sorted(globals().items()):
        if not name.startswith("test_") or (options.tests and not any(word in name for word in options.tests)):
            continue
        wrong: list = []
        began = time.monotonic()
        print(name.removeprefix("test_").replace("_", " "), flush=True)
        try:
            test(options.embody, options.size, random.Random(options.seed), wrong)
        except Exception as error:
            wrong.append(f"{type(error).__name__}: {error}")
        for line in wrong:
            print("  wrong:", line.encode("utf-8", "backslashreplace").decode(), flush=True)
        print(f"  {time.monotonic() - began:.1f} s", flush=True)
        failed += len(wrong) > 0
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
