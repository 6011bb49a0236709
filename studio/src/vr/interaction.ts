// SPDX-License-Identifier: MIT
import { Color, Vector3 } from "three";
import { nameOf } from "../document/scene_document";
import type { Parts } from "../parts";
import type { Hit } from "../view/view";
import type { Carry } from "./carry";
import type { Grabbing } from "./grabbing";
import type { Hand, Hands, Side } from "./hand";
import type { Moving } from "./moving";
import { GRAB_REACH, isLocked, isMovable, nearestEntity } from "./near";
import { RayLook } from "./ray_look";
import type { Stance } from "./stance";
import { lengthText, type Tape } from "./tape";
import { TextLabel } from "./text_label";
import type { Desk } from "./ui/desk";
import type { WristMenu } from "./wrist_menu";
import { t } from "../language";

const PLAIN = new Color(0xdfe6ee);
const CAN_GRAB = new Color(0xff9d2e);
const LOCKED = new Color(0x8a93a0);
/** Things in reach of the hand are looked for at each so many pictures: it reads triangles. */
const NEAR_PAUSE = 4;
/** An impulse that shakes the hand fully, N s; weaker shakes than LEAST_SHAKE are not felt. */
const FULL_SHAKE = 4;
const LEAST_SHAKE = 0.08;
const SHAKE_MS = 40;

/** What the parts of a session that this class ties together are. */
export interface Tools {
  readonly stance: Stance;
  readonly hands: Hands;
  readonly grabbing: Grabbing;
  readonly desk: Desk;
  readonly carry: Carry;
  readonly moving: Moving;
  readonly menu: WristMenu;
  readonly tape: Tape;
  openModels(): void;
  openProperties(): void;
}

/** What one hand points at and touches. */
interface Aim {
  hit: Hit | null;
  near: number | null;
  /** The button that holds what the hand has. */
  by: "trigger" | "squeeze" | null;
  readonly ray: RayLook;
}

/** Decides what a press of a hand means, and draws what it points at. */
export class Interaction {
  private readonly aims: Record<Side, Aim>;
  private readonly label = new TextLabel();
  private readonly size = new Vector3();
  private readonly place = new Vector3();
  /** What is outlined beside the selection, and that selection. */
  private readonly outlined = [-1, -1];
  private chosen: readonly number[] = [];
  private picture = 0;

  constructor(
    private readonly parts: Pick<Parts, "preferences" | "document" | "playback" | "selection" | "motion" | "entities" | "view" | "server">,
    private readonly tools: Tools,
  ) {
    const aim = (): Aim => ({ hit: null, near: null, by: null, ray: new RayLook() });
    this.aims = { left: aim(), right: aim() };
    parts.view.scene.add(this.aims.left.ray.group, this.aims.right.ray.group, this.label.mesh);
  }

  aimOf(side: Side): Readonly<Aim> {
    return this.aims[side];
  }

  /** What the hand holds was struck: an event of the server. */
  shake(side: string, impulse: number): void {
    if ((side !== "left" && side !== "right") || !this.parts.preferences.get("vr").haptics) return;
    const strength = Math.min(impulse / FULL_SHAKE, 1);
    this.tools.hands.of(side).pulse(Math.max(Math.sqrt(strength), LEAST_SHAKE), SHAKE_MS);
  }

  update(): void {
    ++this.picture;
    this.buttons();
    for (const hand of this.tools.hands.both) {
      this.aim(hand);
      this.press(hand);
    }
  }

  end(): void {
    for (const { ray } of Object.values(this.aims)) ray.hide();
    this.label.hide();
    this.outlined.fill(-1);
    this.parts.view.outline.show(this.parts.selection.indices);
  }

  private buttons(): void {
    const { hands, menu } = this.tools;
    if (hands.left.lower.pressed) menu.toggle();
    if (hands.left.upper.pressed) this.tools.openModels();
    if (hands.right.lower.pressed) this.tools.openProperties();
    if (hands.right.upper.pressed && this.parts.document.undo !== null) void this.parts.server.command("edit.undo", {});
  }

  /** The hands take turns: each picture one ray is followed. */
  private aim(hand: Hand): void {
    const aim = this.aims[hand.side];
    const { desk, grabbing, carry, stance } = this.tools;
    if (!hand.seen || desk.isBusy(hand.side) || grabbing.held(hand.side) || carry.side === hand.side) {
      aim.hit = aim.near = null;
      return;
    }
    const turn = hand.side === "left" ? 0 : 1;
    if (this.picture % 2 === turn || hand.trigger.pressed) aim.hit = this.parts.view.cast(hand.rayOrigin, hand.rayDirection);
    if (this.picture % NEAR_PAUSE === 2 * turn || hand.trigger.pressed || hand.squeeze.pressed) {
      const near = nearestEntity(this.parts, hand.position, GRAB_REACH * stance.scale);
      if (near !== null && near !== aim.near && this.parts.preferences.get("vr").haptics) hand.pulse(0.15, 10);
      aim.near = near;
    }
  }

