#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Hostile clients do not freeze the server, fill its memory or make it lose acknowledged changes: long commands,
pages of other sites, floods of commands, idle connections, uploads that never end; and SIGTERM ends it in time.

Usage: hostile_clients.py EMBODY [part of a test's name …]
"""
import http.client
import json
import os
import pathlib
import resource
import signal
import socket
import sqlite3
import struct
import sys
import tempfile
import time

from viewer import Server, Viewer

# A frozen server fails the test by this timeout, s.
PATIENCE = 30
# Longest time until SIGTERM has ended the server, s (docs/protocol.md).
LONGEST_END = 3

BOX = {"index": 1, "shape": {"type": "box", "half_extents": [0.3, 0.2, 0.3]}, "pose": {"position": [0, 1, 0]}}


def heap(entities: int) -> list:
    """Boxes that move for long, so that a command of many steps takes long."""
    return [{"index": i + 1, "shape": {"type": "box", "half_extents": [0.1, 0.1, 0.1]}, "allow_sleep": False,
             "pose": {"position": [0.21 * (i % 10), 0.3 + 0.21 * (i // 100), 0.21 * (i // 10 % 10)]}} for i in range(entities)]


class Stage:
    """A server with a scene, in a temporary folder."""

    def __init__(self, embody: str, entities=(BOX,)):
        self.folder = tempfile.TemporaryDirectory()
        scene = pathlib.Path(self.folder.name) / "scene.json"
        floor = {"index": len(entities) + 1, "shape": {"type": "plane"}, "attributes": {"kind": "static"}}
        scene.write_text(json.dumps({"embody_scene": 1, "title": "Stage", "entities": [*entities, floor]}))
        self.database = pathlib.Path(self.folder.name) / "models.sqlite"
        self.server = Server(embody, str(self.database), str(scene))
        self.port = self.server.port

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.server.process.poll() is None:
            self.server.process.kill()
        self.server.close()
        self.folder.cleanup()

    def get(self, path: str, method="GET", headers=None, patience=PATIENCE):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=patience)
        connection.request(method, path, headers=headers or {})
        answer = connection.getresponse()
        body = answer.read()
        connection.close()
        return answer, body

    def journals_after_end(self) -> list:
        """The journals in the server's home folder; to be read before it is closed."""
        return sorted(pathlib.Path(self.server.home.name).rglob("autosave/*.journal"))

    def end(self, wrong: list, what: str):
        """Sends SIGTERM and returns how long the server took to end."""
        began = time.monotonic()
        self.server.process.send_signal(signal.SIGTERM)
        try:
            code = self.server.process.wait(timeout=PATIENCE)
        except Exception:
            wrong.append(f"{what}: SIGTERM did not end the server within {PATIENCE} s")
            return
        took = time.monotonic() - began
        print(f"  {what}: ended after {took:.2f} s")
        if took > LONGEST_END:
            wrong.append(f"{what}: SIGTERM took {took:.1f} s, promised are {LONGEST_END}")
        if code != 0:
            wrong.append(f"{what}: the server ended with {code}")


def busy_viewer(stage: Stage, steps: int) -> Viewer:
    """A client whose command is being executed."""
    viewer = Viewer(stage.port)
    viewer.do("hello")
    viewer.ask("simulation.step", count=steps)
    time.sleep(0.3)
    return viewer


def test_nothing_waits_for_a_command(embody: str, wrong: list):
    with Stage(embody, heap(1000)) as stage:
        viewer = busy_viewer(stage, 100_000)
        waiting = socket.create_connection(("127.0.0.1", stage.port))
        waiting.sendall(f"GET /scene.json HTTP/1.1\r\nHost: 127.0.0.1:{stage.port}\r\n\r\n".encode())
        time.sleep(0.3)
        try:
            answer, body = stage.get("/api/health", patience=10)
            if answer.status != 200:
                wrong.append(f"/api/health answers {answer.status} while a command runs")
            Viewer(stage.port).close()
        except TimeoutError:
            wrong.append("HTTP is frozen while a command runs and somebody asks for /scene.json")
        stage.end(wrong, "a command in hand, /scene.json asked for")
        viewer.close()
        waiting.close()


def test_the_scene_is_answered_after_the_command(embody: str, wrong: list):
    with Stage(embody, heap(200)) as stage:
        viewer = busy_viewer(stage, 200)
        answer, body = stage.get("/scene.json", patience=120)
        if answer.status != 200 or len(json.loads(body)["entities"]) != 201:
            wrong.append(f"/scene.json during a command: {answer.status}")
        viewer.close()


def test_pages_of_other_sites_are_refused(embody: str, wrong: list):
    with Stage(embody) as stage:
        own = f"http://127.0.0.1:{stage.port}"
        image = {"Sec-Fetch-Mode": "no-cors", "Sec-Fetch-Dest": "image"}
        link = {"Sec-Fetch-Mode": "navigate", "Sec-Fetch-Dest": "document"}
        cases = [("/scene.json", {}, 200), ("/api/health", {}, 200), ("/scene.json", {"Sec-Fetch-Site": "same-origin"}, 200),
                 ("/scene.json", {"Sec-Fetch-Site": "none", **link}, 200), ("/scene.json", {"Origin": own}, 200),
                 ("/scene.json", {"Origin": "http://evil.example"}, 403), ("/scene.json", {"Origin": "null"}, 403),
                 ("/scene.json", {"Host": "evil.example"}, 403)]
        for path in ("/scene.json", "/api/health", "/models/1/geometry.glb", "/assets/x.js"):
            for site in ("cross-site", "same-site"):
                cases.append((path, {"Sec-Fetch-Site": site, **image}, 403))
        cases.append(("/scene.json", {"Sec-Fetch-Site": "cross-site", **link}, 403))
        for path, headers, status in cases:
            answer, body = stage.get(path, headers=headers)
            if answer.status != status:
                wrong.append(f"{path} with {headers}: {answer.status} instead of {status}")
            elif status == 403 and not json.loads(body)["error"]["why"]:
                wrong.append(f"{path} with {headers} is refused without a reason")
        answer, _ = stage.get("/", headers={"Sec-Fetch-Site": "cross-site", **link})
        if answer.status == 403:
            wrong.append("a link to the Studio on another page is refused")


def test_answers_protect_the_page(embody: str, wrong: list):
    promised = {"X-Content-Type-Options": "nosniff", "X-Frame-Options": "DENY", "Referrer-Policy": "no-referrer",
                "Cross-Origin-Resource-Policy": "same-origin", "Cross-Origin-Opener-Policy": "same-origin"}
    with Stage(embody) as stage:
        for path in ("/", "/scene.json", "/api/health", "/nowhere"):
            answer, _ = stage.get(path)
            for name, value in promised.items():
                if answer.headers.get(name) != value:
                    wrong.append(f"{path}: {name} is {answer.headers.get(name)!r}")
            policy = answer.headers.get("Content-Security-Policy", "")
            for word in ("default-src 'none'", "frame-ancestors 'none'", "base-uri 'none'", "script-src 'self'"):
                if word not in policy:
                    wrong.append(f"{path}: Content-Security-Policy lacks {word}: {policy!r}")
            if "unsafe-inline" in policy or "unsafe-eval'" in policy.replace("wasm-unsafe-eval'", ""):
                wrong.append(f"{path}: Content-Security-Policy is not strict: {policy!r}")


def test_a_flood_of_commands_gets_every_reply(embody: str, wrong: list):
    # More commands than may wait, behind one that takes long, so that reading pauses.
    count = 2000
    with Stage(embody, heap(200)) as stage:
        viewer = Viewer(stage.port)
        viewer.do("hello")
        first = viewer.ask("simulation.step", count=60)
        last = [viewer.ask("entity.attributes", index=1) for _ in range(count)][-1]
        expected = first
        try:
            while expected <= last:
                message = viewer.read()
                if isinstance(message, dict) and "id" in message:
                    if message["id"] != expected or not message["ok"]:
                        wrong.append(f"reply {message['id']} where {expected} was due")
                        return
                    expected += 1
        except ConnectionError as error:
            wrong.append(f"after {expected - first} of {count + 1} replies: {error}")
        viewer.close()


def idle_connections(port: int, wanted: int) -> list:
    held = []
    for _ in range(wanted):
        connection = socket.socket()
        connection.settimeout(5)
        try:
            connection.connect(("127.0.0.1", port))
        except OSError:
            connection.close()
            break
        held.append(connection)
    return held


def test_idle_connections_keep_nobody_out(embody: str, wrong: list):
    with Stage(embody) as stage:
        viewer = Viewer(stage.port)
        viewer.do("hello")
        viewer.do("entity.transform", poses=[{"index": 1, "position": [0, 2, 0]}])
        held = idle_connections(stage.port, 1500)
        # Every second connection sends half a request and no more.
        for connection in held[::2]:
            try:
                connection.sendall(b"GET / HTTP/1.1\r\nHost: ")
            except OSError:
                pass
        began = time.monotonic()
        try:
            answer, _ = stage.get("/api/health", patience=10)
            print(f"  {len(held)} idle connections; a new client is answered {answer.status} after {time.monotonic() - began:.2f} s")
            if answer.status != 200:
                wrong.append(f"a new client is answered {answer.status} while others are idle")
            newcomer = Viewer(stage.port)
            newcomer.do("hello")
            newcomer.close()
        except OSError as error:
            wrong.append(f"{len(held)} idle connections keep a new client out: {error!r}")
        saved = viewer.do("scene.save", name="kept")
        if not pathlib.Path(saved["path"]).exists():
            wrong.append("the scene was not saved")
        viewer.close()
        for connection in held:
            connection.close()


def test_too_many_viewers_are_refused_with_a_reason(embody: str, wrong: list):
    with Stage(embody) as stage:
        viewers, refused = [], None
        for _ in range(600):
            try:
                viewers.append(Viewer(stage.port))
            except (AssertionError, OSError) as error:
                refused = error
                break
        print(f"  {len(viewers)} viewers are served, the next hears: {refused}")
        if refused is None or "503" not in str(refused):
            wrong.append(f"600 viewers: {refused!r} instead of 503")
        viewers[0].do("hello")
        answer, _ = stage.get("/api/health")
        if answer.status != 200:
            wrong.append(f"with all viewers there, HTTP answers {answer.status}")
        for viewer in viewers:
            viewer.close()


def begin_upload(port: int, size: int, sent: int) -> socket.socket:
    connection = socket.create_connection(("127.0.0.1", port))
    connection.sendall(f"POST /import?name=big.stl HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nContent-Length: {size}\r\n\r\n".encode())
    connection.settimeout(PATIENCE)
    block = bytes(1 << 20)
    try:
        for _ in range(sent >> 20):
            connection.sendall(block)
    except OSError:
        pass  # refused: the answer says why
    return connection


def drafts(stage: Stage, name: str = "big.stl") -> list:
    # The server removes folders meanwhile; os.walk() passes over what is gone.
    return [folder for folder, _, files in os.walk(stage.folder.name) if name in files]


def test_uploads_fill_no_memory_and_are_counted(embody: str, wrong: list):
    size = 255 << 20
    with Stage(embody) as stage:
        before = stage.server.memory()
        unfinished = [begin_upload(stage.port, size, 8 << 20) for _ in range(12)]
        time.sleep(1)
        grown = stage.server.memory() - before
        print(f"  12 unfinished uploads of 8 MiB: the server grew by {grown >> 20} MiB; {len(drafts(stage))} are kept")
        if grown > 32 << 20:
            wrong.append(f"unfinished uploads made the server grow by {grown >> 20} MiB")
        if not 1 <= len(drafts(stage)) <= 8:
            wrong.append(f"{len(drafts(stage))} uploads are kept at once, 8 are allowed")
        refusals = 0
        for connection in unfinished[8:]:
            try:
                refusals += b" 503 " in connection.recv(4096).split(b"\r\n")[0]
            except OSError:
                refusals += 1  # the connection was closed while the client was still sending
        if refusals != 4:
            wrong.append(f"{refusals} of 4 uploads too many were refused")
        # Nothing is left of clients that disconnect.
        for connection in unfinished:
            connection.close()
        until = time.monotonic() + PATIENCE
        while drafts(stage) and time.monotonic() < until:
            time.sleep(0.1)
        if drafts(stage):
            wrong.append(f"{len(drafts(stage))} uploads are left of clients that went away")
        # And the next upload is accepted.
        answer, body = stage.get("/import?name=broken.stl", method="POST")
        if answer.status != 422:
            wrong.append(f"an upload after these is answered {answer.status}: {body[:200]!r}")


def test_a_killed_server_leaves_no_uploads(embody: str, wrong: list):
    with Stage(embody) as stage:
        upload = begin_upload(stage.port, 255 << 20, 4 << 20)
        until = time.monotonic() + PATIENCE
        while not drafts(stage) and time.monotonic() < until:
            time.sleep(0.1)
        stage.server.process.kill()
        stage.server.process.wait()
        upload.close()
        left = len(drafts(stage))
        scene = pathlib.Path(stage.folder.name) / "scene.json"
        with Server(embody, str(stage.database), str(scene)):
            if drafts(stage):
                wrong.append(f"{len(drafts(stage))} uploads of a killed server (of {left}) are there after the next start")
        if left == 0:
            wrong.append("the killed server kept no upload on disk: this test says nothing")


def test_sigterm_ends_whatever_runs(embody: str, wrong: list):
    with Stage(embody, heap(1000)) as stage:
        viewer = Viewer(stage.port)
        viewer.do("hello")
        viewer.do("entity.transform", poses=[{"index": 1, "position": [0, 5, 0]}])
        # A flood of commands behind a long one: reading pauses, and nobody reads the replies.
        viewer.ask("simulation.step", count=100_000)
        for _ in range(600):
            viewer.ask("entity.attributes", index=1)
        stalled = [Viewer(stage.port, buffer=1 << 12) for _ in range(4)]
        upload = begin_upload(stage.port, 255 << 20, 4 << 20)
        stage.end(wrong, "a long command, paused reading, stalled viewers, an upload")
        check_journal(stage, 5, wrong)
        for connection in (viewer, *stalled, upload):
            connection.close()


def check_journal(stage: Stage, height: float, wrong: list):
    journals = stage.journals_after_end()
    if len(journals) != 1:
        wrong.append(f"{len(journals)} journals after SIGTERM")
        return
    # The first edit is in the document itself; each line has its checksum before it.
    head, document = (json.loads(line.split(" ", 1)[1]) for line in journals[0].read_text().splitlines()[:2])
    entity = next(e for e in document["document"]["entities"] if e["index"] == 1)
    if head["embody_journal"] != 1 or entity["pose"]["position"] != [0, height, 0]:
        wrong.append(f"the journal has the first entity at {entity['pose']['position']}")


def children(process: int) -> list:
    return [int(child) for task in pathlib.Path(f"/proc/{process}/task").iterdir() for child in (task / "children").read_text().split()]


def folded_sheet(side: int) -> bytes:
    """A binary STL of side² × 2 triangles, which takes some seconds to prepare."""
    def corner(x, y):
        return struct.pack("<3f", x, (x * y) % 7, y)
    triangles = [bytes(12) + corner(x, y) + corner(x, y + 1) + corner(x + 1, y + flip) + bytes(2) for x in range(side) for y in range(side) for flip in (0, 1)]
    return bytes(80) + struct.pack("<I", len(triangles)) + b"".join(triangles)


def test_sigterm_ends_an_import(embody: str, wrong: list):
    with Stage(embody) as stage:
        viewer = Viewer(stage.port)
        viewer.do("hello")
        viewer.do("entity.transform", poses=[{"index": 1, "position": [0, 4, 0]}])
        content = folded_sheet(300)
        upload = socket.create_connection(("127.0.0.1", stage.port))
        upload.sendall(f"POST /import?name=sheet.stl HTTP/1.1\r\nHost: 127.0.0.1:{stage.port}\r\nContent-Length: {len(content)}\r\n\r\n".encode() + content)
        until = time.monotonic() + PATIENCE
        while not (workers := children(stage.server.process.pid)) and time.monotonic() < until:
            time.sleep(0.01)
        time.sleep(0.3)
        upload.settimeout(0.01)
        try:
            wrong.append(f"the import is over before SIGTERM, and this test says nothing: {upload.recv(200)!r}")
        except TimeoutError:
            pass
        stage.end(wrong, "an import in hand")
        check_journal(stage, 4, wrong)
        left = [worker for worker in workers if pathlib.Path(f"/proc/{worker}").exists()]
        if not workers or left:
            wrong.append(f"of {len(workers)} workers {len(left)} outlive the server")
        connection = sqlite3.connect(stage.database)
        whole = connection.execute("PRAGMA integrity_check").fetchall()
        models = connection.execute("SELECT count(*) FROM model WHERE key NOT LIKE 'primitive:%'").fetchone()[0]
        connection.close()
        if whole != [("ok",)] or models != 0:
            wrong.append(f"the database after it: {whole}, {models} models")
        if drafts(stage, "sheet.stl"):
            wrong.append("the upload is still there")
        viewer.close()
        upload.close()


def test_sigterm_ends_a_step_that_takes_long(embody: str, wrong: list):
    # One step of very many grains takes longer than the time for the server's end.
    heaps = [{"index": i + 1, "shape": {"type": "box", "half_extents": [1, 1, 1]}, "pose": {"position": [0, 1.1 + 2.2 * i, 0]},
              "attributes": {"kind": "granular", "grain_budget": 20_000}} for i in range(4)]
    with Stage(embody, heaps) as stage:
        viewer = Viewer(stage.port)
        viewer.do("hello")
        viewer.do("scene.settings", substeps=64)
        viewer.do("scene.settings", title="Changed")
        viewer.ask("simulation.step", count=10)
        time.sleep(1)
        stage.end(wrong, "a step of 80,000 grains")
        journals = stage.journals_after_end()
        if len(journals) != 1 or '"title":"Changed"' not in journals[0].read_text().splitlines()[-1]:
            wrong.append(f"the last edit was not kept: {journals}")
        viewer.close()


def main() -> int:
    # The tests open more connections than the server allows.
    hard = resource.getrlimit(resource.RLIMIT_NOFILE)[1]
    resource.setrlimit(resource.RLIMIT_NOFILE, (hard, hard))
    embody, *wanted = sys.argv[1:]
    failed = 0
    for name, test in sorted(globals().items()):
        if not name.startswith("test_") or (wanted and not any(word in name for word in wanted)):
            continue
        wrong = []
        print(name.removeprefix("test_").replace("_", " "), flush=True)
        try:
            test(embody, wrong)
        except Exception as error:
            wrong.append(f"{type(error).__name__}: {error}")
        for line in wrong:
            print("  wrong:", line, flush=True)
        failed += len(wrong) > 0
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
