/** Throughput, backlog, charge and robots by task over time, with a cursor at the present. */

import type { Course } from "../data/figures";
import type { Run } from "../data/run";
import { GROUND, robotColours, type Theme } from "../draw/palette";
import { clock, h } from "./dom";
import type { Store } from "./state";

const LINES = ["#0072B2", "#D55E00"];
const HEIGHT = 62;
const LEFT = 40;
const TOP = 6;
const BOTTOM = 14;

/** Distances of the marks of time, in seconds. */
const STEPS_S = [10, 30, 60, 300, 600, 1800, 3600, 7200, 14_400, 21_600, 43_200, 86_400];
const MOST_MARKS = 5;
const DAY_S = 86_400;

interface Chart {
  title: HTMLElement;
  canvas: HTMLCanvasElement;
  /** All but the cursor, drawn anew only when `drawn`, which says what it shows, is another. */
  ground: HTMLCanvasElement;
  drawn: string;
  draw(pen: CanvasRenderingContext2D, frame: Frame, theme: Theme): void;
  /** Says what is the case at a time. */
  tell(time_s: number): HTMLElement[];
}

interface Frame {
  width: number;
  end_s: number;
}

/** Makes the charts; `update` draws them anew. */
export function charts(
  store: Store,
  runs: Run[],
  end_s: () => number,
): { root: HTMLElement; update: () => void } {
  const made: Chart[] = [
    course(runs, "Throughput", "units/h", ({ unitsPerHour }) => unitsPerHour),
    course(runs, "Orders waiting", "for a station", ({ backlog }) => backlog),
    ...(runs.every((run) => run.robots.hasLevels)
      ? [course(runs, "Charge", "% in the mean", ({ charge }) => charge)]
      : []),
    ...runs.map((run, n) => tasks(run, runs.length > 1 ? ` of ${"AB"[n]}` : "")),
  ];
  const root = h("section", { className: "charts" });
  for (const { title, canvas } of made) {
    canvas.addEventListener("pointerdown", (event) => seek(event, canvas));
    canvas.addEventListener("pointermove", (event) => {
      if (event.buttons === 1) seek(event, canvas);
    });
    root.append(title, canvas);
  }
  const seek = (event: PointerEvent, canvas: HTMLCanvasElement) => {
    const frame = canvas.getBoundingClientRect();
    const share = (event.clientX - frame.left - LEFT) / (frame.width - LEFT);
    store.set({ time_s: Math.min(Math.max(share, 0), 1) * end_s() });
  };
  const update = () => {
    const { theme, time_s } = store.state;
    for (const one of made) {
      const frame = { width: one.canvas.clientWidth, end_s: end_s() };
      const pen = frame.width > 0 ? prepared(one, frame, theme) : null;
      if (pen === null) continue;
      pen.strokeStyle = "#E6007E";
      pen.lineWidth = 1.5;
      const x = across(frame, time_s);
      pen.strokeRect(x, TOP, 0.01, HEIGHT - TOP - BOTTOM);
      one.title.lastElementChild?.replaceChildren(...one.tell(time_s));
    }
  };
  return { root, update };
}

function chart(title: string, draw: Chart["draw"], tell: Chart["tell"]): Chart {
  const heading = h("h3", {}, h("span", {}, title), h("span", {}));
  const canvas = h("canvas", { ariaLabel: title });
  return { title: heading, canvas, ground: h("canvas"), drawn: "", draw, tell };
}

/** Makes a chart of one figure with a line per run. */
function course(
  runs: Run[],
  title: string,
  unit: string,
  values: (course: Course) => number[],
): Chart {
  const tell = (time_s: number) => {
    const told = runs.map((run, n) => {
      const known = run.course();
      const bin = Math.min(Math.floor((time_s * 1e6) / known.bin_us), values(known).length - 1);
      const now = values(known)[bin].toFixed(0);
      if (runs.length === 1) return h("span", {}, now);
      const line = h("b", {}, `${"AB"[n]} ${now}`);
      line.style.color = LINES[n];
      return line;
    });
    return [...told, h("span", {}, unit)];
  };
  const draw: Chart["draw"] = (pen, frame, theme) => lines(pen, frame, runs, theme, values);
  return chart(title, draw, tell);
}

