// SPDX-License-Identifier: MIT
import { Matrix4, Plane, Ray, Vector3 } from "three";
import type { Hand, Hands, Side } from "../hand";
import type { Stance } from "../stance";
import { BAR, inBox, type Panel } from "./panel";
import { button, type Widget } from "./widgets";

/** New panels stand so far before the eyes, m; a millimetre is 0.095° there. */
const DISTANCE = 0.6;
/** A fingertip presses at the panel and lets go this far before it, m. */
const POKE = 0.004;
const POKE_ENDS = 0.018;
/** The fingertip counts as pointing at a panel within this, m. */
const POKE_REACH = 0.05;
/** The stick scrolls by a row so often, s. */
const SCROLL_PAUSE = 0.16;

interface Pointing {
  panel: Panel | null;
  /** mm on the panel. */
  x: number;
  y: number;
  /** m of the scene, along the ray. */
  distance: number;
  widget: Widget | null;
  /** What the trigger or finger went down on. */
  down: { panel: Panel; widget: Widget } | null;
  /** The panel is carried by its bar. */
  carried: Panel | null;
  poking: boolean;
  scrolled: number;
}

/** All panels in the user's room, and what the hands do on them. */
export class Desk {
  readonly panels: Panel[] = [];
  private readonly pointings: Record<Side, Pointing> = { left: nothing(), right: nothing() };
  private readonly ray = new Ray();
  private readonly plane = new Plane();
  private readonly point = new Vector3();
  private readonly normal = new Vector3();
  private readonly matrix = new Matrix4();
  private readonly carriedFrom = new Matrix4();

  constructor(
    private readonly hands: Hands,
    private readonly stance: Stance,
    /** Whether the hand carries something: its trigger puts that down. */
    private readonly isFull: (side: Side) => boolean,
  ) {}

  add(panel: Panel): void {
    this.panels.push(panel);
    if (!panel.mesh.parent) this.stance.origin.add(panel.mesh);
  }

  /** Places a panel before the user, `aside` metres to the right, facing the eyes. */
  open(panel: Panel, aside = 0, lower = 0.12): void {
    const { head, origin } = this.stance;
    // Upright panels before the body, wherever the head nods.
    const forth = this.point.set(0, 0, -1).applyQuaternion(head.quaternion).setY(0).normalize();
    if (forth.lengthSq() < 0.5) forth.set(0, 0, -1);
    const right = this.normal.set(-forth.z, 0, forth.x);
    const { mesh } = panel;
    mesh.position.copy(head.position).addScaledVector(forth, DISTANCE).addScaledVector(right, aside);
    mesh.position.y -= lower;
    mesh.up.set(0, 1, 0);
    origin.updateMatrixWorld();
    mesh.quaternion.setFromRotationMatrix(this.matrix.lookAt(head.position, mesh.position, mesh.up));
    if (panel.options.hasBar && !panel.widgets.some(({ id }) => id === "close")) panel.renew();
    panel.show(true);
    mesh.updateMatrixWorld(true);
  }

  /** The button that closes a panel with a bar. */
  static closer(panel: Panel): Widget {
    return button({ id: "close", box: { x: panel.options.width - 34, y: 6, w: 26, h: 25 }, icon: "close", run: () => (panel.onClose ? panel.onClose() : panel.show(false)) });
  }

  /** How far along its ray the hand points at a panel, m of the scene; null: at none. */
  distanceOf(side: Side): number | null {
    const { panel, distance, carried } = this.pointings[side];
    return panel || carried ? distance : null;
  }

  /** Whether panels have this hand's trigger now. */
  isBusy(side: Side): boolean {
    const { panel, down, carried, poking } = this.pointings[side];
    return panel !== null || down !== null || carried !== null || poking;
  }

  update(seconds: number): void {
    for (const panel of this.panels) panel.hovered !== null && !this.isPointedAt(panel) && panel.hover(null);
    for (const hand of this.hands.both) this.follow(hand, seconds);
    for (const panel of this.panels) panel.update();
  }

  private isPointedAt(panel: Panel): boolean {
    return this.pointings.left.panel === panel || this.pointings.right.panel === panel;
  }

  private follow(hand: Hand, seconds: number): void {
    const pointing = this.pointings[hand.side];
    if (!hand.seen) {
      Object.assign(pointing, { panel: null, widget: null, down: null, carried: null, poking: false });
      return;
    }
    if (pointing.carried) return this.carry(hand, pointing);
    this.aim(hand, pointing);
    const { panel } = pointing;
    pointing.widget = panel?.widgetAt(pointing.x, pointing.y) ?? null;
    panel?.hover(pointing.widget?.id ?? (this.isOnBar(panel, pointing) ? "bar" : null));
    const pressed = pointing.poking ? this.pokes(hand, pointing) : hand.trigger.pressed;
    if (pressed && panel && !this.isFull(hand.side)) this.press(hand, pointing, panel);
    else if (pointing.down) this.drag(hand, pointing);
    this.turnWheel(hand, pointing, seconds);
  }

