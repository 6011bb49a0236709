// SPDX-License-Identifier: MIT
import { BufferGeometry, Group, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial, SphereGeometry, Vector3 } from "three";
import type { Hand } from "./hand";
import type { Stance } from "./stance";
import { TextLabel } from "./text_label";

const COLOR = 0xff9d2e;
/** Radius of the marks at its ends, m of the room. */
const MARK = 0.006;

/** A measuring tape: the first press sets one end, the second the other; the distance stands beside it. */
export class Tape {
  readonly group = new Group();
  isOn = false;
  private readonly ends = [new Vector3(), new Vector3()] as const;
  /** How many ends are set. */
  private set = 0;
  private readonly line = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ color: COLOR, depthTest: false, transparent: true, toneMapped: false }));
  private readonly marks = [mark(), mark()] as const;
  private readonly label = new TextLabel();
  private readonly middle = new Vector3();

  constructor(private readonly stance: Stance) {
    this.line.geometry.setFromPoints([...this.ends]);
    this.line.frustumCulled = false;
    this.line.raycast = () => {};
    this.line.renderOrder = 1150;
    this.group.add(this.line, ...this.marks, this.label.mesh);
    this.group.visible = false;
  }

  /** m; null before both ends are set. */
  get length(): number | null {
    return this.set === 2 ? this.ends[0].distanceTo(this.ends[1]) : null;
  }

  toggle(): void {
    this.isOn = !this.isOn;
    this.set = 0;
    this.group.visible = false;
  }

  /** The trigger of a hand, with the point that its ray meets, or where the hand is. */
  press(point: Vector3): void {
    if (this.set === 2) this.set = 0;
    this.ends[this.set === 0 ? 0 : 1].copy(point);
    ++this.set;
  }

  /** The free end goes with the hand. */
  update(hand: Hand, met: Vector3 | null): void {
    if (!this.isOn) return;
    this.group.visible = this.set > 0;
    if (this.set === 0) return;
    if (this.set === 1) this.ends[1].copy(met ?? hand.position);
    const places = this.line.geometry.getAttribute("position");
    this.ends.forEach((end, at) => places.setXYZ(at, end.x, end.y, end.z));
    places.needsUpdate = true;
    this.marks.forEach((each, at) => {
      each.position.copy(this.ends[at]!);
      each.scale.setScalar(MARK * this.stance.scale);
    });
    this.middle.copy(this.ends[0]).add(this.ends[1]).multiplyScalar(0.5);
    this.label.show(lengthText(this.ends[0].distanceTo(this.ends[1])), this.middle, this.stance.head);
  }

  get text(): string {
    return this.set > 0 ? this.label.text : "";
  }
}

/** A length with a sensible number of digits. */
export function lengthText(metres: number): string {
  return metres < 1 ? `${(100 * metres).toFixed(1)} cm` : `${metres.toFixed(2)} m`;
}

function mark(): Mesh {
  const mesh = new Mesh(new SphereGeometry(1, 16, 12), new MeshBasicMaterial({ color: COLOR, depthTest: false, transparent: true, toneMapped: false }));
  mesh.renderOrder = 1151;
  mesh.raycast = () => {};
  return mesh;
}
