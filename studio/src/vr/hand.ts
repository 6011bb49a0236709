// SPDX-License-Identifier: MIT
import { Matrix4, Quaternion, Vector3, type WebXRManager, type XRGripSpace, type XRHandSpace, type XRTargetRaySpace } from "three";

export type Side = "left" | "right";

/** Indices of the "xr-standard" gamepad. */
const TRIGGER = 0;
const SQUEEZE = 1;
const LOWER = 4;
const UPPER = 5;
const STICK_X = 2;
const STICK_Y = 3;
/** Below this a stick rests. */
const DEAD = 0.15;
/** A tracked hand is a fist while its four fingertips are on average nearer to the wrist than this, m; it opens again at the second. */
const FIST = 0.085;
const FIST_ENDS = 0.1;
const FINGERS = ["index-finger-tip", "middle-finger-tip", "ring-finger-tip", "pinky-finger-tip"] as const;

/** A button that is polled or told by events; `pressed` and `released` hold for one picture. */
export class Button {
  held = false;
  pressed = false;
  released = false;
  private next = false;
  private touched = false;

  tell(held: boolean): void {
    this.next = held;
    this.touched ||= held;
  }

  update(): void {
    // A press that ended before the next picture counts for one picture.
    const now = this.next || (this.touched && !this.held);
    this.pressed = now && !this.held;
    this.released = !now && this.held;
    this.held = now;
    this.touched = false;
  }
}

/** One hand of the user: a controller or a tracked hand. Positions are in the scene unless they say room. */
export class Hand {
  source: XRInputSource | null = null;
  readonly trigger = new Button();
  readonly squeeze = new Button();
  readonly lower = new Button();
  readonly upper = new Button();
  private readonly buttons = [this.trigger, this.squeeze, this.lower, this.upper] as const;
  stickX = 0;
  stickY = 0;
  /** How far the trigger is pulled, 0 … 1. */
  pull = 0;
  /** Whether it has a pose now. */
  seen = false;
  /** Where things are held, and how the hand is turned. */
  readonly position = new Vector3();
  readonly rotation = new Quaternion();
  readonly room = new Vector3();
  readonly rayOrigin = new Vector3();
  readonly rayDirection = new Vector3();
  /** The point that pokes at panels. */
  readonly tip = new Vector3();
  private readonly scale = new Vector3();
  private readonly matrix = new Matrix4();

  constructor(
    readonly side: Side,
    public ray: XRTargetRaySpace,
    public grip: XRGripSpace,
    public joints: XRHandSpace,
  ) {}

  get isTracked(): boolean {
    return this.source?.hand !== undefined && this.source?.hand !== null;
  }

  /** Reads poses and buttons for the coming picture. */
  update(): void {
    const pad = this.source?.gamepad;
    const isTracked = this.isTracked;
    this.seen = this.source !== null && (this.ray.visible || this.grip.visible);
    this.stickX = isTracked ? 0 : rested(pad?.axes[STICK_X]);
    this.stickY = isTracked ? 0 : rested(pad?.axes[STICK_Y]);
    this.pull = pad?.buttons[TRIGGER]?.value ?? Number(this.trigger.held);
    if (!isTracked) {
      this.lower.tell(pad?.buttons[LOWER]?.pressed ?? false);
      this.upper.tell(pad?.buttons[UPPER]?.pressed ?? false);
      if (pad?.buttons[SQUEEZE]) this.squeeze.tell(pad.buttons[SQUEEZE].pressed);
    } else this.squeeze.tell(this.isFist());
    for (const button of this.buttons) button.update();
    if (this.seen) this.readPoses(isTracked);
  }

  /** Forgets what was pressed: the device went away. */
  drop(): void {
    this.source = null;
    for (const button of this.buttons) button.tell(false);
  }

