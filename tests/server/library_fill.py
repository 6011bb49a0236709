#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The server fills its library while it is used: from paths and from a list that is still written, between uploads, and on with it
after a stop.

Usage: library_fill.py EMBODY
"""
import http.client
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import unittest
import zipfile

from viewer import Viewer

EMBODY = sys.argv.pop(1)


def box(width: float) -> str:
    """A box as OBJ, 1 m high; another width is another model."""
    corners = [(x, y, z) for x in (0, width) for y in (0, 1) for z in (0, 1)]
    faces = ["1 2 4 3", "5 7 8 6", "1 5 6 2", "3 4 8 7", "1 3 7 5", "2 6 8 4"]
    return "".join(f"v {x} {y} {z}\n" for x, y, z in corners) + "".join(f"f {face}\n" for face in faces)


class FillsWhileItIsUsed(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.database = self.folder / "models.sqlite"
        self.mark = self.folder / "filled"
        self.list = self.folder / "list"
        os.mkfifo(self.list)

    def models(self, name: str, count: int, offset: float = 0) -> pathlib.Path:
        folder = self.folder / name
        folder.mkdir()
        for i in range(count):
            (folder / f"{name} {i}.obj").write_text(box(0.5 + offset + 0.01 * i))
        return folder

    def start(self, *words: str, scene: pathlib.Path | None = None) -> Viewer:
        words = [EMBODY, "serve", "--port", "0", "--database", str(self.database), *words, *(["--scene", str(scene)] if scene else [])]
        self.server = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                       env={**os.environ, "XDG_DATA_HOME": str(self.folder)})
        line = self.server.stdout.readline()
        self.assertIn("http://127.0.0.1:", line)
        self.port = int(line.rsplit(":", 1)[1].strip(" /\n"))
        viewer = Viewer(self.port)
        self.addCleanup(viewer.close)
        return viewer

    def stop(self) -> str:
        self.server.send_signal(signal.SIGINT)
        _, errors = self.server.communicate(timeout=60)
        self.assertEqual(self.server.returncode, 0, errors)
        return errors

    def tearDown(self):
        if self.server.poll() is None:
            self.server.kill()
            self.server.communicate()

    def until(self, viewer: Viewer, name: str, is_right) -> list:
        """The events of this name up to the first that is right."""
        seen = []
        while not seen or not is_right(seen[-1]):
            message = viewer.read()
            if isinstance(message, dict) and message.get("event") == name:
                seen.append(message)
        return seen

    def keys(self, folder: pathlib.Path) -> dict:
        other = self.folder / "other.sqlite"
        subprocess.run([EMBODY, "import", "--database", str(other), str(folder)], check=True, capture_output=True)
        found = subprocess.run([EMBODY, "search", "--database", str(other), "--limit", "1000", "--json", folder.name], check=True,
                               capture_output=True, text=True)
        return {model["name"]: model["key"] for model in json.loads(found.stdout)["models"]}

    def test_a_list_that_is_still_written_fills_the_scene_and_the_library(self):
        first, second = self.models("early", 4), self.models("late", 4, 1)
        keys = self.keys(first) | self.keys(second)
        scene = self.folder / "scene.json"
        things = [{"name": name, "model": key, "pose": {"position": [2 * i, 3, 0]}} for i, (name, key) in enumerate(sorted(keys.items()))]
        self.assertEqual(len(things), 8)
        scene.write_text(json.dumps({"embody_scene": 1, "entities": things}))
        viewer = self.start("--fill-list", str(self.list), "--fill-mark", str(self.mark), scene=scene)
        hello = viewer.do("hello")
        self.assertEqual(hello["import"]["state"], "running")
        self.assertEqual(len(hello["waiting"]), 8)
        self.assertEqual(len(hello["scene"]["entities"]), 8)
        viewer.do("simulation.play")
        with open(self.list, "w") as names:
            print(first, file=names, flush=True)
            waiting = self.until(viewer, "waiting", lambda event: len(event["indices"]) == 4)
            self.assertEqual(waiting[-1]["indices"], [entity["index"] for entity in hello["scene"]["entities"][4:]])
            self.assertFalse(self.mark.exists())
            print(second, file=names, flush=True)
            self.until(viewer, "waiting", lambda event: event["indices"] == [])
        told = self.until(viewer, "import", lambda event: event["state"] == "done")[-1]
        self.assertEqual((told["added"], told["total"], told["failures"], told["notes"]), (8, 8, [], []))
        self.assertTrue(self.mark.exists())
        self.assertEqual(viewer.do("hello")["import"]["state"], "done")
        self.assertIn("The library is filled: 8 new models", self.stop())

    def test_what_could_not_be_had_is_told_and_tried_again_next_time(self):
        viewer = self.start("--fill", str(self.models("some", 2)), "--fill-list", str(self.list), "--fill-mark", str(self.mark))
        self.list.write_text("# The moon could not be downloaded.\n")
        told = self.until(viewer, "import", lambda event: event["state"] == "done")[-1]
        self.assertEqual(told["notes"], ["The moon could not be downloaded."])
        self.assertEqual(told["added"], 2)
        self.assertFalse(self.mark.exists())
        self.assertIn("The moon could not be downloaded.", self.stop())

    def test_failures_are_named_and_do_not_stop_it(self):
        folder = self.models("mixed", 3)
        (folder / "broken.obj").write_text("v 1 2\nf 1 2 3\n")
        viewer = self.start("--fill", str(folder), "--fill-mark", str(self.mark))
        told = self.until(viewer, "import", lambda event: event["state"] == "done")[-1]
        self.assertEqual([failure["path"] for failure in told["failures"]], ["broken.obj"])
        self.assertEqual((told["added"], told["total"]), (3, 4))
        self.assertTrue(self.mark.exists(), "it would fail again")
        self.assertIn("broken.obj", self.stop())

    def test_light_sources_without_a_shape_are_counted_and_no_failures(self):
        catalogue = self.folder / "lamps.sh3f"
        pieces = [("Lamp", "lamp.obj", True), ("Halogen light", "light.obj", True), ("Empty chair", "chair.obj", False)]
        entries = "id=lamps\nname=Lamps\n"
        for i, (name, model, shines) in enumerate(pieces, 1):
            entries += f"id#{i}=lamps#{i}\nname#{i}={name}\nmodel#{i}=/{model}\nwidth#{i}=10\ndepth#{i}=10\nheight#{i}=10\n"
            entries += f"lightSourceX#{i}=5\n" if shines else ""
        with zipfile.ZipFile(catalogue, "w") as archive:
            archive.writestr("PluginFurnitureCatalog.properties", entries)
            archive.writestr("lamp.obj", box(1))
            for empty in ("light.obj", "chair.obj"):
                archive.writestr(empty, "v 0 0 0\nv 1 0 0\nl 1 2\n")
        viewer = self.start("--fill", str(catalogue))
        told = self.until(viewer, "import", lambda event: event["state"] == "done")[-1]
        self.assertEqual((told["added"], told["skipped"], told["total"]), (1, 1, 3))
        self.assertEqual([failure["path"] for failure in told["failures"]], ["lamps.sh3f!lamps#3"])
        self.assertIn("1 light sources have no shape and were left out", self.stop())

    def test_an_upload_goes_first_and_a_stopped_fill_goes_on(self):
        folder = self.models("many", 40)
        viewer = self.start("--fill", str(folder), "--fill-mark", str(self.mark))
        begun = self.until(viewer, "import", lambda event: event["total"] == 40 and event["done"] > 0)[-1]
        connection = http.client.HTTPConnection("127.0.0.1", self.port)
        connection.request("POST", "/import?name=mine.obj", box(3.0))
        self.assertEqual(json.loads(connection.getresponse().read())["added"], 1)
        connection.close()
        there = self.model_count()
        self.assertTrue(begun["done"] > 30 or there < 40, "the upload did not wait for all of it")
        self.stop()
        viewer = self.start("--fill", str(folder), "--fill-mark", str(self.mark))
        told = self.until(viewer, "import", lambda event: event["state"] == "done")[-1]
        self.assertEqual(told["total"], 40)
        self.assertLessEqual(told["added"], 6 + 1 + 40 - there, "what was imported stayed")
        self.assertEqual(self.model_count(), 6 + 1 + 40)
        self.assertTrue(self.mark.exists())

    def model_count(self) -> int:
        """Primitives count, too: six."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port)
        connection.request("GET", "/api/health")
        count = json.loads(connection.getresponse().read())["models"]
        connection.close()
        return count


if __name__ == "__main__":
    unittest.main()
