/** Throughput, backlog, charge and robots by task over time, drawn by uPlot; a click seeks. */

import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import type { Course } from "../data/figures";
import type { Run } from "../data/run";
import { GROUND, LINES, robotColours } from "../draw/palette";
import { clock, h } from "./dom";
import type { Store } from "./state";

const HEIGHT = 46;
/** What the lowest chart has below it for the times. */
const TIMES = 18;
const LEFT = 38;

/** Distances of the marks of time, in seconds. */
const STEPS_S = [10, 30, 60, 300, 600, 1800, 3600, 7200, 14_400, 21_600, 43_200, 86_400];
const MARK_PX = 70;
const DAY_S = 86_400;

type Pen = (plot: uPlot) => string;

interface Chart {
  root: HTMLElement;
  title: HTMLElement;
  plot: uPlot;
  cursor: HTMLElement;
  data(): uPlot.AlignedData;
  /** Says what is the case at a time. */
  tell(time_s: number): HTMLElement[];
}

interface Part {
  title: string;
  scale: (u: uPlot, least: number, most: number) => [number, number];
  series: uPlot.Series[];
  data: Chart["data"];
  tell: Chart["tell"];
}

/** Makes the charts; `update` draws them anew. */
export function charts(
  store: Store,
  runs: Run[],
  end_s: () => number,
): { root: HTMLElement; update: () => void } {
  const text: Pen = () => GROUND[store.state.theme].text;
  const grid: Pen = () => GROUND[store.state.theme].line;
  const lines = (_: uPlot, n: number) => LINES[store.state.theme][n - 1];
  const parts: Part[] = [
    course(runs, "Throughput", "units/h", ({ unitsPerHour }) => unitsPerHour, lines),
    course(runs, "Orders waiting", "for a station", ({ backlog }) => backlog, lines),
    ...(runs.every((run) => run.robots.hasLevels)
      ? [course(runs, "Charge", "% in the mean", ({ charge }) => charge, lines)]
      : []),
    ...runs.map((run, n) => tasks(store, run, runs.length > 1 ? ` of ${"AB"[n]}` : "")),
  ];
  const root = h("div", { className: "charts" });
  let hovered_s: number | undefined;
  const hover = (time_s: number | undefined) => {
    hovered_s = time_s;
    for (const one of made) say(one);
  };
  const seek = (time_s: number) => store.set({ time_s: Math.min(Math.max(time_s, 0), end_s()) });
  const made = parts.map((part, n) => {
    const last = n === parts.length - 1;
    return chart(part, { text, grid, last, end_s, seek, hover });
  });
  const say = ({ title, tell }: Chart) => {
    const time_s = Math.min(hovered_s ?? store.state.time_s, end_s());
    const at = hovered_s === undefined ? [] : [h("em", {}, `at ${clock(time_s)} h`)];
    title.lastElementChild?.replaceChildren(...at, ...tell(time_s));
  };
  root.append(...made.map((one) => one.root));
  let shown = "";
  const update = () => {
    const width = root.clientWidth;
    if (width === 0) return;
    const state = [width, end_s(), store.state.theme].join();
    for (const one of made) {
      if (state !== shown) {
        one.plot.setSize({ width, height: one.plot.height });
        one.plot.setData(one.data());
      }
      const x = one.plot.valToPos(store.state.time_s, "x");
      one.cursor.style.transform = `translateX(${x.toFixed(1)}px)`;
      say(one);
    }
    shown = state;
  };
  new ResizeObserver(update).observe(root);
  return { root, update };
}

interface Frame {
  text: Pen;
  grid: Pen;
  last: boolean;
  end_s: () => number;
  seek(time_s: number): void;
  hover(time_s: number | undefined): void;
}

function chart({ title, scale, series, data, tell }: Part, frame: Frame): Chart {
  const { text, grid, last, end_s, seek, hover } = frame;
  const heading = h("h3", {}, h("span", {}, title), h("span", {}));
  const inside = h("div", { ariaLabel: title, role: "img" });
  const axis = { stroke: text, font: "10px system-ui, sans-serif", ticks: { show: false } };
  const height = HEIGHT + (last ? TIMES : 0);
  const plot = new uPlot(
    {
      width: 300,
      height,
      padding: [7, 19, last ? 0 : 3, 0],
      legend: { show: false },
      cursor: { y: false, points: { show: false }, drag: { x: false, y: false } },
      scales: { x: { time: false, range: () => [0, Math.max(end_s(), 1)] }, y: { range: scale } },
      axes: [
        {
          ...axis,
          grid: { stroke: grid, width: 1 },
          size: last ? TIMES : 0,
          gap: 2,
          splits: (u) => marks(end_s(), u.bbox.width / devicePixelRatio),
          values: (_, times) => times.map((time_s) => (last ? `${hours(time_s)} h` : "")),
        },
        {
          ...axis,
          grid: { show: false },
          size: LEFT,
          gap: 4,
          splits: (_, __, ___, most) => [most],
        },
      ],
      series: [{}, ...series],
    },
    data(),
    inside,
  );
  const cursor = h("i", { className: "present" });
  plot.over.append(cursor);
  const timeOf = ({ clientX }: PointerEvent) =>
    plot.posToVal(clientX - plot.over.getBoundingClientRect().left, "x");
  plot.over.addEventListener("pointerdown", (event) => seek(timeOf(event)));
  plot.over.addEventListener("pointermove", (event) => {
    if (event.buttons === 1) seek(timeOf(event));
    hover(Math.max(timeOf(event), 0));
  });
  plot.over.addEventListener("pointerleave", () => hover(undefined));
  return { root: h("div", {}, heading, inside), title: heading, plot, cursor, data, tell };
}

