// SPDX-License-Identifier: MIT
// Owns the WebSocket, so that frames are received while the page draws. Text is passed on at once and in order. At most one state
// frame is on its way to the page; later ones are merged here until the page asks again. Without this the picture was 0.3 s late
// when drawing was slow.
import { type DebugFrame, decodeDebugFrame, isDebugFrame } from "./debug_frame";
import { decodeFrame, NewestFrame, type Frame } from "./frame";

/** Page → worker. */
export type ToWorker = { kind: "open"; url: string } | { kind: "send"; text: string } | { kind: "next_frame" };
/** Worker → page. */
export type FromWorker =
  | { kind: "opened" }
  | { kind: "closed"; reason: string }
  | { kind: "text"; text: string }
  | { kind: "frame"; frame: Frame }
  | { kind: "debug"; frame: DebugFrame }
  | { kind: "fault"; reason: string };

const RETRY_MS = [250, 500, 1000, 2000, 4000];

let socket: WebSocket | null = null;
let url = "";
let attempts = 0;
const newest = new NewestFrame();
/** Not passed on yet; a newer frame replaces it. */
let newestDebug: DebugFrame | null = null;
let pageIsReady = true;

function tell(message: FromWorker, transfer: Transferable[] = []): void {
  postMessage(message, { transfer });
}

/** Sends the newest debug frame to the page, if there is one. */
function flushDebug(): void {
  const frame = newestDebug;
  if (!frame) return;
  newestDebug = null;
  pageIsReady = false;
  tell({ kind: "debug", frame }, frame.batches.slice(0, 1).map((batch) => batch.lines.buffer));
}

/** Sends the merged frame to the page at once. */
function flushFrame(): void {
  const frame = newest.take();
  if (!frame) return;
  pageIsReady = false;
  tell({ kind: "frame", frame }, [
    frame.indices.buffer,
    frame.poses.buffer,
    frame.states.buffer,
    frame.pointed.buffer,
    ...frame.sets.map((set) => set.positions.buffer),
  ]);
}

function receive(data: unknown): void {
  if (typeof data === "string") {
    // A pose from before an event must not arrive after the event.
    flushFrame();
    tell({ kind: "text", text: data });
    return;
  }
  try {
    if (isDebugFrame(data as ArrayBuffer)) newestDebug = decodeDebugFrame(data as ArrayBuffer);
    else newest.add(decodeFrame(data as ArrayBuffer));
  } catch (error) {
    tell({ kind: "fault", reason: (error as Error).message });
    return;
  }
  if (!pageIsReady) return;
  flushFrame();
  flushDebug();
}

function open(): void {
  const opening = new WebSocket(url);
  opening.binaryType = "arraybuffer";
  socket = opening;
  opening.onopen = () => {
    attempts = 0;
    pageIsReady = true;
    newest.take();
    newestDebug = null;
    tell({ kind: "opened" });
  };
  opening.onmessage = (event) => receive(event.data);
  opening.onclose = (event) => {
    socket = null;
    tell({ kind: "closed", reason: event.reason });
    setTimeout(open, RETRY_MS[Math.min(attempts++, RETRY_MS.length - 1)]);
  };
}

onmessage = (event: MessageEvent<ToWorker>) => {
  const message = event.data;
  if (message.kind === "open") {
    url = message.url;
    open();
  } else if (message.kind === "send") {
    if (socket?.readyState === WebSocket.OPEN) socket.send(message.text);
  } else {
    pageIsReady = true;
    flushFrame();
    flushDebug();
  }
};
