// SPDX-License-Identifier: MIT
import {
  Color,
  DirectionalLight,
  Fog,
  HemisphereLight,
  Mesh,
  PlaneGeometry,
  PMREMGenerator,
  type Scene,
  ShaderMaterial,
  type Texture,
  type Vector3,
  type WebGLRenderer,
} from "three";
import { RoomEnvironment } from "three/examples/jsm/environments/RoomEnvironment.js";
import type { Quality } from "./tint";

export type Theme = "dark" | "light";

const BACKGROUND: Record<Theme, number> = { dark: 0x262b33, light: 0xcdd5de };
const GRID_COLOR: Record<Theme, number> = { dark: 0xa8b4c4, light: 0x3a4450 };
const SHADOW_REACH_LEAST = 6;

/** Light, fog and ground grid: a plain studio that does not change the models' own colours. */
export class Environment {
  private readonly sun = new DirectionalLight(0xfff4e6, 1.9);
  private readonly sky = new HemisphereLight(0xdfe8f5, 0x6e6a64, 0.5);
  private readonly fog = new Fog(0, 50, 200);
  private readonly grid = gridMesh();
  private reflections: Texture | null = null;

  constructor(
    private readonly scene: Scene,
    private readonly renderer: WebGLRenderer,
  ) {
    this.sun.shadow.mapSize.set(2048, 2048);
    this.sun.shadow.bias = -0.0004;
    this.sun.shadow.normalBias = 0.02;
    this.sun.shadow.radius = 4;
    scene.add(this.sun, this.sun.target, this.sky, this.grid);
    scene.fog = this.fog;
  }

  setTheme(theme: Theme): void {
    this.scene.background = new Color(BACKGROUND[theme]);
    this.fog.color.set(BACKGROUND[theme]);
    (this.grid.material as ShaderMaterial).uniforms["color"]!.value.set(GRID_COLOR[theme]);
  }

  setQuality(quality: Quality): void {
    const high = quality === "high";
    this.sun.castShadow = high;
    this.renderer.shadowMap.enabled = high;
    if (high && !this.reflections) {
      const generator = new PMREMGenerator(this.renderer);
      this.reflections = generator.fromScene(new RoomEnvironment(), 0.04).texture;
      generator.dispose();
    }
    this.scene.environment = high ? this.reflections : null;
    // State colours look pale under strong image-based light.
    this.scene.environmentIntensity = 0.35;
    this.sky.intensity = high ? 0.5 : 2.1;
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
    const moved = resized || this.sun.target.position.distanceTo(target) > 0.1 * camera.right;
    if (moved) this.sun.target.position.copy(target);
    this.sun.position.set(0.45, 1, 0.6).normalize().multiplyScalar(4 * camera.right).add(this.sun.target.position);
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
    polygonOffset: true,
    polygonOffsetFactor: -2,
    polygonOffsetUnits: -2,
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
