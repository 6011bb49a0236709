# SPDX-License-Identifier: MIT
"""Checks the form of the held-out masses: columns, numbers, sources, licences, and that the halves follow their rule.

    check_mass_held_out.py FOLDER
"""

import csv
import hashlib
import math
import pathlib
import sys

COLUMNS = (
    "id name category dim_x_m dim_y_m dim_z_m mesh mesh_volume_m3 mass_kg mass_kind source licence note".split()
)
SIZES = ("dim_x_m", "dim_y_m", "dim_z_m")
TABLES = (("held-out", 250, 6), ("market", 600, 2))  # name, minimum number of objects and of sources
FITTED_SOURCES = {"abid", "ansur", "car", "fish", "fruit", "wands", "ycb"}
LEAST_BULK_DENSITY, GREATEST_BULK_DENSITY = 1.0, 23000.0  # kg/m3; osmium has 22,600


def half_of(identifier):
    """The half that an id belongs to: "dev" where the first byte of its SHA-256 is even, else "sealed"."""
    return "dev" if hashlib.sha256(identifier.encode()).digest()[0] % 2 == 0 else "sealed"


def complaints_about(row, half):
    for column in ("id", "name", "category", "source", "licence"):
        if not row[column].strip():
            yield f"{column} is empty"
    if ":" not in row["id"]:
        yield "the id is not source:number"
    if row["id"].split(":")[0] in FITTED_SOURCES:
        yield "its source is one that masses may be fitted to"
    if row["mass_kind"] not in ("object", "packaged item"):
        yield f"mass_kind is '{row['mass_kind']}', neither 'object' nor 'packaged item'"
    if half_of(row["id"]) != half:
        yield f"belongs to the half '{half_of(row['id'])}'"
    try:
        numbers = [float(row[column]) for column in (*SIZES, "mass_kg")]
    except ValueError as error:
        yield str(error)
        return
    if not all(math.isfinite(number) and number > 0 for number in numbers):
        yield "sizes and mass must be finite and positive"
        return
    density = numbers[3] / math.prod(numbers[:3])
    if not LEAST_BULK_DENSITY <= density <= GREATEST_BULK_DENSITY:
        yield f"mass / box is {density:.4g} kg/m3"


def rows_of(path, half, complaints):
    with open(path, encoding="utf-8", newline="") as file:
        reader = csv.DictReader(file)
        if reader.fieldnames != COLUMNS:
            complaints.append(f"{path.name}: columns are {reader.fieldnames}, wanted {COLUMNS}")
            return
        for row in reader:
            if None in row or None in row.values():
                complaints.append(f"{path.name}: line {reader.line_num} has not {len(COLUMNS)} fields")
                continue
            complaints += [f"{path.name}: {row['id']}: {text}" for text in complaints_about(row, half)]
            yield row


def main():
    folder = pathlib.Path(sys.argv[1])
    complaints, seen = [], set()
    for table, least_objects, least_sources in TABLES:
        rows = []
        for half in ("dev", "sealed"):
            rows += rows_of(folder / f"mass-{table}-{half}.csv", half, complaints)
        for row in rows:
            if row["id"] in seen:
                complaints.append(f"{row['id']} is there twice")
            seen.add(row["id"])
        sources = {row["id"].split(":")[0] for row in rows}
        if len(rows) < least_objects:
            complaints.append(f"{table}: {len(rows)} objects, wanted {least_objects} or more")
        if len(sources) < least_sources:
            complaints.append(f"{table}: {len(sources)} sources, wanted {least_sources} or more")
        print(f"{table}: {len(rows)} objects of {len(sources)} sources")
    for complaint in complaints:
        print(complaint)
    print(f"{len(complaints)} complaints")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
