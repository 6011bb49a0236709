// SPDX-License-Identifier: MIT
import { BackSide, Color, Mesh, ShaderMaterial, SphereGeometry, Vector3 } from "three";

/** How high the sun stands at noon, and how far it goes north, as parts of its way. */
const NOON_HEIGHT = 0.85;
const SOUTH = 0.52;
/** Heights of the sun (sine) between which dusk becomes day. */
const DUSK = -0.12;
const DAY = 0.25;

const SKY = {
  night: { zenith: new Color(0x05070f), horizon: new Color(0x121826) },
  dusk: { zenith: new Color(0x2b3a5c), horizon: new Color(0xd9a27e) },
  day: { zenith: new Color(0x3f78c4), horizon: new Color(0xbcd3e8) },
};
const MOONLIGHT = new Color(0x8fa6d8);
const LOW_SUN = new Color(0xffa56b);
const HIGH_SUN = new Color(0xfff4e6);

/** Sun and sky at an hour of the day. */
export interface Daylight {
  /** Towards the sun, or by night towards the moon. */
  direction: Vector3;
  sun: Color;
  /** Of the sun as a directional light, and of the sky around. */
  sunStrength: number;
  skyStrength: number;
  /** What the picture is brightened by, as a camera that is set for rooms by day. */
  exposure: number;
  zenith: Color;
  horizon: Color;
}

/** The sun rises at 6 in the east (+X), is highest at 12 in the south (+Z) and sets at 18. */
export function daylightAt(hour: number): Daylight {
  const angle = ((hour - 6) / 12) * Math.PI;
  const height = Math.sin(angle);
  const day = smooth(DUSK, DAY, height);
  const isNight = height < DUSK / 2;
  const direction = new Vector3(Math.cos(angle), Math.max(0.12, Math.abs(height)) * NOON_HEIGHT, SOUTH).normalize();
  const between = (night: Color, dusk: Color, full: Color) =>
    height < 0 ? night.clone().lerp(dusk, smooth(-0.25, 0, height)) : dusk.clone().lerp(full, smooth(0, DAY, height));
  return {
    direction,
    sun: isNight ? MOONLIGHT.clone() : LOW_SUN.clone().lerp(HIGH_SUN, smooth(0, 0.45, height)),
    sunStrength: isNight ? 0.16 : 0.25 + 2.0 * day,
    skyStrength: 0.1 + 0.9 * day,
    exposure: 1 + 0.5 * day,
    zenith: between(SKY.night.zenith, SKY.dusk.zenith, SKY.day.zenith),
    horizon: between(SKY.night.horizon, SKY.dusk.horizon, SKY.day.horizon),
  };
}

function smooth(from: number, to: number, value: number): number {
  const part = Math.min(1, Math.max(0, (value - from) / (to - from)));
  return part * part * (3 - 2 * part);
}

/** The sky as a dome around the eye: its colours, and the glow around the sun. */
export class SkyDome {
  readonly mesh: Mesh<SphereGeometry, ShaderMaterial>;

  constructor() {
    const material = new ShaderMaterial({
      side: BackSide,
      depthWrite: false,
      depthTest: false,
      fog: false,
      toneMapped: false,
      uniforms: { zenith: { value: new Color() }, horizon: { value: new Color() }, sun: { value: new Color() }, towards: { value: new Vector3() } },
      vertexShader: `
        varying vec3 along;
        void main() {
          along = position;
          // Around the eye wherever it is.
          gl_Position = projectionMatrix * vec4(mat3(modelViewMatrix) * position, 1.0);
        }`,
      fragmentShader: `
        varying vec3 along;
        uniform vec3 zenith, horizon, sun, towards;
        void main() {
          vec3 ray = normalize(along);
          vec3 color = mix(horizon, zenith, pow(max(ray.y, 0.0), 0.55));
          // The ground gives back the sky's light without its blue.
          vec3 ground = 0.6 * dot(horizon, vec3(0.2126, 0.7152, 0.0722)) * vec3(1.04, 1.0, 0.93);
          color = mix(color, ground, smoothstep(0.0, -0.25, ray.y));
          float near = max(dot(ray, towards), 0.0);
          float high = near * near * near * near;
          color += sun * (0.25 * high * high + 1.5 * smoothstep(0.9993, 0.9997, near)) * step(-0.02, ray.y);
          gl_FragColor = vec4(color, 1.0);
          #include <colorspace_fragment>
        }`,
    });
    this.mesh = new Mesh(new SphereGeometry(10, 24, 16), material);
    this.mesh.renderOrder = -10;
    this.mesh.frustumCulled = false;
    this.mesh.raycast = () => {};
  }

  show({ zenith, horizon, sun, direction, sunStrength }: Daylight): void {
    const { uniforms } = this.mesh.material;
    uniforms["zenith"]!.value.copy(zenith);
    uniforms["horizon"]!.value.copy(horizon);
    uniforms["sun"]!.value.copy(sun).multiplyScalar(Math.min(1, sunStrength));
    uniforms["towards"]!.value.copy(direction);
  }
}
