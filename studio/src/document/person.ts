// SPDX-License-Identifier: MIT
// Who sits at this tab: a random text that stays the same over reloads, so that the person's undo and name do. Of several tabs of a
// browser the first one is the browser's person, each further one a person of its own.

const PLACE = "embody.person";
/** A page that is being left may hold its lock a little longer than the next one takes to start; a duplicated tab waits in vain. */
const LOCK_WAIT_MS = 1500;

/** The person of this tab; it is held until the page is left. */
export async function thisPerson(): Promise<string> {
  const ofTab = read("sessionStorage");
  // A page that is loaded again is surely the same; its lock comes when the page before has let go, which may take long.
  const isReload = (performance.getEntriesByType("navigation")[0] as PerformanceNavigationTiming | undefined)?.type === "reload";
  if (ofTab && isReload) {
    void claim(ofTab, null);
    return ofTab;
  }
  if (ofTab && (await claim(ofTab, LOCK_WAIT_MS))) return keep(ofTab);
  const ofBrowser = read("localStorage");
  if (ofBrowser && navigator.locks && (await claim(ofBrowser, 0))) return keep(ofBrowser);
  const fresh = crypto.getRandomValues(new Uint32Array(4)).join("-");
  await claim(fresh, 0);
  return keep(fresh);
}

function keep(person: string): string {
  write("sessionStorage", person);
  if (!read("localStorage")) write("localStorage", person);
  return person;
}

/**
 * Takes the person for this tab; false where another tab of the browser has it, such as the one that this was duplicated from.
 * Browsers have these locks on https and on this machine; elsewhere the storage of the tab alone decides. Waits so long where another one has it; null: as long as it takes.
 */
function claim(person: string, waitMs: number | null): Promise<boolean> {
  if (!navigator.locks) return Promise.resolve(true);
  return new Promise((resolve) => {
    const given = new AbortController();
    const timer = waitMs === null ? 0 : setTimeout(() => given.abort(), waitMs);
    const options: LockOptions = waitMs === 0 ? { ifAvailable: true } : { signal: given.signal };
    const held = navigator.locks.request(`${PLACE} ${person}`, options, (lock) => {
      clearTimeout(timer);
      resolve(lock !== null);
      // The lock is held until the page is left.
      return lock ? new Promise<void>((release) => addEventListener("pagehide", () => release())) : undefined;
    });
    held.catch(() => resolve(false));
  });
}

// Where the user lets the browser store nothing, every page is a new person.
function read(where: "sessionStorage" | "localStorage"): string | null {
  try {
    return window[where].getItem(PLACE);
  } catch {
    return null;
  }
}

function write(where: "sessionStorage" | "localStorage", person: string): void {
  try {
    window[where].setItem(PLACE, person);
  } catch {
    // As above.
  }
}
