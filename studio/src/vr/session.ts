// SPDX-License-Identifier: MIT
import { Box3, Color, Matrix4, Vector3 } from "three";
import type { Parts } from "../parts";
import { Signal } from "../signal";
import type { UserAction } from "../tools/actions";
import type { ContactSounds } from "../tools/contact_sounds";
import type { Headset } from "../view/view";
import { Carry } from "./carry";
import { Grabbing } from "./grabbing";
import { Hands } from "./hand";
import { HandLook, setAccent } from "./hand_look";
import { HelpPanel } from "./help_panel";
import { Interaction } from "./interaction";
import { ModelPanel } from "./model_panel";
import { Moving } from "./moving";
import { PresenceSender } from "./presence";
import { PropertyPanel } from "./property_panel";
import { RealRoom } from "./real_room";
import { SettingsPanel } from "./settings_panel";
import { Stance } from "./stance";
import { Tape } from "./tape";
import { MessagePanel, TextPanel } from "./text_panel";
import { Touch } from "./touch";
import { Desk } from "./ui/desk";
import { WristMenu } from "./wrist_menu";
import { t } from "../language";

export type VrParts = Pick<Parts, "preferences" | "server" | "notices" | "people" | "document" | "playback" | "selection" | "motion" | "models" | "entities" | "view">;

const LONGEST_STEP_S = 0.1;
/** Shadows reach so far around the user, m of the room. */
const SHADOW_REACH = 6;
const FEATURES = ["local-floor", "bounded-floor", "hand-tracking", "layers"];
const ROOM_FEATURES = ["plane-detection", "local-floor", "hand-tracking", "layers"];

/** The Studio in a headset. Made once; a visit begins with enter() and ends when the device says so. */
export class VrSession {
  readonly changed = new Signal<void>();
  readonly stance = new Stance();
  readonly hands: Hands;
  readonly grabbing: Grabbing;
  readonly desk: Desk;
  readonly carry: Carry;
  readonly moving: Moving;
  readonly menu: WristMenu;
  readonly tape: Tape;
  readonly interaction: Interaction;
  readonly looks: readonly HandLook[];
  readonly touches: readonly Touch[];
  room: RealRoom | null = null;
  private readonly models: ModelPanel;
  private readonly properties: PropertyPanel;
  private readonly settings: SettingsPanel;
  private readonly ask: TextPanel;
  private readonly message: MessagePanel;
  private readonly presence: PresenceSender;
  private readonly headset: Headset;
  private session: XRSession | null = null;
  private placed = false;
  private last = 0;
  /** Where the user stood before the scene became a dollhouse. */
  private before: Matrix4 | null = null;
  private readonly eye = new Vector3();
  private readonly forth = new Vector3();
  private readonly feet = new Vector3();

  constructor(
    private readonly parts: VrParts,
    actions: readonly UserAction[],
    private readonly sounds: ContactSounds,
  ) {
    const { view, notices, preferences } = parts;
    const { stance } = this;
    stance.origin.visible = false;
    view.scene.add(stance.origin);
    view.renderer.xr.enabled = true;
    this.hands = new Hands(view.renderer.xr, stance.origin);
    this.headset = { camera: stance.head, target: new Vector3(), distance: SHADOW_REACH };
    this.desk = new Desk(this.hands, stance, (side) => this.carry.side === side);
    this.grabbing = new Grabbing(parts, this.hands, stance);
    this.carry = new Carry(parts, this.hands, this.desk);
    this.moving = new Moving(parts, this.hands, stance, (hand) => this.desk.isBusy(hand.side) || this.grabbing.held(hand.side) !== null || this.carry.side === hand.side);
    this.tape = new Tape(stance);
    this.models = new ModelPanel(parts, this.desk, this.carry);
    this.properties = new PropertyPanel(parts, this.desk, actions);
    const help = new HelpPanel(this.desk);
    this.settings = new SettingsPanel(parts, this.desk, () => help.open());
    this.ask = new TextPanel(this.desk);
    this.message = new MessagePanel(this.desk);
    this.menu = new WristMenu(parts, this.desk, stance, actions, this.choices());
    this.interaction = new Interaction(parts, this);
    this.looks = this.hands.both.map((hand) => new HandLook(hand));
    this.touches = this.hands.both.map((hand) => new Touch(parts, hand, this.grabbing));
    this.presence = new PresenceSender(parts, this.hands, stance, this.grabbing);
    stance.origin.add(...this.looks.map(({ group }) => group));
    view.scene.add(this.tape.group);
    view.beforeFrame.on((now) => this.isRunning && this.update(now));
    notices.told.on(({ level, text, remedy }) => this.isRunning && this.message.tell(level, text, remedy));
    preferences.changed.on((name) => {
      if (name === "vr") this.applySettings();
      if (name === "theme") for (const panel of this.desk.panels) panel.readTheme();
    });
  }

