// SPDX-License-Identifier: MIT
import { Vector3 } from "three";
import { CommandRefused } from "./connection/connection";
import type { BodyState } from "./document/motion";
import { nameOf } from "./document/scene_document";
import type { Studio } from "./studio";
import type { ContactSounds, Heard } from "./tools/contact_sounds";
import type { Curve, TakeState, TimeMark } from "./connection/messages";
import type { Timeline } from "./time/timeline";
import type { JointTool } from "./tools/joint_tool";
import { presentPoses } from "./tools/poses";
import type { VrSession } from "./vr/session";
import { type VrHook, vrHook } from "./vr/test_view";

/** What tests and scripts in the page may read: `window.embody`. It can change nothing but the drawing. */
export interface TestHook {
  connected(): boolean;
  /** Resolves once the page has heard of all that the server had done before this call. */
  caughtUp(): Promise<void>;
  simulation(): { state: string; time: number; step: number };
  statistics(): unknown;
  selection(): number[];
  entities(): { index: number; name: string; model: string | null; position: number[]; rotation: number[]; state: BodyState; drawn: boolean }[];
  /** Models that are being loaded, and pictures drawn so far. */
  loading(): number;
  frames(): number;
  /** Draw calls and triangles of the last picture. */
  drawn(): { calls: number; triangles: number };
  /** The level of detail that an entity was last drawn in: 0 is full, -1 not at all. */
  levelOf(index: number): number | undefined;
  /** How dark the contact shadow of an entity is, 0 … 1, and how high it lies, m; null: it has none. */
  contactShadow(index: number): { darkness: number; height: number } | null;
  /** The hour that sun and sky are drawn for (null: the plain light), and lamps that are on and that light the picture. */
  light(): { hour: number | null; on: number[]; shining: number };
  /** Draws everything in full detail, or not any more. */
  showFullDetail(full: boolean): void;
  /** Draws so many pictures while the camera moves sideways; the growth of the page's memory by a picture, bytes. */
  measure(pictures: number): Promise<number>;
  /** The place on the page where the centre of an entity's box is drawn. */
  seenAt(index: number): { x: number; y: number } | null;
  /** Red, green, blue and amount of the state colour that an entity is drawn with. */
  tintOf(index: number): number[];
  /** Number of an entity's points, of triangles of their surface where they are a liquid and whether it is that of their present places, and their box; null where it has no points. */
  points(index: number): { count: number; triangles: number; liquid: boolean; settled: boolean; lower: number[]; upper: number[] } | null;
  /** A soft entity's drawn form in its own frame: size of its box, number of vertices and mean length of their normals; else null. */
  bent(index: number): { size: number[]; vertices: number; normals: number } | null;
  /** Number of the selection's nodes that are marked as pinned. */
  pinned(): number;
  /** Lines that mark the selection's taps, drains and liquids without a drop: their number, and the box around them. */
  portMarks(): { lines: number; lower: number[]; upper: number[] };
  /** Number of convex parts that are drawn over the selection. */
  collisionParts(): number;
  /** Lines and points of each meaning (docs/protocol.md, "Debug frames") that are drawn. */
  debugCounts(): Record<number, { lines: number; points: number }>;
  /** Number of joints that are drawn over the picture. */
  joints(): number;
  /** Whether the pointer is over a handle that turns the axis of a joint. */
  jointHandle(): boolean;
  pick(x: number, y: number): number | null;
  /** Where the camera is and what it looks at. */
  camera(): { position: number[]; target: number[] };
  /** The scene's box as it is seen, as parts of the picture's width and height, without floors and walls. */
  filled(): { width: number; height: number };
  /** This page's number, and what it knows of the other members; `drawn`: they are in the picture. */
  people(): { client: number; others: { client: number; name: string; color: string; drawn: boolean; presence: unknown }[] };
  /** The Studio in a headset. */
  readonly vr: VrHook;
  /** Sounds of impacts that were made, the newest last. */
  heard(): readonly Heard[];
  /** What is recorded of the run, and its marks; what is plotted. */
  take(): { state: TakeState; marks: readonly TimeMark[] };
  plotted(): { times: readonly number[]; curves: readonly Curve[] };
  /** Draws the other people or not: pictures of two pages differ by them. */
  showPeople(shown: boolean): void;
  /** The place where the page shows that what is carried over the scene would lie; null: it shows none. */
  ghost(): { position: number[]; rotation: number[] } | null;
  /** The place on the page where a point of the world is drawn. */
  project(x: number, y: number, z: number): { x: number; y: number };
  /** Stops drawing, for screenshots; resume() starts it again. */
  halt(): void;
  resume(): void;
}

/** Of Chromium alone, which tells it exactly with --enable-precise-memory-info. */
function memoryInUse(): number {
  return (performance as unknown as { memory?: { usedJSHeapSize: number } }).memory?.usedJSHeapSize ?? 0;
}

