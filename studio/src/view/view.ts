// SPDX-License-Identifier: MIT
import { type Color, type Intersection, NeutralToneMapping, PCFShadowMap, type PerspectiveCamera, Plane, Raycaster, Scene, Vector2, Vector3, WebGLRenderer } from "three";
import type { Motion } from "../document/motion";
import type { SceneDocument } from "../document/scene_document";
import { Signal } from "../signal";
import type { Batch } from "./batch";
import { CameraRig } from "./camera_rig";
import { CollisionOverlay } from "./collision_overlay";
import { ContactShadows } from "./contact_shadows";
import { Viewer } from "./detail";
import { DebugOverlay } from "./debug_overlay";
import type { EntityView } from "./entity_view";
import { Environment, type Theme } from "./environment";
import type { People } from "../document/people";
import { PeopleView } from "./people_view";
import { PinMarks } from "./pin_marks";
import { PortMarks } from "./port_marks";
import { Lamps } from "./lamps";
import { Outline } from "./outline";
import { smoothShadows } from "./soft_shadows";
import type { Quality } from "./tint";

/** The point where a ray from the pointer met an entity. */
export interface Hit {
  index: number;
  point: Vector3;
  normal: Vector3;
  distance: number;
}

/** A headset that shows the scene: its camera, and the place that light and shadows are made for. */
export interface Headset {
  readonly camera: PerspectiveCamera;
  readonly target: Vector3;
  distance: number;
}

const GROUND = new Plane(new Vector3(0, 1, 0), 0);
const LONGEST_STEP_S = 0.1;
/** Without antialiasing: after so long without a new picture, ms, the last one is drawn again at so many times the resolution. */
const STILL_MS = 400;
/** While models arrive, a picture at least so often, ms. */
const ARRIVALS_MS = 500;
const STILL_FINENESS = 2;
/** So many pictures in succession, each later than this after the one before, ms, count as slow drawing. */
const SLOW_PICTURES = 12;
const SLOW_MS = 120;

/** Levels of detail may be so far from the full surface, pixels: without a graphics card triangles cost most. */
const TOLERANCE: Record<Quality, number> = { high: 1, low: 1.5 };

/** The 3D view. A picture is drawn only when something changed. */
export class View {
  readonly scene = new Scene();
  readonly rig = new CameraRig();
  readonly renderer: WebGLRenderer;
  readonly environment: Environment;
  readonly outline: Outline;
  readonly collision: CollisionOverlay;
  readonly debug = new DebugOverlay();
  readonly pins: PinMarks;
  readonly ports: PortMarks;
  readonly people: PeopleView;
  readonly contactShadows: ContactShadows;
  readonly lamps: Lamps;
  /** Sent just before a picture is drawn, with the page's clock in milliseconds. */
  readonly beforeFrame = new Signal<number>();
  /** Sent after a picture was drawn, while it can still be read. */
  readonly afterFrame = new Signal<void>();
  /** Drawing was slow for the last SLOW_PICTURES pictures; sent once. */
  readonly slow = new Signal<void>();
  /** Pictures drawn so far. */
  frames = 0;
  /** Shortest time between pictures of a moving scene, ms; what the user does is drawn at once. */
  pace = 0;
  /** A film or a picture is being drawn: the page itself is not, and frames of the server are left alone. */
  isCapturing = false;
  private headset: Headset | null = null;
  private background: Color | null = null;
  private waiting = 0;
  private arriving = 0;
  private still = 0;
  /** The present picture was drawn at the higher resolution. */
  private isFine = false;
  /** The canvas is antialiased. */
  readonly hasSmoothEdges: boolean;
  private asked = false;
  private halted = false;
  /** Contact shadows are not all made yet. */
  private shadowsWait = false;
  private lastFrame = 0;
  /** The last picture asked for the next one: the time between them is work, not idle time. */
  private goesOn = false;
  /** Number of slow pictures in succession; -1 once `slow` was sent. */
  private slowPictures = 0;
  private pixelRatio = 1;
  private readonly size = new Vector2();
  /** What is in view of pictures, and in which detail. */
  readonly viewer = new Viewer();
  private readonly raycaster = new Raycaster();
  private readonly hits: Intersection[] = [];

