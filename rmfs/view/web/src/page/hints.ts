/** What is under the mouse, in a few words beside it. */

import { Plane, type Ray, Vector3 } from "three";
import type { Layout } from "../data/layout";
import { STATES } from "../data/robots";
import type { Placement } from "../draw/placement";
import { clock, h } from "./dom";
import { queues } from "./overview";
import type { Pane } from "./pane";
import type { Selection, ViewState } from "./state";

/** While time goes on, what is under a mouse that rests is looked at anew so often. */
const AGAIN_MS = 200;
const BESIDE_PX = 14;

/** The words beside the mouse. */
export class Hint {
  readonly root = h("div", { className: "hint", hidden: true });
  private at: [number, number] | undefined;
  private looked_ms = Number.NEGATIVE_INFINITY;

  /** `told` says what is at a point of the page. */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly told: (clientX: number, clientY: number) => string,
  ) {
    canvas.addEventListener("pointermove", ({ clientX, clientY, buttons, pointerType }) => {
      this.at = buttons === 0 && pointerType !== "touch" ? [clientX, clientY] : undefined;
      this.looked_ms = Number.NEGATIVE_INFINITY;
      requestAnimationFrame((now_ms) => this.update(now_ms));
    });
    canvas.addEventListener("pointerleave", () => {
      this.at = undefined;
      this.root.hidden = true;
    });
  }

  update(now_ms: number): void {
    if (this.at === undefined) {
      this.root.hidden = true;
      return;
    }
    if (now_ms - this.looked_ms < AGAIN_MS) return;
    this.looked_ms = now_ms;
    const text = this.told(...this.at);
    this.root.hidden = text === "";
    if (this.root.textContent !== text) this.root.textContent = text;
    const frame = this.canvas.getBoundingClientRect();
    const [x, y] = [this.at[0] - frame.left, this.at[1] - frame.top];
    const { offsetWidth, offsetHeight, style } = this.root;
    const left =
      x + BESIDE_PX + offsetWidth > frame.width ? x - BESIDE_PX - offsetWidth : x + BESIDE_PX;
    const top =
      y + BESIDE_PX + offsetHeight > frame.height ? y - BESIDE_PX - offsetHeight : y + BESIDE_PX;
    style.left = `${Math.max(left, 0)}px`;
    style.top = `${Math.max(top, 0)}px`;
  }
}

/** Says what a robot, pod or station is about. */
export function hintOf(pane: Pane, { what, index }: Selection, time_us: number): string {
  const { run, poses } = pane;
  if (what === "robot") {
    const pose = poses[index];
    const { kind, station } = run.robots.tasks[index].at(time_us);
    const towards = station >= 0 ? ` for ${nameOf(run.layout, station)}` : "";
    const load = pose.pod >= 0 ? `, carries pod ${pose.pod}` : "";
    const state = STATES[run.robots.state(index, time_us, pose)];
    return `robot ${index}: ${run.robots.words[kind]}${towards}, ${state}${load}`;
  }
  if (what === "pod") {
    const units = run.stock.contents(index, time_us).reduce((sum, [, count]) => sum + count, 0);
    const fill = (100 * run.stock.fill(index, time_us)).toFixed(0);
    const age = run.stock.wasVisited(index, time_us)
      ? `, last visit ${clock(run.stock.age_s(index, time_us))} h ago`
      : "";
    return `pod ${index}: ${units} units, ${fill} % full${age}`;
  }
  const { handles, order_slots } = run.header.stations[index];
  const figures = run.stations.figures(index, time_us);
  const orders = `, ${run.orders.countOpen(index, time_us)} of ${order_slots} orders`;
  const open = order_slots > 0 ? orders : "";
  const queue = queues(pane)[index].length;
  return `${nameOf(run.layout, index)}${open}, ${figures.perHour.toFixed(0)} ${handles} per h, ${queue} in its queue`;
}

/** Says what a place on the floor is. */
export function hintOfWaypoint(
  { run, counts }: Pane,
  waypoint: number,
  { heat, overlay }: Pick<ViewState, "heat" | "overlay">,
): string {
  const { layout } = run;
  const kinds = [
    ...(layout.isStorage[waypoint] ? ["storage location"] : []),
    ...(layout.isQueue[waypoint] ? ["queue"] : []),
    ...(layout.header.elevators.flat().includes(waypoint) ? ["elevator"] : []),
  ];
  const kind = kinds.length > 0 ? `, ${kinds.join(", ")}` : "";
  const tier = layout.header.tiers.length > 1 ? `, tier ${layout.tier[waypoint]}` : "";
  const count = heat === "off" ? undefined : counts?.[waypoint];
  const words = heat === "visits" ? "visits" : "s waited";
  const seen =
    count === undefined ? "" : `, ${count.toFixed(0)} ${words}${overlay ? " (B − A)" : ""}`;
  return `waypoint ${waypoint}${kind}${tier}${seen}`;
}

/** Returns the waypoint that a ray points at; -1 if it meets none. */
export function waypointUnder(layout: Layout, placement: Placement, ray: Ray): number {
  const meets = new Vector3();
  let found = -1;
  let away = Number.POSITIVE_INFINITY;
  placement.shown.forEach((shown, tier) => {
    const floor = new Plane(new Vector3(0, 0, 1), -placement.z[tier]);
    if (!shown || ray.intersectPlane(floor, meets) === null) return;
    const near = nearest(layout, tier, meets.x - placement.x[tier], meets.y);
    const distance = ray.origin.distanceTo(meets);
    if (near < 0 || distance >= away) return;
    found = near;
    away = distance;
  });
  return found;
}

function nearest({ x, y, tier, pitch_m }: Layout, on: number, px: number, py: number): number {
  let found = -1;
  let least = (0.6 * pitch_m) ** 2;
  for (let v = 0; v < x.length; v++) {
    const square = (x[v] - px) ** 2 + (y[v] - py) ** 2;
    if (square < least && tier[v] === on) {
      least = square;
      found = v;
    }
  }
  return found;
}

function nameOf({ header }: Layout, station: number): string {
  return `${header.stations[station].letter}${station}`;
}