  get isRunning(): boolean {
    return this.session !== null;
  }

  get isDollhouse(): boolean {
    return this.before !== null;
  }

  /** Asks the device for a session; the browser demands that a click calls this. */
  async enter(mode: "immersive-vr" | "immersive-ar"): Promise<void> {
    const { view, preferences, notices } = this.parts;
    const { xr } = view.renderer;
    try {
      const session = await navigator.xr!.requestSession(mode, { optionalFeatures: mode === "immersive-ar" ? ROOM_FEATURES : FEATURES });
      session.addEventListener("end", () => this.end());
      xr.setReferenceSpaceType("local-floor");
      xr.setFramebufferScaleFactor(preferences.get("vr").sharpness);
      this.begin(session, mode);
      await xr.setSession(session);
      xr.setFoveation(preferences.get("vr").foveation);
      view.drawForHeadset(this.headset, mode === "immersive-ar");
    } catch (error) {
      this.end();
      notices.tell({ level: "error", text: t("The headset could not be used: {{message}}", { message: (error as Error).message }), remedy: t("Put it on, wake it up and try again.") });
    }
  }

  /** Ends the visit; surfaces of the real room are asked about first. */
  leave(): void {
    const { room } = this;
    if (!room || room.indices.length === 0) return void this.session?.end();
    const leave = async (keep: boolean): Promise<void> => {
      await room.end(keep);
      void this.session?.end();
    };
    this.ask.choose(t("Leave"), t("{{count}} surfaces of your real room are in the scene. Shall they stay in it?", { count: room.indices.length }), [
      { id: "remove-room", label: t("Take them out"), run: () => void leave(false) },
      { id: "keep-room", label: t("Keep them"), run: () => void leave(true) },
    ]);
  }

  openModels(): void {
    this.menu.unpin();
    this.models.toggle();
  }

  openProperties(): void {
    this.menu.unpin();
    this.properties.toggle();
  }

  toggleDollhouse(): void {
    this.setDollhouse(!this.isDollhouse);
    const { preferences } = this.parts;
    preferences.set("vr", { ...preferences.get("vr"), dollhouse: this.isDollhouse });
  }

  private begin(session: XRSession, mode: XRSessionMode): void {
    const { parts, stance } = this;
    this.session = session;
    this.placed = false;
    this.before = null;
    this.last = 0;
    stance.origin.visible = true;
    this.sounds.ears = stance.head;
    setAccent(new Color(getComputedStyle(document.documentElement).getPropertyValue("--accent").trim()));
    this.room = mode === "immersive-ar" ? new RealRoom(parts, stance, this.ask) : null;
    if (this.room) parts.view.environment.showGrid(false);
    this.changed.emit();
  }

  /** The device has ended the session: the desktop's picture is as before. */
  private end(): void {
    if (!this.session) return;
    const { parts } = this;
    this.session = null;
    this.grabbing.releaseAll();
    this.carry.drop();
    this.moving.stop();
    for (const touch of this.touches) touch.end();
    for (const panel of this.desk.panels) panel.show(false);
    for (const hand of this.hands.both) hand.drop();
    this.interaction.end();
    this.presence.end();
    // Whoever takes the headset off without an answer finds the scene as it was.
    void this.room?.end(false);
    this.room = null;
    this.stance.origin.visible = false;
    this.sounds.ears = parts.view.rig.camera;
    parts.view.environment.showGrid(parts.preferences.get("grid"));
    parts.view.endHeadset();
    this.changed.emit();
  }

