#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The automatic attributes of real models and real objects reach their goals: `embody evaluate`.

Usage: attributes_hold.py EMBODY DATABASE REFERENCE_FOLDER
REFERENCE_FOLDER holds mass-held-out-dev.csv and mass-market-dev.csv. The sealed half is for judging, not for tests: a failure here gets
corrected, and data that corrections were made by are no longer held out.
"""
import json
import pathlib
import subprocess
import sys


def main() -> int:
    embody, database, reference = sys.argv[1:]
    wrong = []

    def evaluate(*words: str) -> dict:
        done = subprocess.run([embody, "evaluate", *words, "--json"], stdout=subprocess.PIPE, text=True, check=True)
        return json.loads(done.stdout)

    def hold(what: str, value: float, low: float, high: float) -> None:
        print(f"{what}: {value:.4g} (from {low:g} to {high:g})")
        if not low <= value <= high:
            wrong.append(f"{what} is {value:.4g}, not from {low:g} to {high:g}")

    # Masses of measured objects.
    truth = str(pathlib.Path(reference) / "mass-held-out-dev.csv")
    masses = evaluate("mass", "--truth", truth)["all"]
    hold("mass ALDE", masses["alde"], 0, 0.55)
    hold("mass MnRE", masses["mnre"], 0.65, 1)
    hold("mass within a factor 2", masses["within_factor_2"], 0.72, 1)
    hold("coverage of 80 % intervals", masses["coverage_80"], 0.75, 0.85)

    # Goods of market places under sales texts: worse than the goal, but not worse than they were.
    market = str(pathlib.Path(reference) / "mass-market-dev.csv")
    goods = evaluate("mass", "--truth", market)["all"]
    hold("mass ALDE of market goods", goods["alde"], 0, 0.7)
    hold("coverage of their 80 % intervals", goods["coverage_80"], 0.75, 0.85)

    # Flags of the catalogue itself.
    catalogue = evaluate("catalogue", "--database", database)
    hold("models", catalogue["models"], 800, 1e6)
    hold("category better than default", catalogue["above_default"], 0.97, 1)
    hold("static or movable as the catalogue says", catalogue["movable"]["agreement"], 0.92, 1)
    hold("models with a density sum", catalogue["density_sum"]["models"], 800, 1e6)
    hold("median density sum over mass", catalogue["density_sum"]["median_ratio"], 0.8, 1.25)
    hold("models that contradict themselves", len(catalogue["broken"]), 0, 0)

    # Behaviour in the simulation.
    behaviour = evaluate("behaviour", "--database", database)
    hold("models simulated", behaviour["models"], 600, 1e6)
    hold("models that could not be", len(behaviour["failures"]), 0, 0)

    def share(name: str) -> float:
        return 1 - len(behaviour[name]["wrong"]) / behaviour[name]["judged"]

    hold("mass is the attribute's", share("mass"), 1, 1)
    hold("at rest after 5 s", share("at_rest"), 0.97, 1)
    hold("furniture stands", share("furniture_stands"), 0.93, 1)
    hold("slides judged", behaviour["slide"]["judged"], 250, 1e6)
    hold("stopping distance follows from friction", share("slide"), 0.99, 1)
    hold("rebounds judged", behaviour["rebound"]["judged"], 100, 1e6)
    hold("rebound follows from restitution", share("rebound"), 0.98, 1)

    for line in wrong:
        print("wrong:", line)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