export function offerTestHook(studio: Studio, headset: VrSession, sounds: ContactSounds, timeline: Timeline, joints: JointTool): void {
  const hook: TestHook = {
    connected: () => studio.server.isOpen && studio.server.ready,
    // Events and replies come in order over one connection, so any answer comes after them.
    caughtUp: () =>
      studio.server.request("entity.presets", {}).then(
        () => undefined,
        (error: Error) => {
          if (!(error instanceof CommandRefused)) throw error;
        },
      ),
    simulation: () => studio.playback.simulation,
    statistics: () => studio.playback.statistics,
    selection: () => [...studio.selection.indices],
    entities: () =>
      [...studio.document.entities.values(), ...studio.document.spawned.values()].map((entity) => {
        const pose = presentPoses(studio, [entity.index]).get(entity.index);
        return {
          index: entity.index,
          name: nameOf(entity),
          model: entity.model ?? null,
          position: pose?.position.toArray() ?? [],
          rotation: pose?.rotation.toArray() ?? [],
          state: studio.motion.state(entity.index),
          drawn: studio.entities.drawableOf(entity.index) !== undefined,
        };
      }),
    loading: () => studio.entities.loading || Number(studio.entities.isSettling),
    frames: () => studio.view.frames,
    drawn: () => ({ calls: studio.view.renderer.info.render.calls, triangles: studio.view.renderer.info.render.triangles }),
    levelOf: (index) => studio.entities.levelOf(index),
    contactShadow: (index) => {
      const { contactShadows } = studio.view;
      const height = contactShadows.heightOf(index);
      return height === null ? null : { darkness: contactShadows.darknessOf(index), height };
    },
    light: () => ({ hour: studio.view.environment.hour, on: [...studio.view.lamps.on], shining: studio.view.lamps.shining }),
    showFullDetail: (full) => {
      studio.view.viewer.full = full;
      studio.view.invalidate();
    },
    measure: async (pictures) => {
      const { view } = studio;
      let grown = 0;
      for (let picture = 0; picture < pictures; ++picture) {
        const before = memoryInUse();
        await new Promise<void>((drawn) => {
          const end = view.afterFrame.on(() => {
            end();
            drawn();
          });
          view.rig.pan(1, 0, view.canvas.clientHeight);
        });
        // Less than before: what was left lying was collected.
        grown += Math.max(0, memoryInUse() - before);
      }
      return Math.round(grown / pictures);
    },
    seenAt: (index) => {
      const bounds = studio.entities.boundsOf([index], performance.now());
      if (bounds.isEmpty()) return null;
      const { x, y } = studio.view.project(bounds.getCenter(new Vector3()));
      return { x, y };
    },
    tintOf: (index) => studio.entities.tintOf(index),
    points: (index) => {
      const cloud = studio.entities.clouds.of(index);
      return cloud ? { count: cloud.count, triangles: cloud.isLiquid ? cloud.triangles : 0, liquid: cloud.isLiquid, settled: !cloud.isLiquid || cloud.isSettled, lower: cloud.bounds.min.toArray(), upper: cloud.bounds.max.toArray() } : null;
    },
    bent: (index) => studio.entities.softs.skinOf(index)?.measure() ?? null,
    pinned: () => studio.view.pins.count,
    portMarks: () => {
      const { count, bounds } = studio.view.ports;
      return { lines: count, lower: bounds.min.toArray(), upper: bounds.max.toArray() };
    },
    collisionParts: () => studio.view.collision.parts,
    debugCounts: () => studio.view.debug.counts,
    joints: () => joints.count,
    jointHandle: () => joints.isBusy,
    pick: (x, y) => studio.view.pick(x, y)?.index ?? null,
    camera: () => studio.view.rig.seen(),
    filled: () => {
      const { min, max } = studio.framing.contents();
      const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((at) => studio.view.project(new Vector3(at & 1 ? max.x : min.x, at & 2 ? max.y : min.y, at & 4 ? max.z : min.z)));
      const extent = (values: number[]) => Math.max(...values) - Math.min(...values);
      const { width, height } = studio.view.canvas.getBoundingClientRect();
      return { width: extent(corners.map(({ x }) => x)) / width, height: extent(corners.map(({ y }) => y)) / height };
    },
    people: () => ({
      client: studio.server.client,
      others: studio.people.others.map((member) => ({ ...member, drawn: studio.view.people.drawn.includes(member.client), presence: studio.people.presence(member.client) })),
    }),
    vr: vrHook(studio, headset),
    heard: () => sounds.heard,
    take: () => ({ state: studio.take.state, marks: studio.take.marks }),
    plotted: () => timeline.plots.told,
    showPeople: (shown) => {
      studio.view.people.group.visible = shown;
      studio.view.invalidate();
    },
    ghost: () => {
      const ghost = studio.view.scene.getObjectByName("ghost");
      return ghost?.visible ? { position: ghost.position.toArray(), rotation: ghost.quaternion.toArray() } : null;
    },
    project: (x, y, z) => {
      const at = studio.view.project(new Vector3(x, y, z));
      return { x: at.x, y: at.y };
    },
    halt: () => studio.view.halt(),
    resume: () => studio.view.resume(),
  };
  (window as unknown as { embody: TestHook }).embody = hook;
}
