// SPDX-License-Identifier: MIT
import { t, translateServerText } from "../language";
// The registry's words as people read them.

const WORDS: Record<string, string> = {
  fluid: t("liquid"),
  granular: t("grains"),
  visual: t("only drawn"),
  free: t("anywhere"),
  pair_table: t("measured for the pair"),
  own: t("its own"),
  average: t("mean of both"),
  geometric_mean: t("geometric mean of both"),
  minimum: t("the lower of both"),
  maximum: t("the higher of both"),
  multiply: t("product of both"),
  decomposition: t("several convex parts"),
  trimesh: t("its triangles"),
};

export function wordText(word: string): string {
  return WORDS[word] ?? translateServerText(word.replaceAll("_", " "));
}
