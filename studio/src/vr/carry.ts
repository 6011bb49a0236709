// SPDX-License-Identifier: MIT
import type { Drop, ModelSummary, NewEntity } from "../connection/messages";
import type { Parts } from "../parts";
import { Signal } from "../signal";
import { Ghost, turned } from "../tools/ghost";
import type { Hand, Hands, Side } from "./hand";
import type { Desk } from "./ui/desk";

/** A far ghost turns so fast at the stick's full deflection, rad/s. */
const TURN_RATE = 2;
/** A press that ends sooner took the thing in the hand for good: the next press puts it down. s */
const CLICK = 0.3;

/** A new thing in the hand: its ghost lies where the ray meets the scene, and letting go adds it there. */
export class Carry {
  readonly added = new Signal<{ model: ModelSummary | null; index: number }>();
  private readonly ghost: Ghost;
  private carried: { side: Side; entity: NewEntity; model: ModelSummary | null; sticky: boolean } | null = null;
  private spin = 0;
  private age = 0;

  constructor(
    private readonly parts: Pick<Parts, "server" | "notices" | "selection" | "models" | "view">,
    private readonly hands: Hands,
    private readonly desk: Desk,
  ) {
    this.ghost = new Ghost(parts);
  }

  get side(): Side | null {
    return this.carried?.side ?? null;
  }

  /** Takes a new thing; `sticky`: the trigger is not held, the next press puts it down. */
  take(side: Side, entity: NewEntity, model: ModelSummary | null, sticky: boolean): void {
    this.carried = { side, entity, model, sticky };
    this.spin = 0;
    this.age = 0;
    this.ghost.begin(entity).catch((error: Error) => this.parts.notices.report(error));
    this.hands.of(side).pulse(0.4, 20);
  }

  drop(): void {
    this.carried = null;
    this.ghost.end();
  }

  update(seconds: number): void {
    const { carried } = this;
    if (!carried) return;
    this.age += seconds;
    const hand = this.hands.of(carried.side);
    this.spin -= hand.stickX * TURN_RATE * seconds;
    const overPanel = this.desk.distanceOf(carried.side) !== null;
    if (overPanel) this.ghost.hide();
    else this.ghost.moveAlong(dropOf(hand), this.spin);
    const ends = carried.sticky ? hand.trigger.pressed && this.age > CLICK : hand.trigger.released;
    if (ends) this.end(hand, overPanel);
  }

  private end(hand: Hand, overPanel: boolean): void {
    const carried = this.carried!;
    this.drop();
    // Let go over a panel it goes back into the catalogue.
    if (overPanel) return;
    void this.add(carried.entity, carried.model, dropOf(hand));
    hand.pulse(0.5, 25);
  }

  private async add(entity: NewEntity, model: ModelSummary | null, drop: Drop): Promise<void> {
    // A plane is infinite: it has a fixed pose and lies on nothing.
    const params = entity.shape?.type === "plane" ? { entity } : { entity: turned(entity, this.spin), drop };
    const made = await this.parts.server.command("entity.add", params);
    if (!made) return;
    this.parts.selection.set([made.index]);
    this.added.emit({ model, index: made.index });
  }
}

function dropOf(hand: Hand): Drop {
  return { origin: hand.rayOrigin.toArray(), direction: hand.rayDirection.toArray() };
}
