// SPDX-License-Identifier: MIT
import { type Material, MeshLambertMaterial, type MeshStandardMaterial } from "three";
import { BodyState } from "../document/motion";

/** Red, green and gray as in the paper's Fig. 9, linear; the fourth number is how much they replace the entity's own hue. */
export const STATE_TINT: Record<BodyState, readonly [number, number, number, number]> = {
  [BodyState.active]: [0.9, 0.05, 0.04, 0.92],
  [BodyState.wantsToSleep]: [0.05, 0.62, 0.12, 0.92],
  [BodyState.asleep]: [0.3, 0.31, 0.32, 0.95],
  [BodyState.still]: [0, 0, 0, 0],
};

export type Quality = "high" | "low";

// The state gives the hue, the entity's own colour how light it is, so that textures can still be made out.
export const MIX = `
float ownLight = dot(diffuseColor.rgb, vec3(0.2126, 0.7152, 0.0722));
diffuseColor.rgb = mix(diffuseColor.rgb, vTint.rgb * (0.45 + 0.9 * ownLight), vTint.a);
#include <alphatest_fragment>`;

/** A copy of the material that takes its hue from the instanced attribute `tint`; low quality means matt, without reflections. */
export function tintable(original: Material, quality: Quality): Material {
  const material = quality === "low" ? lambert(original as MeshStandardMaterial) : original.clone();
  material.onBeforeCompile = (shader) => {
    shader.vertexShader = shader.vertexShader
      .replace("#include <common>", "#include <common>\nattribute vec4 tint;\nvarying vec4 vTint;")
      .replace("#include <begin_vertex>", "#include <begin_vertex>\nvTint = tint;");
    shader.fragmentShader = shader.fragmentShader
      .replace("#include <common>", "#include <common>\nvarying vec4 vTint;")
      .replace("#include <alphatest_fragment>", MIX);
  };
  material.customProgramCacheKey = () => "tint";
  return material;
}

function lambert(original: MeshStandardMaterial): MeshLambertMaterial {
  const { color, map, transparent, opacity, side, vertexColors, alphaTest } = original;
  return new MeshLambertMaterial({ color, map, transparent, opacity, side, vertexColors, alphaTest });
}
