// SPDX-License-Identifier: MIT
import { Box3, type BufferAttribute, type BufferGeometry, Matrix4, Mesh, Vector3 } from "three";
import { MeshoptDecoder } from "three/examples/jsm/libs/meshopt_decoder.module.js";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import type { Connection } from "../connection/connection";
import type { ModelSummary } from "../connection/messages";
import { type Drawable, type DrawablePart, drawable } from "./drawable";
import { LoadQueue } from "./load_queue";
import { farParts, mergeParts } from "./merge_parts";
import { thinOut } from "./thin_out";
import { wholeLevels } from "./whole_levels";

/** So many models are asked about, and loaded, at once: enough to keep network and decoder busy, few enough to stay in order. */
const MOST_ASKED = 16;
const MOST_LOADED = 6;
/** The error of the first coarser level, in the model's extent; each further one has twice as much (src/interchange/compact/detail_levels.h). */
const LEVELS_FROM = 0.001;

/** Cached models of the database: summaries by key, pictures by id and content. */
export class ModelStore {
  private readonly loader = new GLTFLoader().setMeshoptDecoder(MeshoptDecoder);
  private readonly summaries = new Map<string, Promise<ModelSummary>>();
  private readonly drawables = new Map<string, Promise<Drawable>>();
  private readonly asking = new LoadQueue(MOST_ASKED);
  private readonly loads = new LoadQueue(MOST_LOADED);

  constructor(private readonly connection: Connection) {}

  /** Keeps a summary from a search, so that it need not be asked for again. */
  learn(model: ModelSummary): void {
    this.summaries.set(model.key, Promise.resolve(model));
  }

  /** Drops the summaries of these models, or of all (null), where they may have changed: they are asked for again. */
  forgetSummaries(keys: readonly string[] | null = null): void {
    if (keys === null) this.summaries.clear();
    else for (const key of keys) this.summaries.delete(key);
  }

  summary(key: string, urgency = () => Infinity): Promise<ModelSummary> {
    return keep(this.summaries, key, () => this.asking.add(urgency, async () => (await this.connection.request("catalog.model", { key })).model));
  }

  /** The picture of a model; `urgency`, of its size in metres, says which of many are loaded first. */
  async drawable(key: string, urgency: (size: number) => number = () => Infinity): Promise<Drawable> {
    const model = await this.summary(key, () => urgency(1));
    const path = `models/${model.id}/geometry.glb?v=${model.content_hash}`;
    const size = Math.hypot(...model.size);
    return keep(this.drawables, path, () => this.loads.add(() => urgency(size), () => this.load(this.connection.address(path))));
  }

  thumbnail(model: ModelSummary): string {
    return this.connection.address(`models/${model.id}/thumbnail.png?v=${model.content_hash}`);
  }

  private async load(address: string): Promise<Drawable> {
    const gltf = await this.loader.loadAsync(address);
    gltf.scene.updateMatrixWorld(true);
    const meshes: Mesh<BufferGeometry>[] = [];
    gltf.scene.traverse((object) => object instanceof Mesh && meshes.push(object));
    const told = meshes.map(({ geometry }) => toldLevels(geometry));
    const extent = extentOf(meshes);
    const errors = told.every((levels) => levels !== undefined) ? levelErrors(told, extent) : undefined;
    const parts: DrawablePart[] = await Promise.all(
      meshes.map(async ({ geometry, material, matrixWorld }, at) => {
        const part = { material: [material].flat()[0]!, matrix: new Matrix4().copy(matrixWorld) };
        if (!errors) return { geometry, ...part };
        const levels = await Promise.all(told[at]!.map(({ indices }) => (indices === undefined ? null : (gltf.parser.getDependency("accessor", indices) as Promise<BufferAttribute>))));
        const scale = matrixWorld.getMaxScaleOnAxis();
        return { ...thinOut(geometry, wholeLevels(geometry, levels, errors, scale), errors, extent, scale), ...part };
      }),
    );
    const loaded = drawable(mergeParts(parts));
    if (!errors) return loaded;
    loaded.levelErrors = errors;
    const far = farParts(parts, errors.length);
    if (far) loaded.far = far;
    return loaded;
  }
}

interface ToldLevel {
  indices?: number;
  error: number;
}

/** What the server says of a part's coarser levels (src/interchange/compact/detail_levels.h); undefined: there are none. */
function toldLevels(geometry: BufferGeometry): ToldLevel[] | undefined {
  return (geometry.userData as { embody?: { levels?: ToldLevel[] } }).embody?.levels;
}

/** How far each level may be from the full surface, m: as the server says, and no less than what the level is for. */
function levelErrors(told: readonly ToldLevel[][], extent: number): number[] {
  return told[0]!.map((_, level) => Math.max(LEVELS_FROM * 2 ** level * extent, ...told.map((levels) => levels[level]!.error)));
}

/** The largest side of the meshes' common box. */
function extentOf(meshes: readonly Mesh<BufferGeometry>[]): number {
  const bounds = new Box3();
  for (const { geometry, matrixWorld } of meshes) {
    if (!geometry.boundingBox) geometry.computeBoundingBox();
    bounds.union(new Box3().copy(geometry.boundingBox!).applyMatrix4(matrixWorld));
  }
  return Math.max(...bounds.getSize(new Vector3()).toArray());
}

/** The promise that is kept under the key; a failed one is removed, so that the next call tries again. */
function keep<Value>(kept: Map<string, Promise<Value>>, key: string, make: () => Promise<Value>): Promise<Value> {
  let promise = kept.get(key);
  if (!promise) {
    promise = make();
    promise.catch(() => kept.delete(key));
    kept.set(key, promise);
  }
  return promise;
}
