#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the seeds of the fuzz targets: small whole files of everything that is read. Files of the corpus with other names (what a target
once failed on) stay.

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
    """The payload of a prepared model, its picture of 256 × 256 exchanged for a small one."""
    geometry_end = 8 + int.from_bytes(model[:8], "little")
    picture_end = geometry_end + 8 + int.from_bytes(model[geometry_end:geometry_end + 8], "little")
    picture = samples.png()
    return model[:geometry_end] + len(picture).to_bytes(8, "little") + picture + model[picture_end:]


def scenes():
    """The smallest of the demos; everything.json beside them is what tests/scene/sample_documents.cpp calls `everything`."""
    for file in (HERE.parent.parent / "data/scenes").glob("*.json"):
        if file.stat().st_size < 5000:
            put("scene", file.name, file.read_bytes())


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
    stored(embody)
    return 0


if __name__ == "__main__":
    sys.exit(main())
