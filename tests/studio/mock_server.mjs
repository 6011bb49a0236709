// SPDX-License-Identifier: MIT
// A stand-in for `embody serve` with as much of docs/protocol.md as the Studio's panels need, and as many models as a test wants.
// Physics and attributes are only imitated here; tests of these run the real server.
import { createReadStream, existsSync } from "node:fs";
import { createServer } from "node:http";
import { createRequire } from "node:module";
import { extname, join, normalize } from "node:path";
import { fileURLToPath } from "node:url";
import { boxGlb, PIXEL } from "./models.mjs";

const studio = fileURLToPath(new URL("../../studio/", import.meta.url));
const { WebSocketServer } = createRequire(join(studio, "package.json"))("ws");

const TYPES = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css" };
const NOUNS = ["chair", "table", "lamp", "sofa", "shelf", "bed", "stool", "vase"];

export class MockServer {
  constructor({ models = 40, port = 0 } = {}) {
    this.models = models;
    this.port = port;
    /** How late replies are, ms; events come at once. */
    this.late = 0;
    this.log = [];
    this.past = [];
    this.future = [];
    this.simulation = { state: "stopped", time: 0, step: 0 };
    this.scene = { title: "Mock", settings: {}, entities: [], joints: [], actions: [] };
    this.next = 1;
    this.put({ name: "Floor", shape: { type: "plane", normal: [0, 1, 0], offset: 0 } });
    this.put({ name: "Crate", shape: { type: "box", half_extents: [0.2, 0.2, 0.2] }, pose: { position: [0, 1, 0] } });
    this.bodies = new Map();
    this.resetBodies();
  }

  async start() {
    this.http = createServer((request, response) => this.answer(request, response));
    this.sockets = new WebSocketServer({ server: this.http, path: "/ws" });
    this.sockets.on("connection", (socket) => {
      socket.on("message", (text) => this.receive(socket, JSON.parse(text)));
    });
    await new Promise((done) => this.http.listen(this.port, "127.0.0.1", done));
    this.port = this.http.address().port;
    this.timer = setInterval(() => this.simulation.state === "playing" && this.step(), 1000 / 60);
    return `http://127.0.0.1:${this.port}/`;
  }

  async stop() {
    clearInterval(this.timer);
    for (const socket of this.sockets.clients) socket.terminate();
    this.http.closeAllConnections();
    await new Promise((done) => this.http.close(done));
  }

  put(entity) {
    const made = { pose: {}, ...entity, index: this.next++ };
    made.pose = { position: [0, 0, 0], rotation: [0, 0, 0, 1], ...entity.pose };
    this.scene.entities.push(made);
    return made;
  }

  entity(index) {
    return this.scene.entities.find((each) => each.index === index);
  }

  model(id) {
    const noun = NOUNS[id % NOUNS.length];
    return {
      id, key: `mock/${id}`, name: `${noun} ${id}`, source: "mock", licence: "CC0", author: "", category: noun, subcategory: "", kind: "rigid",
      tags: [], size: [0.5, 0.5, 0.5], vertices: 8, triangles: 12, parts: 1, quality: 2, geometry_kind: "mesh", content_hash: "1",
    };
  }

  attributes(index) {
    const manual = this.entity(index)?.attributes ?? {};
    const number = (name, kind, label, unit, value, source, level) => ({
      name, kind, label, unit, type: "number", choices: [], range: [0, 1e9], help: `${label} of the body.`, low: value * 0.7, high: value * 1.4,
      value: manual[name] ?? value, automatic: value, overridden: name in manual,
      source: name in manual ? "set by hand" : source, level: name in manual ? "manual" : level,
    });
    const word = (name, kind, label, value, choices) => ({
      name, kind, label, unit: "", type: "word", choices, range: null, help: label, low: null, high: null, value: manual[name] ?? value,
      automatic: value, overridden: name in manual, source: "the category's usual", level: "category",
    });
    return [
      word("kind", "identity", "Physical kind", "rigid", ["static", "rigid", "soft"]),
      number("mass", "mass", "Mass", "kg", 6.4, "bulk density of a wooden chair × its box", "subcategory"),
      { ...number("center_of_mass", "mass", "Centre of mass", "m", 0, "computed", "measured"), type: "vector", value: manual.center_of_mass ?? [0, 0.25, 0], automatic: [0, 0.25, 0], low: null, high: null },
      word("surface_material", "surface", "Surface", "wood", ["wood", "steel", "glass"]),
      number("friction_dynamic", "surface", "Sliding friction", "1", 0.4, "wood on wood, handbook", "category"),
    ];
  }

