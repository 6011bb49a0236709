#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The program as a person or a script calls it.

Usage: test_cli.py EMBODY   (the built program)
"""
import json
import math
import os
import pathlib
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.request

EMBODY = ""
SOURCE = pathlib.Path(__file__).resolve().parent.parent.parent
COMMANDS = ("serve", "import", "search", "show", "set", "reset", "history", "undo", "simulate", "check", "classify", "scene", "bench")

# A tetrahedron of 1 m, closed and outward.
TETRAHEDRON = """v 0 0 0
v 1 0 0
v 0 1 0
v 0 0 1
f 1 3 2
f 1 2 4
f 1 4 3
f 2 3 4
"""


def run(*words: str, **environment: str) -> subprocess.CompletedProcess:
    return subprocess.run([EMBODY, *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=240,
                          env={**os.environ, **environment})


class Help(unittest.TestCase):
    def test_every_command_explains_itself_with_an_example(self):
        for command in COMMANDS:
            result = run(command, "--help")
            self.assertEqual(result.returncode, 0, command)
            self.assertIn("Example:", result.stdout, command)
            self.assertIn(f"embody {command}", result.stdout, command)

    def test_wrong_words_are_refused_by_name(self):
        result = run("search", "--limti", "3")
        self.assertEqual(result.returncode, 2)
        self.assertIn("--limti", result.stderr)
        self.assertEqual(run().returncode, 2)
        self.assertEqual(run("fly").returncode, 2)
        self.assertEqual(run("search", "--limit", "0").returncode, 2)


NASTY = "red\x1b[31m\n\u009b2J\u202eexe.chair\x07"
STEERING = [chr(c) for c in (*range(0x20), *range(0x7F, 0xA0), *range(0x202A, 0x202F), *range(0x2066, 0x206A)) if c != 0x0A]


class Terminal(unittest.TestCase):
    """No name of a file, a database or a scene controls the terminal, and a line that could not be written is reported."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = pathlib.Path(self.folder.name)
        self.database = str(self.path / "models.sqlite")

    def tearDown(self):
        self.folder.cleanup()

    def assert_plain(self, result, *, json_expected=False):
        for text in (result.stdout, result.stderr):
            for sign in STEERING:
                self.assertNotIn(sign, text, repr(text))
        if json_expected:
            return json.loads(result.stdout)
        # A line end in a name would start a new line.
        for line in (result.stdout + result.stderr).splitlines():
            self.assertFalse(line.startswith("\u009b"), line)
        return None

    def test_control_characters_in_names_of_models_are_escaped(self):
        folder = self.path / NASTY
        folder.mkdir()
        (folder / f"{NASTY}.obj").write_text(TETRAHEDRON)
        (folder / f"broken {NASTY}.obj").write_text("v 1 2 3")
        (folder / "стол è 椅子.obj").write_text(TETRAHEDRON.replace("1", "2"))
        database = ("--database", self.database)
        imported = run("import", *database, str(folder))
        self.assert_plain(imported)
        self.assertIn("\\x1b[31m", imported.stderr)
        self.assert_plain(run("import", *database, "--json", "--again", str(folder)), json_expected=True)

        found = self.assert_plain(run("search", *database, "--json", "exe"), json_expected=True)
        model = found["models"][0]
        self.assertIn("\x1b", model["name"], "JSON gives the name as it is")
        listed = run("search", *database)
        self.assert_plain(listed)
        self.assertIn("стол", listed.stdout)
        one = (*database, str(model["id"]))
        for words in (("show", *one), ("set", *one, "mass=2"), ("set", *one, f"mass={NASTY}"), ("history", *database),
                      ("set", *database, "--all", "--dry-run", "mass=3"), ("reset", *one), ("classify", NASTY),
                      ("evaluate", "catalogue", *database), ("show", *database, NASTY), ("search", NASTY, NASTY, *database)):
            self.assert_plain(run(*words))
        self.assert_plain(run("show", *one, "--json"), json_expected=True)

        # In a scene, and as the name of a scene.
        scene = self.path / f"{NASTY}.json"
        entity = {"index": 1, "name": NASTY, "model": model["key"], "pose": {"position": [0, 1e12, 0]}}
        scene.write_text(json.dumps({"embody_scene": 1, "title": NASTY, "entities": [entity]}))
        for command in ("check", "simulate"):
            result = run(command, *database, str(scene))
            self.assertEqual(result.returncode, 1, command)
            self.assert_plain(result)
            self.assertIn("\\x1b[31m", result.stdout + result.stderr, command)
        scene.write_text(json.dumps({"embody_scene": 1, NASTY: 3}))
        self.assert_plain(run("check", *database, str(scene)))
        self.assert_plain(run("simulate", *database, str(scene)))
        self.assert_plain(run("--no\x1b[31m"))
        self.assert_plain(run("check", "--no\x1b[31m", str(scene)))

    def test_bytes_that_are_no_utf8_are_escaped(self):
        name = os.fsencode(self.path) + b"/caf\xe9.json"
        pathlib.Path(os.fsdecode(name)).write_text("{}")
        result = subprocess.run([EMBODY, "check", "--database", self.database, name], capture_output=True, timeout=60)
        self.assertIn(b"caf\\xe9.json", result.stdout + result.stderr)

    def test_output_that_cannot_be_written_is_an_error(self):
        if not os.path.exists("/dev/full"):
            self.skipTest("no /dev/full here")
        (self.path / "chair.obj").write_text(TETRAHEDRON)
        scene = self.path / "scene.json"
        ball = {"index": 1, "shape": {"type": "sphere", "radius": 0.2}}
        scene.write_text(json.dumps({"embody_scene": 1, "entities": [ball]}))
        database = ("--database", self.database)
        self.assertEqual(run("import", *database, str(self.path)).returncode, 0)
        for words in (("import", *database, str(self.path)), ("search", *database), ("search", *database, "--json"),
                      ("show", *database, "chair"), ("set", *database, "chair", "mass=2"), ("history", *database),
                      ("reset", *database, "chair"), ("undo", *database), ("check", *database, str(scene)),
                      ("simulate", *database, str(scene), "--seconds", "0.1"), ("classify", "chair"), ("attributes",),
                      ("attributes", "--markdown"), ("evaluate", "catalogue", *database), ("scene",), ("scene", "table1_g"),
                      ("bench", "table1", "--scene", "table1_f", "--steps", "1"), ("--help",), ("--version",)):
            with open("/dev/full", "w") as full:
                result = subprocess.run([EMBODY, *words], stdout=full, stderr=subprocess.PIPE, text=True, timeout=240)
            self.assertEqual(result.returncode, 1, words)
            self.assertIn("standard output: cannot be written: No space left on device", result.stderr, words)
        # A failure of standard error cannot be reported anywhere.
        with open("/dev/full", "w") as full:
            self.assertEqual(subprocess.run([EMBODY, "show", *database, "none"], stderr=full, timeout=60).returncode, 1)

    def test_a_reader_that_closes_the_pipe_is_no_error(self):
        for restore in (True, False):
            process = subprocess.Popen([EMBODY, "scene", "table1_g"], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                       restore_signals=restore)
            process.stdout.close()
            self.assertEqual(process.stderr.read(), b"")
            self.assertNotEqual(process.wait(timeout=60), 0)
            process.stderr.close()