  private update(now: number): void {
    const { stance, parts } = this;
    // The page may still ask for a picture of its own before the device does.
    if (!parts.view.renderer.xr.isPresenting || !parts.view.renderer.xr.getFrame()) return;
    const seconds = Math.min(Math.max((now - this.last) / 1000, 0), LONGEST_STEP_S);
    this.last = now;
    const { xr } = parts.view.renderer;
    xr.updateCamera(stance.head);
    const [left, right] = xr.getCamera().cameras;
    if (left) stance.eyes.lerpVectors(left.position, (right ?? left).position, 0.5);
    stance.refresh();
    if (!this.placed) this.place();
    this.hands.update();
    this.menu.update(this.hands);
    this.desk.update(seconds);
    this.interaction.update();
    this.carry.update(seconds);
    this.grabbing.update(seconds);
    this.moving.update(seconds);
    this.interaction.draw();
    this.message.update(seconds);
    for (const look of this.looks) look.update();
    this.presence.update(now);
    for (const touch of this.touches) touch.update(stance.scale);
    this.room?.update(xr.getFrame(), xr.getReferenceSpace(), seconds);
    stance.feetAt(this.headset.target);
    this.headset.distance = (SHADOW_REACH / 1.4) * Math.min(stance.scale, 4);
  }

  /** The first picture: the user stands on the floor below the desktop's camera and looks where it looked. */
  private place(): void {
    const { stance, parts } = this;
    this.placed = true;
    const { camera } = parts.view.rig;
    const settings = parts.preferences.get("vr");
    this.eye.copy(camera.position);
    camera.getWorldDirection(this.forth).setY(0);
    stance.origin.position.set(0, 0, 0);
    stance.origin.quaternion.identity();
    stance.origin.scale.setScalar(1);
    stance.lift = 0;
    stance.refresh();
    if (this.forth.lengthSq() > 1e-6) stance.face(this.forth.normalize());
    stance.standAt(this.moving.teleport.floorBelow(this.eye, this.feet));
    stance.setLift(settings.heightOffset);
    if (settings.dollhouse && !this.room) this.setDollhouse(true);
    this.message.tell("info", t("Menu: X, or the back of your left wrist. Models: Y"), t("“Moving” in the menu says what your hands can do."));
  }

  private setDollhouse(on: boolean): void {
    const { stance, parts } = this;
    if (on === this.isDollhouse) return;
    const { origin } = stance;
    if (on) {
      this.before = origin.matrix.clone();
      const bounds = parts.entities.boundsOf(parts.document.entities.keys(), performance.now());
      stance.asDollhouse(bounds.isEmpty() ? new Box3() : bounds);
    } else {
      this.before!.decompose(origin.position, origin.quaternion, origin.scale);
      this.before = null;
      stance.refresh();
    }
    this.menu.renew();
  }

  private applySettings(): void {
    const { foveation, heightOffset } = this.parts.preferences.get("vr");
    if (!this.isRunning) return;
    this.parts.view.renderer.xr.setFoveation(foveation);
    this.stance.setLift(heightOffset);
  }

  private save(): void {
    const { server, document: scene, notices } = this.parts;
    const save = async (name?: string): Promise<void> => {
      const saved = await server.command("scene.save", name === undefined ? {} : { name });
      if (saved) notices.tell({ level: "info", text: t("Saved “{{name}}”", { name: saved.name }) });
    };
    if (scene.name) return void save();
    this.menu.unpin();
    this.ask.ask(t("Save the scene as"), scene.title, (name) => void save(name));
  }

  private choices(): ConstructorParameters<typeof WristMenu>[4] {
    const session = this;
    return {
      leave: () => this.leave(),
      save: () => this.save(),
      toggleDollhouse: () => this.toggleDollhouse(),
      openModels: () => this.openModels(),
      openProperties: () => this.openProperties(),
      openSettings: () => {
        this.menu.unpin();
        this.settings.open();
      },
      toggleTape: () => {
        this.tape.toggle();
        this.menu.renew();
      },
      get tapeOn() {
        return session.tape.isOn;
      },
      get dollhouse() {
        return session.isDollhouse;
      },
    };
  }
}
