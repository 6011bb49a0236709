// SPDX-License-Identifier: MIT
import { Matrix4, Quaternion, Vector3 } from "three";
import type { NewEntity } from "../connection/messages";
import type { Parts } from "../parts";
import type { Stance } from "./stance";
import type { TextPanel } from "./text_panel";
import { t, translateServerText } from "../language";

/** Surfaces of the real room become boxes so thick, m: thin ones would let fast things through. */
const THICKNESS = 0.1;
/** Smaller surfaces are left out, m². */
const LEAST_AREA = 0.04;
/** After so long in the room the user is asked, s: devices find surfaces one by one. */
const PATIENCE = 1;

interface Surface {
  name: string;
  matrix: Matrix4;
  /** Box around its outline in its own plane, m. */
  low: [number, number];
  high: [number, number];
}

/** Surfaces of the real room that the device found, as things that stand still in the scene: only where the user agrees. */
export class RealRoom {
  /** Entities that were added. */
  readonly indices: number[] = [];
  private surfaces: Surface[] = [];
  private asked = false;
  private age = 0;

  constructor(
    private readonly parts: Pick<Parts, "server" | "notices">,
    private readonly stance: Stance,
    private readonly ask: TextPanel,
  ) {}

  /** Call once a picture while the real room is seen. */
  update(frame: XRFrame, space: XRReferenceSpace | null, seconds: number): void {
    this.age += seconds;
    if (this.asked || this.age < PATIENCE || !space) return;
    this.surfaces = surfacesOf(frame, space);
    if (this.surfaces.length === 0) return;
    this.asked = true;
    const count = this.surfaces.length;
    const text = t("Your headset knows {{count}} surfaces of this room. As still things in the scene, what falls lands on your floor and table.", { count });
    this.ask.choose(t("Your real room"), text, [
      { id: "use-room", label: t("Use them"), run: () => void this.add() },
      { id: "skip-room", label: t("Leave them out"), run: () => {} },
    ]);
  }

  /** Adds the surfaces to the scene. */
  private async add(): Promise<void> {
    const { server } = this.parts;
    for (const surface of this.surfaces) {
      const added = await server.command("entity.add", { entity: this.entityOf(surface) });
      if (!added) return;
      this.indices.push(added.index);
    }
    // Locked where the server knows locks: hands don't take the real floor away.
    await server.request("entity.lock", { indices: this.indices, locked: true }).catch(() => {});
    this.parts.notices.tell({ level: "info", text: t("{{count}} surfaces of your room are in the scene", { count: this.indices.length }), remedy: t("When you leave you are asked whether they stay.") });
  }

  /** At the end: the surfaces stay in the scene, or go in one step of undo. */
  async end(keep: boolean): Promise<void> {
    const indices = this.indices.splice(0);
    if (keep || indices.length === 0) return;
    const { server } = this.parts;
    await server.request("entity.lock", { indices, locked: false }).catch(() => {});
    await server.command("entity.remove", { indices });
  }

  private entityOf({ name, matrix, low, high }: Surface): NewEntity {
    const { scale, origin } = this.stance;
    const middle = new Vector3((low[0] + high[0]) / 2, -THICKNESS / 2, (low[1] + high[1]) / 2);
    const place = middle.applyMatrix4(matrix).applyMatrix4(origin.matrixWorld);
    const rotation = new Quaternion().setFromRotationMatrix(matrix).premultiply(origin.quaternion);
    return {
      name,
      shape: { type: "box", half_extents: [(scale * (high[0] - low[0])) / 2, (scale * THICKNESS) / 2, (scale * (high[1] - low[1])) / 2] },
      pose: { position: place.toArray() as [number, number, number], rotation: rotation.toArray() as [number, number, number, number] },
      attributes: { kind: "static" },
    };
  }
}

/** The surfaces that the device knows now, in the user's room; a plane's own axis Y is its normal. */
function surfacesOf(frame: XRFrame, space: XRReferenceSpace): Surface[] {
  const surfaces: Surface[] = [];
  for (const plane of frame.detectedPlanes ?? []) {
    const pose = frame.getPose(plane.planeSpace, space);
    if (!pose) continue;
    const xs = plane.polygon.map(({ x }) => x);
    const zs = plane.polygon.map(({ z }) => z);
    const low: [number, number] = [Math.min(...xs), Math.min(...zs)];
    const high: [number, number] = [Math.max(...xs), Math.max(...zs)];
    if ((high[0] - low[0]) * (high[1] - low[1]) < LEAST_AREA) continue;
    const label = (plane as { semanticLabel?: string }).semanticLabel;
    const kind = label ?? (plane.orientation === "vertical" ? "wall" : "surface");
    surfaces.push({ name: t("Real {{kind}}", { kind: translateServerText(kind) }), matrix: new Matrix4().fromArray(pose.transform.matrix), low, high });
  }
  return surfaces;
}
