// SPDX-License-Identifier: MIT
import {
  Color,
  DirectionalLight,
  Fog,
  HemisphereLight,
  Mesh,
  PlaneGeometry,
  PMREMGenerator,
  Scene,
  ShaderMaterial,
  type Texture,
  Vector3,
  type WebGLRenderer,
} from "three";
import { type Daylight, daylightAt, SkyDome } from "./daylight";
import { RoomEnvironment } from "three/examples/jsm/environments/RoomEnvironment.js";
import type { Quality } from "./tint";

export type Theme = "dark" | "light";

const BACKGROUND: Record<Theme, number> = { dark: 0x262b33, light: 0xcdd5de };
const GRID_COLOR: Record<Theme, number> = { dark: 0xa8b4c4, light: 0x3a4450 };
const SHADOW_REACH_LEAST = 6;

const PLAIN_SUN = new Color(0xfff4e6);
const PLAIN_DIRECTION = new Vector3(0.45, 1, 0.6).normalize();
/** Fractions of the sky's and the ground's colour that light things from all sides. */
const PLAIN_SKY = new Color(0xdfe8f5);
const PLAIN_GROUND = new Color(0x6e6a64);
/** By daylight a floor in the sun lights from below. */
const DAYLIT_GROUND = new Color(0x94897b);

/** Light, fog and ground grid: a plain studio that does not change the models' own colours, or sun and sky of an hour. */
export class Environment {
  private readonly sun = new DirectionalLight(0xfff4e6, 1.9);
  private readonly sky = new HemisphereLight(0xdfe8f5, 0x6e6a64, 0.5);
  private readonly fog = new Fog(0, 50, 200);
  private readonly grid = gridMesh();
  private reflections: Texture | null = null;
  /** Of the sky at its hour. */
  private skyReflections: Texture | null = null;
  private readonly dome = new SkyDome();
  private daylight: Daylight | null = null;
  /** The hour that sun and sky are drawn for; null: the plain studio. */
  hour: number | null = null;
  private readonly direction = PLAIN_DIRECTION.clone();
  private theme: Theme = "dark";
  private quality: Quality = "low";
  private sunChanged = false;

  constructor(
    private readonly scene: Scene,
    private readonly renderer: WebGLRenderer,
  ) {
    this.sun.shadow.mapSize.set(2048, 2048);
    this.sun.shadow.bias = -0.0004;
    this.sun.shadow.normalBias = 0.02;
    this.sun.shadow.radius = 2;
    scene.add(this.sun, this.sun.target, this.sky, this.grid);
    scene.fog = this.fog;
  }

  setTheme(theme: Theme): void {
    this.theme = theme;
    (this.grid.material as ShaderMaterial).uniforms["color"]!.value.set(GRID_COLOR[theme]);
    this.paint();
  }

  setQuality(quality: Quality): void {
    this.quality = quality;
    const high = quality === "high";
    this.sun.castShadow = high;
    this.renderer.shadowMap.enabled = high;
    this.paint();
  }

  /** Sun and sky at an hour of the day; null: the plain studio. */
  setHour(hour: number | null): void {
    this.hour = hour;
    this.daylight = hour === null ? null : daylightAt(hour);
    this.skyReflections?.dispose();
    this.skyReflections = null;
    this.paint();
  }

  private paint(): void {
    const { daylight, scene } = this;
    const high = this.quality === "high";
    const background = daylight ? daylight.horizon : new Color(BACKGROUND[this.theme]);
    scene.background = daylight ? null : background;
    this.fog.color.copy(background);
    this.dome.mesh.removeFromParent();
    if (daylight) {
      this.dome.show(daylight);
      scene.add(this.dome.mesh);
    }
    this.direction.copy(daylight?.direction ?? PLAIN_DIRECTION);
    this.sunChanged = true;
    this.sun.color.copy(daylight?.sun ?? PLAIN_SUN);
    this.sun.intensity = daylight?.sunStrength ?? 1.9;
    // Half of the sky's own hue: things keep their colours.
    this.sky.color.copy(PLAIN_SKY);
    if (daylight) this.sky.color.lerp(daylight.zenith.clone().lerp(daylight.horizon, 0.6), 0.5);
    this.sky.groundColor.copy(daylight ? DAYLIT_GROUND : PLAIN_GROUND);
    this.renderer.toneMappingExposure = daylight?.exposure ?? 1;
    this.sky.intensity = (high ? 0.5 : 2.1) * (daylight ? 0.85 * daylight.skyStrength : 1);
    if (high) scene.environment = daylight ? (this.skyReflections ??= this.reflect(daylight)) : (this.reflections ??= this.generate(new RoomEnvironment()));
    else scene.environment = null;
    // State colours look pale under strong image-based light.
    scene.environmentIntensity = daylight ? 0.3 + 0.3 * daylight.skyStrength : 0.35;
  }

