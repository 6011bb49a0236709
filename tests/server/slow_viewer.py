#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A viewer that reads nothing misses frames; the server does not keep them for it, and other viewers receive everything.

Usage: slow_viewer.py EMBODY
"""
import json
import pathlib
import struct
import sys
import tempfile

from viewer import HEAD, Server, Viewer

MOVES = 600
# Grains that are moved by a command: each time all of them have moved, without a step of the simulation.
SCENE = {
    "embody_scene": 1,
    "title": "Carried",
    "entities": [{"index": 1, "shape": {"type": "box", "half_extents": [0.3, 0.2, 0.3]}, "attributes": {"kind": "granular", "grain_budget": 4000}}],
}


def place_of(frame: bytes) -> float:
    """The distance that its first entity was moved by."""
    return struct.unpack_from("<f", frame, HEAD.size + 4)[0] if HEAD.unpack_from(frame)[3] else 0.0


def main() -> int:
    embody = sys.argv[1]
    wrong = []
    with tempfile.TemporaryDirectory() as folder:
        scene = pathlib.Path(folder) / "carried.json"
        scene.write_text(json.dumps(SCENE))
        with Server(embody, str(pathlib.Path(folder) / "models.sqlite"), str(scene)) as server:
            slow = [Viewer(server.port, buffer=1 << 16) for _ in range(8)]
            quick = Viewer(server.port)
            quick.do("hello")
            before = server.memory()
            sent = frames = 0
            for move in range(1, MOVES + 1):
                quick.ask("entity.transform", poses=[{"index": 1, "position": [move, 0, 0]}], merge="carried")
                while not (isinstance(message := quick.read(), bytes) and place_of(message) == move):
                    pass
                sent, frames = sent + len(message), frames + 1
            grown = server.memory() - before
            missed = sent * len(slow)
            print(f"{frames} frames, {sent / 1e6:.0f} MB to the quick viewer; the server grew by {grown / 1e6:.1f} MB with {len(slow)} that read nothing")
            if sent < 10e6:
                wrong.append(f"only {sent} bytes were sent: this test says nothing")
            # The server keeps the current frame for each viewer; other growth is not caused by them.
            if grown > 0.5 * missed:
                wrong.append(f"the server grew by {grown} bytes while {len(slow)} viewers missed {missed} in all")
            # A slow viewer that starts to read receives the present state after the few frames that were being sent.
            for viewer in slow:
                seen = []
                while not seen or seen[-1] < MOVES:
                    message = viewer.read()
                    if isinstance(message, bytes):
                        seen.append(place_of(message))
                if len(seen) > MOVES // 2:
                    wrong.append(f"a slow viewer was sent {len(seen)} of {MOVES} frames: they were queued")
                viewer.close()
            print(f"a slow viewer was sent {len(seen)} frames")
            quick.close()
    for line in wrong:
        print("wrong:", line)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
