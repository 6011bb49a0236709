// SPDX-License-Identifier: MIT
import { AnimationClip, BufferAttribute, BufferGeometry, Group, type Material, Mesh, type MeshStandardMaterial, Quaternion, QuaternionKeyframeTrack, Scene, Vector3, VectorKeyframeTrack } from "three";
import { GLTFExporter } from "three/examples/jsm/exporters/GLTFExporter.js";
import { type Frame, POSE_FLOATS } from "../connection/frame";
import { nameOf } from "../document/scene_document";
import type { Parts } from "../parts";
import type { DrawablePart } from "../view/drawable";
import { colorOf } from "../view/entity_view";
import { MomentView } from "./moment_view";
import { t } from "../language";

/** Poses a second. */
const SAMPLES_PER_SECOND = 30;

export interface AnimationFile {
  file: Blob;
  /** Names of things that are not in it as they moved, and why. */
  still: string[];
}

interface Poses {
  times: number[];
  positions: number[];
  rotations: number[];
}

/**
 * The run from `from` to `to` (s) as a binary glTF file: a node for each thing, and its motion as an animation. Soft things move as a
 * whole, in the form that they have now; grains and liquids are left out. Null where `signal` ended it.
 */
export async function makeAnimation(
  parts: Pick<Parts, "server" | "document" | "motion" | "entities" | "view">,
  { from, to }: { from: number; to: number },
  tell: (done: number, of: number) => void,
  signal: AbortSignal,
): Promise<AnimationFile | null> {
  const moments = new MomentView(parts);
  const count = Math.max(1, Math.ceil((to - from) * SAMPLES_PER_SECOND - 1e-6)) + 1;
  const poses = new Map<number, Poses>();
  for (let sample = 0; sample < count; ++sample) {
    if (signal.aborted) return null;
    const time = Math.min(from + sample / SAMPLES_PER_SECOND, to);
    addPoses(poses, await moments.ask(time), time - from);
    tell(sample + 1, count);
  }

  const { document, entities } = parts;
  const scene = new Scene();
  scene.name = document.title;
  const tracks: (VectorKeyframeTrack | QuaternionKeyframeTrack)[] = [];
  const still: string[] = [];
  for (const [index, motion] of poses) {
    const entity = document.entity(index);
    const drawable = entities.drawableOf(index);
    if (!entity || !drawable || entity.enabled === false) continue;
    if (entities.clouds.of(index)) {
      still.push(t("{{name}} is left out: grains and liquids have no form of their own", { name: nameOf(entity) }));
      continue;
    }
    if (entities.softs.has(index)) still.push(t("{{name}} moves as a whole, in its present form", { name: nameOf(entity) }));
    const node = new Group();
    node.name = `${nameOf(entity)} ${index}`;
    node.position.fromArray(motion.positions);
    node.quaternion.fromArray(motion.rotations);
    node.scale.setScalar(entity.scale ?? 1);
    node.add(...drawable.parts.map((part) => meshOf(part, entity.model ? null : colorOf(entity))));
    scene.add(node);
    if (!moves(motion)) continue;
    tracks.push(new VectorKeyframeTrack(`${node.uuid}.position`, motion.times, motion.positions));
    tracks.push(new QuaternionKeyframeTrack(`${node.uuid}.quaternion`, motion.times, motion.rotations));
  }
  const animations = tracks.length > 0 ? [new AnimationClip(t("Run"), to - from, tracks)] : [];
  const made = (await new GLTFExporter().parseAsync(scene, { binary: true, trs: true, animations })) as ArrayBuffer;
  return { file: new Blob([made], { type: "model/gltf-binary" }), still };
}

function addPoses(all: Map<number, Poses>, frame: Frame, time: number): void {
  frame.indices.forEach((index, record) => {
    let poses = all.get(index);
    if (!poses) {
      poses = { times: [], positions: [], rotations: [] };
      all.set(index, poses);
    }
    const at = record * POSE_FLOATS;
    poses.times.push(time);
    poses.positions.push(...frame.poses.subarray(at, at + 3));
    const rotation = new Quaternion().fromArray(frame.poses, at + 3).normalize();
    // The shorter way between two: both signs are the same rotation.
    const last = poses.rotations.length - 4;
    if (last >= 0 && rotation.dot(new Quaternion().fromArray(poses.rotations, last)) < 0) rotation.set(-rotation.x, -rotation.y, -rotation.z, -rotation.w);
    poses.rotations.push(...rotation.toArray());
  });
}

function moves({ positions, rotations }: Poses): boolean {
  return positions.some((value, at) => value !== positions[at % 3]) || rotations.some((value, at) => value !== rotations[at % 4]);
}

/** A mesh of its own with plain numbers: what the page draws is quantised and shared. */
function meshOf({ geometry, material, matrix }: DrawablePart, color: ReturnType<typeof colorOf> | null): Mesh {
  const plain = new BufferGeometry();
  for (const name of ["position", "normal", "uv"]) {
    const given = geometry.getAttribute(name);
    if (!given) continue;
    const values = new Float32Array(given.count * given.itemSize);
    for (let i = 0; i < given.count; ++i) for (let k = 0; k < given.itemSize; ++k) values[i * given.itemSize + k] = given.getComponent(i, k);
    plain.setAttribute(name, new BufferAttribute(values, given.itemSize));
  }
  if (plain.hasAttribute("normal")) lengthen(plain.getAttribute("normal") as BufferAttribute);
  if (geometry.index) plain.setIndex([...geometry.index.array]);
  let own: Material = material;
  if (color) {
    own = material.clone();
    (own as MeshStandardMaterial).color.copy(color);
  }
  const mesh = new Mesh(plain, own);
  mesh.applyMatrix4(matrix);
  return mesh;
}

/** Unit normals, as glTF wants them: quantised ones are a little off. */
function lengthen(normals: BufferAttribute): void {
  const normal = new Vector3();
  for (let i = 0; i < normals.count; ++i) {
    normal.fromBufferAttribute(normals, i).normalize();
    normals.setXYZ(i, normal.x, normal.y, normal.z);
  }
}