  constructor(
    readonly canvas: HTMLCanvasElement,
    private readonly motion: Motion,
    readonly entities: EntityView,
    people: People,
    document: SceneDocument,
    quality: Quality,
  ) {
    // Antialiasing is the larger half of a picture's cost without a graphics card; a context cannot change it later.
    this.renderer = new WebGLRenderer({ canvas, antialias: quality === "high", stencil: true, powerPreference: "high-performance" });
    this.hasSmoothEdges = this.renderer.getContext().getContextAttributes()?.antialias ?? false;
    this.renderer.toneMapping = NeutralToneMapping;
    smoothShadows();
    this.renderer.shadowMap.type = PCFShadowMap;
    this.renderer.shadowMap.autoUpdate = false;
    this.environment = new Environment(this.scene, this.renderer);
    this.outline = new Outline(entities);
    this.collision = new CollisionOverlay(entities);
    this.pins = new PinMarks(entities.softs);
    this.ports = new PortMarks(document, entities);
    this.people = new PeopleView(people, entities);
    this.contactShadows = new ContactShadows(entities);
    this.lamps = new Lamps(document, entities);
    this.scene.add(entities.group, this.contactShadows.mesh, this.lamps.group, this.outline.group, this.people.group, this.collision.group, this.debug.group, this.pins.points, this.ports.lines);
    this.rig.changed.on(() => {
      entities.lookFrom(this.rig.camera.position);
      this.invalidate();
    });
    // Of many models that arrive only some pictures are drawn on the way: without a graphics card each takes as long as many of them.
    entities.loaded.on(() => (entities.loading > 0 ? this.drawWithin(ARRIVALS_MS) : this.invalidate()));
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement!);
  }

  /** Asks for a new picture. */
  invalidate(): void {
    clearTimeout(this.still);
    if (this.asked || this.halted || this.renderer.xr.isPresenting) return;
    this.asked = true;
    requestAnimationFrame((now) => this.draw(now));
  }

  /** Asks for a picture as soon as `pace` allows. */
  drawSoon(): void {
    clearTimeout(this.still);
    const wait = this.lastFrame + this.pace - performance.now();
    if (wait <= 0) this.invalidate();
    else
      this.waiting ||= window.setTimeout(() => {
        this.waiting = 0;
        this.invalidate();
      }, wait);
  }

  /** Asks for a picture so many milliseconds after the last one at the latest. */
  private drawWithin(milliseconds: number): void {
    this.arriving ||= window.setTimeout(() => {
      this.arriving = 0;
      this.invalidate();
    }, Math.max(0, this.lastFrame + milliseconds - performance.now()));
  }

  /** Stops drawing until resume(): screenshots of a page that always draws may never end. */
  halt(): void {
    // Draws a picture that was asked for: otherwise a canvas of a new size would stay empty.
    if (this.asked) this.draw(performance.now());
    if (!this.isFine) this.drawStill();
    this.halted = true;
  }

  resume(): void {
    this.halted = false;
    this.invalidate();
  }

  setQuality(quality: Quality): void {
    this.pixelRatio = quality === "low" ? 1 : Math.min(devicePixelRatio, 2);
    this.renderer.setPixelRatio(this.pixelRatio);
    this.environment.setQuality(quality);
    this.entities.setQuality(quality);
    this.contactShadows.setQuality(quality);
    this.lamps.setQuality(quality);
    this.viewer.tolerance = TOLERANCE[quality];
    this.resize();
  }

  setTheme(theme: Theme): void {
    this.environment.setTheme(theme);
    this.invalidate();
  }

  /** Sun and sky at an hour of the day; null: the Studio's plain light. */
  setHour(hour: number | null): void {
    this.environment.setHour(hour);
    this.invalidate();
  }

  /** Saves the present picture as a PNG file in the browser's downloads. */
  savePicture(title: string): void {
    this.render();
    this.canvas.toBlob((blob) => {
      if (!blob) return;
      const link = document.createElement("a");
      link.href = URL.createObjectURL(blob);
      link.download = `${title || "scene"}.png`;
      link.click();
      URL.revokeObjectURL(link.href);
    });
  }

  /** In a headset the device asks for every picture; through `seesThrough` the real room is behind the scene. */
  drawForHeadset(headset: Headset, seesThrough: boolean): void {
    this.headset = headset;
    if (seesThrough) {
      this.background = this.scene.background as Color;
      this.scene.background = null;
    }
    this.renderer.setAnimationLoop((now: number) => this.draw(now));
  }

  endHeadset(): void {
    this.headset = null;
    if (this.background) this.scene.background = this.background;
    this.background = null;
    this.renderer.setAnimationLoop(null);
    this.asked = false;
    this.resize();
  }

  /** The nearest entity under a point of the page, or null; entities of `ignore` are skipped. */
  pick(clientX: number, clientY: number, ignore?: ReadonlySet<number>): Hit | null {
    this.aim(clientX, clientY);
    return this.firstHit(ignore);
  }

  /** The nearest entity that a ray meets within `reach` metres, or null. */
  cast(origin: Vector3, direction: Vector3, reach = Infinity, ignore?: ReadonlySet<number>): Hit | null {
    this.raycaster.set(origin, direction);
    this.raycaster.far = reach;
    const hit = this.firstHit(ignore);
    this.raycaster.far = Infinity;
    return hit;
  }

  /** The ray from the eye through a point of the page. */
  ray(clientX: number, clientY: number): { origin: Vector3; direction: Vector3 } {
    this.aim(clientX, clientY);
    return { origin: this.raycaster.ray.origin.clone(), direction: this.raycaster.ray.direction.clone() };
  }

  /** The point where the pointer's ray meets a plane (by default the ground), or null. */
  meet(clientX: number, clientY: number, plane: Plane = GROUND): Vector3 | null {
    this.aim(clientX, clientY);
    return this.raycaster.ray.intersectPlane(plane, new Vector3());
  }

  /** The position of a world point on the page in pixels. */
  project(point: Vector3): Vector2 {
    this.rig.camera.updateMatrixWorld();
    const seen = point.clone().project(this.rig.camera);
    const frame = this.canvas.getBoundingClientRect();
    return new Vector2(frame.left + (0.5 + 0.5 * seen.x) * frame.width, frame.top + (0.5 - 0.5 * seen.y) * frame.height);
  }

  private firstHit(ignore?: ReadonlySet<number>): Hit | null {
    this.hits.length = 0;
    this.raycaster.intersectObject(this.entities.group, true, this.hits);
    for (const hit of this.hits) {
      const batch = hit.object.userData["batch"] as Pick<Batch, "entityAt"> | undefined;
      const index = batch?.entityAt(hit.instanceId ?? -1);
      if (index === undefined || ignore?.has(index)) continue;
      return { index, point: hit.point, normal: hit.normal?.clone() ?? new Vector3(0, 1, 0), distance: hit.distance };
    }
    return null;
  }

  private draw(now: number): void {
    this.asked = false;
    if (this.halted) return;
    if (this.isFine && !this.headset) this.setFine(false);
    const seconds = Math.min((now - this.lastFrame) / 1000, LONGEST_STEP_S);
    if (!this.headset) this.watchPace(now - this.lastFrame);
    this.lastFrame = now;
    const flying = this.rig.advance(now, seconds);
    const moving = this.advance(now);
    const peopleMove = this.people.advance(now, this.headset?.camera ?? this.rig.camera, this.size, this.canvas.clientHeight);
    this.render();
    ++this.frames;
    this.afterFrame.emit();
    this.goesOn = flying || moving || peopleMove;
    if (flying || peopleMove || this.shadowsWait) this.invalidate();
    else if (moving) this.drawSoon();
    else if (!this.hasSmoothEdges && this.entities.loading === 0) this.still = window.setTimeout(() => this.drawStill(), STILL_MS);
  }

  /** Brings all that is drawn to the time `now` of the page's clock; returns whether anything is still on its way. */
  advance(now: number): boolean {
    const bodiesMove = this.motion.advance(now);
    const moving = this.entities.advance(now) || bodiesMove;
    this.beforeFrame.emit(now);
    this.entities.update(now);
    this.shadowsWait = this.contactShadows.update(now);
    this.collision.update(now);
    this.pins.update();
    this.ports.update(now);
    this.outline.update(now, this.renderer.getDrawingBufferSize(this.size));
    const { target, distance } = this.headset ?? this.rig;
    this.lamps.update(now, target);
    const sunMoved = this.environment.follow(target, distance, this.headset ? distance : this.rig.reach);
    if (sunMoved || this.entities.shadowsAreOld) this.renderer.shadowMap.needsUpdate = true;
    this.entities.shadowsAreOld = false;
    return moving;
  }

  /** Draws the last picture again, antialiased by several samples for each pixel. */
  private drawStill(): void {
    if (this.halted || this.hasSmoothEdges || this.renderer.xr.isPresenting) return;
    this.setFine(true);
    this.render();
    this.afterFrame.emit();
  }

  /** Draws what advance() has brought up to date, at the present size. */
  render(): void {
    const camera = this.headset?.camera ?? this.rig.camera;
    // The headset's camera encloses the views of both eyes.
    if (this.headset) this.renderer.xr.updateCamera(this.headset.camera);
    this.viewer.hasShadows = this.renderer.shadowMap.enabled;
    this.viewer.look(camera, this.renderer.getDrawingBufferSize(this.size).y);
    this.entities.arrange(this.viewer);
    this.renderer.render(this.scene, camera);
  }

  private setFine(isFine: boolean): void {
    this.isFine = isFine;
    this.renderer.setPixelRatio(isFine ? STILL_FINENESS * this.pixelRatio : this.pixelRatio);
  }

  private watchPace(interval: number): void {
    if (this.slowPictures < 0) return;
    // A longer pause is idle time, not work, unless the last picture asked for this one.
    const late = interval - this.pace > SLOW_MS && (this.goesOn || interval < 8 * SLOW_MS);
    this.slowPictures = late ? this.slowPictures + 1 : 0;
    if (this.slowPictures < SLOW_PICTURES) return;
    this.slowPictures = -1;
    this.slow.emit();
  }

  /** Takes over the size of the page. */
  resize(): void {
    const frame = this.canvas.parentElement!.getBoundingClientRect();
    if (frame.width < 1 || frame.height < 1 || this.renderer.xr.isPresenting) return;
    this.rig.fit(frame.width / frame.height);
    this.renderer.setSize(frame.width, frame.height);
    this.invalidate();
  }

  private aim(clientX: number, clientY: number): void {
    const frame = this.canvas.getBoundingClientRect();
    const x = (2 * (clientX - frame.left)) / frame.width - 1;
    const y = 1 - (2 * (clientY - frame.top)) / frame.height;
    this.rig.camera.updateMatrixWorld();
    this.raycaster.setFromCamera(new Vector2(x, y), this.rig.camera);
  }
}
