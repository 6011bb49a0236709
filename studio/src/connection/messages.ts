// SPDX-License-Identifier: MIT
// The commands and events of docs/protocol.md as types. SI units, Y up, rotations x y z w.
import type { DebugName } from "./debug_frame";
import type { Action, Camera, Entity, Joint, Level, Pose, Scene, SceneSettings, Shape, Vector, Quaternion } from "./scene_types";

export interface ModelSummary {
  id: number;
  key: string;
  name: string;
  source: string;
  licence: string;
  author: string;
  category: string;
  subcategory: string;
  kind: string;
  tags: string[];
  size: Vector;
  vertices: number;
  triangles: number;
  parts: number;
  quality: number;
  geometry_kind: string;
  content_hash: string;
}

/** A vector has three numbers, a symmetric tensor six: xx, yy, zz, xy, xz, yz. */
export type AttributeValue = number | string | boolean | number[];
/** What an attribute is set to; components of a vector or tensor that are null stay as they are. */
export type AttributeEdit = AttributeValue | (number | null)[];

export interface AttributeEntry {
  name: string;
  kind: string;
  kind_label: string;
  label: string;
  value: AttributeValue;
  unit: string;
  low: number | null;
  high: number | null;
  source: string;
  level: string;
  help: string;
  type: "number" | "word" | "truth" | "vector" | "tensor";
  choices: string[];
  range: [number | null, number | null] | null;
  automatic: AttributeValue | null;
  overridden: boolean;
  /** Why the value makes no sense. */
  warnings: ValueWarning[];
  /** Of an entity with a model: the value without the entity's scale. */
  of_model?: AttributeValue;
}

/** A value that contradicts others, or that no real thing has. */
export interface ValueWarning {
  why: string;
  remedy: string;
  /** The attribute whose automatic value mends it. */
  reset: string | null;
}

/** A material that whole things are made of, and what follows from it. */
export interface MaterialPreset {
  preset: string;
  label: string;
  source: string;
  values: { name: string; label: string; unit: string; value: number; low: number | null; high: number | null }[];
}

/** Joints and actions without their numbers, and changes of them; null: the format's default. */
export type JointEdit = { [Field in "name" | "type" | "entity_a" | "entity_b" | "bodies_collide" | "limit" | "motor"]?: unknown } & { anchor?: Vector; axis?: Vector };
export type NewAction = Omit<Action, "id">;
export type ActionEdit = { [Field in keyof NewAction]?: NewAction[Field] | null };

/** The models that a change is for. */
export type ModelChoice = { keys: string[] } | { words?: string; category?: string } | { all: true };

/** What a change of the catalogue did, or would do. */
export interface ChangeSummary {
  batch: number | null;
  command: string;
  label: string;
  dry_run: boolean;
  chosen: number;
  changed: number;
  values: number;
  unchanged: number;
  refused: number;
  /** The first of the models that change, and of those that refuse. */
  models: { key: string; name: string }[];
  refusals: { key: string; name: string; attribute: string; why: string }[];
  /** In the open scene: how many entities take the new value, and how many keep a value of their own. */
  entities: { following: number; keeping: number };
}

/** One change of the catalogue by a person. */
export interface ChangeBatch {
  batch: number;
  time: string;
  person: string;
  session: string;
  command: string;
  asked: string;
  undoes: number | null;
  undone_by: number | null;
  values: number;
  models: number;
  /** The first changed values; null: the automatic value was used. */
  changes: { key: string; name: string; attribute: string; label: string; unit: string; before: AttributeValue | null; after: AttributeValue | null }[];
}

export interface SceneListing {
  name: string;
  title: string;
  /** Not of a recovery. */
  description?: string;
  /** `recovery`: work that was not saved before its program ended or another scene was opened. */
  kind: "saved" | "recovery" | "demo";
  modified: string | null;
  /** Of a recovery: how many edits it has. */
  edits?: number;
}

