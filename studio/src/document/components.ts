// SPDX-License-Identifier: MIT
// Vectors of several entities at once: what they agree in, and what each becomes when one component is typed.

/** Each component in which all vectors agree; null where they differ. Null for no vectors. */
export function commonComponents(vectors: readonly (readonly number[])[]): (number | null)[] | null {
  const [first, ...others] = vectors;
  return first ? first.map((part, at) => (others.every((other) => other[at] === part) ? part : null)) : null;
}

/** A vector with the components that are not null in `typed`. */
export function withTyped(own: readonly number[], typed: readonly (number | null)[]): number[] {
  return own.map((part, at) => typed[at] ?? part);
}
