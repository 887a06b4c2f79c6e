/** Pods: boxes at their places or on robots, coloured by what is asked. */

import { BoxGeometry, Color, PlaneGeometry } from "three";
import type { Pose } from "../data/motion";
import type { Run } from "../data/run";
import { type Bodies, bodies } from "./bodies";
import { amount, logShare, type Theme } from "./palette";
import type { Mode, Placement } from "./placement";
import { shaded, shadedMaterial } from "./shapes";

export type PodMode = "plain" | "fill" | "popularity" | "age";

/** Scales of the colours: units picked from a pod, and seconds since its last visit. */
export const POPULARITY = { least: 1, most: 300 };
export const AGE_S = { least: 60, most: 24 * 3600 };

const HEIGHT_M = 1.5;
const LEGS_M = 0.38;
const LIFTED_M = 0.08;
const SMALL = 0.4;
/** Every pod has its colour looked up once in so many frames. */
const FRAMES_PER_ROUND = 12;

export class PodBodies {
  readonly bodies: Bodies;
  private readonly side: number;
  private shrink = 1;
  /** The pod that was coloured last. */
  private next = 0;
  private readonly plain: Record<Theme, Color>;
  private readonly colour = new Color();
  private readonly shapes = {
    "2d": shaded(new PlaneGeometry(1, 1)),
    "3d": shaded(new BoxGeometry(1, 1, 1)),
  };
  /** Up to when the stored pods are drawn; NaN if all have to be drawn anew. */
  private drawn_us = Number.NaN;

  constructor(private readonly run: Run) {
    const { layout } = run;
    this.bodies = bodies(this.shapes["2d"], shadedMaterial(), layout.podWaypoint.length);
    this.side = Math.min(2 * layout.header.pod_radius_m, 0.85 * layout.pitch_m);
    const { light, dark } = layout.header.themes;
    this.plain = { light: new Color(light.pod), dark: new Color(dark.pod) };
  }

  /**
   * Gives the pods the shape of the plan or of space, small in a plan whose floor shows something;
   * they are drawn anew at the next occasion.
   */
  shape(mode: Mode, small: boolean): void {
    this.bodies.reshape(this.shapes[mode]);
    this.shrink = small && mode === "2d" ? SMALL : 1;
    this.drawn_us = Number.NaN;
  }

  /** Puts every pod where it is; only those that are carried or have moved are touched. */
  place(time_us: number, poses: Pose[], placement: Placement): void {
    const { places } = this.run;
    const put = (pod: number) => this.put(pod, time_us, poses, placement);
    if (Number.isNaN(this.drawn_us)) for (let pod = 0; pod < places.of.length; pod++) put(pod);
    else places.moved(this.drawn_us, time_us, put);
    for (const { pod } of poses) if (pod >= 0) put(pod);
    this.drawn_us = time_us;
  }

  /** Colours all pods, or only the next few: in turn, so that no frame takes long. */
  paint(time_us: number, mode: PodMode, theme: Theme, all: boolean): void {
    const count = this.run.layout.podWaypoint.length;
    if (mode === "plain" && !all) return;
    const few = Math.ceil(count / FRAMES_PER_ROUND);
    for (let n = all ? count : few; n > 0; n--) {
      this.next = (this.next + 1) % count;
      this.bodies.paint(this.next, this.colourOf(this.next, time_us, mode, theme));
    }
  }

  private put(pod: number, time_us: number, poses: Pose[], placement: Placement): void {
    const where = this.run.places.of[pod].at(time_us);
    if (where < 0) {
      const { x, y, z, shown } = placement.of(poses[-1 - where]);
      this.draw(pod, x, y, z + LIFTED_M, shown, placement);
      return;
    }
    const { x, y, tier } = this.run.layout;
    const floor = tier[where];
    const left = x[where] + placement.x[floor];
    this.draw(pod, left, y[where], placement.z[floor], placement.shown[floor], placement);
  }

  private draw(
    pod: number,
    x: number,
    y: number,
    floor: number,
    shown: boolean,
    placement: Placement,
  ): void {
    if (!shown) {
      this.bodies.hide(pod);
      return;
    }
    const flat = placement.mode === "2d";
    const z = floor + (flat ? 0.05 : LEGS_M + HEIGHT_M / 2);
    const height = flat ? 1 : HEIGHT_M;
    const side = this.side * this.shrink;
    this.bodies.place(pod, { x, y, z }, { x: side, y: side, z: height });
  }

  private colourOf(pod: number, time_us: number, mode: PodMode, theme: Theme): Color {
    const { stock } = this.run;
    if (mode === "plain") return this.plain[theme];
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
