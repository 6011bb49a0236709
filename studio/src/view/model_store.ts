// SPDX-License-Identifier: MIT
import { type BufferAttribute, type BufferGeometry, Matrix4, Mesh } from "three";
import { MeshoptDecoder } from "three/examples/jsm/libs/meshopt_decoder.module.js";
import { type GLTF, GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import type { Connection } from "../connection/connection";
import type { ModelSummary } from "../connection/messages";
import { type Drawable, type DrawablePart, drawable } from "./drawable";
import { LoadQueue } from "./load_queue";
import { farParts, mergeParts } from "./merge_parts";
import { wholeLevels } from "./whole_levels";

/** So many models are asked about, and loaded, at once: enough to keep network and decoder busy, few enough to stay in order. */
const MOST_ASKED = 16;
const MOST_LOADED = 6;

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
    const parts: DrawablePart[] = await Promise.all(
      meshes.map(async ({ geometry, material, matrixWorld }) => {
        const levels = await this.levelsOf(gltf, geometry, matrixWorld.getMaxScaleOnAxis());
        return { geometry, material: [material].flat()[0]!, matrix: new Matrix4().copy(matrixWorld), ...(levels && { levels }) };
      }),
    );
    const told = meshes.map(({ geometry }) => toldLevels(geometry));
    const loaded = drawable(mergeParts(parts));
    if (told.every((levels) => levels !== undefined)) loaded.levelErrors = told[0]!.map((_, level) => Math.max(...told.map((levels) => levels[level]!.error)));
    const far = loaded.levelErrors && farParts(parts, loaded.levelErrors.length);
    if (far) loaded.far = far;
    return loaded;
  }

  private async levelsOf(gltf: GLTF, geometry: BufferGeometry, scale: number): Promise<(BufferAttribute | null)[] | undefined> {
    const told = toldLevels(geometry);
    if (!told) return undefined;
    const levels = await Promise.all(told.map(({ indices }) => (indices === undefined ? null : (gltf.parser.getDependency("accessor", indices) as Promise<BufferAttribute>))));
    return wholeLevels(geometry, levels, told.map(({ error }) => error), scale);
  }
}

/** What the server says of a part's coarser levels (src/interchange/compact/detail_levels.h); undefined: there are none. */
function toldLevels(geometry: BufferGeometry): { indices?: number; error: number }[] | undefined {
  return (geometry.userData as { embody?: { levels?: { indices?: number; error: number }[] } }).embody?.levels;
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
