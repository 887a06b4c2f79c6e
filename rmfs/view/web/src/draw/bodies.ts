/** Many bodies of one shape in one draw call, each with its place, size and colour. */

import type { BufferAttribute, BufferGeometry, Color, Material, Mesh, Raycaster } from "three";
import { inSoftware } from "./graphics";
import { Instances } from "./instances";
import { Merged } from "./merged";

export interface Triple {
  x: number;
  y: number;
  z: number;
}

export interface Struck {
  index: number;
  away: number;
}

export interface Bodies {
  readonly mesh: Mesh;
  /** Gives all bodies another shape; they have to be placed anew. */
  reshape(shape: BufferGeometry): void;
  /** Puts a body somewhere, turned about the vertical and stretched. */
  place(index: number, at: Triple, size: Triple, heading?: number): void;
  /** Makes a body vanish until it is placed again. */
  hide(index: number): void;
  /** Gives a body a colour; one it has already costs nothing. */
  paint(index: number, colour: Color): void;
  /** Returns the nearest body on a ray and how far it is, if there is any. */
  struck(ray: Raycaster): Struck | undefined;
}

/** Makes bodies in the way that suits what draws. */
export function bodies(shape: BufferGeometry, material: Material, count: number): Bodies {
  return inSoftware() ? new Merged(shape, material, count) : new Instances(shape, material, count);
}

/** If a greater share of an attribute has changed, all of it is sent to the graphics at once. */
const MOST_RANGES = 0.25;

/** Marks `size` numbers of one body to be sent to the graphics before the next frame. */
export function changed(attribute: BufferAttribute, index: number, size: number): void {
  attribute.needsUpdate = true;
  const { updateRanges, array } = attribute;
  if (updateRanges.length > (MOST_RANGES * array.length) / size) {
    attribute.clearUpdateRanges();
    attribute.addUpdateRange(0, array.length);
  } else if (updateRanges.length !== 1 || updateRanges[0].count !== array.length) {
    attribute.addUpdateRange(size * index, size);
  }
}
