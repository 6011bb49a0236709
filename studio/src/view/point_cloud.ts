// SPDX-License-Identifier: MIT
import {
  type Color,
  FrontSide,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  type Intersection,
  BufferAttribute,
  Box3,
  Material,
  Mesh,
  MeshDepthMaterial,
  MeshLambertMaterial,
  MeshStandardMaterial,
  type Raycaster,
  Uniform,
  Vector3,
  Vector4,
} from "three";
import type { PointSet } from "../connection/frame";
import { MIX, type Quality } from "./tint";

/** Strength of the state colour, relative to that of other entities. */
const SHARE_OF_TINT = 0.6;

// Each grain is a square that faces the eye, cut to a disc and lit as the ball that it stands for. `centre` is its present
// position.
const VERTEX_HEAD = `
attribute vec3 from;
attribute vec3 to;
uniform vec3 fromLower, fromSize, toLower, toSize;
uniform float part, radius, rim, sink;
varying vec2 vCorner;
varying vec3 vShade;
vec3 shadeOf(float seed) {
  vec3 noise = fract(sin(seed * vec3(12.9898, 78.233, 37.719)) * 43758.5453);
  return vec3(0.78 + 0.4 * noise.x) + vec3(0.05, 0.0, -0.05) * (noise.y - 0.5);
}`;
const VERTEX_PLACE = `
vec3 centre = mix(fromLower + fromSize * from, toLower + toSize * to, part);
vec3 across = vec3(viewMatrix[0][0], viewMatrix[1][0], viewMatrix[2][0]);
vec3 upwards = vec3(viewMatrix[0][1], viewMatrix[1][1], viewMatrix[2][1]);
float own = radius - rim * (viewMatrix * vec4(centre, 1.0)).z / projectionMatrix[1][1];
vec3 towards = vec3(viewMatrix[0][2], viewMatrix[1][2], viewMatrix[2][2]);
vec3 transformed = centre + own * (across * position.x + upwards * position.y) - sink * radius * towards;
vCorner = position.xy;
vShade = shadeOf(float(gl_InstanceID));`;
const FRAGMENT_HEAD = `
varying vec2 vCorner;
varying vec3 vShade;
uniform vec4 stateTint;`;
const FRAGMENT_NORMAL = `
float faceDirection = 1.0;
vec3 normal = vec3(vCorner, sqrt(max(0.0, 1.0 - dot(vCorner, vCorner))));
vec3 nonPerturbedNormal = normal;`;
const CUT = "if (dot(vCorner, vCorner) > 1.0) discard;";

interface Uniforms {
  [name: string]: Uniform;
}

/** A material whose squares are centred on the points. */
function placed<M extends Material>(material: M, uniforms: Uniforms, head: string, fragment: [string, string][]): M {
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, uniforms);
    shader.vertexShader = shader.vertexShader
      .replace("#include <common>", `#include <common>\n${VERTEX_HEAD}`)
      .replace("#include <begin_vertex>", VERTEX_PLACE);
    shader.fragmentShader = shader.fragmentShader.replace("#include <common>", `#include <common>\n${head}`);
    for (const [chunk, text] of fragment) shader.fragmentShader = shader.fragmentShader.replace(chunk, text);
  };
  return material;
}

/** The points of one entity, drawn as balls. */
export class PointCloud {
  readonly mesh: Mesh<InstancedBufferGeometry, Material>;
  readonly isLiquid = false;
  /** The points are drops of a liquid. */
  readonly isDrops: boolean;
  readonly bounds = new Box3();
  private readonly uniforms: Uniforms = {
    fromLower: new Uniform(new Vector3()),
    fromSize: new Uniform(new Vector3()),
    toLower: new Uniform(new Vector3()),
    toSize: new Uniform(new Vector3()),
    part: new Uniform(1),
    radius: new Uniform(0),
    rim: new Uniform(0),
    sink: new Uniform(0),
    stateTint: new Uniform(new Vector4(0, 0, 0, 0)),
  };
  private older: InstancedBufferAttribute;
  private newer: InstancedBufferAttribute;
  private start = 0;
  private duration = 0;

