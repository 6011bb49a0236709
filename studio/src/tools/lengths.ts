// SPDX-License-Identifier: MIT

/** A length for people: "1.25 m", "8 cm". */
export function formatLength(metres: number): string {
  const length = Math.abs(metres);
  return length < 0.995 ? `${Math.round(100 * length)} cm` : `${length.toFixed(2)} m`;
}
