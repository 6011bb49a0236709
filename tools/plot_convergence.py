#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws docs/images/convergence.svg from the results of `embody bench convergence --json`. Needs python3-matplotlib.

Usage: embody bench convergence --json | plot_convergence.py PICTURE.svg
"""
import json
import sys

import matplotlib

matplotlib.use("svg")
from matplotlib import pyplot  # noqa: E402  (after the backend is chosen)


def main() -> int:
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    studies = json.load(sys.stdin)["studies"]
    # The same measurements yield the same file.
    matplotlib.rcParams.update({"svg.hashsalt": "embody", "svg.fonttype": "none", "font.size": 8})
    across = 4
    figure, axes = pyplot.subplots(-(-len(studies) // across), across, figsize=(11, 5.2), squeeze=False)
    for study, axis in zip(studies, axes.flat):
        resolutions = [row["resolution"] for row in study["rows"]]
        errors = [100 * abs(row["error"]) for row in study["rows"]]
        axis.loglog(resolutions, errors, "o-", color="#2563eb", markersize=4)
        # Second order through the first point, as a reference slope.
        second = [errors[0] * (resolutions[0] / n) ** 2 for n in resolutions]
        axis.loglog(resolutions, second, ":", color="#9ca3af")
        axis.set_xticks(resolutions, [str(n) for n in resolutions])
        axis.minorticks_off()
        axis.set_title(study["study"].replace("_", " "))
        axis.set_xlabel(study["resolution"])
        axis.set_ylabel("error, %")
        axis.grid(True, color="#e5e7eb")
    for axis in list(axes.flat)[len(studies):]:
        axis.remove()
    figure.tight_layout()
    figure.savefig(sys.argv[1], metadata={"Date": None})
    return 0


if __name__ == "__main__":
    sys.exit(main())
