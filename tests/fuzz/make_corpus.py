#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the seeds of the fuzz targets: small valid files of every format that is read. Files of the corpus with other names (on which a
target once failed) stay.

Usage: make_corpus.py EMBODY   (the built program; its worker lies beside it)
"""
import json
import pathlib
import sqlite3
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "attacks"))
import sample_files as samples
import worker_frames
import zip_files

CATALOGUE = r"""id=sample
name=Sample \u00e9
id#1=sample\#chair
name#1=Chair
tags#1=seat, wood
category#1=Kitchen
icon#1=/chair/chair.png
model#1=/chair/chair.obj
width#1=50
depth#1=60.5
height#1=1.1e2
movable#1=true
modelRotation#1=1 0 0 0 0 1 0 -1 0
id#2=sample\#door
name#2=Door
category#2=Doors
icon#2=/door.png
model#2=/door.obj
width#2=91
depth#2=10
height#2=208
movable#2=false
doorOrWindow#2=true
"""


def archives() -> dict[str, bytes]:
    member = zip_files.Member
    return {
        "catalogue.sh3f": zip_files.build([member(b"PluginFurnitureCatalog.properties", CATALOGUE.encode()), member(b"chair/chair.obj", samples.obj()),
                                           member(b"chair/chair.png", samples.png()), member(b"door.obj", samples.obj(), packed=False)]),
        "plain.zip": zip_files.build([member(b"a.obj", samples.obj("b")), member(b"b.mtl", samples.mtl("wood.png"))], comment=b"sample"),
        "names.zip": zip_files.build([member("caf\u00e9.obj".encode("cp437"), samples.obj()), member("стол.obj".encode(), samples.obj(), flags=0x800),
                                      member(b"../out.obj", samples.obj()), member(b"c:\\x.obj", samples.obj()), member(b"folder/")]),
        "many.zip": zip_files.of_many_entries(20),
        "list.properties": CATALOGUE.encode()}


def put(target: str, name: str, content: bytes):
    folder = HERE / "corpus" / target
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_bytes(content)


def with_small_picture(model: bytes) -> bytes:
    """The payload of a prepared model, with a small picture in place of the one of 256 × 256."""
    geometry_end = 8 + int.from_bytes(model[:8], "little")
    picture_end = geometry_end + 8 + int.from_bytes(model[geometry_end:geometry_end + 8], "little")
    picture = samples.png()
    return model[:geometry_end] + len(picture).to_bytes(8, "little") + picture + model[picture_end:]


def scenes():
    """The smallest of the demo scenes; everything.json beside them is what tests/scene/sample_documents.cpp calls `everything`."""
    for file in (HERE.parent.parent / "data/scenes").glob("*.json"):
        if file.stat().st_size < 5000:
            put("scene", file.name, file.read_bytes())


def worlds():
    """Programs for tests/fuzz/targets/world.cpp: a byte for each call, as listed there, then the bytes of its choices."""
    step, shape, body, joint, deform, pour, place, push, change, several, switch, destroy, destroy_else = 0, 1, 2, 4, 5, 6, 8, 9, 10, 11, 12, 13, 14
    change_joint, change_deformable, hold, nodes, change_fluid, move_fluid, settings, ask, ground = range(15, 24)
    run = [step, 7] * 3
    ball, box, hull = [shape, 4, 0, 60], [shape, 4, 1, 80, 40, 80], [shape, 4, 5, 3] + [0, 0, 0, 239, 0, 0, 0, 239, 0, 0, 0, 239, 200, 200, 200, 120, 120, 10]
    at = lambda x, y, z: [body, 0, 1, 1, x, y, z]
    sheet, disc, rope, solid = [deform, 0, 90, 90, 0], [deform, 1, 60, 0], [deform, 2, 120, 8, 0], [deform, 3, 40, 40, 40, 1, 1, 1, 0]
    water = [pour, 180, 0, 60, 130, 60, 150, 100, 150, 0]
    programs = {
        "stack": [ground, 3] + run * 2 + [ask, 120, 239, 120, 120, 0, 120, 0, 239] + run + [destroy, 1, 1] + run,
        "shapes": [ground, 0] + ball + at(100, 200, 120) + box + at(140, 200, 120) + hull + at(120, 239, 140) +
                  [shape, 4, 2, 20, 40] + at(60, 200, 120) + [shape, 4, 3, 40, 20] + at(180, 200, 120) + [shape, 4, 4, 60, 60] + at(120, 220, 60) + run * 3,
        "field": [shape, 1, 4, 4, 100, 100] + [120, 10] * 8 + [body, 0, 2, 0, 0, 1, 0, 0, 0] + ball + at(160, 200, 160) + run * 2,
        "compound": [ground, 0] + [shape, 3, 2, 0, 60, 60, 120, 120, 0, 0, 0, 0, 1, 40, 40, 40, 180, 120, 120, 0, 0, 0, 0] + at(120, 200, 120) + run * 2,
        "chain": ball + at(120, 200, 120) + at(160, 200, 120) + [joint, 255, 1, 1, 4, 120, 200, 120, 0, 0, 0, 0] + [joint, 0, 1, 2, 2, 1, 60, 200, 1, 200, 100, 5, 60, 120, 120, 0, 0, 0, 0] +
                 run + [change_joint, 0, 0, 0, 1, 3, 1, 0, 239, 0] + run + [push, 0, 2, 200, 10, 100, 120, 120, 120, 1] + run,
        "sheet": [ground, 2] + sheet + [0] + run + [hold, 0, 0, 3, 0, 120, 120, 120] + run + [nodes, 0, 0, 1, 3, 120, 239, 120, 200, 120, 120] + run,
        "rope": [ground, 1] + rope + [1, 0, 0, 0, 120, 120, 120] + run + [change_deformable, 0, 0, 1, 0, 6, 1] + run,
        "ties": solid + [0] + disc + [1, 2, 100, 120, 160, 0, 4] + run * 2,
        "water": [ground, 2] + water + [1, 0, 0] + run + ball + at(120, 200, 120) + run + [move_fluid, 0, 2, 255, 10, 100] + run + [move_fluid, 0, 0, 3] + [120, 150, 120] * 3 + run,
        "storm": [settings, 3, 200, 100, 50, 1, settings, 4, 120, 1] + sheet + [0, change_deformable, 0, 0, 1, 1, 0] + run + [settings, 1, 239, 0] + run,
        "asleep": [ground, 1] + [settings, 8, 0, 0] + run * 2 + [switch, 0, 1] + run + [place, 0, 120, 200, 120, 0, 0, 0, 0] + run + [several, 2, 0, 1, 1, 4, 120, 239, 120, 1, 3, 120, 120, 120] + run,
        "refused": [body, 7, 0] + ball + [body, 0, 1, 1, 253, 0, 0] + at(120, 120, 120) + [push, 0, 0, 253, 254, 255, 0, 0, 0, 0] + [destroy_else, 0, 0] + [change, 0, 3, 1, 5, 1, 248] + [change_fluid, 0, 2, 0] + run,
    }
    for name, program in programs.items():
        put("world", name, bytes([1] + program))


def stored(embody: str):
    with tempfile.TemporaryDirectory() as folder:
        models = pathlib.Path(folder) / "models"
        models.mkdir()
        (models / "plain.obj").write_bytes(samples.obj())
        (models / "textured.obj").write_bytes(samples.obj("wood", 2))
        (models / "wood.mtl").write_bytes(samples.mtl("wood.png"))
        (models / "wood.png").write_bytes(samples.png())
        database = pathlib.Path(folder) / "models.sqlite"
        subprocess.run([embody, "import", "--database", str(database), str(models)], check=True, capture_output=True)
        connection = sqlite3.connect(database)
        rows = connection.execute("SELECT key, compact FROM stored_geometry JOIN model_geometry AS g ON g.geometry = stored_geometry.id"
                                  " JOIN model ON model.id = g.model WHERE key LIKE 'file:%' OR key = 'primitive:box' ORDER BY length(compact)").fetchall()
        connection.close()
        assert len(rows) >= 2, rows
        for number, (_, compact) in enumerate(rows):
            put("stored_geometry", f"{number}.glb", compact)
        worker = pathlib.Path(embody).resolve().parent / "embody-import-worker"
        answers = [worker_frames.prepare(worker, models / name) for name in ("plain.obj", "textured.obj")]
    for number, answer in enumerate(answers):
        put("worker_protocol", f"model{number}", b"\0" + with_small_picture(answer))
    item = worker_frames.item("/models/chair.obj")
    error = worker_frames.failed("chair.obj", "is empty")
    put("worker_protocol", "item", b"\1" + item)
    put("worker_protocol", "error", b"\2" + error)
    put("worker_protocol", "frames", b"\3" + worker_frames.frame(worker_frames.READY) + worker_frames.frame(worker_frames.ITEM, item) +
        worker_frames.frame(worker_frames.FAILED, error))


def main() -> int:
    embody = sys.argv[1]
    for name, content in archives().items():
        put("archive", name, content)
    for name, make in samples.IMAGES.items():
        put("image", name, make())
    for name, make in samples.MODELS.items():
        kind = pathlib.Path(name).suffix[1:]
        put({"ac": "ac3d"}.get(kind, kind), name, make())
        if kind == "ply":
            put("prepare", name, make())
    put("obj", "textured.obj", samples.obj("wood"))
    put("ac3d", "textured.ac", samples.ac3d("wood.png"))
    put("glb", "picture.glb", samples.glb(samples.gltf_document(None, samples.png())))
    scenes()
    worlds()
    stored(embody)
    return 0


if __name__ == "__main__":
    sys.exit(main())
