/** The layout that the form would build, drawn as it changes. */

import { decode } from "../data/container";
import { type Header, type Layout, readLayout } from "../data/layout";
import { faint, GROUND, type Theme } from "../draw/palette";
import { h } from "./dom";
import { ask } from "./sources";

/** Who types is done when nothing has come for so long. */
const PATIENCE_MS = 300;
const WIDTH_PX = 460;
const MOST_HEIGHT_PX = 420;
const GAP_M = 3;
const LABEL = "600 11px system-ui, sans-serif";

export class Preview {
  private readonly canvas = h("canvas", { role: "img", ariaLabel: "the layout" });
  private readonly words = h("p", { className: "counts" });
  private readonly wrong = h("p", { className: "wrong", role: "alert" });
  readonly root = h("figure", { id: "preview" }, this.canvas, this.words, this.wrong);
  private waiting: number | undefined;
  private asked = 0;

  /** Shows a layout with some values changed, as soon as no further change has come for a moment. */
  show(name: string, set: Record<string, unknown>): void {
    clearTimeout(this.waiting);
    this.waiting = window.setTimeout(() => void this.fetch(name, set), PATIENCE_MS);
  }

  /** Says why there is no picture of what is typed. */
  refuse(reason: unknown): void {
    clearTimeout(this.waiting);
    this.wrong.textContent = reason instanceof Error ? reason.message : String(reason);
    this.canvas.classList.add("stale");
  }

  private async fetch(name: string, set: Record<string, unknown>): Promise<void> {
    this.asked++;
    const mine = this.asked;
    try {
      const answer = await ask("preview", { layout: name, set });
      const layout = readLayout(decode<Header>(await answer.arrayBuffer()));
      // an answer that was overtaken is of no interest
      if (mine !== this.asked) return;
      draw(
        this.canvas,
        layout,
        document.documentElement.dataset.theme === "dark" ? "dark" : "light",
      );
      this.words.textContent = counts(layout);
      this.wrong.textContent = "";
      this.canvas.classList.remove("stale");
    } catch (reason) {
      if (mine === this.asked) this.refuse(reason);
    }
  }
}

/** Says in words how much of what there is. */
function counts({ header, podWaypoint, robotWaypoint, isStorage }: Layout): string {
  const kinds = new Map<string, number>();
  for (const { kind } of header.stations) kinds.set(kind, (kinds.get(kind) ?? 0) + 1);
  const places = isStorage.reduce((sum, is) => sum + is, 0);
  const sizes = header.tiers.map(
    ({ length_m, width_m }) => `${short(length_m)} × ${short(width_m)} m`,
  );
  return [
    header.tiers.length > 1 ? `${header.tiers.length} tiers of ${sizes[0]}` : sizes[0],
    `${robotWaypoint.length} robots`,
    `${podWaypoint.length} pods on ${places} storage locations`,
    ...[...kinds].map(([kind, count]) => `${count} ${kind} stations`),
  ].join(", ");
}

function short(length_m: number): string {
  return String(Number(length_m.toFixed(1)));
}

function draw(canvas: HTMLCanvasElement, layout: Layout, theme: Theme): void {
  const { header, x, y, tier, pitch_m } = layout;
  const colours = header.themes[theme];
  let along = 0;
  const left = header.tiers.map(({ length_m }) => {
    const here = along;
    along += length_m + GAP_M;
    return here;
  });
  const wide = along - GAP_M + 4;
  const deep = Math.max(...header.tiers.map(({ width_m }) => width_m)) + 2;
  const scale = Math.min(WIDTH_PX / wide, MOST_HEIGHT_PX / deep);
  const sharp = window.devicePixelRatio;
  canvas.width = Math.ceil(wide * scale * sharp);
  canvas.height = Math.ceil(deep * scale * sharp);
  canvas.style.width = `${Math.ceil(wide * scale)}px`;
  const pen = canvas.getContext("2d");
  if (pen === null) return;
  pen.setTransform(sharp, 0, 0, sharp, 0, 0);
  const across = (v: number) => (2 + left[tier[v]] + x[v]) * scale;
  const down = (v: number) => (deep - 1 - y[v]) * scale;
  const square = (v: number, side_m: number) => {
    const side = side_m * scale;
    pen.fillRect(across(v) - side / 2, down(v) - side / 2, side, side);
  };
  const disc = (v: number, radius_m: number) => {
    pen.beginPath();
    pen.arc(across(v), down(v), Math.max(radius_m * scale, 1.5), 0, 2 * Math.PI);
    pen.fill();
  };
  pen.fillStyle = GROUND[theme].floor;
  header.tiers.forEach(({ length_m, width_m }, number) => {
    const top = (deep - 1 - width_m) * scale;
    pen.fillRect((2 + left[number]) * scale, top, length_m * scale, width_m * scale);
  });
  const kinds: [Uint8Array, string][] = [
    [layout.isStorage, faint(colours.pod, theme).getStyle()],
    [layout.isQueue, faint(header.colours.queue_zone, theme).getStyle()],
  ];
  for (const [is, colour] of kinds) {
    pen.fillStyle = colour;
    for (let v = 0; v < x.length; v++) if (is[v]) square(v, 0.9 * pitch_m);
  }
  pen.fillStyle = colours.pod;
  for (const v of layout.podWaypoint) square(v, 0.75 * pitch_m);
  pen.fillStyle = colours.elevator;
  for (const v of header.elevators.flat()) square(v, 0.9 * pitch_m);
  pen.font = LABEL;
  pen.textAlign = "center";
  header.stations.forEach(({ letter, waypoint }, number) => {
    pen.fillStyle = colours.stations[number];
    disc(waypoint, 0.8);
    pen.fillStyle = GROUND[theme].text;
    pen.fillText(`${letter}${number}`, across(waypoint), down(waypoint) - 7);
  });
  pen.fillStyle = colours.task.park;
  for (const v of layout.robotWaypoint) disc(v, 0.35);
}
