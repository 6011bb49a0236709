// SPDX-License-Identifier: MIT
import { Connection } from "./connection/connection";
import type { DebugName } from "./connection/debug_frame";
import type { CatalogEvent, DocumentEvent, Hello, Recovery, ServerEvent, Simulation, Statistics } from "./connection/messages";
import { Notices } from "./connection/notices";
import type { Shape } from "./connection/scene_types";
import { Server } from "./connection/server";
import { Motion } from "./document/motion";
import { Opening } from "./document/opening";
import { People } from "./document/people";
import { thisPerson } from "./document/person";
import { PickedModel } from "./document/picked_model";
import { Playback } from "./document/playback";
import { SceneDocument } from "./document/scene_document";
import { setBlendRate } from "./document/blend";
import { Selection } from "./document/selection";
import { Take } from "./document/take";
import { Warnings } from "./document/warnings";
import type { Found, Parts } from "./parts";
import { Preferences } from "./preferences";
import { Signal } from "./signal";
import { PresenceSender } from "./tools/presence";
import { EntityView } from "./view/entity_view";
import { Framing } from "./view/framing";
import { ModelStore } from "./view/model_store";
import { drawsInSoftware } from "./view/software";
import { View } from "./view/view";
import { t, translateServerText } from "./language";

/** Of a large selection only so many collision shapes are asked for. */
const MOST_COLLISION_SHAPES = 64;
/** Simulated seconds per second that count as real time; the longest pause between pictures that helps to keep it, ms. */
const KEEPS_PACE = 0.95;
const LONGEST_PACE_MS = 100;

/** All objects that a page has one of, and the handlers of the server's events. */
export class Studio implements Parts {
  readonly preferences = new Preferences();
  readonly connection = new Connection();
  readonly notices = new Notices();
  readonly server = new Server(this.connection, this.notices);
  readonly document = new SceneDocument();
  readonly playback = new Playback();
  readonly take = new Take();
  readonly selection = new Selection();
  readonly picked = new PickedModel();
  readonly people = new People();
  readonly opening = new Opening();
  readonly warnings = new Warnings(this.server, this.document);
  found: Found = { models: { all: true }, text: t("all models") };
  readonly motion = new Motion();
  readonly models = new ModelStore(this.connection);
  readonly entities = new EntityView(this.document, this.motion, this.models, this.connection, this.preferences.get("quality"));
  readonly view: View;
  /** The user asked for the history of changes. */
  readonly historyWanted = new Signal<void>();
  /** Unsaved work was found when this page connected. */
  readonly recovered = new Signal<readonly Recovery[]>();
  readonly framing: Framing;
  private readonly person = thisPerson();
  private wasGreeted = false;
  private collisionAsked = 0;
  private readonly onOneProcessor = ["localhost", "127.0.0.1", "[::1]"].includes(location.hostname) && drawsInSoftware();

  constructor(canvas: HTMLCanvasElement) {
    this.view = new View(canvas, this.motion, this.entities, this.people, this.document, this.preferences.get("quality"));
    this.framing = new Framing(this.document, this.entities, this.view.rig);
    new PresenceSender(this);
    this.followPeople();
    this.followDocument();
    this.followConnection();
    this.followPreferences();
    this.followLook();
  }

  private followPeople(): void {
    const { people, view, entities } = this;
    people.changed.on(() => {
      view.people.meet();
      view.invalidate();
    });
    people.moved.on((client) => {
      view.people.follow(client);
      view.drawSoon();
    });
    // What is drawn otherwise has another outline.
    this.document.changed.on(() => view.people.refresh());
    entities.loaded.on(() => view.people.refresh());
    entities.pointed.on(() => view.people.refresh());
  }

  private followDocument(): void {
    this.document.changed.on((changed) => {
      if (changed.all) this.selection.clear();
      for (const index of changed.removed) if (!this.document.entity(index)) this.motion.forget(index);
      this.entities.apply(changed);
      this.selection.set(this.selection.indices.filter((index) => this.document.entity(index)));
      this.view.outline.show(this.selection.indices);
      void this.showCollision();
      this.view.invalidate();
    });
    this.picked.changed.on(() => {
      if (this.picked.model) this.selection.clear();
    });
    this.selection.changed.on(() => {
      if (this.selection.indices.length > 0) this.picked.set(null);
      this.view.outline.show(this.selection.indices);
      void this.showCollision();
      if (this.preferences.get("overlays").length > 0) void this.askDebug();
      this.view.invalidate();
    });
    this.entities.loaded.on(() => this.view.outline.show(this.selection.indices));
    this.entities.pointed.on((index) => {
      if (this.selection.has(index)) this.view.outline.show(this.selection.indices);
    });
    this.entities.surfacesLost.on((reason) => {
      this.notices.tell({ level: "error", text: t("The surfaces of liquids cannot be drawn: {{reason}}", { reason }), remedy: t("You see their drops instead. Reload the page to try again.") });
      this.view.invalidate();
    });
    this.entities.failed.on(({ index, reason }) => {
      const entity = this.document.entity(index);
      this.notices.tell({ level: "warning", text: t("“{{name}}” cannot be drawn: {{reason}}", { name: entity?.name ?? index, reason }) });
    });
  }

