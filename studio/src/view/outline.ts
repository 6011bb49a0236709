// SPDX-License-Identifier: MIT
import {
  AlwaysStencilFunc,
  BufferGeometry,
  Color,
  type ColorRepresentation,
  Group,
  InstancedBufferGeometry,
  KeepStencilOp,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  NotEqualStencilFunc,
  ReplaceStencilOp,
  ShaderMaterial,
  Uniform,
  Vector2,
} from "three";
import type { EntityView } from "./entity_view";

const OWN_COLOR = 0xffa726;
const WIDTH_PIXELS = 2;
const COPIES = 8;
/** The own selection is drawn last, over those of the others. */
const OWN_LAYER = 1;
const LAST_ORDER = 999;
/** Layers of outlines, as many as a stencil buffer of eight bits tells apart. */
export const MOST_LAYERS = 255;

/**
 * A line around entities: their silhouette is drawn into the stencil buffer, then eight copies shifted by the line's width
 * are drawn outside of it. It works for any mesh and needs no second render target, which matters on software renderers.
 * Several outlines are drawn one after the other, each on a layer (a number from 1) of its own: 1 is drawn last.
 */
export class Outline {
  readonly group = new Group();
  private readonly mask: MeshBasicMaterial;
  private readonly rim: ShaderMaterial;
  private readonly cloudRim = new Uniform(0);
  private shown: { index: number; meshes: Mesh[]; ofCloud: boolean }[] = [];
  private readonly matrix = new Matrix4();

  constructor(
    private readonly entities: EntityView,
    private readonly color: ColorRepresentation = OWN_COLOR,
    private readonly layer = OWN_LAYER,
  ) {
    this.mask = new MeshBasicMaterial({
      colorWrite: false,
      depthWrite: false,
      depthTest: false,
      // What is transparent is drawn in the order of the layers.
      transparent: true,
      side: 2,
      stencilWrite: true,
      stencilRef: layer,
      stencilFunc: AlwaysStencilFunc,
      stencilZPass: ReplaceStencilOp,
    });
    this.rim = rimMaterial(color, layer);
  }

  dispose(): void {
    this.show([]);
    this.mask.dispose();
    this.rim.dispose();
  }

  /** Outlines exactly these entities, as they are drawn now. */
  show(indices: readonly number[]): void {
    for (const { meshes, ofCloud } of this.shown)
      for (const mesh of meshes) ofCloud ? (mesh.material as MeshBasicMaterial).dispose() : release(mesh.geometry);
    this.group.clear();
    this.shown = [];
    for (const index of indices) {
      const cloud = this.entities.clouds.of(index);
      if (cloud?.isLiquid) {
        const meshes = [this.mesh(maskGeometry(cloud.geometry), this.mask), this.mesh(rimGeometry(cloud.geometry), this.rim)];
        this.shown.push({ index, meshes, ofCloud: false });
        continue;
      }
      if (cloud) {
        const mask = this.prepared(cloud.twin(this.mask.clone(), new Uniform(0)), true);
        const rim = this.prepared(cloud.twin(cloudRimMaterial(this.color, this.layer), this.cloudRim), false);
        this.shown.push({ index, meshes: [mask, rim], ofCloud: true });
        continue;
      }
      const drawable = this.entities.drawableOf(index);
      if (!drawable?.castsShadow) continue;
      const meshes = drawable.parts.flatMap((part) => [
        this.mesh(maskGeometry(part.geometry), this.mask),
        this.mesh(rimGeometry(part.geometry), this.rim),
      ]);
      this.shown.push({ index, meshes, ofCloud: false });
    }
  }

  /** Moves the outline with the entities; `size` is the canvas's in pixels. */
  update(now: number, size: Vector2): void {
    (this.rim.uniforms["shift"]!.value as Vector2).set((2 * WIDTH_PIXELS) / size.x, (2 * WIDTH_PIXELS) / size.y);
    this.cloudRim.value = (2 * WIDTH_PIXELS) / size.y;
    for (const { index, meshes, ofCloud } of this.shown) {
      if (ofCloud) continue;
      const liquid = this.entities.clouds.of(index);
      if (liquid?.isLiquid) {
        for (const { geometry } of meshes) follow(geometry, liquid.geometry);
        continue;
      }
      const drawable = this.entities.drawableOf(index);
      const drawn = drawable !== undefined && this.entities.matrixOf(index, now, this.matrix);
      meshes.forEach((mesh, at) => {
        mesh.visible = drawn;
        const part = drawable?.parts[at >> 1];
        if (part) mesh.matrixWorld.multiplyMatrices(this.matrix, part.matrix);
      });
    }
  }

  private mesh(geometry: BufferGeometry, material: MeshBasicMaterial | ShaderMaterial): Mesh {
    return this.prepared(new Mesh(geometry, material), material === this.mask);
  }

  private prepared(mesh: Mesh, isMask: boolean): Mesh {
    mesh.matrixAutoUpdate = false;
    mesh.matrixWorldAutoUpdate = false;
    mesh.frustumCulled = false;
    mesh.renderOrder = LAST_ORDER - 2 * (this.layer - 1) - (isMask ? 1 : 0);
    mesh.raycast = () => {};
    this.group.add(mesh);
    return mesh;
  }
}

function maskGeometry(original: BufferGeometry): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setIndex(original.index);
  geometry.setAttribute("position", original.getAttribute("position"));
  return geometry;
}

/** Detaches the shared buffers before disposal: three.js would otherwise dispose of those of the drawn mesh, and stop updating it. */
function release(geometry: BufferGeometry): void {
  geometry.setIndex(null);
  geometry.deleteAttribute("position");
  geometry.dispose();
}

/** Takes over the present triangles of the original. */
function follow(geometry: BufferGeometry, original: BufferGeometry): void {
  geometry.setIndex(original.index);
  geometry.setAttribute("position", original.getAttribute("position"));
  geometry.setDrawRange(original.drawRange.start, original.drawRange.count);
}

function rimGeometry(original: BufferGeometry): BufferGeometry {
  const geometry = new InstancedBufferGeometry();
  geometry.setIndex(original.index);
  geometry.setAttribute("position", original.getAttribute("position"));
  geometry.instanceCount = COPIES;
  return geometry;
}

function cloudRimMaterial(color: ColorRepresentation, layer: number): MeshBasicMaterial {
  return new MeshBasicMaterial({
    color,
    depthTest: false,
    depthWrite: false,
    transparent: true,
    toneMapped: false,
    stencilWrite: true,
    stencilRef: layer,
    stencilFunc: NotEqualStencilFunc,
    stencilZPass: KeepStencilOp,
  });
}

function rimMaterial(color: ColorRepresentation, layer: number): ShaderMaterial {
  return new ShaderMaterial({
    depthTest: false,
    depthWrite: false,
    transparent: true,
    side: 2,
    stencilWrite: true,
    stencilRef: layer,
    stencilFunc: NotEqualStencilFunc,
    stencilZPass: KeepStencilOp,
    uniforms: { shift: { value: new Vector2() }, color: { value: new Color(color) } },
    vertexShader: `
      uniform vec2 shift;
      void main() {
        float angle = float(gl_InstanceID) * ${((2 * Math.PI) / COPIES).toFixed(6)};
        gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
        gl_Position.xy += vec2(cos(angle), sin(angle)) * shift * gl_Position.w;
      }`,
    fragmentShader: `
      uniform vec3 color;
      void main() {
        gl_FragColor = vec4(color, 1.0);
        #include <colorspace_fragment>
      }`,
  });
}
