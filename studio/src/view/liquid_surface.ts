// SPDX-License-Identifier: MIT
import {
  AddEquation,
  BufferAttribute,
  BufferGeometry,
  Color,
  CustomBlending,
  DynamicDrawUsage,
  FrontSide,
  Group,
  type Intersection,
  type Material,
  Mesh,
  MeshLambertMaterial,
  OneFactor,
  OneMinusSrcAlphaFactor,
  type Raycaster,
  ShaderMaterial,
  Sphere,
  SrcColorFactor,
  Uniform,
  Vector3,
  Vector4,
  Box3,
  ZeroFactor,
} from "three";
import type { PointSet } from "../connection/frame";
import { lookOf, type Optics, WATER } from "./liquid_look";
import { refractingLiquid } from "./liquid_material";
import type { FromLiquidWorker, ToLiquidWorker } from "./liquid_worker";
import type { Quality } from "./tint";

/** Strength of the state colour, relative to that of other entities. */
const SHARE_OF_TINT = 0.08;
/** Fraction of light at normal incidence that water reflects: ((n − 1)/(n + 1))², n = 1.33. */
const REFLECTANCE = 0.02;
/** Thickness of the layer that has the colour a person set, m of the liquid. */
const DEPTH_OF_COLOR = 0.1;

/** Factor for the light from behind; at a slant its path through the liquid is longer. */
const FILTER_VERTEX = `
varying vec3 vNormalOfView, vToEye;
void main() {
  vec4 at = modelViewMatrix * vec4(position, 1.0);
  vNormalOfView = normalMatrix * normal;
  vToEye = -at.xyz;
  gl_Position = projectionMatrix * at;
}`;
const FILTER_FRAGMENT = `
uniform vec3 through;
uniform vec4 stateTint;
varying vec3 vNormalOfView, vToEye;
void main() {
  float facing = abs(dot(normalize(vNormalOfView), normalize(vToEye)));
  float mirrored = ${REFLECTANCE} + ${1 - REFLECTANCE} * pow(1.0 - facing, 5.0);
  vec3 passed = pow(through, vec3(1.0 / max(facing, 0.4))) * (1.0 - mirrored);
  gl_FragColor = vec4(passed * (1.0 - stateTint.a), 1.0);
}`;
/** Light from the liquid itself: scattered light, and the mirrored sky. */
const GLOW = `
float facing = abs(dot(normal, normalize(vViewPosition)));
float mirrored = ${REFLECTANCE} + ${1 - REFLECTANCE} * pow(1.0 - facing, 5.0);
outgoingLight += mirrored * sky;
outgoingLight = mix(outgoingLight, stateTint.rgb, stateTint.a);
#include <opaque_fragment>
gl_FragColor.a = 0.0;`;

/** The surface of one entity's liquid: it filters the light from behind, then adds its own; in full quality it refracts, in one pass. */
export class LiquidSurface {
  readonly mesh = new Group();
  readonly bounds = new Box3();
  readonly isLiquid = true;
  readonly geometry = new BufferGeometry();
  private readonly uniforms = {
    absorption: new Uniform(new Vector3()),
    scattering: new Uniform(0),
    through: new Uniform(new Vector3(1, 1, 1)),
    sky: new Uniform(new Color(0.75, 0.8, 0.85)),
    stateTint: new Uniform(new Vector4()),
  };
  private readonly filter: Mesh<BufferGeometry, Material>;
  private readonly glow: Mesh<BufferGeometry, Material>;
  private optics = WATER;
  private color: Color | null = null;
  private thickness = 0.1;
  private start = 0;
  private duration = 0;
  private shownPart = -1;
  private isWaiting = false;

