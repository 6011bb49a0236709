// SPDX-License-Identifier: MIT
import { CapsuleGeometry, Color, CylinderGeometry, DynamicDrawUsage, Group, InstancedMesh, LatheGeometry, Matrix4, Mesh, MeshStandardMaterial, Quaternion, SphereGeometry, TorusGeometry, Vector2, Vector3 } from "three";
import type { Hand } from "./hand";

const BODY = new MeshStandardMaterial({ color: 0x565f6c, roughness: 0.55, metalness: 0.1 });
const FACE = new MeshStandardMaterial({ color: 0x3a424e, roughness: 0.45 });
const KNOB = new MeshStandardMaterial({ color: 0xd5dce5, roughness: 0.6 });
const ACCENT = new MeshStandardMaterial({ color: 0xff9d2e, roughness: 0.5, emissive: 0xff9d2e, emissiveIntensity: 0.25 });
const SKIN = new MeshStandardMaterial({ color: 0xb9c4d2, roughness: 0.75 });

/** How far a trigger turns and a stick leans when fully moved, rad; how far a button goes in, m. */
const TRIGGER_TURN = 0.35;
const STICK_LEAN = 0.4;
const BUTTON_DEPTH = 0.0015;

/** Joints that are joined by a bone, from the wrist outwards. */
const CHAINS = ["thumb", "index-finger", "middle-finger", "ring-finger", "pinky-finger"];
const LINKS = ["metacarpal", "phalanx-proximal", "phalanx-intermediate", "phalanx-distal", "tip"];
const BONES: readonly (readonly [XRHandJoint, XRHandJoint])[] = CHAINS.flatMap((chain) => {
  const names = LINKS.filter((link) => chain !== "thumb" || link !== "phalanx-intermediate").map((link) => `${chain}-${link}` as XRHandJoint);
  return names.map((name, at) => [at === 0 ? "wrist" : names[at - 1]!, name] as const);
});
/** Where the device tells no radius of a joint, m. */
const JOINT_RADIUS = 0.008;

/** A controller in its grip's frame: the handle goes down and back, stick and buttons are on a round face above the thumb. */
class ControllerLook {
  readonly group = new Group();
  private readonly trigger = new Group();
  private readonly stick = new Group();
  private readonly buttons: Mesh[];

  constructor(side: Hand["side"]) {
    const inward = side === "left" ? 1 : -1;
    const handle = new Mesh(new CapsuleGeometry(0.0175, 0.058, 8, 24), BODY);
    handle.rotation.x = Math.PI / 2 - 0.25;
    handle.position.set(0, -0.006, 0.01);
    // A flat disc with a round rim, turned about its axis.
    const rim = [[0, -0.012], [0.024, -0.0075], [0.0265, -0.002], [0.0255, 0.003], [0.021, 0.006], [0, 0.006]].map(([x, y]) => new Vector2(x, y));
    const face = new Group();
    face.position.set(0, 0.012, -0.032);
    face.rotation.x = 0.35;
    const ring = new Mesh(new TorusGeometry(0.0258, 0.0011, 8, 40), ACCENT);
    ring.rotation.x = Math.PI / 2;
    this.stick.add(new Mesh(new CylinderGeometry(0.0035, 0.005, 0.008, 16), KNOB), placed(new Mesh(new CylinderGeometry(0.0078, 0.0066, 0.003, 24), KNOB), 0, 0.0055, 0));
    this.stick.position.set(-0.007 * inward, 0.009, -0.004);
    this.buttons = [placed(button(), 0.011 * inward, 0.0065, 0.006), placed(button(), 0.014 * inward, 0.0065, -0.007)];
    face.add(new Mesh(new LatheGeometry(rim, 40), FACE), ring, this.stick, ...this.buttons);
    const blade = new Mesh(new CapsuleGeometry(0.0075, 0.014, 5, 14), KNOB);
    blade.rotation.x = 0.5;
    blade.position.set(0, -0.012, -0.006);
    this.trigger.add(blade);
    this.trigger.position.set(0, 0.0, -0.034);
    this.group.add(handle, face, this.trigger);
    for (const mesh of [handle, ...face.children]) mesh.castShadow = false;
  }