/** Unsaved work that was found. */
export interface Recovery {
  name: string;
  title: string;
  modified: string | null;
  edits: number;
}

/** A page that is connected; the colour is "#rrggbb". */
/** What a client may do besides looking. */
export interface Rights {
  edit: boolean;
  run: boolean;
  /** Say what others may do. */
  invite: boolean;
}

export interface Member {
  client: number;
  name: string;
  color: string;
  rights: Rights;
}

/** Addresses by which others come, and what they may do then; one for each network of the server's machine. */
export interface Invitation {
  rights: Rights;
  urls: string[];
}

export interface Hand {
  hand: "left" | "right";
  position: Vector;
  rotation: Quaternion;
  /** Index of the entity that it holds. */
  holds?: number;
}

/** What a member looks at, points at, selects and holds. */
export interface Presence {
  selection?: number[];
  camera?: Camera;
  /** The point under the mouse; null: it is elsewhere. */
  pointer?: { position: Vector } | null;
  /** Of a headset. */
  head?: Required<Pose> | null;
  hands?: Hand[];
  mode?: "page" | "headset";
}

export type SimulationState = "stopped" | "playing" | "paused";
export interface Simulation {
  state: SimulationState;
  time: number;
  step: number;
  /** Simulated seconds in one of the clock's, as it was set. */
  rate?: number;
}

/** What is recorded of the run; times in simulated seconds. */
export interface TakeState {
  start: number;
  end: number;
  /** The moment that is shown; null: what is now. */
  shown: number | null;
  bytes: number;
  samples: number;
  /** Another number: there are other marks. */
  marks: number;
}

/** Something that happened in the run. */
export interface TimeMark {
  time: number;
  kind: "contact" | "action" | "rope_broke" | "sheet_tore" | "hand" | "branch";
  a?: number;
  b?: number;
  /** N s. */
  impulse?: number;
  name?: string;
}

export type Quantity = "height" | "x" | "z" | "speed" | "spin" | "kinetic_energy" | "momentum";

/** Values at the times that were told with them; null where the thing was not there. */
export interface Curve {
  index: number;
  quantity: Quantity;
  unit: string;
  values: (number | null)[];
}

export interface Statistics {
  time: number;
  step: number;
  /** All entities in the world. */
  bodies: number;
  /** Entities that can move, and how many of them are in each state; a pile of grains, a liquid or a cloth counts as one. */
  things: number;
  active: number;
  wants_to_sleep: number;
  asleep: number;
  /** Grains, particles of liquids and nodes of deformable things. */
  points: number;
  contacts: number;
  step_ms: number;
  real_time_factor: number;
}

/** Where it went wrong, why, and what the user can do. */
export interface ServerError {
  where: string;
  why: string;
  remedy: string;
}

/** Parameters of one entity.add; the server fills in the rest. */
export type NewEntity = Partial<Omit<Entity, "index">>;

export interface PoseEdit {
  index: number;
  position?: Vector;
  rotation?: Quaternion;
}

export interface Ray {
  origin: Vector;
  direction: Vector;
}

/** A new contact that can be heard. `a` and `b` are the entities; the impulse in N s. */
export interface Impact {
  position: Vector;
  impulse: number;
  a: number;
  b: number;
}

/** Where the pointer drops something. */
export interface Drop extends Ray {
  /** False: backs are not turned to walls, gaps are not closed. */
  snap?: boolean;
}

/** Where a thing comes to lie, or lies. */
export interface Placed {
  pose: { position: Vector; rotation: Quaternion };
  on: number | null;
  placement: "floor" | "wall" | "ceiling";
  /** Of a thing that is there: what a drag puts where the pointer's ray meets the scene. */
  point?: Vector;
}

export type Axis = "x" | "y" | "z";

