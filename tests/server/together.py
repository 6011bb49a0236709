#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Eight people build in one scene at once: what each does reaches all others, everybody ends with the same document, and the server does
not grow. How long an edit takes to reach the others is printed, not judged: that depends on the machine.

Usage: together.py EMBODY [--seconds S] [--clients N] [--rate EDITS_A_SECOND] [--edits N] [--acts ACT,ACT…]
    (an hour: --seconds 3600; an hour's edits in minutes: --rate 50 --edits 90000 --seconds 3600)
"""
import argparse
import json
import pathlib
import random
import sys
import tempfile
import threading
import time

from viewer import Server, Viewer

BOXES = 100
FLOOR = {"index": 1, "name": "Floor", "locked": True, "shape": {"type": "plane", "normal": [0, 1, 0], "offset": 0}, "attributes": {"kind": "static"}}
SCENE = {
    "embody_scene": 1,
    "title": "Together",
    "entities": [FLOOR] + [{"index": i + 2, "shape": {"type": "box", "half_extents": [0.1, 0.1, 0.1]}, "pose": {"position": [i % 10, 0.1, i // 10]}} for i in range(BOXES)],
}
EDITS_A_SECOND = 5  # of each person, unless --rate says otherwise
ACTS = {"move": 0.7, "attribute": 0.1, "undo": 0.1, "time": 0.05, "add": 0.05}  # what edits are of
PRESENCES_A_SECOND = 15
MAX_LEFT = 5  # things that a person has added and not removed yet
MEGABYTE = 1e6


class Person:
    """A page: one thread edits, one reads all that the server sends."""

    def __init__(self, port: int, number: int, told: dict, options):
        self.number, self.told, self.options = number, told, options
        self.chance = random.Random(number)
        self.viewer = Viewer(port)
        self.viewer.do("hello", person=f"person {number}")
        self.viewer.do("client.set_name", name=f"Person {number}")
        self.delays, self.seen, self.refused, self.edits = [], set(), 0, 0
        self.added: list = []  # by this person, ever
        self.there: set = set()  # entities that were added, by anybody
        self.replies: dict = {}
        self.ended = threading.Event()
        self.fault = None
        self.reader = threading.Thread(target=self.read, daemon=True)
        self.reader.start()

    def read(self):
        try:
            while not self.ended.is_set():
                message = self.viewer.read()
                if not isinstance(message, dict):
                    continue
                if "id" in message:
                    self.replies[message["id"]] = message
                elif message["event"] == "document":
                    for change in message["changes"]:
                        if change["op"] == "entity":
                            self.there.add(change["entity"]["index"])
                        elif change["op"] == "entity_removed":
                            self.there.discard(change["index"])
                        # The height of a box is the name of the edit that put it there; undo may bring it back later.
                        height = change["pose"]["position"][1] if change["op"] == "pose" else None
                        if height not in self.seen and (sent := self.told.get(height)) and sent[0] != self.number:
                            self.seen.add(height)
                            self.delays.append(time.monotonic() - sent[1])
        except (ConnectionError, OSError) as error:
            if not self.ended.is_set():
                self.fault = error

    def wait_for(self, command: int) -> dict:
        until = time.monotonic() + 120
        while command not in self.replies:
            assert self.fault is None, self.fault
            assert time.monotonic() < until, "no reply"
            time.sleep(0.001)
        return self.replies.pop(command)

    def edit(self):
        chance = self.chance
        act = chance.choices(self.options.acts, [ACTS[name] for name in self.options.acts])[0]
        if act == "move":
            height = round(chance.uniform(0.1, 2), 12)
            self.told[height] = (self.number, time.monotonic())
            command = self.viewer.ask("entity.transform", poses=[{"index": chance.randrange(2, BOXES + 2), "position": [chance.uniform(0, 10), height, chance.uniform(0, 10)]}])
        elif act == "attribute":
            command = self.viewer.ask("entity.set_attribute", indices=[chance.randrange(2, BOXES + 2)], name="friction_dynamic", value=chance.uniform(0.1, 1))
        elif act == "undo":
            command = self.viewer.ask("edit.undo")
        elif act == "time":
            command = self.viewer.ask("simulation.play" if chance.random() < 0.5 else "simulation.reset")
        else:
            # Things come and go. Those that undo has brought back go with the new one, or the scene would grow.
            place = [chance.uniform(0, 10), 3, chance.uniform(0, 10)]
            added = self.wait_for(self.viewer.ask("entity.add", entity={"shape": {"type": "sphere", "radius": 0.1}, "pose": {"position": place}}))
            self.added.append(added["result"]["index"])
            command = self.viewer.ask("entity.remove", indices=[index for index in self.added if index in self.there])
        self.refused += not self.wait_for(command)["ok"]
        self.edits += 1

    def live(self, until: float):
        try:
            began, presences = time.monotonic(), 0
            while (now := time.monotonic()) < until and self.edits < self.options.edits / self.options.clients:
                if now >= began + self.edits / self.options.rate:
                    self.edit()
                if now >= began + presences / PRESENCES_A_SECOND:
                    self.wait_for(self.viewer.ask("client.present", camera={"position": [self.chance.uniform(0, 5), 2, 5], "target": [5, 0, 5]}, selection=[self.number + 2]))
                    presences += 1
                time.sleep(max(0, began + min(self.edits / self.options.rate, presences / PRESENCES_A_SECOND) - time.monotonic()))
        except (AssertionError, OSError) as error:
            self.fault = error

    def document(self) -> dict:
        return self.wait_for(self.viewer.ask("hello"))["result"]["scene"]

    def close(self):
        self.ended.set()
        self.viewer.close()


def percentile(values: list, part: float) -> float:
    return sorted(values)[min(len(values) - 1, int(part * len(values)))] if values else float("nan")


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("embody")
    parser.add_argument("--seconds", type=float, default=20)
    parser.add_argument("--clients", type=int, default=8)
    parser.add_argument("--rate", type=float, default=EDITS_A_SECOND)
    parser.add_argument("--edits", type=float, default=float("inf"))
    parser.add_argument("--acts", type=lambda words: words.split(","), default=list(ACTS))
    options = parser.parse_args()
    wrong, told = [], {}
    with tempfile.TemporaryDirectory() as folder:
        scene = pathlib.Path(folder) / "together.json"
        scene.write_text(json.dumps(SCENE))
        with Server(options.embody, str(pathlib.Path(folder) / "models.sqlite"), str(scene)) as server:
            people = [Person(server.port, number, told, options) for number in range(options.clients)]
            began = time.monotonic()
            lives = [threading.Thread(target=person.live, args=(began + options.seconds,)) for person in people]
            for life in lives:
                life.start()
            # Memory once the journal and everybody's list of undo have their length, and at the end.
            samples = []
            while any(life.is_alive() for life in lives):
                time.sleep(min(5, options.seconds / 20))
                samples.append(server.memory())
            for life in lives:
                life.join()
            wrong += [f"person {person.number}: {person.fault}" for person in people if person.fault]
            if not wrong:
                documents = [person.document() for person in people]
                if any(document != documents[0] for document in documents):
                    wrong.append("people have different documents")
                things = len(documents[0]["entities"])
                if things > len(SCENE["entities"]) + MAX_LEFT * options.clients:
                    wrong.append(f"the scene has grown to {things} things: then memory has a reason to grow")
                delays = [delay for person in people for delay in person.delays]
                edits = sum(person.edits for person in people)
                if len(delays) < edits:
                    wrong.append(f"only {len(delays)} times somebody was told of one of {edits} edits")
                third = len(samples) // 3
                early, late = max(samples[third:2 * third]), max(samples[2 * third:])
                print(f"{options.clients} people, {options.seconds:.0f} s: {edits} edits ({sum(person.refused for person in people)} refused), {things} things, told to the others {len(delays)} times after "
                      f"{1e3 * percentile(delays, 0.5):.1f} ms (median), {1e3 * percentile(delays, 0.99):.1f} ms (99 %), {1e3 * max(delays):.0f} ms (longest); "
                      f"memory {samples[0] / MEGABYTE:.1f} MB at first, {early / MEGABYTE:.1f} MB in the second third, {late / MEGABYTE:.1f} MB in the last")
                # The lists of undo fill in the first thousand steps of a person; that is the only growth that a short run may see.
                if late > 1.05 * early + 10 * MEGABYTE:
                    wrong.append(f"the server grew from {early} to {late} bytes")
            for person in people:
                person.close()
    for line in wrong:
        print("wrong:", line)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
