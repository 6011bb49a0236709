// SPDX-License-Identifier: MIT
import { type Camera, Quaternion, Vector3 } from "three";
import type { Impact } from "../connection/messages";
import type { Parts } from "../parts";

/** How a material rings: its lowest mode for a thing of 0.3 m (Hz), the higher modes as multiples, how long they ring (s), loudness. */
interface Ring {
  base: number;
  modes: readonly number[];
  decay: number;
  loud: number;
}

// Ratios of free bars (2.76, 5.40), plates and bodies; decays as heard at home: wood is dull, metal rings, cloth thuds.
const RINGS = {
  wood: { base: 340, modes: [1, 2.57, 4.95], decay: 0.07, loud: 1 },
  metal: { base: 620, modes: [1, 2.76, 5.4, 8.93], decay: 0.45, loud: 0.8 },
  glass: { base: 1250, modes: [1, 2.32, 4.25], decay: 0.22, loud: 0.7 },
  stone: { base: 800, modes: [1, 1.9, 3.1], decay: 0.035, loud: 1 },
  plastic: { base: 520, modes: [1, 2.1, 3.9], decay: 0.05, loud: 0.8 },
  soft: { base: 95, modes: [1, 1.6], decay: 0.06, loud: 0.6 },
} satisfies Record<string, Ring>;
export type RingName = keyof typeof RINGS;

/** Words in the names of surface materials, and what they ring like. */
const SOUNDS_LIKE: readonly (readonly [RegExp, RingName])[] = [
  [/steel|iron|alumin|brass|lead|titanium|metal/, "metal"],
  [/glass|ceramic|ice|crystal/, "glass"],
  [/stone|concrete|brick|plaster|asphalt|coal/, "stone"],
  [/fabric|leather|foam|rubber|paper|cardboard|cork|flesh|plant|food|fruit|bread|cheese|wax|soil|grain|hay|powder/, "soft"],
  [/plastic|composite|epoxy/, "plastic"],
];
const USUAL: RingName = "wood";
/** Length of the things that RINGS is for, m, and the least and greatest pitch, Hz. */
const USUAL_LENGTH = 0.3;
const LOWEST = 50;
const HIGHEST = 7000;
/** An impulse that sounds as loud as can be, N s: 1 kg that falls from 1.3 m. */
const LOUDEST = 5;
const MOST_VOICES = 24;

/** What was last heard, for tests. */
export interface Heard {
  like: RingName;
  frequency: number;
  volume: number;
  position: readonly number[];
}

/** Sounds of impacts, made on the spot: a few decaying tones by material and size, where they happen, as loud as the impulse. */
export class ContactSounds {
  /** Who hears them. */
  ears: Camera;
  readonly heard: Heard[] = [];
  private context: AudioContext | null = null;
  private voices = 0;
  private listens = false;
  private readonly materials = new Map<number, Promise<RingName>>();
  private readonly place = new Vector3();
  private readonly forth = new Vector3();
  private readonly turn = new Quaternion();
  private readonly size = new Vector3();

  constructor(private readonly parts: Pick<Parts, "preferences" | "server" | "document" | "entities" | "view">) {
    this.ears = parts.view.rig.camera;
    parts.document.changed.on(({ all, entities }) => {
      if (all) this.materials.clear();
      else for (const index of entities) this.materials.delete(index);
    });
    parts.preferences.changed.on((name) => {
      if (name === "sounds") void this.subscribe();
    });
    parts.server.changed.on(() => {
      const { ready, isOpen } = parts.server;
      if (isOpen && ready && !this.listens) void this.subscribe();
      if (!isOpen) this.listens = false;
    });
  }

  /** Asks the server for impacts while they are to be heard; it makes them only for who listens. */
  private async subscribe(): Promise<void> {
    const impacts = this.parts.preferences.get("sounds");
    this.listens = impacts;
    if (this.parts.server.isOpen) await this.parts.server.command("simulation.listen", { impacts });
  }