  /** Asks for the collision shapes of the selection and draws them. */
  private async showCollision(): Promise<void> {
    const wanted = ++this.collisionAsked;
    const indices = this.preferences.get("collision") ? this.selection.indices.slice(0, MOST_COLLISION_SHAPES) : [];
    const shown: { index: number; shape: Shape }[] = [];
    for (const index of indices) {
      const told = await this.server.command("entity.collision_shape", { index });
      // The selection or the document may have changed while the answer was on its way.
      if (wanted !== this.collisionAsked) return;
      if (told?.shape) shown.push({ index, shape: told.shape });
    }
    this.view.collision.show(shown);
    this.view.invalidate();
  }

  /** Tells the server which debug drawings are wanted; their frames follow. */
  private async askDebug(): Promise<void> {
    const { show, of } = this.debugWish();
    if (show.length === 0) this.view.debug.show(null);
    await this.server.command("debug.draw", of ? { show, of } : { show });
  }

  /** What is drawn for all things, else what is drawn of the selection. */
  private debugWish(): { show: readonly DebugName[]; of?: number[] } {
    const { debug, overlays } = { debug: this.preferences.get("debug"), overlays: this.preferences.get("overlays") };
    const of = [...this.selection.indices];
    if (of.length === 0) return { show: debug };
    return debug.length > 0 ? { show: [...new Set([...debug, ...overlays])] } : { show: overlays, of };
  }

  private followConnection(): void {
    this.connection.opened.on(() => {
      // It may be another server. Frames may arrive before the answer to hello, so poses become invalid only here.
      this.models.forgetSummaries();
      this.motion.clear();
      this.entities.forgetPoints();
      void this.greet();
    });
    this.connection.closed.on(() => {
      this.opening.forget();
      this.people.meet([]);
      this.server.changed.emit();
    });
    this.connection.fault.on((reason) => this.notices.tell({ level: "error", text: reason, remedy: t("Reload the page.") }));
    this.connection.event.on((event) => this.receive(event));
    this.connection.debug.on((frame) => {
      // A frame may still arrive after debug drawing was turned off.
      this.view.debug.show(this.debugWish().show.length > 0 ? frame : null);
      this.view.drawSoon();
      this.connection.wantFrame();
    });
    this.connection.frame.on((frame) => {
      if (this.view.isCapturing) return this.connection.wantFrame();
      this.motion.take(frame, performance.now(), this.playback.playing);
      this.entities.takePoints(frame, performance.now(), this.playback.playing);
      this.playback.goOn(frame);
      this.view.drawSoon();
      // The next frame is requested after this one has been drawn; where nothing is drawn (a hidden page), at once.
      if (document.hidden) this.connection.wantFrame();
      else setTimeout(() => requestAnimationFrame(() => this.connection.wantFrame()), this.view.pace);
    });
  }

  private followLook(): void {
    const { document: scene, view } = this;
    let hour: number | null = null;
    scene.changed.on(({ all, settings }) => {
      view.lamps.take();
      const next = scene.sky ? scene.timeOfDay : null;
      if ((all || settings) && next !== hour) view.setHour((hour = next));
    });
  }

  private followPreferences(): void {
    const { preferences, view } = this;
    view.setTheme(preferences.get("theme"));
    view.setQuality(preferences.get("quality"));
    view.environment.showGrid(preferences.get("grid"));
    view.slow.on(() => {
      if (preferences.get("quality") === "high")
        this.notices.tell({ level: "info", text: t("Drawing is slow on this computer"), remedy: t("View options have “Fast drawing”: no shadows or reflections.") });
    });
    preferences.changed.on((name) => {
      if (name === "theme") view.setTheme(preferences.get("theme"));
      if (name === "quality") view.setQuality(preferences.get("quality"));
      if (name === "grid") view.environment.showGrid(preferences.get("grid"));
      if (name === "tint" || name === "fullTint") this.retint();
      if (name === "collision") void this.showCollision();
      if (name === "debug" || name === "overlays") void this.askDebug();
      if (name === "userName") void this.tellName();
      view.invalidate();
    });
  }

  /** After (re)connecting: loads the whole document and the present state of the simulation. */
  private async greet(): Promise<void> {
    const hello = await this.server.command("hello", { person: await this.person });
    if (!hello) return;
    this.server.meet(hello);
    if (this.preferences.get("userName")) void this.tellName();
    if (this.debugWish().show.length > 0) void this.askDebug();
    this.playback.simulation = hello.simulation;
    setBlendRate(hello.simulation.rate ?? 1);
    if (hello.take) this.take.take(hello.take);
    const isSame = this.wasGreeted && this.document.name === hello.name && this.document.title === (hello.scene.title ?? t("Untitled"));
    this.wasGreeted = true;
    this.document.reset(hello);
    // After a lost connection the user goes on where they were.
    if (!isSame) this.framing.open();
    if (hello.waiting?.length) this.notices.tell({ level: "info", text: waitingText(hello.waiting.length), remedy: t("They appear when these are imported.") });
    this.retint();
    this.meetPeople(hello);
    this.server.changed.emit();
    this.playback.changed.emit();
  }

