// SPDX-License-Identifier: MIT
import type { BufferGeometry } from "three";
import type { ElementFinder } from "./element_finder";
import { addBetween, divide, EDGE_KEY_STEP, geometryOf, numbersOf } from "./refine";

/** A drawn edge is halved so often to find where it crosses a tear. */
const HALVINGS = 8;
/** A crossing nearer to an end of its edge than this share of it is moved there: no slivers. */
const NEAR_END = 0.05;

/** For each node the first one with the same place at rest: the one that it came from where a sheet tore. Null: the sheet is whole. */
export function originsOf(nodes: ArrayLike<number>): Uint32Array | null {
  const first = new Map<string, number>();
  const origins = new Uint32Array(nodes.length / 3);
  for (let node = 0; node < origins.length; ++node) {
    const place = `${nodes[3 * node]} ${nodes[3 * node + 1]} ${nodes[3 * node + 2]}`;
    const known = first.get(place);
    if (known === undefined) first.set(place, node);
    origins[node] = known ?? node;
  }
  return first.size < origins.length ? origins : null;
}

/** Tells which triangles of a torn sheet are on different sides of a tear. */
export class TornSheet {
  /** For each triangle those that share an edge with it: of the torn sheet, and of the sheet before it tore. */
  private readonly torn: number[][];
  private readonly whole: number[][];
  /** 1 for the nodes at the ends of torn edges. */
  private readonly isAtTear: Uint8Array;
  private readonly known = new Map<number, boolean>();

  constructor(
    private readonly triangles: Uint32Array,
    origins: Uint32Array,
  ) {
    this.torn = neighbours(triangles);
    this.whole = neighbours(triangles.map((node) => origins[node]!));
    this.isAtTear = this.endsOfTears(origins);
  }

  /** Whether a tear lies between two triangles: the way from one to the other over their edges is longer than before it. */
  isAcross(s: number, t: number): boolean {
    if (s === t || this.shareWholeNode(s, t)) return false;
    const key = Math.min(s, t) * this.whole.length + Math.max(s, t);
    let across = this.known.get(key);
    if (across === undefined) this.known.set(key, (across = this.isLonger(s, t)));
    return across;
  }

  private isLonger(s: number, t: number): boolean {
    const seenWhole = new Set([s]);
    const seenTorn = new Set([s]);
    for (let whole = [s], torn = [s]; whole.length > 0;) {
      whole = step(whole, seenWhole, this.whole);
      torn = step(torn, seenTorn, this.torn);
      if (seenWhole.has(t)) return !seenTorn.has(t);
    }
    return false;
  }

  /** Around a node that no tear touches nothing is separated. */
  private shareWholeNode(s: number, t: number): boolean {
    const { triangles, isAtTear } = this;
    for (let i = 3 * s; i < 3 * s + 3; ++i)
      for (let k = 3 * t; k < 3 * t + 3; ++k) if (triangles[i] === triangles[k] && !isAtTear[triangles[i]!]) return true;
    return false;
  }

  private endsOfTears(origins: Uint32Array): Uint8Array {
    const { triangles } = this;
    const isEnd = new Uint8Array(origins.length);
    this.whole.forEach((list, t) => {
      const lost = list.filter((other) => !this.torn[t]!.includes(other));
      for (const other of lost) {
        const places = [0, 1, 2].map((k) => origins[triangles[3 * other + k]!]!);
        for (let i = 3 * t; i < 3 * t + 3; ++i) if (places.includes(origins[triangles[i]!]!)) isEnd[triangles[i]!] = 1;
      }
    });
    return isEnd;
  }
}

/** One step from the newest triangles to those beside them. */
function step(newest: readonly number[], seen: Set<number>, beside: readonly number[][]): number[] {
  const next: number[] = [];
  for (const t of newest)
    for (const other of beside[t]!) {
      if (seen.has(other)) continue;
      seen.add(other);
      next.push(other);
    }
  return next;
}

function neighbours(triangles: Uint32Array): number[][] {
  const byEdge = new Map<number, number[]>();
  for (let i = 0; i < triangles.length; ++i) {
    const key = edgeKey(triangles[i]!, triangles[i % 3 === 2 ? i - 2 : i + 1]!);
    const list = byEdge.get(key);
    if (list) list.push(Math.floor(i / 3));
    else byEdge.set(key, [Math.floor(i / 3)]);
  }
  const beside: number[][] = Array.from({ length: triangles.length / 3 }, () => []);
  for (const list of byEdge.values()) for (const t of list) for (const other of list) if (other !== t) beside[t]!.push(other);
  return beside;
}

function edgeKey(a: number, b: number): number {
  return Math.min(a, b) * EDGE_KEY_STEP + Math.max(a, b);
}

/** A drawn geometry that is cut along the tears, and for each vertex the triangle of the sheet that carries it. */
export interface CutGeometry {
  geometry: BufferGeometry;
  elements: number[];
}