  follow(hand: Hand): void {
    this.trigger.rotation.x = -TRIGGER_TURN * hand.pull;
    this.stick.rotation.set(STICK_LEAN * hand.stickY, 0, -STICK_LEAN * hand.stickX);
    this.buttons[0]!.position.y = 0.0065 - (hand.lower.held ? BUTTON_DEPTH : 0);
    this.buttons[1]!.position.y = 0.0065 - (hand.upper.held ? BUTTON_DEPTH : 0);
  }
}

/** A tracked hand: a ball at each joint and a bone between neighbours. */
class JointsLook {
  readonly group = new Group();
  private readonly balls = instances(new SphereGeometry(1, 16, 12), BONES.length + 1);
  private readonly bones = instances(new CylinderGeometry(1, 1, 1, 14, 1, true), BONES.length);
  private readonly matrix = new Matrix4();
  private readonly along = new Vector3();
  private readonly middle = new Vector3();
  private readonly turn = new Quaternion();
  private readonly size = new Vector3();
  private static readonly UP = new Vector3(0, 1, 0);

  constructor() {
    this.group.add(this.balls, this.bones);
  }

  follow(hand: Hand): void {
    const { joints } = hand.joints;
    for (let at = 0; at < BONES.length; ++at) {
      const [from, to] = BONES[at]!;
      const a = joints[from];
      const b = joints[to];
      if (!a || !b) continue;
      const radius = b.jointRadius ?? JOINT_RADIUS;
      this.balls.setMatrixAt(at, this.matrix.makeScale(radius, radius, radius).setPosition(b.position));
      this.along.copy(b.position).sub(a.position);
      this.middle.copy(a.position).add(b.position).multiplyScalar(0.5);
      const length = this.along.length();
      this.turn.setFromUnitVectors(JointsLook.UP, this.along.divideScalar(length || 1));
      this.bones.setMatrixAt(at, this.matrix.compose(this.middle, this.turn, this.size.set(radius * 0.92, length, radius * 0.92)));
    }
    const wrist = joints["wrist"];
    if (wrist) {
      const radius = 1.1 * (wrist.jointRadius ?? 2 * JOINT_RADIUS);
      this.balls.setMatrixAt(BONES.length, this.matrix.makeScale(radius, radius, radius).setPosition(wrist.position));
    }
    this.balls.instanceMatrix.needsUpdate = true;
    this.bones.instanceMatrix.needsUpdate = true;
  }
}

/** How one hand is drawn: as a controller, or as the user's own hand. Hangs in the room. */
export class HandLook {
  readonly group = new Group();
  private readonly controller: ControllerLook;
  private readonly joints = new JointsLook();

  constructor(private readonly hand: Hand) {
    this.controller = new ControllerLook(hand.side);
    this.controller.group.matrixAutoUpdate = false;
    this.group.add(this.controller.group, this.joints.group);
  }

  /** Whether a controller, a hand or nothing is drawn. */
  get drawn(): "controller" | "hand" | null {
    return this.joints.group.visible ? "hand" : this.controller.group.visible ? "controller" : null;
  }

  update(): void {
    const { hand } = this;
    this.joints.group.visible = hand.seen && hand.isTracked;
    this.controller.group.visible = hand.seen && !hand.isTracked;
    if (this.joints.group.visible) this.joints.follow(hand);
    if (!this.controller.group.visible) return;
    this.controller.group.matrix.copy((hand.grip.visible ? hand.grip : hand.ray).matrix);
    this.controller.follow(hand);
  }
}

function button(): Mesh {
  return new Mesh(new CylinderGeometry(0.0042, 0.0042, 0.004, 24), KNOB);
}

function placed(mesh: Mesh, x: number, y: number, z: number): Mesh {
  mesh.position.set(x, y, z);
  return mesh;
}

function instances(geometry: SphereGeometry | CylinderGeometry, count: number): InstancedMesh {
  const mesh = new InstancedMesh(geometry, SKIN, count);
  mesh.instanceMatrix.setUsage(DynamicDrawUsage);
  mesh.frustumCulled = false;
  return mesh;
}

/** Takes over the page's accent colour. */
export function setAccent(color: Color): void {
  ACCENT.color.copy(color);
  ACCENT.emissive.copy(color);
}