  /** Finds the panel under the fingertip, or else the one that the ray meets first. */
  private aim(hand: Hand, pointing: Pointing): void {
    const { scale } = this.stance;
    pointing.panel = null;
    pointing.distance = Infinity;
    const wasPoking = pointing.poking && pointing.down !== null;
    pointing.poking = false;
    for (const panel of this.panels) {
      if (!panel.isShown || panel.options.isPassive) continue;
      const { x, y, z } = panel.toLocal(hand.tip);
      if ((Math.abs(z) < POKE_REACH || wasPoking) && inPanel(panel, x, y)) {
        Object.assign(pointing, { panel, x, y, distance: 0 });
        pointing.poking = true;
        this.depth = z;
        return;
      }
      this.ray.set(hand.rayOrigin, hand.rayDirection);
      this.normal.set(0, 0, 1).transformDirection(panel.mesh.matrixWorld);
      this.plane.setFromNormalAndCoplanarPoint(this.normal, this.point.setFromMatrixPosition(panel.mesh.matrixWorld));
      if (!this.ray.intersectPlane(this.plane, this.point)) continue;
      const distance = this.point.distanceTo(hand.rayOrigin);
      if (distance >= pointing.distance || distance > 5 * scale) continue;
      const at = panel.toLocal(this.point);
      if (!inPanel(panel, at.x, at.y)) continue;
      pointing.panel = panel;
      pointing.x = at.x;
      pointing.y = at.y;
      pointing.distance = distance;
    }
  }

  private depth = 0;

  private pokes(hand: Hand, pointing: Pointing): boolean {
    return pointing.down === null && (this.depth < POKE || hand.trigger.pressed);
  }

  private isOnBar(panel: Panel, { x, y }: Pointing): boolean {
    return panel.options.hasBar === true && y <= BAR + 4 && inPanel(panel, x, y);
  }

  private press(hand: Hand, pointing: Pointing, panel: Panel): void {
    const { widget, x, y } = pointing;
    if (widget) {
      pointing.down = { panel, widget };
      panel.pressed = widget.id;
      widget.press?.(x, y);
      panel.renew();
      hand.pulse(0.3, 12);
    } else if (this.isOnBar(panel, pointing)) {
      pointing.carried = panel;
      this.carriedFrom.copy(hand.ray.matrix).invert().multiply(panel.mesh.matrix);
      hand.pulse(0.3, 12);
    }
  }

  private drag(hand: Hand, pointing: Pointing): void {
    const { panel, widget } = pointing.down!;
    const inside = pointing.panel === panel && inBox(widget.box, pointing.x, pointing.y);
    const released = pointing.poking ? this.depth > POKE_ENDS && !hand.trigger.held : !hand.trigger.held;
    if (!released) {
      if (pointing.panel !== panel && widget.leave) {
        this.letGo(hand.side);
        widget.leave(hand.side);
      }
      if (pointing.panel !== panel || !widget.move) return;
      widget.move(pointing.x, pointing.y);
      panel.renew();
      return;
    }
    pointing.down = null;
    panel.pressed = null;
    panel.renew();
    widget.release?.(pointing.x, pointing.y, inside, hand.side);
  }

  private carry(hand: Hand, pointing: Pointing): void {
    const panel = pointing.carried!;
    panel.mesh.matrix.multiplyMatrices(hand.ray.matrix, this.carriedFrom);
    panel.mesh.matrix.decompose(panel.mesh.position, panel.mesh.quaternion, panel.mesh.scale);
    // It goes on facing the eyes.
    panel.mesh.quaternion.setFromRotationMatrix(this.matrix.lookAt(this.stance.head.position, panel.mesh.position, panel.mesh.up));
    if (!hand.trigger.held) pointing.carried = null;
  }

  private turnWheel(hand: Hand, pointing: Pointing, seconds: number): void {
    pointing.scrolled -= seconds;
    if (!pointing.panel?.scroll || Math.abs(hand.stickY) < 0.5 || pointing.scrolled > 0) return;
    pointing.scrolled = SCROLL_PAUSE;
    pointing.panel.scroll(Math.sign(hand.stickY));
  }

  /** Takes a press away from the panels: a model was pulled out and is carried on. */
  letGo(side: Side): void {
    const pointing = this.pointings[side];
    if (pointing.down) {
      pointing.down.panel.pressed = null;
      pointing.down.panel.renew();
    }
    pointing.down = null;
  }
}

function inPanel({ options }: Panel, x: number, y: number): boolean {
  return x >= 0 && y >= 0 && x <= options.width && y <= options.height;
}

function nothing(): Pointing {
  return { panel: null, x: 0, y: 0, distance: Infinity, widget: null, down: null, carried: null, poking: false, scrolled: 0 };
}