  constructor(
    readonly index: number,
    set: PointSet,
    quality: Quality,
  ) {
    this.isDrops = set.liquid;
    const geometry = new InstancedBufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array([-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0]), 3));
    geometry.setAttribute("normal", new BufferAttribute(new Float32Array([0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1]), 3));
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
    geometry.instanceCount = set.positions.length / 3;
    this.older = new InstancedBufferAttribute(set.positions.slice(), 3, true);
    this.newer = new InstancedBufferAttribute(set.positions.slice(), 3, true);
    this.mesh = new Mesh(geometry, this.material(quality));
    // The disc that casts the shadow lies at the far side of the ball, so that a grain casts no shadow on itself.
    const sunk = { ...this.uniforms, sink: new Uniform(1) };
    this.mesh.customDepthMaterial = placed(new MeshDepthMaterial(), sunk, FRAGMENT_HEAD, [["#include <alphatest_fragment>", CUT]]);
    this.mesh.castShadow = this.mesh.receiveShadow = true;
    this.mesh.frustumCulled = false;
    this.mesh.userData["batch"] = { entityAt: () => index };
    this.mesh.raycast = (raycaster, hits) => this.meet(raycaster, hits);
    this.take(set, 0, 0);
    this.take(set, 0, 0);
  }

  get count(): number {
    return this.mesh.geometry.instanceCount;
  }

  accepts(set: PointSet): boolean {
    return set.liquid === this.isDrops && this.count === set.positions.length / 3;
  }

  /** Moves to these positions within `duration` ms. */
  take(set: PointSet, now: number, duration: number): void {
    [this.older, this.newer] = [this.newer, this.older];
    (this.newer.array as Uint16Array).set(set.positions);
    this.newer.needsUpdate = true;
    this.mesh.geometry.setAttribute("from", this.older);
    this.mesh.geometry.setAttribute("to", this.newer);
    const { fromLower, fromSize, toLower, toSize, radius } = this.uniforms;
    fromLower!.value.copy(toLower!.value);
    fromSize!.value.copy(toSize!.value);
    toLower!.value.fromArray(set.lower);
    toSize!.value.fromArray(set.size);
    radius!.value = set.radius;
    this.bounds.min.fromArray(set.lower);
    this.bounds.max.fromArray(set.size).add(this.bounds.min);
    this.bounds.expandByScalar(set.radius);
    this.start = now;
    this.duration = duration;
    this.uniforms["part"]!.value = duration > 0 ? 0 : 1;
  }

  /** Moves the points on; returns whether they are still moving. */
  advance(now: number): boolean {
    const part = this.duration > 0 ? Math.min(Math.max((now - this.start) / this.duration, 0), 1) : 1;
    this.uniforms["part"]!.value = part;
    return part < 1;
  }

  setColor(color: Color): void {
    (this.mesh.material as MeshStandardMaterial).color.copy(color);
  }

  /** A pile in a single flat hue would lose its form, so the state colour is mixed in only partly. */
  setTint([red, green, blue, amount]: readonly number[]): void {
    (this.uniforms["stateTint"]!.value as Vector4).set(red!, green!, blue!, SHARE_OF_TINT * amount!);
  }

  tint(): number[] {
    return (this.uniforms["stateTint"]!.value as Vector4).toArray();
  }

  setQuality(quality: Quality): void {
    const color = (this.mesh.material as MeshStandardMaterial).color;
    this.mesh.material.dispose();
    this.mesh.material = this.material(quality);
    this.setColor(color);
  }

  /** The same points in another material, each disc larger by `rim` half heights of the picture; for outlines. */
  twin(material: Material, rim: Uniform): Mesh {
    const uniforms = { ...this.uniforms, rim };
    return new Mesh(this.mesh.geometry, placed(material, uniforms, FRAGMENT_HEAD, [["#include <alphatest_fragment>", CUT]]));
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
    this.mesh.customDepthMaterial?.dispose();
  }

  private material(quality: Quality): Material {
    const material = quality === "low" ? new MeshLambertMaterial() : new MeshStandardMaterial({ roughness: 0.85, metalness: 0 });
    material.shadowSide = FrontSide;
    const lit = placed(material, this.uniforms, FRAGMENT_HEAD, [
      ["#include <alphatest_fragment>", `${CUT}\ndiffuseColor.rgb *= vShade;\nvec4 vTint = stateTint;${MIX}`],
      ["#include <normal_fragment_begin>", FRAGMENT_NORMAL],
    ]);
    lit.customProgramCacheKey = () => "points";
    return lit;
  }

  private meet(raycaster: Raycaster, hits: Intersection[]): void {
    const { ray, near, far } = raycaster;
    if (!ray.intersectsBox(this.bounds)) return;
    const { toLower, toSize, radius } = this.uniforms;
    const lower = toLower!.value as Vector3;
    const size = toSize!.value as Vector3;
    const reach = (radius!.value as number) ** 2;
    const positions = this.newer.array as Uint16Array;
    const centre = new Vector3();
    let best: { distance: number; centre: Vector3 } | null = null;
    for (let at = 0; at < positions.length; at += 3) {
      centre.set(positions[at]! / 65535, positions[at + 1]! / 65535, positions[at + 2]! / 65535).multiply(size).add(lower);
      const off = ray.distanceSqToPoint(centre);
      if (off > reach) continue;
      const along = centre.sub(ray.origin).dot(ray.direction) - Math.sqrt(reach - off);
      if (along < near || along > far || (best && along >= best.distance)) continue;
      centre.set(positions[at]! / 65535, positions[at + 1]! / 65535, positions[at + 2]! / 65535).multiply(size).add(lower);
      best = { distance: along, centre: centre.clone() };
    }
    if (!best) return;
    const point = ray.at(best.distance, new Vector3());
    hits.push({ distance: best.distance, point, normal: point.clone().sub(best.centre).normalize(), object: this.mesh, instanceId: 0 });
  }
}