/** Makes a chart of how many robots of a run have which task. */
function tasks(run: Run, name: string): Chart {
  const colours = robotColours(run.header, "task");
  const tell = (time_s: number) => {
    const count = run.robots.words.map(() => 0);
    for (const steps of run.robots.tasks) count[steps.at(time_s * 1e6).kind]++;
    return [...count.keys()]
      .filter((kind) => count[kind] > 0)
      .map((kind) => {
        const patch = h("i", {});
        patch.style.background = colours[kind];
        return h("span", {}, patch, `${count[kind]} ${run.robots.words[kind]}`);
      });
  };
  const draw: Chart["draw"] = (pen, frame, theme) => stacked(pen, frame, run, theme, colours);
  return chart(`Robots${name}`, draw, tell);
}

/** Returns a pen for a chart that shows everything but the cursor. */
function prepared(one: Chart, frame: Frame, theme: Theme): CanvasRenderingContext2D | null {
  const sharp = window.devicePixelRatio;
  const shown = [frame.width, frame.end_s, sharp, theme].join();
  const { canvas, ground } = one;
  if (one.drawn !== shown) {
    one.drawn = shown;
    for (const sheet of [canvas, ground]) {
      sheet.width = frame.width * sharp;
      sheet.height = HEIGHT * sharp;
      sheet.getContext("2d")?.scale(sharp, sharp);
    }
    const pen = ground.getContext("2d");
    if (pen !== null) one.draw(pen, frame, theme);
  }
  const pen = canvas.getContext("2d");
  pen?.clearRect(0, 0, frame.width, HEIGHT);
  pen?.drawImage(ground, 0, 0, frame.width, HEIGHT);
  return pen;
}

function across({ width, end_s }: Frame, time_s: number): number {
  return LEFT + ((width - LEFT - 1) * time_s) / Math.max(end_s, 1);
}

function lines(
  pen: CanvasRenderingContext2D,
  frame: Frame,
  runs: Run[],
  theme: Theme,
  values: (course: Course) => number[],
): void {
  const courses = runs.map((run) => run.course());
  const most = roundUp(Math.max(1, ...courses.flatMap(values)));
  axes(pen, frame, most, theme);
  courses.forEach((course, n) => {
    pen.strokeStyle = LINES[n % LINES.length];
    pen.lineWidth = 1.3;
    pen.beginPath();
    values(course).forEach((value, bin) => {
      const end_us = Math.min((bin + 1) * course.bin_us, runs[n].known_us);
      pen.lineTo(across(frame, end_us / 1e6), up(value / most));
    });
    pen.stroke();
  });
}

function stacked(
  pen: CanvasRenderingContext2D,
  frame: Frame,
  run: Run,
  theme: Theme,
  colours: string[],
): void {
  const { robots, bin_us } = run.course();
  const most = run.motion.robots;
  axes(pen, frame, most, theme);
  for (let bin = 0; bin < robots[0].length; bin++) {
    const from = across(frame, (bin * bin_us) / 1e6);
    const to = across(frame, Math.min((bin + 1) * bin_us, run.known_us) / 1e6);
    let below = 0;
    run.robots.words.forEach((_, task) => {
      const count = robots[task][bin];
      pen.fillStyle = colours[task];
      pen.fillRect(from, up((below + count) / most), to - from + 0.5, up(0) - up(count / most));
      below += count;
    });
  }
}

function up(share: number): number {
  return HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * share;
}

function axes(pen: CanvasRenderingContext2D, frame: Frame, most: number, theme: Theme): void {
  pen.clearRect(0, 0, frame.width, HEIGHT);
  pen.fillStyle = GROUND[theme].text;
  pen.strokeStyle = GROUND[theme].line;
  pen.lineWidth = 1;
  pen.font = "10px system-ui, sans-serif";
  pen.textAlign = "right";
  pen.fillText(String(most), LEFT - 4, TOP + 8);
  pen.fillText("0", LEFT - 4, HEIGHT - BOTTOM);
  const steps = STEPS_S.filter((step) => frame.end_s / step <= MOST_MARKS);
  const step_s = steps[0] ?? Math.ceil(frame.end_s / MOST_MARKS / DAY_S) * DAY_S;
  for (let time_s = 0; time_s <= frame.end_s; time_s += step_s) {
    const x = across(frame, time_s);
    pen.strokeRect(x, TOP, 0.01, HEIGHT - TOP - BOTTOM);
    const text = `${hours(time_s)} h`;
    const width = pen.measureText(text).width;
    pen.fillText(text, Math.min(x + width / 2, frame.width), HEIGHT - 2);
  }
  pen.strokeRect(LEFT, TOP, frame.width - LEFT - 1, HEIGHT - TOP - BOTTOM);
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
