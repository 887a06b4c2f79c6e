/** Where tiers are drawn: side by side in the plan, above each other in space, or one alone. */

import type { Layout } from "../data/layout";
import type { Pose } from "../data/motion";

export type Mode = "2d" | "3d";
export const ALL_TIERS = -1;

const GAP_M = 3;
/** Floors above each other are drawn so far apart, as a share of their depth, that one sees between. */
const APART = 0.35;

export class Placement {
  readonly x: number[];
  readonly z: number[];
  readonly shown: boolean[];
  /** Whether there is a floor above another. */
  readonly hasUpperFloors: boolean;
  /** Extent of what is drawn. */
  readonly box: { x: number; y: number; z: number; width: number; depth: number };

  constructor(
    layout: Layout,
    readonly mode: Mode,
    tier: number,
  ) {
    const tiers = layout.header.tiers;
    const alone = tier !== ALL_TIERS && tier < tiers.length;
    let along = 0;
    this.x = tiers.map(({ length_m }) => {
      const here = along;
      along += length_m + GAP_M;
      return mode === "2d" && !alone ? here : 0;
    });
    const apart_m = APART * Math.max(...tiers.map(({ width_m }) => width_m));
    this.z = tiers.map(({ height_m }, number) =>
      mode === "3d" && !alone ? Math.max(height_m, number * apart_m) : 0,
    );
    this.shown = tiers.map((_, number) => !alone || number === tier);
    this.hasUpperFloors = mode === "3d" && !alone && tiers.length > 1;
    const visible = tiers.map((size, number) => ({ size, number })).filter(this.isShown);
    const last = visible[visible.length - 1];
    const right = Math.max(...visible.map(({ size, number }) => this.x[number] + size.length_m));
    const depth = Math.max(...visible.map(({ size }) => size.width_m));
    this.box = { x: right / 2, y: depth / 2, z: this.z[last.number] / 2, width: right, depth };
  }

  private readonly isShown = ({ number }: { number: number }) => this.shown[number];

  /** Returns where a robot is drawn; its z is that of the floor it stands on. */
  of(pose: Pose): { x: number; y: number; z: number; shown: boolean } {
    const { x, y, tier, tierTo, ride } = pose;
    const near = ride < 0.5 ? tier : tierTo;
    const z = this.z[tier] + ride * (this.z[tierTo] - this.z[tier]);
    return { x: x + this.x[near], y, z, shown: this.shown[near] };
  }
}