/**
 * Cuts a drawn geometry along the tears of the sheet that carries it. `nearest`: for each vertex the nearest triangle of the sheet.
 * Null where no tear crosses it.
 */
export function cutAlongTears(geometry: BufferGeometry, nearest: ArrayLike<number>, finder: ElementFinder, sheet: TornSheet): CutGeometry | null {
  const cutter = new Cutter(geometry, Array.from(nearest), finder, sheet);
  const triangles = cutter.cut(geometry.index!.array);
  return cutter.hasCut ? { geometry: geometryOf(cutter.attributes, triangles), elements: cutter.elements } : null;
}

class Cutter {
  readonly attributes;
  private readonly positions: number[];
  /** Number of vertices before any was added. */
  private readonly count: number;
  /** For each drawn edge that crosses a tear the vertex there; -1 where the crossing is at an end. */
  private readonly points = new Map<number, number>();
  /** For each vertex its copies on other sides. */
  private readonly copies = new Map<number, number[]>();
  private readonly weights = new Float32Array(4);

  constructor(
    geometry: BufferGeometry,
    /** For each vertex the triangle of the sheet that carries it. */
    readonly elements: number[],
    private readonly finder: ElementFinder,
    private readonly sheet: TornSheet,
  ) {
    this.attributes = numbersOf(geometry);
    this.positions = this.attributes.get("position")!.values;
    this.count = this.positions.length / 3;
  }

  get hasCut(): boolean {
    return this.elements.length > this.count;
  }

  /** Divides the triangles at the tears, then puts each part on the side where its centroid is. */
  cut(triangles: ArrayLike<number>): number[] {
    const divided: number[] = [];
    const isCut = (a: number, b: number) => this.isAcross(a, b) && this.pointOn(a, b) >= 0;
    const point = (a: number, b: number) => this.pointOn(a, b);
    for (let i = 0; i < triangles.length; i += 3) divide(triangles[i]!, triangles[i + 1]!, triangles[i + 2]!, isCut, point, divided);
    for (let i = 0; i < divided.length; i += 3) this.separate(divided, i);
    return divided;
  }

  private separate(triangles: number[], i: number): void {
    const [a, b, c] = [triangles[i]!, triangles[i + 1]!, triangles[i + 2]!];
    const isAtTear = Math.max(a, b, c) >= this.count || this.isAcross(a, b) || this.isAcross(b, c) || this.isAcross(c, a);
    if (!isAtTear) return;
    const middle = [0, 1, 2].map((k) => (this.positions[3 * a + k]! + this.positions[3 * b + k]! + this.positions[3 * c + k]!) / 3);
    const t = this.finder.find(middle[0]!, middle[1]!, middle[2]!, this.weights);
    for (let k = i; k < i + 3; ++k) triangles[k] = this.onSideOf(triangles[k]!, t);
  }

  private isAcross(a: number, b: number): boolean {
    return this.sheet.isAcross(this.elements[a]!, this.elements[b]!);
  }

  /** The vertex, or a copy of it that is on the same side as this triangle of the sheet. */
  private onSideOf(v: number, t: number): number {
    const isElsewhere = (element: number) => this.sheet.isAcross(element, t);
    if (!isElsewhere(this.elements[v]!)) return v;
    const copies = this.copies.get(v) ?? [];
    const known = copies.find((copy) => !isElsewhere(this.elements[copy]!));
    if (known !== undefined) return known;
    const copy = this.add(v, v, 0, this.elementAt(v, v, 0, isElsewhere));
    this.copies.set(v, [...copies, copy]);
    return copy;
  }

  private pointOn(a: number, b: number): number {
    const key = edgeKey(a, b);
    let point = this.points.get(key);
    if (point === undefined) this.points.set(key, (point = this.addCrossing(Math.min(a, b), Math.max(a, b))));
    return point;
  }

  private addCrossing(a: number, b: number): number {
    let from = 0;
    let to = 1;
    for (let halving = 0; halving < HALVINGS; ++halving) {
      const share = (from + to) / 2;
      if (this.sheet.isAcross(this.elements[a]!, this.elementAt(a, b, share))) to = share;
      else from = share;
    }
    return to > NEAR_END && from < 1 - NEAR_END ? this.add(a, b, to, this.elementAt(a, b, to)) : -1;
  }

  private add(a: number, b: number, share: number, element: number): number {
    this.elements.push(element);
    return addBetween(this.attributes, a, b, share);
  }

  /** The triangle of the sheet that is nearest to a point between two vertices. */
  private elementAt(a: number, b: number, share: number, isLeftOut?: (t: number) => boolean): number {
    const [x, y, z] = [0, 1, 2].map((k) => (1 - share) * this.positions[3 * a + k]! + share * this.positions[3 * b + k]!) as [number, number, number];
    return this.finder.find(x, y, z, this.weights, isLeftOut);
  }
}