  constructor(
    readonly index: number,
    public set: PointSet,
    quality: Quality,
    private readonly tell: (message: ToLiquidWorker) => void,
  ) {
    // Empty until the first mesh has been made.
    this.geometry.setAttribute("position", new BufferAttribute(new Float32Array(3), 3));
    this.geometry.setAttribute("normal", new BufferAttribute(new Float32Array(3), 3));
    this.geometry.setAttribute("thickness", new BufferAttribute(new Float32Array(1), 1));
    this.geometry.setIndex(new BufferAttribute(new Uint32Array(1), 1));
    this.geometry.setDrawRange(0, 0);
    const filter = new ShaderMaterial({
      uniforms: this.uniforms,
      vertexShader: FILTER_VERTEX,
      fragmentShader: FILTER_FRAGMENT,
      transparent: true,
      blending: CustomBlending,
      blendEquation: AddEquation,
      blendSrc: ZeroFactor,
      blendDst: SrcColorFactor,
    });
    this.filter = new Mesh(this.geometry, filter);
    this.glow = new Mesh(this.geometry, this.glowMaterial(quality));
    this.filter.visible = quality === "low";
    for (const mesh of [this.filter, this.glow]) {
      mesh.frustumCulled = false;
      mesh.userData["batch"] = { entityAt: () => index };
    }
    // After everything that is seen through it, and the filter before the glow.
    this.filter.renderOrder = 10;
    this.glow.renderOrder = 11;
    this.filter.raycast = () => {};
    this.glow.raycast = (raycaster, hits) => this.meet(raycaster, hits);
    this.glow.receiveShadow = true;
    this.mesh.add(this.filter, this.glow);
    this.take(set, 0, 0);
  }

  /** Number of particles under the surface. */
  get count(): number {
    return this.set.positions.length / 3;
  }

  /** Number of triangles that are drawn. */
  get triangles(): number {
    return this.geometry.drawRange.count / 3;
  }

  /** The surface of the present positions is there. */
  get isSettled(): boolean {
    return !this.isWaiting && this.shownPart === 1;
  }

  accepts(set: PointSet): boolean {
    return set.liquid;
  }

  /** Moves to these positions within `duration` ms. */
  take(set: PointSet, now: number, duration: number): void {
    this.set = set;
    this.tell({ kind: "points", set });
    this.bounds.min.fromArray(set.lower);
    this.bounds.max.fromArray(set.size).add(this.bounds.min);
    this.bounds.expandByScalar(set.radius);
    this.start = now;
    this.duration = duration;
    this.shownPart = -1;
    this.ask(duration > 0 ? 0 : 1);
  }

  /** Asks for the surface of the present positions; the picture is drawn again once it has arrived. */
  advance(now: number): boolean {
    const part = this.duration > 0 ? Math.min(Math.max((now - this.start) / this.duration, 0), 1) : 1;
    if (part !== this.shownPart) this.ask(part);
    return false;
  }

  private ask(part: number): void {
    if (this.isWaiting) return;
    this.isWaiting = true;
    this.shownPart = part;
    this.tell({ kind: "mesh", index: this.index, part });
  }

  /** A mesh came from the worker. */
  show(made: FromLiquidWorker): void {
    this.isWaiting = false;
    this.thickness = made.area > 0 ? Math.max((2 * made.volume) / made.area, 1e-4) : 0.1;
    this.makeRoom(made.positions.length / 3, made.indices.length);
    renew(this.geometry.getAttribute("position") as BufferAttribute, made.positions);
    renew(this.geometry.getAttribute("normal") as BufferAttribute, made.normals);
    renew(this.geometry.getAttribute("thickness") as BufferAttribute, made.thickness);
    renew(this.geometry.index!, made.indices);
    this.geometry.setDrawRange(0, made.indices.length);
    const size = this.bounds.getSize(new Vector3());
    this.geometry.boundingSphere = new Sphere(this.bounds.getCenter(new Vector3()), size.length() / 2);
    this.applyLook();
  }

  setOptics(optics: Optics): void {
    this.optics = optics;
    this.applyLook();
  }