/** Makes a chart of one figure with a line per run. */
function course(
  runs: Run[],
  title: string,
  unit: string,
  values: (course: Course) => number[],
  stroke: (u: uPlot, n: number) => string,
): Part {
  const tell = (time_s: number) => {
    const told = runs.map((run, n) => {
      const known = run.course();
      const bin = Math.min(Math.floor((time_s * 1e6) / known.bin_us), values(known).length - 1);
      const now = values(known)[bin].toFixed(0);
      return runs.length === 1
        ? h("span", {}, now)
        : h("b", { className: `run-${"ab"[n]}` }, `${"AB"[n]} ${now}`);
    });
    return [...told, h("span", {}, unit)];
  };
  const data = (): uPlot.AlignedData => {
    const tables = runs.map((run): uPlot.AlignedData => [ends(run), values(run.course())]);
    return tables.length === 1 ? tables[0] : uPlot.join(tables);
  };
  const series = runs.map(() => ({ stroke, width: 1.3, points: { show: false }, spanGaps: true }));
  const scale = (_: uPlot, __: number, most: number): [number, number] => [
    0,
    roundUp(Math.max(most, 1)),
  ];
  return { title, scale, series, data, tell };
}

/** Makes a chart of how many robots of a run have which task, one above the other. */
function tasks(store: Store, run: Run, name: string): Part {
  const { words } = run.robots;
  const colour = (task: number) => robotColours(run.header, "task", store.state.theme)[task];
  const tell = (time_s: number) => {
    const count = words.map(() => 0);
    for (const steps of run.robots.tasks) count[steps.at(time_s * 1e6).kind]++;
    return [...count.keys()]
      .filter((kind) => count[kind] > 0)
      .map((kind) => {
        const patch = h("i", {});
        patch.style.background = colour(kind);
        return h("span", {}, patch, `${count[kind]} ${words[kind]}`);
      });
  };
  // the sums of all tasks up to one, the greatest first: each is drawn over the one before
  const order = [...words.keys()].reverse();
  const data = (): uPlot.AlignedData => {
    const { robots } = run.course();
    const times = [0, ...ends(run)];
    const sums = order.map((upTo) =>
      times.map((_, n) =>
        robots.slice(0, upTo + 1).reduce((sum, counts) => sum + counts[Math.max(n - 1, 0)], 0),
      ),
    );
    return [times, ...sums];
  };
  const stepped = uPlot.paths.stepped?.({ align: -1 });
  const series = order.map((task) => ({
    fill: () => colour(task),
    width: 0,
    points: { show: false },
    ...(stepped === undefined ? {} : { paths: stepped }),
  }));
  return { title: `Robots${name}`, scale: () => [0, run.motion.robots], series, data, tell };
}

/** Returns when the bins of a run end, in seconds. */
function ends(run: Run): number[] {
  const { bin_us, backlog } = run.course();
  return backlog.map((_, bin) => Math.min((bin + 1) * bin_us, run.known_us) / 1e6);
}

/** Returns marks of time that leave room for their texts. */
function marks(end_s: number, width_px: number): number[] {
  const most = Math.max(Math.floor(width_px / MARK_PX), 2);
  const step_s =
    STEPS_S.find((step) => end_s / step <= most) ?? Math.ceil(end_s / most / DAY_S) * DAY_S;
  return Array.from({ length: Math.floor(end_s / step_s) + 1 }, (_, n) => n * step_s);
}

/** Writes a time as short as can be. */
function hours(time_s: number): string {
  return clock(time_s).replace(/:00$/, "");
}

/** Returns the next greater number of one digit, or of two whose second is a 5, that leaves room. */
function roundUp(value: number): number {
  const power = 10 ** Math.floor(Math.log10(value));
  const digits = [1, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10];
  const nice = digits.find((digit) => digit * power >= 1.04 * value) ?? 12;
  return Math.ceil(nice * power);
}