  // Commands by name; each returns its result and may edit the scene.
  commands = {
    hello: () => ({ version: "0.0-mock", scene: this.scene, revision: 1, simulation: this.simulation, frame_version: 2, undo: null, redo: null, unsaved: false, name: "", client: 7, members: [{ client: 7, name: "Studio 7", color: "#0072b2" }], recovered: [], spawned: [], despawned: [] }),
    "catalog.categories": () => ({ categories: NOUNS.map((category) => ({ category, models: Math.ceil(this.models / NOUNS.length) })) }),
    "catalog.model": ({ key }) => ({ model: this.model(Number(key.split("/")[1])), attributes: [] }),
    "catalog.search": ({ words = "", category = "", limit = 50, offset = 0 }) => {
      const wanted = NOUNS.findIndex((noun) => noun === category || (words && noun.startsWith(words.toLowerCase())));
      if ((words || category) && wanted < 0) return { models: [], total: 0 };
      const every = wanted < 0 ? 1 : NOUNS.length;
      const total = Math.ceil(this.models / every);
      const count = Math.max(0, Math.min(limit, total - offset));
      return { models: Array.from({ length: count }, (_, at) => this.model((offset + at) * every + Math.max(wanted, 0))), total };
    },
    "scene.list": () => ({ scenes: [{ name: "mock", title: "Mock", kind: "demo", modified: null }] }),
    "scene.save": ({ name }) => {
      this.scene.title = name ?? this.scene.title;
      this.unsaved = false;
      this.tell([]);
      return { name: this.scene.title, path: "mock.json" };
    },
    "scene.new": () => {
      this.scene = { title: "Untitled", settings: {}, entities: [], joints: [], actions: [] };
      this.unsaved = false;
      this.tell([{ op: "reset", scene: this.scene }]);
    },
    "client.present": () => {},
    "simulation.listen": () => {},
    "entity.lock": ({ indices, locked }) => this.edit("lock", () => indices.forEach((index) => (this.entity(index).locked = locked))),
    "catalog.stop": () => {},
    "scene.settings": (settings) => this.edit("change settings", () => Object.assign(this.scene.settings, settings), [{ op: "settings", settings }]),
    "entity.add": ({ entity, drop }) => {
      let added;
      this.edit(`add ${entity.name}`, () => {
        const t = drop && drop.direction[1] < 0 ? -drop.origin[1] / drop.direction[1] : 0;
        const position = drop ? drop.origin.map((o, axis) => (axis === 1 ? 0.3 : o + t * drop.direction[axis])) : undefined;
        added = this.put({ ...entity, pose: position ? { position } : entity.pose });
      });
      return { index: added.index };
    },
    "entity.remove": ({ indices }) => this.edit("delete", () => (this.scene.entities = this.scene.entities.filter(({ index }) => !indices.includes(index)))),
    "entity.transform": ({ poses, merge }) => {
      const begun = merge && merge === this.merge ? this.past.pop() : null;
      this.merge = merge;
      this.edit("move", () => poses.forEach(({ index, ...pose }) => Object.assign(this.entity(index).pose, pose)));
      // One drag is one undo step: undo goes back to the state before the first message of the drag.
      if (begun) this.past[this.past.length - 1] = begun;
    },
    "entity.update": ({ index, entity }) => this.edit("change", () => Object.assign(this.entity(index), entity)),
    "entity.set_attribute": ({ indices, name, value }) => {
      if (name === "mass" && !(value > 0)) throw { where: name, why: "the mass must be above 0 kg", remedy: "" };
      const whole = (index) => (Array.isArray(value) ? value.map((part, at) => part ?? (this.attributes(index).find((each) => each.name === name).value[at])) : value);
      this.edit(`set ${name}`, () => indices.forEach((index) => (this.entity(index).attributes = { ...this.entity(index).attributes, [name]: whole(index) })));
    },
    "entity.reset_attribute": ({ indices, name }) => this.edit(`reset ${name}`, () => indices.forEach((index) => delete this.entity(index).attributes?.[name])),
    "entity.attributes": ({ index }) => ({ attributes: this.attributes(index) }),
    "entity.collision_shape": () => ({
      shape: {
        type: "compound",
        children: [0, 1, 2].map((x) => ({
          type: "hull",
          points: [[x, 0, 0], [x + 0.5, 0, 0], [x, 1, 0], [x, 0, 1]],
        })),
      },
    }),
    "action.trigger": () => ({ started: 1 }),
    "edit.undo": () => this.travel(this.past, this.future),
    "edit.redo": () => this.travel(this.future, this.past),
    "simulation.play": () => this.setState("playing"),
    "simulation.pause": () => this.setState("paused"),
    "simulation.step": () => (this.setState("paused"), this.step()),
    "simulation.reset": () => {
      this.resetBodies();
      Object.assign(this.simulation, { time: 0, step: 0 });
      this.setState("stopped");
      this.sendFrame();
    },
  };

