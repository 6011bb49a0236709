// SPDX-License-Identifier: MIT

/** Names of drivers without a graphics card: Mesa, Chromium, Windows, macOS. */
const SOFTWARE = /llvmpipe|softpipe|swrast|swiftshader|software|microsoft basic render/i;

let known: boolean | null = null;

/** Whether this computer draws with its processor, by the name of its WebGL driver; false where that is unknown. */
export function drawsInSoftware(): boolean {
  return (known ??= askDriver());
}

function askDriver(): boolean {
  const gl = document.createElement("canvas").getContext("webgl2");
  if (!gl) return false;
  const names = gl.getExtension("WEBGL_debug_renderer_info");
  const name = String(gl.getParameter(names ? names.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return SOFTWARE.test(name);
}
