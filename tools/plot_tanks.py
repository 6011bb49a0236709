#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws docs/images/tanks.svg from the results of `embody bench tanks --json`. Needs python3-matplotlib.

Usage: embody bench tanks --json | plot_tanks.py PICTURE.svg
"""
import json
import sys
import textwrap

import matplotlib

matplotlib.use("svg")
from matplotlib import pyplot  # noqa: E402  (after the backend is chosen)


def main() -> int:
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    tanks = json.load(sys.stdin)["tanks"]
    # The same measurements yield the same file.
    matplotlib.rcParams.update({"svg.hashsalt": "embody", "svg.fonttype": "none", "font.size": 8})
    figure, axes = pyplot.subplots(1, len(tanks) + 1, figsize=(11, 2.6), squeeze=False)
    for tank, axis in zip(tanks, axes.flat):
        times = [moment[0] for moment in tank["moments"]]
        axis.plot(times, [moment[1] for moment in tank["moments"]], color="#2563eb")
        axis.set_title(textwrap.fill(tank["what"], 30))
        axis.set_ylabel("energy above rest, J")
        axis.set_ylim(bottom=0)
    free = next(tank for tank in tanks if tank["tank"] == "free")
    last = axes.flat[len(tanks)]
    first = free["moments"][0][3]
    last.plot([moment[0] for moment in free["moments"]], [moment[3] / first for moment in free["moments"]], color="#2563eb")
    last.set_title(textwrap.fill("the tank in space: its angular momentum", 30))
    last.set_ylabel("over the first")
    last.set_ylim(0, 1.1)
    for axis in axes.flat:
        axis.set_xlabel("s")
        axis.grid(True, color="#e5e7eb")
    figure.tight_layout()
    figure.savefig(sys.argv[1], metadata={"Date": None})
    return 0


if __name__ == "__main__":
    sys.exit(main())
