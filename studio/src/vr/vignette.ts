// SPDX-License-Identifier: MIT
import { Mesh, PlaneGeometry, ShaderMaterial } from "three";

/** How fast it comes and goes, 1/s. */
const RATE = 8;

/** Darkens the edge of the picture while the user moves smoothly, which keeps many from feeling sick. Hangs before the eyes. */
export class Vignette {
  readonly mesh: Mesh<PlaneGeometry, ShaderMaterial>;
  private amount = 0;

  constructor() {
    const material = new ShaderMaterial({
      transparent: true,
      depthTest: false,
      depthWrite: false,
      uniforms: { amount: { value: 0 } },
      vertexShader: "varying vec2 at; void main() { at = position.xy; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }",
      fragmentShader: `
        varying vec2 at;
        uniform float amount;
        void main() {
          float edge = mix(0.55, 0.16, amount);
          gl_FragColor = vec4(0.0, 0.0, 0.0, smoothstep(edge, edge + 0.12, length(at)) * min(amount * 4.0, 1.0));
        }`,
    });
    // At 0.3 m it covers 146° with its side of 2 m.
    this.mesh = new Mesh(new PlaneGeometry(2, 2), material);
    this.mesh.position.z = -0.3;
    this.mesh.renderOrder = 2000;
    this.mesh.frustumCulled = false;
    this.mesh.raycast = () => {};
    this.mesh.visible = false;
  }

  get shown(): number {
    return this.amount;
  }

  /** `wanted` is how much: 0 … 1. */
  update(wanted: number, seconds: number): void {
    this.amount += (wanted - this.amount) * Math.min(RATE * seconds, 1);
    this.mesh.visible = this.amount > 0.01;
    this.mesh.material.uniforms["amount"]!.value = this.amount;
  }
}