/** The scene and its simulation at the time when a client connects. */
export interface Hello {
  version: string;
  scene: Scene;
  revision: number;
  simulation: Simulation;
  take?: TakeState;
  frame_version: number;
  /** Labels of what this person can undo and redo. */
  undo: string | null;
  redo: string | null;
  unsaved: boolean;
  name: string;
  members?: Member[];
  recovered?: Recovery[];
  /** This client's number. */
  client: number;
  /** Entities that actions added to the running world, and those of the document that actions removed. */
  spawned: Entity[];
  despawned: number[];
  /** Entities that wait for their models. */
  waiting?: number[];
  /** How far the filling of the library is; null: nothing is, or was, to be filled. */
  import?: LibraryFill | null;
  /** `invitations` only for who may invite; empty where the server answers nobody but its own machine. */
  server?: { tls: boolean; invitations?: Invitation[] };
}

/** Models that the server imports by itself. */
export interface LibraryFill {
  state: "running" | "done" | "stopped";
  done: number;
  /** 0: files are still looked for. */
  total: number;
  /** Null: not known yet. */
  seconds_left: number | null;
  /** The model just finished. */
  file: string;
  added: number;
  /** Light sources that have no shape. */
  skipped: number;
  failures: { path: string; why: string }[];
  /** What could not be had, in sentences. */
  notes: string[];
}

/** The mesh that carries a deformable entity's drawn form, at rest, in the entity's frame, with its scale applied. */
export interface SimulationMesh {
  /** x, y, z of each node, m. Where a sheet tore two nodes have the same place; the new one is the last. */
  nodes: number[];
  /** Of a solid: four nodes of each tetrahedron. */
  tetrahedra?: number[];
  /** Of cloth: three nodes of each triangle. */
  triangles?: number[];
  /** Of a rope, whose nodes follow each other: it is broken between each of these nodes and the next. */
  broken?: number[];
}

/** Of what opens another scene: where other members are asked first, who, and how many seconds they have; nothing is opened yet. */
export interface Asked {
  asked?: number[];
  question?: number;
  seconds?: number;
}