  /** Sets a person's colour; null: the colour follows from the attributes. */
  setColor(color: Color | null): void {
    this.color = color;
    this.applyLook();
  }

  setTint([red, green, blue, amount]: readonly number[]): void {
    this.uniforms.stateTint.value.set(red!, green!, blue!, SHARE_OF_TINT * amount!);
  }

  tint(): number[] {
    return this.uniforms.stateTint.value.toArray();
  }

  setQuality(quality: Quality): void {
    this.glow.material.dispose();
    this.glow.material = this.glowMaterial(quality);
    this.filter.visible = quality === "low";
    this.applyLook();
  }

  dispose(): void {
    this.tell({ kind: "forget", index: this.index });
    this.geometry.dispose();
    this.filter.material.dispose();
    this.glow.material.dispose();
  }

  private applyLook(): void {
    const optics: Optics = this.color
      ? {
          absorption: this.color.toArray().map((share) => -Math.log(Math.max(share, 0.01)) / DEPTH_OF_COLOR) as Optics["absorption"],
          scattering: this.optics.scattering,
        }
      : this.optics;
    const look = lookOf(optics, this.thickness);
    this.uniforms.through.value.fromArray(look.through);
    this.uniforms.absorption.value.fromArray(optics.absorption);
    this.uniforms.scattering.value = optics.scattering;
    // A refracting surface does this at each point.
    if (this.filter.visible) (this.glow.material as MeshLambertMaterial).color.setRGB(...look.back);
    this.glow.castShadow = Math.max(...look.through) < 0.5;
  }

  private glowMaterial(quality: Quality): Material {
    if (quality === "high") return refractingLiquid(this.uniforms);
    const material = new MeshLambertMaterial();
    material.transparent = true;
    material.side = material.shadowSide = FrontSide;
    material.blending = CustomBlending;
    material.blendEquation = AddEquation;
    material.blendSrc = OneFactor;
    material.blendDst = OneFactor;
    material.blendSrcAlpha = ZeroFactor;
    material.blendDstAlpha = OneMinusSrcAlphaFactor;
    material.onBeforeCompile = (shader) => {
      Object.assign(shader.uniforms, this.uniforms);
      shader.fragmentShader = shader.fragmentShader
        .replace("#include <common>", "#include <common>\nuniform vec3 sky;\nuniform vec4 stateTint;")
        .replace("#include <opaque_fragment>", GLOW);
    };
    material.customProgramCacheKey = () => "liquid";
    return material;
  }

  // Buffers grow with the mesh and are kept. All are replaced together: the outline, which shares them, binds the new ones.
  private makeRoom(vertices: number, indices: number): void {
    const { position } = this.geometry.attributes;
    if (position!.count >= vertices && this.geometry.index!.count >= indices) return;
    this.geometry.dispose();
    const room = (count: number): number => Math.ceil(1.5 * count);
    const made = (array: Float32Array | Uint32Array, size: number) => new BufferAttribute(array, size).setUsage(DynamicDrawUsage);
    this.geometry.setAttribute("position", made(new Float32Array(3 * room(vertices)), 3));
    this.geometry.setAttribute("normal", made(new Float32Array(3 * room(vertices)), 3));
    this.geometry.setAttribute("thickness", made(new Float32Array(room(vertices)), 1));
    this.geometry.setIndex(made(new Uint32Array(room(indices)), 1));
  }

  private meet(raycaster: Raycaster, hits: Intersection[]): void {
    if (!this.geometry.boundingSphere || !raycaster.ray.intersectsBox(this.bounds)) return;
    Mesh.prototype.raycast.call(this.glow, raycaster, hits);
  }
}

function renew(attribute: BufferAttribute, values: Float32Array | Uint32Array): void {
  (attribute.array as Float32Array).set(values);
  attribute.clearUpdateRanges();
  attribute.addUpdateRange(0, values.length);
  attribute.needsUpdate = true;
}