  take(impacts: readonly Impact[]): void {
    // Browsers let a page sound only after the user has touched it.
    if (!this.parts.preferences.get("sounds") || navigator.userActivation?.hasBeenActive === false) return;
    for (const impact of impacts) void this.sound(impact);
  }

  private async sound(impact: Impact): Promise<void> {
    const { a, b, impulse, position } = impact;
    const volume = Math.min(Math.sqrt(impulse / LOUDEST), 1);
    for (const index of [a, b]) {
      if (!this.parts.document.entity(index) || this.parts.document.entity(index)!.shape?.type === "plane") continue;
      const like = await this.materialOf(index);
      this.ring(like, this.pitchOf(index, like), volume * RINGS[like].loud, position);
    }
  }

  private materialOf(index: number): Promise<RingName> {
    let material = this.materials.get(index);
    if (!material) {
      material = this.parts.server.request("entity.attributes", { index }).then(
        ({ attributes }) => soundsLike(String(attributes.find(({ name }) => name === "surface_material")?.value ?? ""), String(attributes.find(({ name }) => name === "kind")?.value ?? "")),
        () => USUAL,
      );
      this.materials.set(index, material);
    }
    return material;
  }

  private pitchOf(index: number, like: RingName): number {
    this.parts.entities.boundsOf([index], performance.now()).getSize(this.size);
    const length = Math.max(this.size.x, this.size.y, this.size.z, 0.01);
    return Math.min(Math.max(RINGS[like].base * (USUAL_LENGTH / length) ** 0.8, LOWEST), HIGHEST);
  }

  private ring(like: RingName, frequency: number, volume: number, position: readonly number[]): void {
    if (this.voices >= MOST_VOICES) return;
    this.heard.push({ like, frequency, volume, position });
    if (this.heard.length > MOST_VOICES) this.heard.shift();
    const context = (this.context ??= new AudioContext());
    this.listen(context);
    const panner = new PannerNode(context, { panningModel: "HRTF", distanceModel: "inverse", refDistance: 1, positionX: position[0]!, positionY: position[1]!, positionZ: position[2]! });
    panner.connect(context.destination);
    const { modes, decay } = RINGS[like];
    const now = context.currentTime;
    modes.forEach((mode, at) => {
      // A higher mode is softer and dies sooner.
      const tone = new OscillatorNode(context, { frequency: Math.min(frequency * mode, 0.45 * context.sampleRate) });
      const gain = new GainNode(context, { gain: 0 });
      const length = decay / (1 + 0.6 * at);
      gain.gain.setValueAtTime(0, now);
      gain.gain.linearRampToValueAtTime((0.5 * volume) / (1 + at), now + 0.002);
      gain.gain.exponentialRampToValueAtTime(1e-4, now + 0.002 + 6 * length);
      tone.connect(gain).connect(panner);
      tone.start(now);
      tone.stop(now + 0.01 + 6 * length);
      if (at > 0) return;
      ++this.voices;
      tone.onended = () => {
        --this.voices;
        panner.disconnect();
      };
    });
  }

  private listen({ listener }: AudioContext): void {
    this.ears.getWorldPosition(this.place);
    this.ears.getWorldQuaternion(this.turn);
    this.forth.set(0, 0, -1).applyQuaternion(this.turn);
    listener.positionX.value = this.place.x;
    listener.positionY.value = this.place.y;
    listener.positionZ.value = this.place.z;
    listener.forwardX.value = this.forth.x;
    listener.forwardY.value = this.forth.y;
    listener.forwardZ.value = this.forth.z;
  }
}

function soundsLike(material: string, kind: string): RingName {
  if (kind !== "rigid" && kind !== "static" && kind !== "articulated") return "soft";
  return SOUNDS_LIKE.find(([words]) => words.test(material))?.[1] ?? USUAL;
}
