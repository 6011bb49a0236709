// SPDX-License-Identifier: MIT
import { Vector3 } from "three";
import type { Parts } from "../parts";
import type { VrSession } from "./session";

type Three = number[];

/** What tests may read of the Studio in a headset. */
export interface VrHook {
  running(): boolean;
  /** The user: feet, direction and eyes in the scene, size times life-size. */
  stance(): { feet: Three; facing: Three; head: Three; scale: number; dollhouse: boolean };
  /** A point of the scene in the user's room, where devices are. */
  toRoom(point: Three): Three;
  toScene(point: Three): Three;
  hands(): { side: string; drawn: string | null; position: Three; holds: number | null; hit: number | null; near: number | null; ray: boolean }[];
  /** Widgets of all panels that are shown, with their middle and the ends of their middle line in the user's room. */
  widgets(): { panel: string; id: string; off: boolean; at: Three; from: Three; to: Three; size: Three }[];
  /** Text of the label in the scene, and of the tape. */
  label(): string;
  tape(): { text: string; length: number | null };
  teleport(): { aims: boolean; allowed: boolean; target: Three };
  vignette(): number;
  carrying(): string | null;
  foveation(): number | undefined;
  /** The picture as PNG, read in the same frame as it was drawn. */
  picture(): Promise<string>;
}

export function vrHook(parts: Pick<Parts, "view">, session: VrSession): VrHook {
  const { stance, hands, grabbing, interaction, moving, desk } = session;
  const vector = new Vector3();
  return {
    running: () => session.isRunning,
    stance: () => ({
      feet: stance.feetAt(vector).toArray(),
      facing: stance.facing(new Vector3()).toArray(),
      head: stance.headAt(new Vector3()).toArray(),
      scale: stance.scale,
      dollhouse: session.isDollhouse,
    }),
    toRoom: (point) => stance.origin.worldToLocal(new Vector3(...point)).toArray(),
    toScene: (point) => stance.origin.localToWorld(new Vector3(...point)).toArray(),
    hands: () =>
      hands.both.map((hand, at) => {
        const { hit, near, ray } = interaction.aimOf(hand.side);
        return { side: hand.side, drawn: session.looks[at]!.drawn, position: hand.position.toArray(), holds: grabbing.held(hand.side)?.index ?? null, hit: hit?.index ?? null, near, ray: ray.group.visible };
      }),
    widgets: () =>
      desk.panels
        .filter(({ isShown }) => isShown)
        .flatMap((panel) =>
          panel.widgets.map((widget) => ({
            panel: panel.options.id,
            id: widget.id,
            off: widget.off ?? false,
            at: stance.origin.worldToLocal(panel.placeOf(widget, 0.5, new Vector3())).toArray(),
            from: stance.origin.worldToLocal(panel.placeOf(widget, 0, new Vector3())).toArray(),
            to: stance.origin.worldToLocal(panel.placeOf(widget, 1, new Vector3())).toArray(),
            size: [widget.box.w, widget.box.h],
          })),
        ),
    label: () => interaction.labelText,
    tape: () => ({ text: session.tape.text, length: session.tape.length }),
    teleport: () => ({ aims: moving.teleport.aims, allowed: moving.teleport.allowed, target: moving.teleport.target.toArray() }),
    vignette: () => moving.vignette.shown,
    carrying: () => session.carry.side,
    foveation: () => parts.view.renderer.xr.getFoveation(),
    picture: () =>
      new Promise((done) => {
        // The drawing buffer is lost after the frame: it is read at the end of the next one.
        const stop = parts.view.afterFrame.on(() => {
          stop();
          done(parts.view.canvas.toDataURL("image/png"));
        });
      }),
  };
}