  private meetPeople({ members = [], client, recovered = [] }: Hello): void {
    this.people.meet(members, client);
    if (recovered.length > 0) this.recovered.emit(recovered);
  }

  private async tellName(): Promise<void> {
    await this.server.command("client.set_name", { name: this.preferences.get("userName") });
  }

  /** Models were changed: their cached data are dropped, and the client that changed them is offered an undo. */
  private takeCatalog(event: CatalogEvent): void {
    this.models.forgetSummaries(event.keys);
    void this.showCollision();
    this.server.catalogChanged.emit(event);
    if (event.client !== this.server.client) {
      const who = event.session.replace(/^studio: /, "");
      const action = { label: t("History"), run: () => this.historyWanted.emit() };
      this.notices.tell({ level: "info", text: t("{{what}}, by {{who}}", { what: pastOf(event.label), who }), action });
      return;
    }
    const undone = event.command === "undo";
    const action = { label: undone ? t("Redo") : t("Undo"), run: () => void this.server.command("catalog.undo", { batch: event.batch }) };
    this.notices.tell({ level: "info", text: pastOf(event.label), action });
  }

  private receive(event: ServerEvent): void {
    switch (event.event) {
      case "document":
        this.takeDocument(event);
        break;
      case "simulation":
        this.takeSimulation(event);
        break;
      case "take":
        this.take.take(event);
        break;
      case "spawned":
        this.document.spawn(event.entity);
        break;
      case "despawned":
        this.document.despawn(event.index);
        break;
      case "waiting":
        this.document.wait(event.indices);
        break;
      case "import":
        this.server.takeFill(event);
        break;
      case "statistics":
        this.playback.measure(event);
        this.sharePower(event);
        this.playback.measured.emit();
        break;
      case "message":
        this.notices.tell({ ...event, text: translateServerText(event.text) });
        break;
      case "catalog":
        this.takeCatalog(event);
        break;
      case "progress":
        this.server.progress.emit(event);
        break;
      case "members":
        this.people.meet(event.members);
        break;
      case "presence": {
        const { event: _, client, ...presence } = event;
        this.people.take(client, presence);
        break;
      }
      case "history":
        this.document.takeHistory(event);
        break;
      case "question":
        this.opening.ask(event);
        break;
      case "question_over":
        this.opening.end(event.question);
        break;
      case "rope_broke":
        this.entities.redress(event.index);
        break;
      case "sheet_tore":
        this.entities.softs.tear(event.index, event.nodes);
        break;
      case "history":
        this.document.takeHistory(event);
        break;
      case "members":
      case "presence":
      case "action":
      case "impacts":
      case "hand":
        break;
    }
  }

  /** Where one processor both simulates and draws, pictures are drawn less often until the simulation keeps pace. */
  private sharePower({ real_time_factor: rate }: Statistics): void {
    if (!this.onOneProcessor) return;
    const wanted = this.playback.simulation.rate ?? 1;
    const change = this.playback.playing && rate < KEEPS_PACE * wanted ? 20 : -10;
    this.view.pace = Math.min(Math.max(this.view.pace + change, 0), LONGEST_PACE_MS);
  }

  private takeDocument(event: DocumentEvent): void {
    const isOther = event.changes.some((change) => change.op === "reset");
    // All poses of the new scene follow in a frame.
    if (isOther) {
      this.motion.clear();
      this.entities.forgetPoints();
    }
    this.document.apply(event);
    if (!isOther) return;
    this.framing.open();
    void this.knowRecoveries();
  }

  /** Unsaved work that was left while this page looked on need not be offered when it is loaded again. */
  private async knowRecoveries(): Promise<void> {
    const answer = await this.server.command("scene.list", {});
    if (answer) this.preferences.set("recoveriesKnown", answer.scenes.filter(({ kind }) => kind === "recovery").map(({ name }) => name));
  }

  private takeSimulation({ state, time, step, rate = 1 }: Simulation): void {
    const restarted = state === "stopped" && this.playback.simulation.state !== "stopped";
    this.playback.simulation = { state, time, step, rate };
    setBlendRate(rate);
    if (restarted) {
      this.document.forgetSpawned();
      this.entities.mend();
    }
    this.retint();
    this.playback.changed.emit();
  }

  /** Shows state colours only while a simulation runs; while a scene is being built its own colours are shown. */
  private retint(): void {
    const { preferences } = this;
    const shown = preferences.get("tint") && this.playback.simulation.state !== "stopped";
    this.entities.tinted = !shown ? "off" : preferences.get("fullTint") ? "full" : "faint";
    this.entities.update(performance.now(), true);
    this.view.invalidate();
  }
}

function waitingText(count: number): string {
  return t("{{count, number}} things wait for their models, which the database does not have yet.", { count });
}

/** The label of an undo step in the past tense. */
function pastOf(label: string): string {
  return translateServerText(label.replace(/^Take back /, "Took back ").replace(/^Set /, "Changed "));
}