/** Parameters and result of each command. */
export interface Commands {
  hello: [{ person?: string }, Hello];
  "catalog.search": [{ words?: string; category?: string; limit?: number; offset?: number }, { models: ModelSummary[]; total: number }];
  "catalog.categories": [Record<string, never>, { categories: { category: string; models: number }[] }];
  "catalog.model": [{ key: string }, { model: ModelSummary; attributes: AttributeEntry[] }];
  "catalog.change": [
    { models: ModelChoice; attributes: { name: string; value: AttributeValue | null }[]; skip?: boolean; dry_run?: boolean },
    ChangeSummary,
  ];
  "catalog.set_attribute": [{ key: string; name: string; value: AttributeValue }, { attributes: AttributeEntry[]; batch: number | null }];
  "catalog.reset_attribute": [{ key: string; name: string }, { attributes: AttributeEntry[]; batch: number | null }];
  "catalog.undo": [{ batch: number }, ChangeSummary];
  "catalog.history": [{ key?: string; before?: number; limit?: number; changes?: number }, { batches: ChangeBatch[] }];
  "catalog.stop": [Record<string, never>, unknown];
  "client.set_name": [{ name: string }, { session: string }];
  "client.present": [Presence, unknown];
  "client.set_rights": [{ client: number; edit: boolean; run: boolean }, unknown];
  "scene.new": [{ name?: string; ask?: boolean }, Asked];
  "scene.load": [({ name: string; version?: string } | { scene: unknown } | { text: string; file: string }) & { ask?: boolean }, Asked];
  "scene.answer": [{ question: number; agrees: boolean }, unknown];
  "scene.save": [{ name?: string; camera?: Camera; version?: string }, { name: string; path: string }];
  "scene.versions": [{ name?: string }, { versions: { version: string; modified: string | null }[] }];
  "scene.discard": [{ name: string }, unknown];
  "scene.list": [Record<string, never>, { scenes: SceneListing[] }];
  "scene.settings": [Partial<SceneSettings> & Pick<Scene, "title" | "sky" | "time_of_day"> & { levels?: Level[]; merge?: string }, unknown];
  "room.add": [{ points: Vector[]; closed?: boolean; floor?: boolean; ceiling?: boolean; height?: number; thickness?: number }, { indices: number[] }];
  "entity.add": [{ entity: NewEntity; drop?: Drop }, { index: number }];
  "entity.preview": [{ entity: NewEntity; drop: Drop } | { index: number }, Placed];
  "entity.drag": [{ indices: number[]; drop: Drop; merge?: string }, Placed];
  "entity.move": [{ indices: number[]; offset: Vector; merge?: string }, unknown];
  "entity.turn": [{ indices: number[]; angle: number; merge?: string }, unknown];
  "entity.align": [{ indices: number[]; axis: Axis; at: "low" | "center" | "high" }, unknown];
  "entity.distribute": [{ indices: number[]; axis: Axis }, unknown];
  "entity.mirror": [{ indices: number[]; axis: Axis }, unknown];
  "entity.array": [{ indices: number[]; counts: Vector; spacing?: Vector }, { indices: number[] }];
  "entity.copy": [{ indices: number[] }, { part: unknown }];
  "entity.paste": [{ part: unknown; drop?: Drop; offset?: Vector }, { indices: number[] }];
  "entity.group": [{ indices: number[]; name?: string }, { group: string }];
  "entity.ungroup": [{ group: string }, { indices: number[] }];
  "entity.set_group": [{ indices: number[]; group: string; from?: string }, unknown];
  "entity.remove": [{ indices: number[] }, unknown];
  "entity.transform": [{ poses: PoseEdit[]; merge?: string }, unknown];
  "entity.update": [{ index: number; entity: NewEntity; merge?: string }, unknown];
  "entity.set_attribute": [{ indices: number[]; name: string; value: AttributeEdit; merge?: string }, unknown];
  "entity.reset_attribute": [{ indices: number[]; name: string }, unknown];
  "entity.lock": [{ indices: number[]; locked: boolean }, unknown];
  "entity.duplicate": [{ indices: number[]; offset?: Vector }, { indices: number[] }];
  "entity.drop_to_floor": [{ indices: number[] }, unknown];
  "entity.attributes": [{ index: number }, { attributes: AttributeEntry[] }];
  "entity.warnings": [{ indices?: number[] }, { entities: { index: number; warnings: (ValueWarning & { attribute: string; label: string })[] }[] }];
  "entity.presets": [Record<string, never>, { presets: MaterialPreset[] }];
  "entity.apply_preset": [{ indices: number[]; preset: string }, unknown];
  "entity.copy_attributes": [{ from: number; indices: number[]; names?: string[] }, { copied: number; skipped: { index: number; name: string; label: string }[] }];
  "entity.collision_shape": [{ index: number }, { shape: Shape | null }];
  "entity.simulation_mesh": [{ index: number; points?: number }, { mesh: SimulationMesh | null }];
  "edit.undo": [Record<string, never>, { undone: string | null }];
  "edit.redo": [Record<string, never>, { redone: string | null }];
  "simulation.play": [Record<string, never>, unknown];
  "simulation.pause": [Record<string, never>, unknown];
  "simulation.step": [{ count?: number }, unknown];
  "simulation.reset": [Record<string, never>, unknown];
  "simulation.keep": [Record<string, never>, unknown];
  "simulation.grab": [{ index: number; point: Vector; target: Vector; hand?: string; rotation?: Quaternion; strength?: number }, unknown];
  "simulation.move_grab": [{ target: Vector; rotation?: Quaternion; hand?: string }, unknown];
  "simulation.release": [{ hand?: string }, unknown];
  "simulation.listen": [{ impacts: boolean }, unknown];
  "simulation.touch": [{ hand: string; position?: Vector; rotation?: Quaternion; radius?: number }, unknown];
  "simulation.set_rate": [{ rate: number }, unknown];
  "time.seek": [{ time: number }, { time: number; step: number }];
  "time.branch": [Record<string, never>, { time: number; notes: string[] }];
  "time.marks": [Record<string, never>, { marks: TimeMark[]; revision: number }];
  "time.curves": [{ curves: { index: number; quantity: Quantity }[]; from?: number; to?: number; samples?: number }, { times: number[]; curves: Curve[] }];
  "time.frame": [{ time?: number }, { frame: string; spawned: Entity[] }];
  "joint.add": [JointEdit, { index: number }];
  "joint.update": [{ index: number; joint: JointEdit }, unknown];
  "joint.remove": [{ index: number }, unknown];
  "action.add": [NewAction, { index: number }];
  "action.update": [{ index: number; action: ActionEdit }, unknown];
  "action.move": [{ index: number; place: number }, { index: number }];
  "action.remove": [{ index: number }, unknown];
  "action.run": [{ index: number; sender?: number }, unknown];
  "debug.draw": [{ show: readonly DebugName[]; of?: number[] }, unknown];
  "action.trigger": [{ key?: string; button?: string }, { started: number }];
}