  /** Shakes the controller; strength 0 … 1. */
  pulse(strength: number, milliseconds: number): void {
    const actuator = this.source?.gamepad?.hapticActuators?.[0] as { pulse?(value: number, duration: number): unknown } | undefined;
    void actuator?.pulse?.(Math.min(strength, 1), milliseconds);
  }

  private readPoses(isTracked: boolean): void {
    this.ray.updateWorldMatrix(true, false);
    this.rayOrigin.setFromMatrixPosition(this.ray.matrixWorld);
    this.rayDirection.set(0, 0, -1).transformDirection(this.ray.matrixWorld);
    const thumb = this.joints.joints["thumb-tip"];
    const index = this.joints.joints["index-finger-tip"];
    const wrist = this.joints.joints["wrist"];
    if (isTracked && thumb && index && wrist) {
      wrist.updateWorldMatrix(true, false);
      index.updateWorldMatrix(true, false);
      wrist.matrixWorld.decompose(this.position, this.rotation, this.scale);
      this.room.copy(thumb.position).add(index.position).multiplyScalar(0.5);
      this.position.copy(this.room).applyMatrix4(this.matrix.copy(this.ray.parent!.matrixWorld));
      this.tip.setFromMatrixPosition(index.matrixWorld);
      return;
    }
    const held = this.grip.visible ? this.grip : this.ray;
    held.updateWorldMatrix(true, false);
    held.matrixWorld.decompose(this.position, this.rotation, this.scale);
    this.room.copy(held.position);
    this.tip.copy(this.rayOrigin);
  }

  private isFist(): boolean {
    const wrist = this.joints.joints["wrist"];
    if (!wrist) return false;
    let sum = 0;
    for (const name of FINGERS) sum += this.joints.joints[name]?.position.distanceTo(wrist.position) ?? 1;
    return sum / FINGERS.length < (this.squeeze.held ? FIST_ENDS : FIST);
  }
}

/** The two hands of a device, whatever it is that reports them. */
export class Hands {
  readonly left: Hand;
  readonly right: Hand;
  readonly both: readonly [Hand, Hand];

  constructor(xr: WebXRManager, parent: { add(...objects: object[]): unknown }) {
    const made: (XRTargetRaySpace | XRGripSpace | XRHandSpace)[] = [];
    const make = (side: Side, at: number): Hand => {
      const hand = new Hand(side, xr.getController(at), xr.getControllerGrip(at), xr.getHand(at));
      made.push(hand.ray, hand.grip, hand.joints);
      return hand;
    };
    const spaces = [make("left", 0), make("right", 1)] as const;
    this.left = spaces[0];
    this.right = spaces[1];
    this.both = [this.left, this.right];
    parent.add(...made);
    this.listen(xr);
  }

  of(side: Side): Hand {
    return side === "left" ? this.left : this.right;
  }

  update(): void {
    this.left.update();
    this.right.update();
  }

  /** three.js numbers its controllers as they come; each Hand takes over the spaces of the number that has its side. */
  private listen(xr: WebXRManager): void {
    for (const at of [0, 1]) {
      const ray = xr.getController(at);
      let hand: Hand | null = null;
      ray.addEventListener("connected", ({ data }) => {
        hand = this.of(data.handedness === "left" ? "left" : "right");
        hand.source = data;
        hand.ray = ray;
        hand.grip = xr.getControllerGrip(at);
        hand.joints = xr.getHand(at);
      });
      ray.addEventListener("disconnected", ({ data }) => {
        if (hand?.source === data) hand?.drop();
        hand = null;
      });
      ray.addEventListener("selectstart", () => hand?.trigger.tell(true));
      ray.addEventListener("selectend", () => hand?.trigger.tell(false));
      ray.addEventListener("squeezestart", () => hand?.squeeze.tell(true));
      ray.addEventListener("squeezeend", () => hand?.squeeze.tell(false));
    }
  }
}

function rested(value: number | undefined): number {
  return value === undefined || Math.abs(value) < DEAD ? 0 : value;
}