  private reflect(daylight: Daylight): Texture {
    const surroundings = new Scene();
    const dome = new SkyDome();
    dome.show(daylight);
    surroundings.add(dome.mesh);
    const texture = this.generate(surroundings);
    dome.mesh.geometry.dispose();
    dome.mesh.material.dispose();
    return texture;
  }

  private generate(surroundings: Scene): Texture {
    const generator = new PMREMGenerator(this.renderer);
    const { texture } = generator.fromScene(surroundings, 0.04);
    generator.dispose();
    return texture;
  }

  get isGridShown(): boolean {
    return this.grid.visible;
  }

  showGrid(shown: boolean): void {
    this.grid.visible = shown;
  }

  /** Moves shadows and fog to the point that the camera looks at, `distance` metres away, seeing as much as from `seen`; returns whether the sun moved. */
  follow(target: Vector3, distance: number, seen = distance): boolean {
    const reach = Math.max(SHADOW_REACH_LEAST, 1.4 * seen);
    const camera = this.sun.shadow.camera;
    const resized = Math.abs(camera.right - reach) > 0.15 * reach;
    if (resized) {
      camera.left = camera.bottom = -reach;
      camera.right = camera.top = reach;
      camera.near = 0.1;
      camera.far = 8 * reach;
      camera.updateProjectionMatrix();
    }
    // Shadows are kept while the centre of the view stays within a tenth of their extent.
    const moved = resized || this.sunChanged || this.sun.target.position.distanceTo(target) > 0.1 * camera.right;
    if (moved) this.sun.target.position.copy(target);
    this.sunChanged = false;
    this.sun.position.copy(this.direction).multiplyScalar(4 * camera.right).add(this.sun.target.position);
    this.fog.near = 30 + 4 * distance;
    this.fog.far = 120 + 16 * distance;
    this.grid.position.set(Math.round(target.x), 0, Math.round(target.z));
    return moved;
  }
}

/** Lines each metre, stronger each ten metres, that fade out with distance. */
function gridMesh(): Mesh {
  const geometry = new PlaneGeometry(400, 400);
  geometry.rotateX(-Math.PI / 2);
  const material = new ShaderMaterial({
    transparent: true,
    depthWrite: false,
    // Before what lies at the same height, but below a floor of 5 mm: a whole pixel's slope is more than that.
    polygonOffset: true,
    polygonOffsetFactor: -0.1,
    polygonOffsetUnits: -4,
    side: 2,
    uniforms: { color: { value: new Color() } },
    vertexShader: `
      varying vec3 world;
      void main() {
        vec4 at = modelMatrix * vec4(position, 1.0);
        world = at.xyz;
        gl_Position = projectionMatrix * viewMatrix * at;
      }`,
    fragmentShader: `
      varying vec3 world;
      uniform vec3 color;
      float lines(vec2 at) {
        vec2 width = fwidth(at);
        vec2 near = abs(fract(at - 0.5) - 0.5) / width;
        float line = 1.0 - min(min(near.x, near.y), 1.0);
        return line * (1.0 - smoothstep(0.2, 0.7, max(width.x, width.y)));
      }
      void main() {
        float fade = 1.0 - smoothstep(8.0, 60.0, distance(world, cameraPosition));
        float strength = max(0.2 * lines(world.xz), 0.4 * lines(world.xz / 10.0));
        gl_FragColor = vec4(color, strength * fade);
      }`,
  });
  const mesh = new Mesh(geometry, material);
  mesh.renderOrder = 1;
  mesh.raycast = () => {};
  return mesh;
}
