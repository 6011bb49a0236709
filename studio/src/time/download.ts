// SPDX-License-Identifier: MIT
/** A file's link stays for this long, ms: a browser may ask where to save it. */
const KEPT_MS = 60_000;

/** Saves a file among the browser's downloads. */
export function download(file: Blob, name: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(file);
  link.download = name.replace(/[/\\:*?"<>|]/g, "_");
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), KEPT_MS);
}
