// SPDX-License-Identifier: MIT
// The registry's words as people read them.

const WORDS: Record<string, string> = {
  fluid: "liquid",
  granular: "grains",
  visual: "only drawn",
  free: "anywhere",
  pair_table: "measured for the pair",
  own: "its own",
  average: "mean of both",
  geometric_mean: "geometric mean of both",
  minimum: "the lower of both",
  maximum: "the higher of both",
  multiply: "product of both",
  decomposition: "several convex parts",
  trimesh: "its triangles",
};

export function wordText(word: string): string {
  return WORDS[word] ?? word.replaceAll("_", " ");
}
