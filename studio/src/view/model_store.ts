// SPDX-License-Identifier: MIT
import { Matrix4, Mesh } from "three";
import { MeshoptDecoder } from "three/examples/jsm/libs/meshopt_decoder.module.js";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import type { Connection } from "../connection/connection";
import type { ModelSummary } from "../connection/messages";
import { type Drawable, type DrawablePart, drawable } from "./drawable";
import { LoadQueue } from "./load_queue";

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
    const parts: DrawablePart[] = [];
    gltf.scene.traverse((object) => {
      if (!(object instanceof Mesh)) return;
      const material = Array.isArray(object.material) ? object.material[0] : object.material;
      parts.push({ geometry: object.geometry, material, matrix: new Matrix4().copy(object.matrixWorld) });
    });
    return drawable(parts);
  }
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