  private press(hand: Hand): void {
    const aim = this.aims[hand.side];
    const { grabbing, carry, desk } = this.tools;
    if (aim.by && hand[aim.by].released) {
      aim.by = null;
      grabbing.release(hand.side);
    }
    if (carry.side === hand.side || desk.isBusy(hand.side) || !hand.seen) return;
    if (hand.trigger.pressed) this.pull(hand, aim);
    else if (hand.squeeze.pressed && aim.near !== null && !grabbing.held(hand.side)) this.take(hand, aim, "squeeze", aim.near, hand.position, null);
  }

  private take(hand: Hand, aim: Aim, by: "trigger" | "squeeze", index: number, point: Vector3, distance: number | null): void {
    if (!this.tools.grabbing.grab(hand, index, point, distance)) return;
    aim.by = by;
    if (this.parts.preferences.get("vr").haptics) hand.pulse(0.5, 25);
  }

  /** The trigger was pulled on no panel. */
  private pull(hand: Hand, aim: Aim): void {
    const { tape, moving } = this.tools;
    const { selection } = this.parts;
    const { hit, near } = aim;
    if (tape.isOn) tape.press(hit?.point ?? hand.position);
    else if (near !== null) this.take(hand, aim, "trigger", near, hand.position, null);
    else if (hit && isMovable(this.parts, hit.index)) this.take(hand, aim, "trigger", hit.index, hit.point, hit.distance);
    else {
      moving.aimByPinch(hand);
      if (hit) selection.set([hit.index]);
      else selection.clear();
    }
  }

  /** Draws rays, the outline of what could be grabbed, and the label. */
  draw(): void {
    for (const hand of this.tools.hands.both) this.drawRay(hand);
    this.outline();
    this.drawLabel();
    this.tools.tape.update(this.tools.hands.right, this.aims.right.hit?.point ?? null);
  }

  private drawRay(hand: Hand): void {
    const aim = this.aims[hand.side];
    const { desk, grabbing, carry, moving, stance } = this.tools;
    const held = grabbing.held(hand.side);
    const onPanel = desk.distanceOf(hand.side);
    // A hand that holds, touches, or is at a panel needs no ray.
    const hides = !hand.seen || (held && held.distance === null) || (moving.teleport.aims && !onPanel) || moving.holdsWorld || (aim.near !== null && !held) || onPanel === 0;
    if (hides) aim.ray.hide();
    else if (onPanel !== null) aim.ray.show(hand.rayOrigin, hand.rayDirection, onPanel, null, CAN_GRAB, stance.scale);
    else if (held) aim.ray.show(hand.rayOrigin, hand.rayDirection, held.distance, null, CAN_GRAB, stance.scale);
    else if (carry.side === hand.side) aim.ray.show(hand.rayOrigin, hand.rayDirection, null, null, CAN_GRAB, stance.scale);
    else {
      const { hit } = aim;
      const locked = hit && isLocked(this.parts.document.entity(hit.index));
      const color = locked ? LOCKED : hit && isMovable(this.parts, hit.index) ? CAN_GRAB : PLAIN;
      aim.ray.show(hand.rayOrigin, hand.rayDirection, hit?.distance ?? null, hit?.normal ?? null, color, stance.scale);
    }
  }

  /** Outlines the selection and what the hands could grab now. */
  private outline(): void {
    const a = this.grabbable(this.aims.left);
    const b = this.grabbable(this.aims.right);
    const { indices } = this.parts.selection;
    const { outlined } = this;
    if (outlined[0] === a && outlined[1] === b && this.chosen === indices) return;
    outlined[0] = a;
    outlined[1] = b;
    this.chosen = indices;
    this.parts.view.outline.show([...new Set([...indices, a, b])].filter((index) => index >= 0));
  }

  /** What the hand would take now; -1: nothing. */
  private grabbable({ near, hit }: Aim): number {
    return near ?? (hit && isMovable(this.parts, hit.index) ? hit.index : -1);
  }

  /** The size of what is held, or the name of what is locked. */
  private drawLabel(): void {
    const { grabbing, stance, tape } = this.tools;
    const held = grabbing.held("right") ?? grabbing.held("left");
    const aim = this.aims.right.hit ? this.aims.right : this.aims.left;
    const pointed = aim.hit?.index;
    if (held && grabbing.isStopped && !tape.isOn) {
      const bounds = this.parts.entities.boundsOf([held.index], performance.now());
      if (bounds.isEmpty()) return this.label.hide();
      bounds.getSize(this.size);
      bounds.getCenter(this.place).y = bounds.max.y + 0.06 * stance.scale;
      this.label.show(`${lengthText(this.size.x)} × ${lengthText(this.size.y)} × ${lengthText(this.size.z)}`, this.place, stance.head);
    } else if (pointed !== undefined && isLocked(this.parts.document.entity(pointed))) {
      this.place.copy(aim.hit!.point).y += 0.08 * stance.scale;
      this.label.show(t("{{name}}: locked", { name: nameOf(this.parts.document.entity(pointed)!) }), this.place, stance.head);
    } else this.label.hide();
  }

  get labelText(): string {
    return this.label.mesh.visible ? this.label.text : "";
  }
}