export type DocumentChange =
  | { op: "reset"; scene: Scene }
  | { op: "entity"; entity: Entity }
  | { op: "pose"; index: number; pose: Pose }
  | { op: "entity_removed"; index: number }
  | { op: "settings"; settings: Partial<SceneSettings> & Pick<Scene, "title" | "description" | "sky" | "time_of_day"> & { camera?: Scene["camera"] | null; levels?: Level[] } }
  | { op: "joint"; joint: Joint }
  | { op: "joint_removed"; index: number }
  | { op: "action"; action: Action }
  | { op: "action_removed"; index: number };

export interface DocumentEvent {
  event: "document";
  revision: number;
  changes: DocumentChange[];
  unsaved: boolean;
  /** Name under which the scene was saved; empty where it never was. */
  name: string;
}

/** Models were changed by hand. */
export interface CatalogEvent {
  event: "catalog";
  batch: number;
  command: string;
  label: string;
  models: number;
  /** Null: too many to list. */
  keys: string[] | null;
  attributes: string[];
  session: string;
  /** Null: another program changed them. */
  client: number | null;
}

/** Another member wants to open something: does this one agree? */
export interface Question {
  question: number;
  client: number;
  name: string;
  /** Title of the scene that would be opened. */
  title: string;
  text: string;
  /** Without an answer in this time, s, it is opened. */
  seconds: number;
}

export interface Progress {
  client: number;
  done: number;
  total: number;
}

export type ServerEvent =
  | DocumentEvent
  | ({ event: "simulation" } & Simulation)
  | ({ event: "take" } & TakeState)
  | { event: "spawned"; entity: Entity }
  | { event: "despawned"; index: number }
  | { event: "waiting"; indices: number[] }
  | ({ event: "import" } & LibraryFill)
  | ({ event: "statistics" } & Statistics)
  | CatalogEvent
  | ({ event: "progress" } & Progress)
  | { event: "members"; members: Member[] }
  | ({ event: "presence"; client: number } & Presence)
  | { event: "history"; undo: string | null; redo: string | null }
  | ({ event: "question" } & Question)
  | { event: "question_over"; question: number }
  | { event: "rope_broke"; index: number; segment: number; tension: number; position: Vector }
  | { event: "sheet_tore"; index: number; nodes: number; position: Vector }
  | { event: "impacts"; impacts: Impact[] }
  | { event: "hand"; hand: string; impulse: number; index: number; other: number; position: Vector }
  | { event: "action"; name: string; id: number; sender: number; receiver: number }
  | { event: "message"; level: "info" | "warning" | "error"; text: string };
