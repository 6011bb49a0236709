#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What a server sends to one viewer, by scene: while things move, and when as much as can has come to rest.

Usage: measure_streaming.py EMBODY DATABASE SCENE.json…    prints a table in Markdown (docs/protocol.md)

Rates are per second of simulated time, so that a slow computer changes nothing; who plays in real time gets as much in a second.
"""
import pathlib
import sys
import time

from viewer import HEAD, Server, Viewer

MOVING_S, REST_STEPS, RESTING_S = 4, 1500, 4


def play(viewer: Viewer, seconds: float) -> dict:
    """Plays for so long and counts what comes."""
    viewer.do("simulation.play")
    frames, texts, sets, first, last, statistics = [], 0, 0, None, None, {}
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        message = viewer.read()
        if isinstance(message, bytes):
            head = HEAD.unpack_from(message)
            frames.append(len(message))
            sets += head[4]
        else:
            texts += len(str(message))
            if message.get("event") == "statistics":
                statistics = message
                first = message["time"] if first is None else first
                last = message["time"]
    viewer.do("simulation.pause")
    simulated = max((last or 0) - (first or 0), 1e-9)
    return {"frames": len(frames), "frame": sum(frames) / max(len(frames), 1), "rate": (sum(frames) + texts) / simulated,
            "texts": texts / simulated, "statistics": statistics}


def main() -> int:
    embody, database, *scenes = sys.argv[1:]
    print("| scene | things, points | moving: a frame | a second | at rest: a second | still active | memory at most |")
    print("|---|---|---|---|---|---|---|")
    for scene in scenes:
        with Server(embody, database, scene) as server:
            viewer = Viewer(server.port)
            viewer.do("hello")
            moving = play(viewer, MOVING_S)
            viewer.do("simulation.step", count=REST_STEPS)
            resting = play(viewer, RESTING_S)
            now = resting["statistics"]
            print(f"| {pathlib.Path(scene).stem} | {now['things']}, {now['points']:,} | {moving['frame'] / 1e3:.1f} kB | {moving['rate'] / 1e6:.2f} MB"
                  f" | {resting['rate'] / 1e3:.1f} kB | {now['active'] + now['wants_to_sleep']} | {server.memory(peak=True) >> 20} MiB |", flush=True)
            viewer.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())
