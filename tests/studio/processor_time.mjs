// SPDX-License-Identifier: MIT
// Processor time of the processes that a measurement has started.
import { readFileSync, readdirSync } from "node:fs";

const TICKS_A_SECOND = 100;

/** Processor time so far of a process, s; 0 where it has ended. */
export function timeOf(pid) {
  try {
    const fields = readFileSync(`/proc/${pid}/stat`, "utf8").split(") ")[1].split(" ");
    return (Number(fields[11]) + Number(fields[12])) / TICKS_A_SECOND;
  } catch {
    return 0;
  }
}

/** Processor time so far, s, of the processes of our browser, by their kind. */
export function browserTime() {
  const times = { gpu: 0, page: 0 };
  for (const pid of readdirSync("/proc").filter((name) => /^\d+$/.test(name))) {
    try {
      const command = readFileSync(`/proc/${pid}/cmdline`, "utf8");
      const kind = /--type=gpu-process/.test(command) ? "gpu" : /--type=renderer/.test(command) ? "page" : null;
      if (kind && isOurs(pid)) times[kind] += timeOf(pid);
    } catch {
      // A process that has just ended.
    }
  }
  return times;
}

function isOurs(pid) {
  for (let at = pid; Number(at) > 1; at = readFileSync(`/proc/${at}/stat`, "utf8").split(") ")[1].split(" ")[1]) if (Number(at) === process.pid) return true;
  return false;
}
