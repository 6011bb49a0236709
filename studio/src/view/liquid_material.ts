// SPDX-License-Identifier: MIT
import { FrontSide, MeshPhysicalMaterial, type Uniform } from "three";

/** Refractive index of liquids: water 1.33, honey 1.49. */
const REFRACTIVE_INDEX = 1.33;

/** P. Kubelka and F. Munk (1931) for the way of the refracted ray through the liquid; see lookOf() of liquid_look.ts. */
const LAYER = `
  vec3 eye = normalize(cameraPosition - vWorldPosition);
  vec3 out3 = transformNormalByInverseViewMatrix(normal, viewMatrix);
  vec3 ray = refract(-eye, out3, 1.0 / material.ior);
  float way = vThickness / max(dot(-ray, out3), 0.5);
  float s = max(0.75 * scattering, 1e-6);
  vec3 a = 1.0 + 2.0 * absorption / s;
  vec3 b = sqrt(max(a * a - 1.0, 1e-9));
  vec3 x = min(b * s * way, 20.0);
  vec3 shrink = exp(-2.0 * x);
  vec3 below = a * (1.0 - shrink) + b * (1.0 + shrink);
  vec4 leaves = projectionMatrix * viewMatrix * vec4(vWorldPosition + ray * way, 1.0);
  vec3 behind = getTransmissionSample(0.5 + 0.5 * leaves.xy / leaves.w, 0.0, material.ior).rgb;
  totalDiffuse = totalDiffuse * (1.0 - shrink) / below + behind * 2.0 * b * exp(-x) / below;`;

/** A liquid in full quality: what is behind it is refracted and weakened by the thickness at each point, from the attribute `thickness`. */
export function refractingLiquid(uniforms: Record<"absorption" | "scattering" | "stateTint", Uniform>): MeshPhysicalMaterial {
  const material = new MeshPhysicalMaterial({ roughness: 0.12, metalness: 0, envMapIntensity: 1.5, ior: REFRACTIVE_INDEX, transmission: 1 });
  material.side = material.shadowSide = FrontSide;
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, uniforms);
    shader.vertexShader = shader.vertexShader
      .replace("#include <common>", "#include <common>\nattribute float thickness;\nvarying float vThickness;")
      .replace("#include <begin_vertex>", "#include <begin_vertex>\nvThickness = thickness;");
    shader.fragmentShader = shader.fragmentShader
      .replace("#include <common>", "#include <common>\nuniform vec3 absorption;\nuniform float scattering;\nuniform vec4 stateTint;\nvarying float vThickness;")
      .replace("#include <transmission_fragment>", `material.transmissionAlpha = 1.0;${LAYER}`)
      .replace("#include <opaque_fragment>", "outgoingLight = mix(outgoingLight, stateTint.rgb, stateTint.a);\n#include <opaque_fragment>");
  };
  material.customProgramCacheKey = () => "refracting liquid";
  return material;
}
