# SPDX-License-Identifier: MIT
"""Generated hostile scene files, as text: duplicate fields, deep nesting, numbers out of range, lone surrogates, bytes 0, endless lists."""
import json
import pathlib
import random

from attack_models import JSON_NUMBERS, any_place, damaged

SCENES = pathlib.Path(__file__).resolve().parents[2] / "data/scenes"
WHOLE = [file.read_text() for file in sorted(SCENES.glob("*.json")) if file.stat().st_size < 12_000 and '"model"' not in file.read_text()]
WHOLE.append((pathlib.Path(__file__).resolve().parents[1] / "fuzz/corpus/scene/everything.json").read_text())


def whole(chance: random.Random) -> dict:
    return json.loads(chance.choice(WHOLE))


def numbers(chance: random.Random) -> bytes:
    document = whole(chance)
    for _ in range(chance.randrange(1, 4)):
        inside, key = any_place(chance, document, (int, float))
        inside[key] = f"@{chance.choice(JSON_NUMBERS)}@"
    text = json.dumps(document)
    for number in JSON_NUMBERS:
        text = text.replace(json.dumps(f"@{number}@"), number)
    return text.encode()


def fields(chance: random.Random) -> bytes:
    """Fields exchanged, removed, misspelled, or of another type."""
    document = whole(chance)
    for _ in range(chance.randrange(1, 3)):
        inside, key = any_place(chance, document)
        way = chance.randrange(4)
        if way == 0 and isinstance(inside, dict):
            inside[chance.choice(["", key + "s", "\x1b[2J", "__proto__", "x" * 100_000])] = inside.pop(key)
        elif way == 1:
            del inside[key]
        elif way == 2:
            inside[key] = chance.choice([[], {}, None, True, "", "\u202e", [[]] * 50, [0] * 100_000, {"type": "box"}])
        else:
            other, place = any_place(chance, document)
            inside[key] = json.loads(json.dumps(other[place]))
    return json.dumps(document).encode()


def twice(chance: random.Random) -> bytes:
    text = chance.choice(WHOLE)
    at = chance.choice([i for i, c in enumerate(text) if c == "{"])
    name = chance.choice(['"index": 1, "index": 2, ', '"\\u0061": 1, "a": 1, ', '"embody_scene": 1, '])
    return (text[:at + 1] + name + text[at + 1:]).encode()


def deep(chance: random.Random) -> bytes:
    depth = chance.choice([60, 64, 65, 10_000, 1_000_000])
    opening, closing = chance.choice([("[", "]"), ('{"a":', "}"), ("[{\"entities\":", "}]")])
    return ('{"embody_scene": 1, "entities": ' + opening * depth + chance.choice(["", closing * depth]) + "}").encode()


def many(chance: random.Random) -> bytes:
    """Huge lists, and many entities that refer to each other or to nothing."""
    way = chance.randrange(4)
    if way == 0:
        return ('{"embody_scene": 1, "entities": [' + "{}," * 200_000 + "{}]}").encode()
    if way == 1:
        return json.dumps({"embody_scene": 1, "entities": [{"index": 1, "shape": {"type": "sphere", "radius": 1}}] * 3000}).encode()
    if way == 2:
        balls = [{"index": i, "shape": {"type": "sphere", "radius": 0.1}, "pose": {"position": [i, 1, 0]}} for i in range(1, 50)]
        joints = [{"index": i, "type": "ball", "a": chance.randrange(60), "b": chance.randrange(60), "anchor": [0, 0, 0]} for i in range(1, 50)]
        return json.dumps({"embody_scene": 1, "entities": balls, "joints": joints}).encode()
    return json.dumps({"embody_scene": 1, "entities": [{"shape": {"type": "convex", "points": [[0, 0, 0]] * 20_000}}]}).encode()


def texts(chance: random.Random) -> bytes:
    """Invalid text in the place of a text."""
    bad = chance.choice([b'"\\ud800"', b'"\\udfff\\ud800"', b'"\xff"', b'"\xc0\x80"', b'"\xed\xa0\x80"', b'"a\0b"', b'"\\u0000"', b'"\x1b[2J"', b'"\\u202e"', b'"' + b"x" * 5_000_000 + b'"'])
    return b'{"embody_scene": 1, "title": ' + bad + b', "entities": [{"index": 1, "name": ' + bad + b', "shape": {"type": "box", "half_extents": [1, 1, 1]}}]}'


def tails(chance: random.Random) -> bytes:
    """Text after the end or before the beginning."""
    text = chance.choice(WHOLE).encode()
    bad = chance.choice([b"\0", b"\0]", b"\0\"", b"}", b"]]]]", b"\xef\xbb\xbf", b"\xff\xfe", b"//", b"{}", b"\0" * 100_000, b'\\"'])
    return bad + text if chance.random() < 0.3 else text + bad


def references(chance: random.Random) -> bytes:
    """Names of models that do not exist."""
    name = chance.choice(["../../etc/passwd", "file:../outside/secret.obj", "primitive:", "primitive:box", "file:0000", "", "\x1b[2J", "a" * 100_000, "'; DROP TABLE model; --"])
    return json.dumps({"embody_scene": 1, "entities": [{"index": 1, "model": name}]}).encode()


def changed(chance: random.Random) -> bytes:
    return damaged(chance, chance.choice(WHOLE).encode())


CLASSES = [numbers, fields, twice, deep, many, texts, tails, references, changed]
