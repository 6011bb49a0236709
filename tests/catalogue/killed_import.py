#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""An import of real models that is killed again and again loses nothing and is completed.

Usage: killed_import.py EMBODY CATALOGUES.txt [KILLS [SEED]]
Takes the smallest catalogue, kills the import with its workers at random times, and checks after each kill that the
database is intact and that every model that was there is still there, unchanged.
"""
import os
import pathlib
import random
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time


def models(database: pathlib.Path) -> dict[str, int]:
    """Key and hash of the geometry of each imported model; fails on a damaged database or a model without its parts."""
    if not database.is_file():
        return {}
    connection = sqlite3.connect(database)
    try:
        if not connection.execute("PRAGMA user_version").fetchone()[0]:
            return {}
        assert connection.execute("PRAGMA integrity_check").fetchone() == ("ok",)
        assert connection.execute("PRAGMA foreign_key_check").fetchone() is None
        whole = connection.execute(
            "SELECT key, geometry_hash FROM model JOIN model_geometry AS g ON g.model = id"
            " JOIN model_thumbnail AS t ON t.model = id JOIN model_knowledge AS k ON k.model = id"
            " WHERE key NOT LIKE 'primitive:%'").fetchall()
        count = connection.execute("SELECT count(*) FROM model WHERE key NOT LIKE 'primitive:%'").fetchone()[0]
        assert len(whole) == count, f"{count - len(whole)} models lack a part"
        sources = connection.execute("SELECT count(DISTINCT model) FROM import_source").fetchone()[0]
        assert sources >= count, "a model without a note of where it came from"
        return dict(whole)
    finally:
        connection.close()


def main() -> int:
    embody, listing = sys.argv[1:3]
    kills = int(sys.argv[3]) if len(sys.argv) > 3 else 10
    chance = random.Random(int(sys.argv[4]) if len(sys.argv) > 4 else 4)
    catalogues = [c for c in pathlib.Path(listing).read_text().split("\n") if c]
    if not catalogues:
        print("no catalogue of real models on this machine; install sweethome3d-furniture")
        return 1
    catalogue = min(catalogues, key=lambda c: pathlib.Path(c).stat().st_size)
    with tempfile.TemporaryDirectory() as folder:
        database = pathlib.Path(folder) / "models.sqlite"
        command = [embody, "import", "--database", str(database), catalogue]
        before: dict[str, int] = {}
        killed = 0
        for _ in range(kills):
            running = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(chance.choice([0.05, 0.3, 1.0, 2.5]) * chance.random())
            if running.poll() is None:
                os.kill(running.pid, signal.SIGKILL)
                killed += 1
            running.wait()
            after = models(database)
            lost = {key for key, value in before.items() if after.get(key) != value}
            if lost:
                print(f"lost by a kill: {sorted(lost)}")
                return 1
            before = after
            print(f"killed: {killed}, models: {len(after)}")
        ended = subprocess.run(command, stdout=subprocess.PIPE, text=True)
        end = models(database)
        print(ended.stdout.strip())
        if ended.returncode not in (0, 3) or any(end.get(key) != value for key, value in before.items()):
            print(f"the last import ended with {ended.returncode}, or changed what was there")
            return 1

        # The result equals that of an import without kills.
        undisturbed = pathlib.Path(folder) / "other.sqlite"
        command[3] = str(undisturbed)
        subprocess.run(command, stdout=subprocess.DEVNULL)
        if models(undisturbed) != end:
            print("an undisturbed import gives other models")
            return 1
        return 0


if __name__ == "__main__":
    sys.exit(main())
