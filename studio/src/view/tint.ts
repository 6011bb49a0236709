// SPDX-License-Identifier: MIT
import { type Material, MeshLambertMaterial, type MeshStandardMaterial, type WebGLProgramParametersWithUniforms } from "three";
import { addFinish, finishOf } from "./finish";
import { BodyState } from "../document/motion";

/** How strongly states are shown: not, as a faint tint of the own colour, or by the state's colour alone. */
export type TintStrength = "off" | "faint" | "full";

/** Red, green and gray as in the paper's Fig. 9, linear. */
const STATE_COLOR: Record<BodyState, readonly [number, number, number]> = {
  [BodyState.active]: [0.9, 0.05, 0.04],
  [BodyState.wantsToSleep]: [0.05, 0.62, 0.12],
  [BodyState.asleep]: [0.3, 0.31, 0.32],
  [BodyState.still]: [0, 0, 0],
};
/** Fraction of the entity's own hue that the state's colour replaces. */
const SHARE: Record<TintStrength, number> = { off: 0, faint: 0.1, full: 0.92 };

/** Colour of a state and its amount. */
export function tintOf(state: BodyState, strength: TintStrength): readonly [number, number, number, number] {
  const share = state === BodyState.still ? 0 : SHARE[strength];
  return share > 0 ? [...STATE_COLOR[state], share] : [0, 0, 0, 0];
}

export type Quality = "high" | "low";

// The state determines the hue, the entity's own colour the lightness, so that textures stay visible.
export const MIX = `
float ownLight = dot(diffuseColor.rgb, vec3(0.2126, 0.7152, 0.0722));
diffuseColor.rgb = mix(diffuseColor.rgb, vTint.rgb * (0.45 + 0.9 * ownLight), vTint.a);
#include <alphatest_fragment>`;
/** What is brighter than its colour could be shines: a lamp that is on. */
const GLOW = `
#if defined(USE_COLOR) || defined(USE_COLOR_ALPHA)
totalEmissiveRadiance += diffuseColor.rgb * clamp(max(vColor.r, max(vColor.g, vColor.b)) - 1.0, 0.0, 1.0);
#endif
${MIX}`;
/** A rim of the state's colour where the surface turns away from the eye: the rest keeps its own colours. */
const RIM = `
float turned = 1.0 - abs(dot(normal, normalize(vViewPosition)));
outgoingLight = mix(outgoingLight, vTint.rgb, step(0.001, vTint.a) * 0.5 * pow(turned, 5.0));
#include <opaque_fragment>`;

/**
 * A copy of the material that takes its hue from the instanced attribute `tint`; low quality means matt, without reflections. Cloth
 * has no rim, because its folds turn away from the eye everywhere.
 */
export function tintable(original: Material, quality: Quality, hasRim: boolean): Material {
  const material = quality === "low" ? lambert(original as MeshStandardMaterial) : original.clone();
  const hasSurface = quality === "high" && original.userData["surfaceAtVertices"] === true;
  const finish = finishOf(original);
  material.onBeforeCompile = (shader) => {
    shader.vertexShader = shader.vertexShader
      .replace("#include <common>", "#include <common>\nattribute vec4 tint;\nvarying vec4 vTint;")
      .replace("#include <begin_vertex>", "#include <begin_vertex>\nvTint = tint;");
    if (hasSurface) addSurface(shader);
    if (finish) addFinish(shader, finish);
    shader.fragmentShader = shader.fragmentShader
      .replace("#include <common>", "#include <common>\nvarying vec4 vTint;")
      .replace("#include <alphatest_fragment>", GLOW)
      .replace("#include <opaque_fragment>", hasRim ? RIM : "#include <opaque_fragment>");
  };
  const key = `tint${hasRim ? " and rim" : ""}${hasSurface ? " and surface" : ""}${finish ? " and finish" : ""}`;
  material.customProgramCacheKey = () => key;
  return material;
}

/** Roughness and metalness, of 8 bits each in one number, from the vertices (merge_parts.ts). */
function addSurface(shader: WebGLProgramParametersWithUniforms): void {
  shader.vertexShader = shader.vertexShader
    .replace("#include <common>", "#include <common>\nattribute float surface;\nvarying vec2 vSurface;")
    .replace("#include <begin_vertex>", "#include <begin_vertex>\nfloat packed = floor(surface * 65535.0 + 0.5);\nvSurface = vec2(floor(packed / 256.0), mod(packed, 256.0)) / 255.0;");
  shader.fragmentShader = shader.fragmentShader
    .replace("#include <common>", "#include <common>\nvarying vec2 vSurface;")
    .replace("#include <roughnessmap_fragment>", "float roughnessFactor = vSurface.x;")
    .replace("#include <metalnessmap_fragment>", "float metalnessFactor = vSurface.y;");
}

function lambert(original: MeshStandardMaterial): MeshLambertMaterial {
  const { color, map, transparent, opacity, side, vertexColors, alphaTest } = original;
  return new MeshLambertMaterial({ color, map, transparent, opacity, side, vertexColors, alphaTest });
}
