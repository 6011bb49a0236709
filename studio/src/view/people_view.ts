// SPDX-License-Identifier: MIT
import { BoxGeometry, Color, Group, Matrix4, Mesh, MeshLambertMaterial, type PerspectiveCamera, Quaternion, SphereGeometry, Vector2, Vector3 } from "three";
import type { Hand, Member, Presence } from "../connection/messages";
import type { Camera } from "../connection/scene_types";
import { memberName, type People } from "../document/people";
import type { EntityView } from "./entity_view";
import { disposeSprite, keepSize, nameTag, pointerDot, type ScreenSprite } from "./name_tag";
import { MOST_LAYERS, Outline } from "./outline";

/** Half of the way to a told place is gone in this time, so that 15 places a second look like one motion. */
const HALF_MS = 45;
/** What is nearer to its told place than this is there, m. */
const ARRIVED = 1e-4;
/** Radius of a head, m; far from the eye it is drawn larger, this many times the distance, so that it can be seen. */
const HEAD_RADIUS = 0.11;
const LEAST_ANGLE = 0.012;
/** A page whose camera is nearer to the eye than this is not drawn: it would fill the picture. */
const NEAREST = 0.4;
const UP = new Vector3(0, 1, 0);

const HEAD = new SphereGeometry(1, 20, 14);
const VISOR = new BoxGeometry(1.25, 0.55, 0.5).translate(0, 0.1, -0.85);
const HAND = new BoxGeometry(0.08, 0.03, 0.11);
const DARK = new MeshLambertMaterial({ color: 0x14181d });

/** How far before a headset lies what its wearer looks at, as far as is known, m. */
const HEADSET_LOOK = 2;

/** Where a member's eyes are and what they look at; null where it is not known. */
export function lookOf({ camera, head }: Presence): Camera | null {
  if (!head) return camera ?? null;
  const ahead = new Vector3(0, 0, -HEADSET_LOOK).applyQuaternion(new Quaternion(...head.rotation));
  return { position: head.position, target: ahead.add(new Vector3(...head.position)).toArray() };
}

/** A place that glides to where it was told to be. */
class Glide {
  readonly position = new Vector3();
  readonly rotation = new Quaternion();
  private readonly toPosition = new Vector3();
  private readonly toRotation = new Quaternion();
  private known = false;

  to(position: readonly number[], rotation: Quaternion): void {
    this.toPosition.fromArray(position);
    this.toRotation.copy(rotation);
    if (!this.known) {
      this.position.copy(this.toPosition);
      this.rotation.copy(rotation);
    }
    this.known = true;
  }

  /** Whoever comes back begins anew. */
  forget(): void {
    this.known = false;
  }

  /** Goes on; returns whether it is still on its way. */
  advance(ms: number): boolean {
    if (!this.known || this.position.distanceTo(this.toPosition) + this.rotation.angleTo(this.toRotation) < ARRIVED) return false;
    const part = 1 - 0.5 ** (ms / HALF_MS);
    this.position.lerp(this.toPosition, part);
    this.rotation.slerp(this.toRotation, part);
    return true;
  }
}

/** Another member in the scene: head or camera, hands, the point under the mouse, and what is selected. */
class Figure {
  readonly group = new Group();
  readonly outline: Outline;
  private readonly material: MeshLambertMaterial;
  private readonly head = new Group();
  private readonly hands = new Map<Hand["hand"], { mesh: Mesh; glide: Glide }>();
  private readonly headGlide = new Glide();
  private readonly dotGlide = new Glide();
  private readonly headTag: ScreenSprite;
  private readonly dot: ScreenSprite;
  private readonly dotTag: ScreenSprite;
  private readonly turn = new Quaternion();
  private readonly looking = new Matrix4();
  private isPage = true;
  private selection = "";

  constructor(
    private readonly member: Member,
    entities: EntityView,
    layer: number,
  ) {
    const { color } = member;
    const name = memberName(member);
    this.outline = new Outline(entities, color, layer);
    this.material = new MeshLambertMaterial({ color: new Color(color) });
    this.head.add(new Mesh(HEAD, this.material), new Mesh(VISOR, DARK));
    this.headTag = nameTag(name, color, 0.35);
    this.dot = pointerDot(color);
    this.dotTag = nameTag(name, color, 0.6);
    this.group.add(this.head, this.headTag.sprite, this.dot.sprite, this.dotTag.sprite, this.outline.group);
    this.head.traverse((part) => (part.raycast = () => {}));
    this.showDot(false);
    this.head.visible = this.headTag.sprite.visible = false;
  }

  looksLike({ name, color }: Member): boolean {
    return name === this.member.name && color === this.member.color;
  }