  receive(socket, { id, command, params }) {
    this.log.push({ command, params });
    const carryOut = this.commands[command];
    let reply;
    try {
      if (!carryOut) throw { where: "command", why: `unknown command ${command}`, remedy: "see docs/protocol.md" };
      reply = { id, ok: true, result: carryOut(params) ?? {} };
    } catch (error) {
      if (error instanceof Error) throw error;
      reply = { id, ok: false, error };
    }
    const answer = () => socket.send(JSON.stringify(reply));
    if (this.late > 0) setTimeout(answer, this.late);
    else answer();
    if (command === "hello") this.sendFrame();
  }

  edit(label, change, further = []) {
    this.past.push({ label, before: structuredClone(this.scene) });
    this.future = [];
    const before = structuredClone(this.scene.entities);
    change();
    this.tellDifference(before, further);
  }

  travel(from, to) {
    const step = from.pop();
    if (!step) return {};
    const before = structuredClone(this.scene.entities);
    to.push({ label: step.label, before: structuredClone(this.scene) });
    this.scene = step.before;
    this.tellDifference(before);
    return {};
  }

  tellDifference(before, further = []) {
    const changes = [...further];
    for (const { index } of before) if (!this.entity(index)) changes.push({ op: "entity_removed", index });
    const known = new Map(before.map((entity) => [entity.index, JSON.stringify(entity)]));
    for (const entity of this.scene.entities) if (known.get(entity.index) !== JSON.stringify(entity)) changes.push({ op: "entity", entity });
    this.unsaved = true;
    this.tell(changes);
    this.resetBodies();
    this.sendFrame();
  }

  tell(changes) {
    this.broadcast({ event: "document", revision: 1, changes, unsaved: this.unsaved ?? false, name: "" });
    this.broadcast({ event: "history", undo: this.past.at(-1)?.label ?? null, redo: this.future.at(-1)?.label ?? null });
  }

  broadcast(event) {
    for (const socket of this.sockets.clients) socket.send(JSON.stringify(event));
  }

  setState(state) {
    this.simulation.state = state;
    this.broadcast({ event: "simulation", ...this.simulation });
  }

  resetBodies() {
    this.bodies = new Map();
    for (const { index, pose, shape } of this.scene.entities) {
      const still = shape?.type === "plane";
      this.bodies.set(index, { position: [...pose.position], rotation: pose.rotation, speed: 0, state: still ? 3 : 0, rest: shape ? 0.2 : 0, quiet: 0 });
    }
  }

  step() {
    Object.assign(this.simulation, { time: this.simulation.time + 1 / 60, step: this.simulation.step + 1 });
    for (const body of this.bodies.values()) {
      if (body.state === 3) continue;
      body.speed += 9.81 / 60;
      body.position[1] = Math.max(body.rest, body.position[1] - body.speed / 60);
      if (body.position[1] > body.rest) continue;
      body.speed = 0;
      ++body.quiet;
      body.state = body.quiet < 10 ? 0 : body.quiet < 40 ? 1 : 2;
    }
    this.sendFrame();
    if (this.simulation.step % 15 === 0) this.sendStatistics();
  }

  sendStatistics() {
    const count = (state) => [...this.bodies.values()].filter((body) => body.state === state).length;
    this.broadcast({
      event: "statistics", time: this.simulation.time, step: this.simulation.step, bodies: this.bodies.size, things: count(0) + count(1) + count(2),
      active: count(0), wants_to_sleep: count(1), asleep: count(2), points: 0, contacts: 4, step_ms: 0.21, real_time_factor: 1,
    });
  }

  sendFrame() {
    const frame = Buffer.alloc(32 + 36 * this.bodies.size);
    frame.writeUInt32LE(0x46424d45, 0);
    frame.writeUInt16LE(2, 4);
    frame.writeUInt32LE(this.bodies.size, 8);
    frame.writeDoubleLE(this.simulation.time, 16);
    frame.writeBigUInt64LE(BigInt(this.simulation.step), 24);
    let at = 32;
    for (const [index, { position, rotation, state }] of this.bodies) {
      frame.writeUInt32LE(index, at);
      [...position, ...rotation].forEach((number, which) => frame.writeFloatLE(number, at + 4 + 4 * which));
      frame.writeUInt8(state, at + 32);
      at += 36;
    }
    for (const socket of this.sockets?.clients ?? []) socket.send(frame);
  }

  answer(request, response) {
    const path = normalize(new URL(request.url, "http://mock").pathname);
    if (path.endsWith("thumbnail.png")) return response.writeHead(200, { "content-type": "image/png" }).end(PIXEL);
    if (path.endsWith("geometry.glb")) return response.writeHead(200, { "content-type": "model/gltf-binary" }).end(boxGlb());
    const file = join(studio, "dist", path === "/" ? "index.html" : path);
    if (!existsSync(file)) return response.writeHead(404).end();
    response.writeHead(200, { "content-type": TYPES[extname(file)] ?? "application/octet-stream" });
    createReadStream(file).pipe(response);
  }
}
