// SPDX-License-Identifier: MIT
import { Color, EdgesGeometry, Group, LineBasicMaterial, LineSegments, Matrix4, Mesh, MeshBasicMaterial, Quaternion, Vector3 } from "three";
import type { Shape } from "../connection/scene_types";
import { disposeDrawable, type Drawable } from "./drawable";
import type { EntityView } from "./entity_view";
import { drawShape } from "./shapes";

const ONE = new Vector3(1, 1, 1);
const OPACITY = 0.35;
/** Edges between faces that turn by more than this are drawn, degrees. */
const EDGE_ANGLE = 12;

interface Shown {
  index: number;
  drawable: Drawable;
  pieces: { object: Mesh | LineSegments; local: Matrix4 }[];
}

/** Collision shapes, drawn over the picture: each convex part in a colour of its own. */
export class CollisionOverlay {
  readonly group = new Group();
  private shown: Shown[] = [];
  private readonly matrix = new Matrix4();
  private readonly position = new Vector3();
  private readonly rotation = new Quaternion();

  constructor(private readonly entities: EntityView) {}

  /** Draws exactly these shapes; a shape is in its entity's frame, with the entity's scale applied. */
  show(shapes: readonly { index: number; shape: Shape }[]): void {
    for (const { drawable, pieces } of this.shown) {
      for (const { object } of pieces) {
        if (object instanceof LineSegments) object.geometry.dispose();
        (object.material as MeshBasicMaterial | LineBasicMaterial).dispose();
      }
      disposeDrawable(drawable);
    }
    this.group.clear();
    this.shown = shapes.map(({ index, shape }) => this.draw(index, shape));
  }

  /** Number of convex parts that are drawn. */
  get parts(): number {
    return this.shown.reduce((sum, { drawable }) => sum + drawable.parts.length, 0);
  }

  /** Moves the shapes to the entities' present poses. */
  update(now: number): void {
    for (const { index, pieces } of this.shown) {
      const drawn = this.entities.matrixOf(index, now, this.matrix);
      // The shape has the scale already.
      if (drawn) {
        this.matrix.decompose(this.position, this.rotation, new Vector3());
        this.matrix.compose(this.position, this.rotation, ONE);
      }
      for (const { object, local } of pieces) {
        object.visible = drawn;
        object.matrixWorld.multiplyMatrices(this.matrix, local);
      }
    }
  }

  private draw(index: number, shape: Shape): Shown {
    const drawable = drawShape(shape);
    const pieces = drawable.parts.flatMap((part, at) => {
      const color = new Color().setHSL((0.08 + at * 0.381966) % 1, 0.75, 0.5);
      const face = new MeshBasicMaterial({ color, transparent: true, opacity: OPACITY, depthTest: false, depthWrite: false });
      const line = new LineBasicMaterial({ color, depthTest: false, transparent: true });
      return [
        { object: this.place(new Mesh(part.geometry, face), 990), local: part.matrix },
        { object: this.place(new LineSegments(new EdgesGeometry(part.geometry, EDGE_ANGLE), line), 991), local: part.matrix },
      ];
    });
    return { index, drawable, pieces };
  }

  private place<Piece extends Mesh | LineSegments>(object: Piece, order: number): Piece {
    object.matrixAutoUpdate = false;
    object.matrixWorldAutoUpdate = false;
    object.frustumCulled = false;
    object.renderOrder = order;
    object.raycast = () => {};
    this.group.add(object);
    return object;
  }
}
