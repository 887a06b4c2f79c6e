/** The heat map: a square per waypoint, on a logarithmic scale. */

import { Color, MeshBasicMaterial, PlaneGeometry } from "three";
import type { Run } from "../data/run";
import { type Bodies, bodies } from "./bodies";
import { amount, logShare, signed, type Theme } from "./palette";
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
    this.lay(counts, placement, (count) =>
      amount(logShare(count, range.least, range.most), theme, this.colour),
    );
  }

  /** Draws differences per waypoint: more in run A in its colour, more in run B in that of B. */
  drawDifference(
    differences: Float64Array,
    most: number,
    placement: Placement,
    theme: Theme,
  ): void {
    this.lay(differences, placement, (difference) =>
      signed(differenceShare(difference, most), theme, this.colour),
    );
  }

  private lay(values: Float64Array, placement: Placement, colour: (value: number) => Color): void {
    const { x, y, tier } = this.run.layout;
    const size = { x: 1, y: 1, z: 1 };
    values.forEach((value, v) => {
      if (value === 0 || !placement.shown[tier[v]]) {
        this.squares.hide(v);
        return;
      }
      const at = { x: x[v] + placement.x[tier[v]], y: y[v], z: placement.z[tier[v]] + 0.005 };
      this.squares.place(v, at, size);
      this.squares.paint(v, colour(value));
    });
  }
}

/** Returns where a difference is on a scale that is logarithmic to both sides, -1 to 1. */
export function differenceShare(difference: number, most: number): number {
  return (Math.sign(difference) * Math.log1p(Math.abs(difference))) / Math.log1p(most);
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