  take({ camera, pointer, head, hands, selection }: Presence, refresh: boolean): void {
    this.isPage = !head;
    if (head) this.headGlide.to(head.position, this.turn.fromArray(head.rotation).normalize());
    else if (camera) {
      this.looking.lookAt(new Vector3(...camera.position), new Vector3(...camera.target), UP);
      this.headGlide.to(camera.position, this.turn.setFromRotationMatrix(this.looking));
    }
    this.head.visible = this.headTag.sprite.visible = Boolean(head ?? camera);
    this.showDot(Boolean(pointer));
    if (pointer) this.dotGlide.to(pointer.position, this.turn.identity());
    else this.dotGlide.forget();
    this.takeHands(hands ?? []);
    const chosen = selection ?? [];
    if (!refresh && chosen.join() === this.selection) return;
    this.selection = chosen.join();
    this.outline.show(chosen);
  }

  private showDot(shown: boolean): void {
    this.dot.sprite.visible = this.dotTag.sprite.visible = shown;
  }

  private takeHands(hands: readonly Hand[]): void {
    for (const [side, { mesh }] of this.hands) {
      if (hands.some(({ hand }) => hand === side)) continue;
      mesh.removeFromParent();
      this.hands.delete(side);
    }
    for (const { hand, position, rotation } of hands) {
      let shown = this.hands.get(hand);
      if (!shown) {
        shown = { mesh: new Mesh(HAND, this.material), glide: new Glide() };
        shown.mesh.raycast = () => {};
        this.group.add(shown.mesh);
        this.hands.set(hand, shown);
      }
      shown.glide.to(position, this.turn.fromArray(rotation).normalize());
    }
  }

  /** Moves on by so many milliseconds; returns whether anything is still on its way. */
  advance(ms: number, camera: PerspectiveCamera, height: number): boolean {
    const moving = [this.headGlide.advance(ms), this.dotGlide.advance(ms), ...[...this.hands.values()].map(({ glide }) => glide.advance(ms))];
    const distance = this.headGlide.position.distanceTo(camera.position);
    const radius = this.isPage ? Math.max(HEAD_RADIUS, LEAST_ANGLE * distance) : HEAD_RADIUS;
    this.head.scale.setScalar(this.isPage && distance < NEAREST ? 0 : radius);
    this.head.position.copy(this.headGlide.position);
    this.head.quaternion.copy(this.headGlide.rotation);
    this.headTag.sprite.position.copy(this.headGlide.position).addScaledVector(UP, 1.2 * radius);
    this.dot.sprite.position.copy(this.dotGlide.position);
    this.dotTag.sprite.position.copy(this.dotGlide.position);
    for (const { mesh, glide } of this.hands.values()) {
      mesh.position.copy(glide.position);
      mesh.quaternion.copy(glide.rotation);
    }
    for (const sprite of [this.headTag, this.dot, this.dotTag]) keepSize(sprite, camera, height);
    return moving.includes(true);
  }

  dispose(): void {
    for (const sprite of [this.headTag, this.dot, this.dotTag]) disposeSprite(sprite);
    this.outline.dispose();
    this.material.dispose();
    this.group.removeFromParent();
  }
}

/** Draws the other members of the session. */
export class PeopleView {
  readonly group = new Group();
  private readonly figures = new Map<number, { figure: Figure; layer: number }>();
  private last = 0;

  constructor(
    private readonly people: People,
    private readonly entities: EntityView,
  ) {}

  /** Numbers of the members that are drawn, for tests. */
  get drawn(): number[] {
    return [...this.figures.keys()];
  }

  /** Makes a figure for each of the others. */
  meet(): void {
    const others = this.people.others;
    for (const [client, { figure }] of this.figures) {
      if (others.some((other) => other.client === client && figure.looksLike(other))) continue;
      figure.dispose();
      this.figures.delete(client);
    }
    for (const member of others) {
      if (this.figures.has(member.client)) continue;
      const layer = this.freeLayer();
      const figure = new Figure(member, this.entities, layer);
      this.group.add(figure.group);
      this.figures.set(member.client, { figure, layer });
      this.follow(member.client);
    }
  }

  /** Takes over a member's newest presence. */
  follow(client: number, refresh = false): void {
    this.figures.get(client)?.figure.take(this.people.presence(client), refresh);
  }

  /** Entities are drawn otherwise than before: outlines are made anew. */
  refresh(): void {
    for (const client of this.figures.keys()) this.follow(client, true);
  }

  /** Moves the figures on; `size` is the picture's in pixels, `height` in CSS pixels. Returns whether any is on its way. */
  advance(now: number, camera: PerspectiveCamera, size: Vector2, height: number): boolean {
    const ms = Math.min(now - this.last, 1000);
    this.last = now;
    let moving = false;
    for (const { figure } of this.figures.values()) {
      figure.outline.update(now, size);
      moving = figure.advance(ms, camera, height) || moving;
    }
    return moving;
  }

  /** The own selection has layer 1; whoever is one too many shares the last layer. */
  private freeLayer(): number {
    const taken = new Set([...this.figures.values()].map(({ layer }) => layer));
    let layer = 2;
    while (taken.has(layer) && layer < MOST_LAYERS) ++layer;
    return layer;
  }
}
