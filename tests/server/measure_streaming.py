#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Measures the bytes that a server sends to one viewer, by scene: while bodies move, and after all that can has come to rest.

Usage: measure_streaming.py EMBODY DATABASE SCENE.json…    prints a table in Markdown (docs/protocol.md)

A second with moving bodies is 60 frames, one for each step, however slow this computer is; at rest it is a second of simulated time.
"""
import pathlib
import sys
import time

from viewer import Server, Viewer

MOVING_S, RESTING_S, MOST_WAITED_S = 4, 4, 90


def play(viewer: Viewer, seconds: float) -> dict:
    """Plays for this time and counts the received bytes."""
    viewer.do("simulation.play")
    frames, texts, first, last, statistics = [], 0, None, None, {}
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        message = viewer.read()
        if isinstance(message, bytes):
            frames.append(len(message))
        else:
            texts += len(str(message))
            if message.get("event") == "statistics":
                statistics = message
                first = message["time"] if first is None else first
                last = message["time"]
    viewer.do("simulation.pause")
    simulated = max((last or 0) - (first or 0), 1e-9)
    return {"frame": sum(frames) / max(len(frames), 1), "rate": (sum(frames) + texts) / simulated, "statistics": statistics}


def wait_for_rest(viewer: Viewer):
    """Steps until nothing is active any more, or until the time limit."""
    until = time.monotonic() + MOST_WAITED_S
    while time.monotonic() < until:
        viewer.do("simulation.step", count=60)
        viewer.do("simulation.play")
        while not (isinstance(message := viewer.read(), dict) and message.get("event") == "statistics"):
            pass
        viewer.do("simulation.pause")
        if message["active"] + message["wants_to_sleep"] == 0:
            return


def main() -> int:
    embody, database, *scenes = sys.argv[1:]
    print("| scene | things, points | moving: a frame | a second | at rest: a second | still active | memory at most |")
    print("|---|---|---|---|---|---|---|")
    for scene in scenes:
        with Server(embody, database, scene) as server:
            viewer = Viewer(server.port)
            viewer.do("hello")
            moving = play(viewer, MOVING_S)
            wait_for_rest(viewer)
            resting = play(viewer, RESTING_S)
            now = resting["statistics"]
            print(f"| {pathlib.Path(scene).stem} | {now['things']}, {now['points']:,} | {moving['frame'] / 1e3:.1f} kB | {60 * moving['frame'] / 1e3:,.0f} kB"
                  f" | {resting['rate'] / 1e3:.1f} kB | {now['active'] + now['wants_to_sleep']} | {server.memory(peak=True) >> 20} MiB |", flush=True)
            viewer.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())
