/** The heat map: a square per waypoint, on a logarithmic scale. */

import { Color, MeshBasicMaterial, PlaneGeometry } from "three";
import type { Run } from "../data/run";
import { type Bodies, bodies } from "./bodies";
import { amount, logShare, type Theme } from "./palette";
import type { Placement } from "./placement";

const DECADES = 4;

export interface Range {
  least: number;
  most: number;
}

export class HeatSquares {
  readonly squares: Bodies;
  private readonly colour = new Color();

  constructor(private readonly run: Run) {
    const { x, pitch_m } = run.layout;
    const square = new PlaneGeometry(pitch_m, pitch_m);
    this.squares = bodies(square, new MeshBasicMaterial(), x.length);
    this.squares.mesh.visible = false;
  }

  /** Draws counts per waypoint on a scale; waypoints without any stay empty. */
  draw(counts: Float64Array, range: Range, placement: Placement, theme: Theme): void {
    const { x, y, tier } = this.run.layout;
    const size = { x: 1, y: 1, z: 1 };
    counts.forEach((count, v) => {
      if (!(count > 0) || !placement.shown[tier[v]]) {
        this.squares.hide(v);
        return;
      }
      const at = { x: x[v] + placement.x[tier[v]], y: y[v], z: placement.z[tier[v]] + 0.005 };
      this.squares.place(v, at, size);
      const share = logShare(count, range.least, range.most);
      this.squares.paint(v, amount(share, theme, this.colour));
    });
  }
}

/** Returns the least and the greatest of all counts above zero, not more than `DECADES` apart. */
export function rangeOf(tables: Float64Array[]): Range {
  let least = Number.POSITIVE_INFINITY;
  let most = 0;
  for (const counts of tables) {
    for (const count of counts) {
      if (count > 0 && count < least) least = count;
      if (count > most) most = count;
    }
  }
  return { least: Math.max(Math.min(least, most), most / 10 ** DECADES), most };
}