class Classify(unittest.TestCase):
    def test_a_word_that_only_wordnet_knows_is_explained(self):
        result = run("classify", "tureen", "--category", "Kitchen", "--size", "0.3", "0.25", "0.2", "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        answer = json.loads(result.stdout)
        self.assertEqual(answer["synset"], "tureen.n.01")
        self.assertGreater(answer["steps"], 0)
        self.assertIn('name says "tureen" → tureen.n.01 → ', answer["source"])
        self.assertTrue(0 < answer["confidence"] < 0.95)
        mass = answer["mass_kg"]
        self.assertTrue(0.2 < mass["low"] < mass["value"] < mass["high"] < 20, mass)

    def test_people_read_what_else_it_could_be(self):
        result = run("classify", "chair", "--size", "500", "880", "520")
        self.assertIn("it would fit in units of 0.001 m", result.stdout)
        result = run("classify", "mouse", "--tag", "animal")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("mouse.n.01", result.stdout)
        self.assertIn("or ", result.stdout)

    def test_a_missing_taxonomy_is_reported(self):
        result = run("classify", "chair", EMBODY_DATA="/nowhere")
        self.assertEqual(result.returncode, 1)
        self.assertIn("/nowhere", result.stderr)
        self.assertEqual(run("classify", "chair", "--size", "1", "-2", "1").returncode, 2)


class Database(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = pathlib.Path(self.folder.name)
        self.database = str(self.path / "models.sqlite")
        (self.path / "models").mkdir()
        (self.path / "models" / "wooden chair.obj").write_text(TETRAHEDRON)

    def tearDown(self):
        self.folder.cleanup()

    def test_a_search_in_an_empty_database_says_how_to_fill_it(self):
        result = run("search", "--database", self.database, "chair")
        self.assertNotIn("Traceback", result.stderr)
        self.assertTrue("import" in result.stderr or "No model" in result.stdout, result)

    def test_a_read_only_database_is_searched_and_shown(self):
        run("import", "--database", self.database, str(self.path / "models"))
        user = None
        if os.geteuid() == 0:
            # The administrator may write everywhere, so the test runs as another user.
            user = 65534
            try:
                subprocess.run([EMBODY, "--version"], user=user, check=True, stdout=subprocess.DEVNULL)
            except (PermissionError, subprocess.CalledProcessError):
                self.skipTest("nobody else may run the program here")
        scene = self.path / "scene.json"
        model = json.loads(run("search", "--database", self.database, "--json", "chair").stdout)["models"][0]
        scene.write_text(json.dumps({"embody_scene": 1, "entities": [{"model": model["key"]}]}))
        os.chmod(self.database, 0o444)
        os.chmod(self.path, 0o555)

        def ask(*words):
            return subprocess.run([EMBODY, *words], user=user, capture_output=True, text=True, timeout=240,
                                  env={**os.environ, "HOME": "/nonexistent"})

        database = ("--database", self.database)
        try:
            for words in (("search", *database, "chair"), ("show", *database, "wooden chair"), ("history", *database),
                          ("check", *database, str(scene)), ("simulate", *database, str(scene), "--seconds", "0.1")):
                result = ask(*words)
                self.assertEqual(result.returncode, 0, (words, result.stderr))
            for words in (("set", *database, "wooden chair", "mass=2"), ("import", *database, str(self.path / "models"))):
                result = ask(*words)
                self.assertEqual(result.returncode, 1, words)
                self.assertIn("models.sqlite: is read-only", result.stderr, words)
        finally:
            os.chmod(self.path, 0o755)

    def test_a_file_that_is_no_database_is_left_alone(self):
        alien = self.path / "notes.txt"
        alien.write_text("not a database, but dear to me\n" * 100)
        result = run("search", "--database", str(alien), "chair")
        self.assertEqual(result.returncode, 1)
        self.assertIn("notes.txt", result.stderr)
        self.assertIn("dear to me", alien.read_text())

    def test_a_material_is_known_and_contradictions_are_reported(self):
        run("import", "--database", self.database, str(self.path / "models"))
        model = json.loads(run("search", "--database", self.database, "--json", "chair").stdout)["models"][0]
        one = ("--database", self.database, str(model["id"]))
        refused = run("set", *one, "surface_material=unobtainium")
        self.assertEqual(refused.returncode, 1)
        self.assertIn("steel", refused.stderr)
        self.assertEqual(run("set", *one, "max_hulls=2.5").returncode, 1)
        self.assertEqual(run("set", *one, "surface_material=oak").returncode, 0)
        shown = {a["name"]: a for a in json.loads(run("show", *one, "--json").stdout)["attributes"]}
        self.assertEqual(shown["surface_material"]["value"], "wood")
        self.assertIn("manual surface material", shown["density"]["source"])

        scene = self.path / "scene.json"
        entity = {"index": 1, "name": "chair", "model": model["key"]}
        scene.write_text(json.dumps({"embody_scene": 1, "entities": [entity]}))
        self.assertEqual(run("check", "--database", self.database, str(scene)).returncode, 0)
        entity["attributes"] = {"friction_static": 0.1, "friction_dynamic": 0.9, "surface_material": "unobtainium"}
        scene.write_text(json.dumps({"embody_scene": 1, "entities": [entity]}))
        checked = run("check", "--database", self.database, str(scene))
        self.assertEqual(checked.returncode, 1)
        for name in ("friction_dynamic", "surface_material"):
            self.assertIn("entities[0].attributes." + name, checked.stdout)
        ball = {"index": 1, "shape": {"type": "sphere", "radius": 0.2}, "attributes": {"surface_material": "unobtainium"}}
        scene.write_text(json.dumps({"embody_scene": 1, "entities": [ball]}))
        checked = run("check", "--database", self.database, str(scene))
        self.assertEqual(checked.returncode, 1)
        self.assertIn("entities[0].attributes.surface_material", checked.stdout)

    def test_taps_and_drains_that_lead_nowhere_are_named(self):
        scene = self.path / "scene.json"

        def check(entity):
            water = {"index": 2, "shape": {"type": "box", "half_extents": [0.2, 0.2, 0.2]}, "attributes": {"kind": "fluid"}, "starts_empty": True}
            tap = {"index": 1, "name": "Tap", "shape": {"type": "sphere", "radius": 0.02}, "pose": {"position": [0, 1, 0]}, "attributes": {"kind": "static"}}
            scene.write_text(json.dumps({"embody_scene": 1, "entities": [{**tap, **entity}, water]}))
            checked = run("check", "--database", self.database, str(scene))
            return checked.returncode, checked.stdout + checked.stderr

        flow = {"litres_per_minute": 10, "position": [0, -0.05, 0]}
        self.assertEqual(check({"tap": flow})[0], 0)
        wrong = [
            ({"tap": {**flow, "liquid": 1}}, "tap.liquid", "set it to a liquid"),
            ({"tap": {**flow, "liquid": 9}}, "tap.liquid", "set it to a liquid"),
            ({"tap": {**flow, "litres_per_minute": -1}}, "tap.litres_per_minute", "600000"),
            ({"tap": {**flow, "radius": 0}}, "tap.speed", "set the radius"),
            ({"tap": {**flow, "litres_per_minute": 600000}}, "tap.radius", "enlarge it"),
            ({"drain": {"radius": 11}}, "drain.radius", "10"),
            ({"drain": {"radius": 0.1}, "attributes": {"kind": "soft"}}, "drain", "rigid or static"),
        ]
        for entity, field, remedy in wrong:
            code, told = check(entity)
            self.assertEqual(code, 1, entity)
            for words in (scene.name, field, remedy):
                self.assertIn(words, told, entity)

    def test_import_search_show_set_reset(self):
        broken = self.path / "models" / "broken.glb"
        broken.write_bytes(b"glTF but not really")
        first = run("import", "--database", self.database, "--json", str(self.path / "models"))
        self.assertEqual(first.returncode, 3, first.stderr)  # one file failed and is named
        report = json.loads(first.stdout)
        self.assertEqual(report["added"], 1)
        self.assertIn("broken.glb", report["failures"][0]["path"])
        self.assertIn("broken.glb", first.stderr)

        again = json.loads(run("import", "--database", self.database, "--json", str(self.path / "models")).stdout)
        self.assertEqual((again["added"], again["unchanged"]), (0, 1))

        found = json.loads(run("search", "--database", self.database, "--json", "chair").stdout)
        self.assertEqual(found["models"][0]["name"].lower(), "wooden chair")
        model = str(found["models"][0]["id"])

        shown = json.loads(run("show", "--database", self.database, "--json", model).stdout)
        before = {a["name"]: a for a in shown["attributes"]}
        self.assertTrue(all(a["source"] for a in shown["attributes"]))

        refused = run("set", "--database", self.database, model, "mass=2", "friction_dynamic=9")
        self.assertEqual(refused.returncode, 1)
        self.assertIn("friction_dynamic", refused.stderr)
        self.assertIn("2", refused.stderr)  # the upper end of the range
        for command, word in (("set", "masss=2"), ("reset", "masss")):
            unknown = run(command, "--database", self.database, model, word)
            self.assertEqual(unknown.returncode, 1, command)
            self.assertIn("mass", unknown.stderr)
        self.assertEqual(json.loads(run("show", "--database", self.database, "--json", model).stdout), shown)

        changed = json.loads(run("set", "--database", self.database, "--json", model, "mass=2.5").stdout)
        mass = {a["name"]: a for a in changed["attributes"]}["mass"]
        self.assertEqual((mass["value"], mass["level"]), (2.5, "manual"))

        run("import", "--database", self.database, "--again", str(self.path / "models"))
        kept = json.loads(run("show", "--database", self.database, "--json", model).stdout)
        self.assertEqual({a["name"]: a for a in kept["attributes"]}["mass"]["value"], 2.5)

        reset = json.loads(run("reset", "--database", self.database, "--json", model, "mass").stdout)
        self.assertEqual({a["name"]: a for a in reset["attributes"]}["mass"]["value"], before["mass"]["value"])

    def test_show_tells_the_convex_parts_of_what_is_hollow(self):
        # A table: a board on four legs, open below.
        boxes = [((0, 0.7, 0), (1, 0.75, 1))]
        boxes += [((x, 0, z), (x + 0.06, 0.7, z + 0.06)) for x in (0, 0.94) for z in (0, 0.94)]
        faces = ((0, 2, 6, 4), (1, 5, 7, 3), (0, 4, 5, 1), (2, 3, 7, 6), (0, 1, 3, 2), (4, 6, 7, 5))
        lines = []
        for at, (low, high) in enumerate(boxes):
            lines += [f"v {(low, high)[c & 1][0]} {(low, high)[c >> 1 & 1][1]} {(low, high)[c >> 2][2]}" for c in range(8)]
            lines += ["f " + " ".join(str(8 * at + 1 + corner) for corner in face) for face in faces]
        (self.path / "models" / "table.obj").write_text("\n".join(lines) + "\n")
        self.call("import", str(self.path / "models"))
        told = self.call("show", "table")
        parts = told["decomposition"]
        self.assertTrue(4 <= parts["parts"] <= parts["max_hulls"], parts)
        self.assertLess(parts["concavity"], parts["hull_concavity"] / 5)
        text = run("show", "--database", self.database, "table").stdout
        self.assertIn(f"as {parts['parts']} convex parts; the deepest hollow that they fill is ", text)
        self.assertIsNone(self.call("show", "wooden chair")["decomposition"])

        # With fewer parts the error is larger.
        few = self.call("set", "table", "max_hulls=2")["decomposition"]
        self.assertEqual((few["parts"], few["max_hulls"]), (2, 2))
        self.assertGreater(few["concavity"], parts["concavity"])

    def test_the_users_own_categories_resolve_a_database_again(self):
        own = self.path / "own"
        own.mkdir()
        self.call("import", str(self.path / "models"), EMBODY_TAXONOMY=str(own))
        self.call("set", "wooden chair", "friction_dynamic=0.123", EMBODY_TAXONOMY=str(own))
        (own / "chairs.json").write_text(json.dumps({"categories": [
            {"name": "chair", "mass": [40, 50, 60], "at_size": [0.5, 0.9, 0.5], "source": "weighed in our stock"}]}))
        shown = self.call("show", "wooden chair", EMBODY_TAXONOMY=str(own))
        values = {a["name"]: a for a in shown["attributes"]}
        self.assertIn("your chairs.json", values["mass"]["source"])
        self.assertEqual((values["friction_dynamic"]["value"], values["friction_dynamic"]["level"]), (0.123, "manual"))

    def call(self, *words: str, code: int = 0, **environment: str) -> dict:
        result = run(words[0], "--database", self.database, *words[1:], "--json", **environment)
        self.assertEqual(result.returncode, code, result.stderr)
        return json.loads(result.stdout) if result.stdout else {}

    def test_many_models_are_changed_at_once_and_undone(self):
        for name in ("oak chair", "red chair", "garden chair"):
            (self.path / "models" / f"{name}.obj").write_text(TETRAHEDRON + f"# {name}\n")
        self.call("import", str(self.path / "models"))
        chairs = {m["key"] for m in self.call("search", "chair")["models"]}
        self.assertEqual(len(chairs), 4)

        planned = self.call("set", "--query", "chair", "--dry-run", "mass=7")
        self.assertEqual({m["key"] for m in planned["models"]}, chairs)
        self.assertIsNone(planned["batch"])
        self.assertEqual(self.call("history")["changes"], [])

        # An attribute of soft bodies: nothing is changed, and every model that refuses is named.
        refused = self.call("set", "--all", "mass=7", "youngs_modulus=1e5", code=1)
        self.assertIn("oak chair", [r["name"] for r in refused["refused"]])
        self.assertEqual(self.call("history")["changes"], [])

        one = self.call("set", "red chair", "mass=3", USER="eva")
        self.assertEqual({a["name"]: a for a in one["attributes"]}["mass"]["value"], 3)
        done = self.call("set", "--query", "chair", "--category", "chair", "mass=7", USER="ada")
        self.assertEqual((done["changed"], done["command"]), (4, "set many"))
        history = self.call("history", "red chair")["changes"]
        self.assertEqual([(c["person"], c["before"], c["after"]) for c in history], [("ada", 3, 7), ("eva", None, 3)])
        self.assertIn("chair", history[0]["asked"])
        self.assertEqual(len(self.call("history", "--since", "1h")["changes"]), 5)
        self.assertEqual(self.call("history", "--since", "2200-01-01")["changes"], [])
        self.assertEqual(run("history", "--database", self.database, "--since", "soon").returncode, 1)

        # The value of eva's batch was changed since, so its undo is refused; the undo of ada's last one restores it.
        self.assertEqual(self.call("undo", str(history[1]["batch"]), code=1)["refused"][0]["name"], "red chair")
        self.assertEqual(self.call("undo", USER="ada")["changed"], 4)
        shown = self.call("show", "red chair")
        mass = {a["name"]: a for a in shown["attributes"]}["mass"]
        self.assertEqual(mass["value"], 3)
        self.assertIn("eva", mass["source"])
        self.assertIn("nothing by ada", run("undo", "--database", self.database, USER="ada").stderr)

        again = self.call("reset", "--all", USER="ada")
        self.assertEqual((again["changed"], again["command"]), (1, "reset many"))
        told = run("history", "--database", self.database)
        self.assertIn("3 → automatic", told.stdout)

    def test_a_choice_of_models_must_make_sense(self):
        for words in (("set", "mass=2"), ("set", "--all", "--query", "chair", "mass=2"), ("set", "--all", "mas=2"),
                      ("set", "--all", "mass=1", "mass=2"), ("reset",), ("undo",), ("undo", "77")):
            result = run(words[0], "--database", self.database, *words[1:])
            self.assertEqual(result.returncode, 1, words)
            self.assertTrue(result.stderr.startswith("embody: "), result.stderr)

    def test_an_unknown_model_is_named(self):
        result = run("show", "--database", self.database, "no such thing")
        self.assertEqual(result.returncode, 1)
        self.assertIn("no such thing", result.stderr)


class Scenes(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = pathlib.Path(self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    def test_a_wrong_field_is_refused_by_name(self):
        listed = json.loads(run("scene", "--json").stdout)
        name = listed["scenes"][0]["name"]
        document = json.loads(run("scene", name).stdout)
        document["entities"][0]["colour"] = [1, 0, 0]
        wrong = self.path / "wrong.json"
        wrong.write_text(json.dumps(document))
        result = run("check", str(wrong))
        self.assertEqual(result.returncode, 1)
        self.assertIn("colour", result.stdout + result.stderr)
        self.assertIn("color", result.stdout + result.stderr)  # the correct name that is closest
        simulated = run("simulate", str(wrong), "--seconds", "0.1")
        self.assertEqual(simulated.returncode, 1)
        self.assertIn("colour", simulated.stderr)

    def test_entities_not_simulated_as_their_kind_says_are_reported(self):
        ball = {"name": "Ball", "shape": {"type": "sphere", "radius": 0.2}, "attributes": {"kind": "cloth"}}
        scene = self.path / "balls.json"
        scene.write_text(json.dumps({"embody_scene": 1, "entities": [{**ball, "index": 1},
                                                                     {**ball, "index": 2, "pose": {"position": [1, 0, 0]}}]}))
        told = "Ball is simulated as rigid, because"
        for words in (("check", str(scene)), ("simulate", str(scene), "--seconds", "0.1")):
            plain = run(*words)
            self.assertEqual(plain.returncode, 0, plain.stderr)
            self.assertEqual(plain.stdout.count(told), 1, plain.stdout)
            self.assertIn("(2 of this name)", plain.stdout)
            as_json = json.loads(run(*words, "--json").stdout)
            notes = as_json["scenes"][0]["notes"] if words[0] == "check" else as_json["notes"]
            self.assertEqual(len(notes), 1)
            self.assertIn(told, notes[0])

    def test_the_scenes_that_come_with_embody_can_be_read(self):
        primitives_only = [p for p in sorted((SOURCE / "data" / "scenes").glob("*.json"))
                           if '"model"' not in p.read_text()]
        self.assertTrue(primitives_only)
        result = run("check", *map(str, primitives_only))
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def test_a_ball_falls_as_galileo_says(self):
        scene = {"embody_scene": 1, "settings": {"air_density": 0},
                 "entities": [{"index": 1, "name": "ball", "shape": {"type": "sphere", "radius": 0.1},
                               "pose": {"position": [0, 20, 0]}}]}
        file = self.path / "fall.json"
        file.write_text(json.dumps(scene))
        record = self.path / "out.jsonl"
        result = run("simulate", str(file), "--seconds", "2", "--record", str(record), "--rate", "10", "--energy", "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        lines = [json.loads(line) for line in record.read_text().splitlines()]
        last = lines[-1]
        self.assertTrue(math.isclose(last["t"], 2, abs_tol=1e-9))
        self.assertTrue(math.isclose(last["entities"][0]["position"][1], 20 - 9.81 * 2, abs_tol=1e-3))
        self.assertTrue(math.isclose(last["entities"][0]["linear_velocity"][1], -19.62, abs_tol=1e-3))
        self.assertIn("energy", last)
        self.assertGreaterEqual(len(lines), 20)
        account = json.loads(result.stdout)["energy_account"]
        fallen = account["end"]["kinetic"] - account["start"]["kinetic"]
        self.assertTrue(math.isclose(account["work"]["gravity"], fallen, rel_tol=1e-9))
        self.assertLess(abs(account["unexplained"]), 1e-9 * fallen)
        self.assertLess(account["largest_unexplained_gain"]["joules"], 1e-9 * fallen)
        told = run("simulate", str(file), "--seconds", "2", "--energy")
        self.assertIn("energy of the rigid bodies:", told.stdout)
        self.assertIn("work, J: gravity", told.stdout)
        self.assertIn("unexplained:", told.stdout)
        self.assertNotIn("energy_account", run("simulate", str(file), "--seconds", "0.1", "--json").stdout)

    def test_a_recording_that_cannot_be_written_is_reported(self):
        listed = json.loads(run("scene", "--json").stdout)
        result = run("simulate", listed["scenes"][0]["name"], "--seconds", "0.1", "--record", "/nowhere/out.jsonl")
        self.assertEqual(result.returncode, 1)
        self.assertIn("/nowhere/out.jsonl", result.stderr)

    STAGES = ("wake bodies", "advance fluids", "find pairs", "find contacts", "roll balls", "list joints", "solve impacts", "find islands",
              "run substeps", "stop tunnelling", "advance deformables", "put to sleep", "settle fluids", "write report")

    def test_a_trace_shows_each_stage_once_a_step_and_zones_within_each_other(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "trace.json"
            result = run("simulate", "tall_stack", "--seconds", "0.3", "--trace", str(file), "--json")
            self.assertEqual(result.returncode, 0, result.stderr)
            summary = json.loads(result.stdout)
            self.assertEqual(summary["trace_zones_missing"], 0)
            trace = json.loads(file.read_text())
        self.assertEqual(trace["otherData"]["dropped_zones"], 0)
        zones = [event for event in trace["traceEvents"] if event["ph"] == "X"]
        names = {event["tid"]: event["args"]["name"] for event in trace["traceEvents"] if event["name"] == "thread_name"}
        self.assertEqual(set(names), {zone["tid"] for zone in zones})
        main = next(thread for thread, name in names.items() if name == "main")
        steps = [zone for zone in zones if zone["name"] == "step"]
        self.assertEqual(len(steps), summary["steps"])
        end = lambda zone: zone["ts"] + zone["dur"]
        rounding = 1e-3  # us
        for step in steps:
            inside = [zone for zone in zones if zone["tid"] == main and zone["ts"] >= step["ts"] and end(zone) <= end(step) + rounding]
            for stage in self.STAGES:
                self.assertEqual(sum(zone["name"] == stage for zone in inside), 1, stage)
        for thread in names:
            enclosing = []
            for zone in sorted((zone for zone in zones if zone["tid"] == thread), key=lambda zone: (zone["ts"], -zone["dur"])):
                self.assertGreaterEqual(zone["ts"], 0)
                self.assertGreaterEqual(zone["dur"], 0)
                while enclosing and end(enclosing[-1]) <= zone["ts"] + rounding:
                    enclosing.pop()
                if enclosing:
                    self.assertLessEqual(end(zone), end(enclosing[-1]) + rounding, (zone, enclosing[-1]))
                enclosing.append(zone)

    def test_a_trace_is_written_where_it_is_asked_for_only(self):
        with tempfile.TemporaryDirectory() as folder:
            result = subprocess.run([os.path.abspath(EMBODY), "simulate", "tall_stack", "--seconds", "0.1"], cwd=folder, capture_output=True, text=True,
                                    timeout=240)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(list(pathlib.Path(folder).iterdir()), [])
        for file in ("/nowhere/trace.json", "/dev/full"):
            result = run("simulate", "tall_stack", "--seconds", "0.5", "--trace", file)
            self.assertEqual(result.returncode, 1, file)
            self.assertIn(file, result.stderr)

    def test_non_finite_numbers_are_refused(self):
        for option, value in (("--seconds", "nan"), ("--seconds", "-1"), ("--seconds", "inf"), ("--rate", "nan")):
            result = run("simulate", "table1_e", option, value)
            self.assertEqual(result.returncode, 2, (option, value, result.stderr))
            self.assertIn(option, result.stderr)
            self.assertIn(value, result.stderr)
        self.assertEqual(run("bench", "--steps", "-1").returncode, 2)

    def test_ctrl_c_ends_a_recording_with_whole_lines(self):
        with tempfile.TemporaryDirectory() as folder:
            record = pathlib.Path(folder) / "out.jsonl"
            words = [EMBODY, "simulate", "table1_e", "--seconds", "1000000", "--record", str(record), "--json"]
            with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
                # Wait for the header, which is written before the first step.
                while not record.exists() or record.stat().st_size == 0:
                    self.assertIsNone(process.poll())
                    time.sleep(0.05)
                process.send_signal(signal.SIGINT)
                out, error = process.communicate(timeout=120)
            self.assertEqual(process.returncode, 1, error)
            self.assertIn("stopped", error)
            summary = json.loads(out)
            lines = [json.loads(line) for line in record.read_text().splitlines()]
            self.assertAlmostEqual(lines[-1]["t"], summary["simulated_seconds"], delta=0.1)

    def test_bench_prints_the_papers_columns(self):
        result = run("bench", "table1", "--scene", "table1_e", "--steps", "30", "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        row = json.loads(result.stdout)["scenes"][0]
        self.assertEqual((row["paper"]["max_ms"], row["paper"]["min_ms"], row["paper"]["average_ms"]), (0.757, 0.013, 0.519))
        self.assertGreater(row["max_ms"], 0)
        self.assertLessEqual(row["min_ms"], row["average_ms"])
        self.assertLessEqual(row["average_ms"], row["max_ms"])

    def test_bench_stability_reports_how_a_structure_stands(self):
        result = run("bench", "stability", "--scene", "card_pair", "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        row = json.loads(result.stdout)["scenes"][0]
        self.assertTrue(row["stands"])
        self.assertEqual(row["misses"], "")
        self.assertLess(row["asleep_after_s"], 60)
        self.assertEqual(run("bench", "stability", "--scene", "castle in the air").returncode, 1)


class Server(unittest.TestCase):
    """No message of a client stops the server."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        words = [EMBODY, "serve", "--port", "0", "--database", str(pathlib.Path(self.folder.name) / "models.sqlite")]
        self.server = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                       env={**os.environ, "XDG_DATA_HOME": self.folder.name})
        line = self.server.stdout.readline()
        self.assertIn("http://127.0.0.1:", line, self.server.stderr.read() if not line else "")
        self.port = int(line.strip().rstrip("/").rsplit(":", 1)[1])

    def tearDown(self):
        self.server.terminate()
        self.server.communicate(timeout=60)
        self.folder.cleanup()
        self.assertEqual(self.server.returncode, 0)

    def open_web_socket(self) -> socket.socket:
        client = socket.create_connection(("127.0.0.1", self.port), timeout=60)
        client.sendall(f"GET /ws HTTP/1.1\r\nHost: 127.0.0.1:{self.port}\r\nUpgrade: websocket\r\n"
                       "Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                       "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n".encode())
        answer = b""
        while not answer.endswith(b"\r\n\r\n"):
            answer += client.recv(1)
        self.assertIn(b"101", answer)
        return client

    def health(self) -> dict:
        with urllib.request.urlopen(f"http://127.0.0.1:{self.port}/api/health", timeout=60) as answer:
            return json.load(answer)

    def test_without_models_the_studio_opens_its_first_scene_all_the_same(self):
        health = self.health()
        self.assertEqual((health["name"], health["scene"]), ("embody", "Furnished room"))

    def test_a_file_that_is_too_large_is_refused_with_a_reason(self):
        client = socket.create_connection(("127.0.0.1", self.port), timeout=60)
        client.sendall(f"POST /import?name=a.obj HTTP/1.1\r\nHost: 127.0.0.1:{self.port}\r\n"
                       f"Content-Length: {300 << 20}\r\n\r\n".encode())
        for _ in range(64):
            client.sendall(bytes(1 << 16))
        answer = b""
        while more := client.recv(4096):
            answer += more
        client.close()
        self.assertTrue(answer.startswith(b"HTTP/1.1 413"), answer[:100])
        self.assertIn(b"embody import", answer)

    def test_a_file_that_is_sent_is_imported(self):
        request = urllib.request.Request(f"http://127.0.0.1:{self.port}/import?name=../tetrahedron.obj",
                                         data=TETRAHEDRON.encode(), method="POST")
        with urllib.request.urlopen(request, timeout=60) as answer:
            self.assertEqual(len(json.load(answer)["keys"]), 1)

    def test_a_client_that_only_sends_fills_no_memory(self):
        client = self.open_web_socket()
        text = json.dumps({"id": 1, "command": "simulation.pause", "params": {}}).encode()
        frame = bytes((0x81, 0x80 | len(text), 0, 0, 0, 0)) + text  # masked with zeros
        client.settimeout(3)
        sent = 0
        try:
            while sent < 64 << 20:
                sent += client.send(frame * 1000)
        except OSError:
            pass  # the server waits until the replies are read
        self.assertLess(sent, 64 << 20)
        self.assertEqual(self.health()["name"], "embody")
        client.close()


if __name__ == "__main__":
    EMBODY = sys.argv.pop(1)
    unittest.main(verbosity=2)
