// SPDX-License-Identifier: MIT
import { type Material, MeshLambertMaterial, type MeshStandardMaterial } from "three";
import { BodyState } from "../document/motion";

/** Red, green and gray as in the paper's Fig. 9; the fourth number is how much of the entity's own colour they cover. */
export const STATE_TINT: Record<BodyState, readonly [number, number, number, number]> = {
  [BodyState.active]: [0.86, 0.05, 0.04, 0.72],
  [BodyState.wantsToSleep]: [0.04, 0.62, 0.1, 0.72],
  [BodyState.asleep]: [0.3, 0.31, 0.33, 0.8],
  [BodyState.still]: [0, 0, 0, 0],
};

export type Quality = "high" | "low";

/** A copy of the material that mixes in the instanced attribute `tint`; low quality means matt and without reflections. */
export function tintable(original: Material, quality: Quality): Material {
  const material = quality === "low" ? lambert(original as MeshStandardMaterial) : original.clone();
  material.onBeforeCompile = (shader) => {
    shader.vertexShader = shader.vertexShader
      .replace("#include <common>", "#include <common>\nattribute vec4 tint;\nvarying vec4 vTint;")
      .replace("#include <begin_vertex>", "#include <begin_vertex>\nvTint = tint;");
    shader.fragmentShader = shader.fragmentShader
      .replace("#include <common>", "#include <common>\nvarying vec4 vTint;")
      .replace("#include <alphatest_fragment>", "diffuseColor.rgb = mix(diffuseColor.rgb, vTint.rgb, vTint.a);\n#include <alphatest_fragment>");
  };
  material.customProgramCacheKey = () => "tint";
  return material;
}

function lambert(original: MeshStandardMaterial): MeshLambertMaterial {
  const { color, map, transparent, opacity, side, vertexColors, alphaTest } = original;
  return new MeshLambertMaterial({ color, map, transparent, opacity, side, vertexColors, alphaTest });
}
