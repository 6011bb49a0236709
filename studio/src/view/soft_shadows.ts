// SPDX-License-Identifier: MIT
import { ShaderChunk } from "three";

/** Samples of the sun's shadow at a pixel; five, as three.js takes, leave its edges grainy. */
const SAMPLES = 12;

/** Lets every material that is made from now on take more samples of a shadow map. */
export function smoothShadows(): void {
  const five = /shadow = \(\s*(?:texture\( shadowMap, vec3\( shadowCoord\.xy \+ vogelDiskSample\( \d, 5, phi \)[^;]*)\* 0\.2;/;
  const chunk = ShaderChunk.shadowmap_pars_fragment;
  if (!five.test(chunk)) throw new Error("three.js samples shadows otherwise than soft_shadows.ts expects: look at shadowmap_pars_fragment");
  ShaderChunk.shadowmap_pars_fragment = chunk.replace(
    five,
    `shadow = 0.0;
    for (int i = 0; i < ${SAMPLES}; i++) shadow += texture(shadowMap, vec3(shadowCoord.xy + vogelDiskSample(i, ${SAMPLES}, phi) * radius, shadowCoord.z));
    shadow /= ${SAMPLES}.0;`,
  );
}
