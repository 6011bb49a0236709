// SPDX-License-Identifier: MIT
import type { DocumentChange, DocumentEvent, Hello } from "../connection/messages";
import { Signal } from "../signal";
import { type Action, type Camera, DEFAULT_SETTINGS, type Entity, type Joint, type Level, type Pose, type Quaternion, type Scene, type SceneSettings, type Vector } from "../connection/scene_types";
import { t, translateServerText } from "../language";

/** The hour of the day where a scene says none. */
const USUAL_HOUR = 14;

/** Parts of the document that changed with an event. */
export interface Changed {
  /** Another scene was opened: nothing of the last one remains. */
  all: boolean;
  entities: number[];
  removed: number[];
  settings: boolean;
  joints: boolean;
  actions: boolean;
}

/** The client's copy of the open scene. It changes only by the server's events. */
export class SceneDocument {
  readonly changed = new Signal<Changed>();
  /** What this person can undo and redo has changed. */
  readonly historyChanged = new Signal<void>();
  readonly entities = new Map<number, Entity>();
  /** Entities that actions added to the running world; they are not in the document, and hide one of it with the same index. */
  readonly spawned = new Map<number, Entity>();
  /** Entities of the document that actions removed from the running world. */
  readonly absent = new Set<number>();
  /** Entities whose models are not in the database yet: neither simulated nor drawn. */
  readonly waiting = new Set<number>();
  readonly joints = new Map<number, Joint>();
  readonly actions = new Map<number, Action>();
  settings: SceneSettings = DEFAULT_SETTINGS;
  /** Sun and sky are drawn, for this hour of the day. */
  sky = false;
  timeOfDay = USUAL_HOUR;
  camera: Camera | null = null;
  levels: readonly Level[] = [];
  title = "";
  description = "";
  name = "";
  /** Labels of what this person can undo and redo; null: nothing. */
  undo: string | null = null;
  redo: string | null = null;
  unsaved = false;

  entity(index: number): Entity | undefined {
    return this.spawned.get(index) ?? this.entities.get(index);
  }

  /** Replaces everything by the answer to hello. */
  reset(hello: Hello): void {
    this.takeScene(hello.scene);
    for (const entity of hello.spawned ?? []) this.spawned.set(entity.index, entity);
    for (const index of hello.despawned ?? []) this.absent.add(index);
    for (const index of hello.waiting ?? []) this.waiting.add(index);
    this.takeHeading(hello);
    this.setHistory(hello);
    this.changed.emit({ ...nothingChanged(), all: true, settings: true, joints: true, actions: true });
  }

  apply(event: DocumentEvent): void {
    const changed = nothingChanged();
    for (const change of event.changes) this.applyChange(change, changed);
    this.takeHeading(event);
    this.changed.emit(changed);
  }

  /** An action added an entity to the running world. */
  spawn(entity: Entity): void {
    // What the document has comes back: an action had removed it.
    if (!this.entities.has(entity.index)) this.spawned.set(entity.index, entity);
    this.absent.delete(entity.index);
    this.changed.emit({ ...nothingChanged(), entities: [entity.index] });
  }

  /** An action removed an entity from the running world; an entity of the document stays in it and comes back with a reset. */
  despawn(index: number): void {
    this.spawned.delete(index);
    if (this.entities.has(index)) this.absent.add(index);
    this.changed.emit({ ...nothingChanged(), removed: [index] });
  }

  /** These entities wait for their models now; others have arrived. */
  wait(indices: readonly number[]): void {
    const before = [...this.waiting];
    this.waiting.clear();
    for (const index of indices) this.waiting.add(index);
    this.changed.emit({ ...nothingChanged(), entities: [...new Set([...before, ...indices])].filter((index) => this.entities.has(index)) });
  }

  /** The running world has the document's entities again. */
  forgetSpawned(): void {
    const removed = [...this.spawned.keys()];
    this.spawned.clear();
    this.absent.clear();
    this.changed.emit({ ...nothingChanged(), removed, entities: [...this.entities.keys()] });
  }

  /** Sets what this person can undo and redo. */
  takeHistory(history: Pick<Hello, "undo" | "redo">): void {
    this.setHistory(history);
    this.historyChanged.emit();
  }

  private setHistory({ undo, redo }: Pick<Hello, "undo" | "redo">): void {
    this.undo = undo ?? null;
    this.redo = redo ?? null;
  }

  private takeHeading({ unsaved, name }: Pick<Hello, "unsaved" | "name">): void {
    this.unsaved = unsaved ?? false;
    this.name = name ?? "";
  }

  private takeScene(scene: Scene): void {
    this.entities.clear();
    this.spawned.clear();
    this.absent.clear();
    this.waiting.clear();
    this.joints.clear();
    this.actions.clear();
    for (const entity of scene.entities ?? []) this.entities.set(entity.index, entity);
    for (const joint of scene.joints ?? []) this.joints.set(joint.index, joint);
    for (const action of scene.actions ?? []) this.actions.set(action.id, action);
    this.settings = { ...DEFAULT_SETTINGS, ...scene.settings };
    this.camera = scene.camera ?? null;
    this.levels = scene.levels ?? [];
    this.title = scene.title ?? t("Untitled");
    this.description = scene.description ?? "";
    this.sky = scene.sky ?? false;
    this.timeOfDay = scene.time_of_day ?? USUAL_HOUR;
  }

  private applyChange(change: DocumentChange, changed: Changed): void {
    switch (change.op) {
      case "reset":
        this.takeScene(change.scene);
        Object.assign(changed, { all: true, settings: true, joints: true, actions: true });
        break;
      case "entity":
        this.entities.set(change.entity.index, change.entity);
        changed.entities.push(change.entity.index);
        break;
      case "pose": {
        const moved = this.entities.get(change.index);
        if (!moved) break;
        this.entities.set(change.index, { ...moved, pose: change.pose });
        changed.entities.push(change.index);
        break;
      }
      case "entity_removed":
        this.entities.delete(change.index);
        changed.removed.push(change.index);
        break;
      case "settings":
        this.applySettings(change.settings);
        changed.settings = true;
        break;
      case "joint":
        this.joints.set(change.joint.index, change.joint);
        changed.joints = true;
        break;
      case "joint_removed":
        this.joints.delete(change.index);
        changed.joints = true;
        break;
      case "action":
        this.actions.set(change.action.id, change.action);
        changed.actions = true;
        break;
      case "action_removed":
        this.actions.delete(change.index);
        changed.actions = true;
        break;
    }
  }

  private applySettings({ title, description, camera, levels, sky, time_of_day, ...settings }: Extract<DocumentChange, { op: "settings" }>["settings"]): void {
    this.settings = { ...this.settings, ...settings };
    this.title = title ?? this.title;
    this.description = description ?? this.description;
    this.sky = sky ?? this.sky;
    this.timeOfDay = time_of_day ?? this.timeOfDay;
    if (camera !== undefined) this.camera = camera;
    this.levels = levels ?? this.levels;
  }
}

export function nothingChanged(): Changed {
  return { all: false, entities: [], removed: [], settings: false, joints: false, actions: false };
}

export function positionOf(pose: Pose | undefined): Vector {
  return pose?.position ?? [0, 0, 0];
}

export function rotationOf(pose: Pose | undefined): Quaternion {
  return pose?.rotation ?? [0, 0, 0, 1];
}

/** The name that is shown for the entity. */
export function nameOf(entity: Entity): string {
  if (entity.name) return entity.name;
  const kind = entity.shape?.type ?? "model";
  return `${translateServerText(`${kind[0]!.toUpperCase()}${kind.slice(1)}`)} ${entity.index}`;
}
