#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Imports the real catalogues of this machine with the program itself and checks the result.

Usage: import_real_models.py EMBODY CATALOGUES.txt DATABASE
The database stays for the tests of the Studio.
"""
import json
import pathlib
import subprocess
import sys


def run(*words: str) -> subprocess.CompletedProcess:
    return subprocess.run(words, stdout=subprocess.PIPE, text=True)


def main() -> int:
    embody, listing, database = sys.argv[1:4]
    if not pathlib.Path(listing).is_file():
        print(f"{listing} is missing: ./test writes it")
        return 1
    catalogues = pathlib.Path(listing).read_text().split("\n")
    catalogues = [c for c in catalogues if c]
    if not catalogues:
        print("no catalogue of real models on this machine; install sweethome3d-furniture")
        return 1
    imported = run(embody, "import", "--database", database, "--json", *catalogues)
    report = json.loads(imported.stdout)
    print(f"import: {({k: v for k, v in report.items() if k != 'failures'})}, {len(report['failures'])} failures")
    for failure in report["failures"]:
        print("  failed:", failure["path"], failure["why"])
    done = report["added"] + report["updated"] + report["unchanged"]
    wrong = []
    if done < 0.99 * (done + len(report["failures"])):
        wrong.append("more than 1 % of the models could not be read")
    if imported.returncode != (3 if report["failures"] else 0):
        wrong.append(f"exit code {imported.returncode}")

    # The same catalogues again: nothing is added, nothing is there twice.
    again = json.loads(run(embody, "import", "--database", database, "--json", catalogues[0]).stdout)
    if again["added"] or again["updated"]:
        wrong.append(f"a second import added {again['added']} and updated {again['updated']} models")

    found = json.loads(run(embody, "search", "--database", database, "--limit", "5", "--json", "chair").stdout)
    if found["total"] < 20:
        wrong.append(f"only {found['total']} chairs")
    shown = json.loads(run(embody, "show", "--database", database, "--json", str(found["models"][0]["id"])).stdout)
    attributes = {a["name"]: a for a in shown["attributes"]}
    for name in ("kind", "mass", "friction_static", "restitution", "collision_shape"):
        if name not in attributes or not attributes[name]["source"]:
            wrong.append(f"a chair has no {name} with a source")
    if not 1 <= attributes["mass"]["value"] <= 40:
        wrong.append(f"a chair of {attributes['mass']['value']} kg")
    for line in wrong:
        print("wrong:", line)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
