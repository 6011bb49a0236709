// SPDX-License-Identifier: MIT
import {
  AlwaysStencilFunc,
  BufferGeometry,
  Color,
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

const OUTLINE_COLOR = 0xffa726;
const WIDTH_PIXELS = 2;
const COPIES = 8;

/**
 * A line around the selection: the silhouette is drawn into the stencil buffer, then eight copies shifted by the line's width
 * are drawn outside of it. It works for any mesh and needs no second render target, which matters on software renderers.
 */
export class Outline {
  readonly group = new Group();
  private readonly mask = new MeshBasicMaterial({
    colorWrite: false,
    depthWrite: false,
    depthTest: false,
    side: 2,
    stencilWrite: true,
    stencilRef: 1,
    stencilFunc: AlwaysStencilFunc,
    stencilZPass: ReplaceStencilOp,
  });
  private readonly rim = rimMaterial();
  private readonly cloudRim = new Uniform(0);
  private shown: { index: number; meshes: Mesh[]; ofCloud: boolean }[] = [];
  private readonly matrix = new Matrix4();

  constructor(private readonly entities: EntityView) {}

  /** Outlines exactly these entities, as they are drawn now. */
  show(indices: readonly number[]): void {
    for (const { meshes, ofCloud } of this.shown)
      for (const mesh of meshes) ofCloud ? (mesh.material as MeshBasicMaterial).dispose() : release(mesh.geometry);
    this.group.clear();
    this.shown = [];
    for (const index of indices) {
      const cloud = this.entities.clouds.of(index);
      if (cloud?.isLiquid) {
        const meshes = [this.mesh(maskGeometry(cloud.geometry), this.mask, 998), this.mesh(rimGeometry(cloud.geometry), this.rim, 999)];
        this.shown.push({ index, meshes, ofCloud: false });
        continue;
      }
      if (cloud) {
        const mask = this.prepared(cloud.twin(this.mask.clone(), new Uniform(0)), 998);
        const rim = this.prepared(cloud.twin(cloudRimMaterial(), this.cloudRim), 999);
        this.shown.push({ index, meshes: [mask, rim], ofCloud: true });
        continue;
      }
      const drawable = this.entities.drawableOf(index);
      if (!drawable?.castsShadow) continue;
      const meshes = drawable.parts.flatMap((part) => [
        this.mesh(maskGeometry(part.geometry), this.mask, 998),
        this.mesh(rimGeometry(part.geometry), this.rim, 999),
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

  private mesh(geometry: BufferGeometry, material: MeshBasicMaterial | ShaderMaterial, order: number): Mesh {
    return this.prepared(new Mesh(geometry, material), order);
  }

  private prepared(mesh: Mesh, order: number): Mesh {
    mesh.matrixAutoUpdate = false;
    mesh.matrixWorldAutoUpdate = false;
    mesh.frustumCulled = false;
    mesh.renderOrder = order;
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

function cloudRimMaterial(): MeshBasicMaterial {
  return new MeshBasicMaterial({
    color: OUTLINE_COLOR,
    depthTest: false,
    depthWrite: false,
    transparent: true,
    toneMapped: false,
    stencilWrite: true,
    stencilRef: 1,
    stencilFunc: NotEqualStencilFunc,
    stencilZPass: KeepStencilOp,
  });
}

function rimMaterial(): ShaderMaterial {
  return new ShaderMaterial({
    depthTest: false,
    depthWrite: false,
    transparent: true,
    side: 2,
    stencilWrite: true,
    stencilRef: 1,
    stencilFunc: NotEqualStencilFunc,
    stencilZPass: KeepStencilOp,
    uniforms: { shift: { value: new Vector2() }, color: { value: new Color(OUTLINE_COLOR) } },
    vertexShader: `
      uniform vec2 shift;
      void main() {
        float angle = float(gl_InstanceID) * ${((2 * Math.PI) / COPIES).toFixed(6)};
        gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
        gl_Position.xy += vec2(cos(angle), sin(angle)) * shift * gl_Position.w;
      }`,
    fragmentShader: `
      uniform vec3 color;
      void main() { gl_FragColor = vec4(color, 1.0); }`,
  });
}
