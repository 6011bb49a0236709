// SPDX-License-Identifier: MIT
import { BufferGeometry, Color, CylinderGeometry, Float32BufferAttribute, Group, Mesh, MeshBasicMaterial, Quaternion, RingGeometry, Vector3 } from "three";

const FORTH = new Vector3(0, 0, 1);
/** Thickness of the ray, and radius of the mark at its end as a part of its distance, m. */
const THICKNESS = 0.002;
const MARK = 0.011;
/** A ray that meets nothing ends so far away, m of the room. */
const FREE_END = 2.5;

/** The ray of a hand, which fades out, and a ring where it meets something. In the scene's frame. */
export class RayLook {
  readonly group = new Group();
  private readonly beam: Mesh<BufferGeometry, MeshBasicMaterial>;
  private readonly mark: Mesh<BufferGeometry, MeshBasicMaterial>;
  private readonly turn = new Quaternion();

  constructor() {
    this.beam = new Mesh(beamGeometry(), new MeshBasicMaterial({ vertexColors: true, transparent: true, depthWrite: false, toneMapped: false, fog: false }));
    this.mark = new Mesh(new RingGeometry(0.55, 1, 40), new MeshBasicMaterial({ transparent: true, opacity: 0.95, depthTest: false, depthWrite: false, toneMapped: false, fog: false, side: 2 }));
    this.beam.renderOrder = 1100;
    this.mark.renderOrder = 1101;
    for (const mesh of [this.beam, this.mark]) {
      mesh.frustumCulled = false;
      mesh.raycast = () => {};
      this.group.add(mesh);
    }
    this.group.visible = false;
  }

  hide(): void {
    this.group.visible = false;
  }

  /** Draws the ray up to `distance` metres of the scene (null: it meets nothing); `scale` is the user's size. */
  show(origin: Vector3, direction: Vector3, distance: number | null, normal: Vector3 | null, color: Color, scale: number): void {
    this.group.visible = true;
    const { beam, mark } = this;
    beam.position.copy(origin);
    beam.quaternion.copy(this.turn.setFromUnitVectors(FORTH, direction));
    beam.scale.set(scale, scale, distance ?? FREE_END * scale);
    beam.material.color.copy(color);
    mark.visible = distance !== null;
    if (distance === null) return;
    // The ring is equally wide at any distance, but never smaller than at arm's length.
    mark.scale.setScalar(MARK * Math.max(distance, 0.5 * scale));
    mark.position.copy(origin).addScaledVector(direction, distance);
    mark.quaternion.copy(normal ? this.turn.setFromUnitVectors(FORTH, normal) : beam.quaternion);
    if (normal) mark.position.addScaledVector(normal, 0.002 * scale);
    mark.material.color.copy(color);
  }
}

/** A thin tube of length 1 along Z that begins and ends transparent. */
function beamGeometry(): BufferGeometry {
  const geometry = new CylinderGeometry(0.35 * THICKNESS, THICKNESS, 1, 8, 8, true);
  geometry.rotateX(Math.PI / 2).translate(0, 0, 0.5);
  const places = geometry.getAttribute("position");
  const colors = new Float32Array(4 * places.count);
  for (let at = 0; at < places.count; ++at) {
    const z = places.getZ(at);
    const alpha = Math.min(z / 0.05, 1) * (0.85 - 0.65 * z);
    colors.set([1, 1, 1, alpha], 4 * at);
  }
  geometry.setAttribute("color", new Float32BufferAttribute(colors, 4));
  return geometry;
}

