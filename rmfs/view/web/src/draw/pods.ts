/** Pods: boxes at their places or on robots, coloured by what is asked. */

import { BoxGeometry, Color, MeshLambertMaterial } from "three";
import type { Pose } from "../data/motion";
import type { Run } from "../data/run";
import { Instances } from "./instances";
import { amount, logShare, type Theme } from "./palette";
import type { Placement } from "./placement";

export type PodMode = "plain" | "fill" | "popularity" | "age";

/** Scales of the colours: units picked from a pod, and seconds since its last visit. */
export const POPULARITY = { least: 1, most: 300 };
export const AGE_S = { least: 60, most: 24 * 3600 };

const HEIGHT_M = 1.5;
const LEGS_M = 0.38;
const LIFTED_M = 0.08;

export class PodBodies {
  readonly bodies: Instances;
  private readonly side: number;
  private readonly plain: Color;
  private readonly colour = new Color();
  /** Where each pod was drawn last; NaN if it has to be drawn anew. */
  private readonly drawn: Float64Array;

  constructor(private readonly run: Run) {
    const { layout } = run;
    const count = layout.podWaypoint.length;
    const box = new BoxGeometry(1, 1, 1);
    this.bodies = new Instances(box, new MeshLambertMaterial(), count);
    this.side = Math.min(2 * layout.header.pod_radius_m, 0.85 * layout.pitch_m);
    this.plain = new Color(layout.header.colours.storage);
    this.drawn = new Float64Array(count).fill(Number.NaN);
  }

  /** Draws all pods anew at the next occasion. */
  forget(): void {
    this.drawn.fill(Number.NaN);
  }

  /** Puts every pod where it is; only those that are carried or have moved are touched. */
  place(time_us: number, poses: Pose[], placement: Placement): void {
    const { layout, places } = this.run;
    places.of.forEach((steps, pod) => {
      const where = steps.at(time_us);
      if (where < 0) {
        const { x, y, z, shown } = placement.of(poses[-1 - where]);
        this.put(pod, { x, y, z: z + LIFTED_M }, shown, placement);
        this.drawn[pod] = Number.NaN;
      } else if (this.drawn[pod] !== where) {
        const tier = layout.tier[where];
        const at = { x: layout.x[where] + placement.x[tier], y: layout.y[where] };
        this.put(pod, { ...at, z: placement.z[tier] }, placement.shown[tier], placement);
        this.drawn[pod] = where;
      }
    });
  }

  paint(time_us: number, mode: PodMode, theme: Theme): void {
    const { podWaypoint } = this.run.layout;
    for (let pod = 0; pod < podWaypoint.length; pod++) {
      this.bodies.paint(pod, this.colourOf(pod, time_us, mode, theme));
    }
  }

  private put(
    pod: number,
    floor: { x: number; y: number; z: number },
    shown: boolean,
    placement: Placement,
  ): void {
    if (!shown) {
      this.bodies.hide(pod);
      return;
    }
    const flat = placement.mode === "2d";
    const height = flat ? 0.05 : HEIGHT_M;
    const z = floor.z + (flat ? 0.05 : LEGS_M + HEIGHT_M / 2);
    this.bodies.place(pod, { ...floor, z }, { x: this.side, y: this.side, z: height });
  }

  private colourOf(pod: number, time_us: number, mode: PodMode, theme: Theme): Color {
    const { stock } = this.run;
    if (mode === "plain") return this.plain;
    return amount(share(stock, pod, time_us, mode), theme, this.colour);
  }
}

function share(stock: Run["stock"], pod: number, time_us: number, mode: PodMode): number {
  if (mode === "fill") return stock.fill(pod, time_us);
  if (mode === "popularity") {
    return logShare(stock.picked[pod].at(time_us), POPULARITY.least, POPULARITY.most);
  }
  return logShare(stock.age_s(pod, time_us), AGE_S.least, AGE_S.most);
}
