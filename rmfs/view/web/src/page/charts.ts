/** Throughput, backlog and robots by task over time, with a cursor at the present. */

import type { Course } from "../data/figures";
import { TASKS } from "../data/robots";
import type { Run } from "../data/run";
import { GROUND, TASK_COLOURS, type Theme } from "../draw/palette";
import { clock, h } from "./dom";
import type { Store } from "./state";

const LINES = ["#0072B2", "#D55E00"];
const HEIGHT = 84;
const LEFT = 40;
const TOP = 6;
const BOTTOM = 14;

interface Chart {
  title: string;
  canvas: HTMLCanvasElement;
  draw(pen: CanvasRenderingContext2D, frame: Frame, runs: Run[], theme: Theme): void;
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
    chart("Throughput (units/h)", (pen, frame, all, theme) =>
      lines(pen, frame, all, theme, (course) => course.unitsPerHour),
    ),
    chart("Orders waiting for a station", (pen, frame, all, theme) =>
      lines(pen, frame, all, theme, (course) => course.backlog),
    ),
    ...runs.map((run, n) =>
      chart(`Robots by task${runs.length > 1 ? ` in ${"AB"[n]}` : ""}`, (pen, frame, _, theme) =>
        stacked(pen, frame, run, theme),
      ),
    ),
  ];
  const root = h("section", { className: "charts" }, h("h2", {}, "Course"));
  if (runs.length > 1) root.append(h("p", {}, "A blue, B red"));
  for (const { title, canvas } of made) {
    canvas.addEventListener("pointerdown", (event) => seek(event, canvas));
    canvas.addEventListener("pointermove", (event) => {
      if (event.buttons === 1) seek(event, canvas);
    });
    root.append(h("h3", {}, title), canvas);
  }
  const seek = (event: PointerEvent, canvas: HTMLCanvasElement) => {
    const frame = canvas.getBoundingClientRect();
    const share = (event.clientX - frame.left - LEFT) / (frame.width - LEFT);
    store.set({ time_s: Math.min(Math.max(share, 0), 1) * end_s() });
  };
  const update = () => {
    const { theme, time_s } = store.state;
    for (const { canvas, draw } of made) {
      const pen = prepared(canvas);
      if (pen === null) continue;
      const frame = { width: canvas.clientWidth, end_s: end_s() };
      draw(pen, frame, runs, theme);
      pen.strokeStyle = "#E6007E";
      const x = across(frame, time_s);
      pen.strokeRect(x, TOP, 0.01, HEIGHT - TOP - BOTTOM);
    }
  };
  return { root, update };
}

function chart(title: string, draw: Chart["draw"]): Chart {
  return { title, canvas: h("canvas", { ariaLabel: title }), draw };
}

function prepared(canvas: HTMLCanvasElement): CanvasRenderingContext2D | null {
  const sharp = window.devicePixelRatio;
  const width = canvas.clientWidth;
  if (width === 0) return null;
  canvas.width = width * sharp;
  canvas.height = HEIGHT * sharp;
  const pen = canvas.getContext("2d");
  pen?.scale(sharp, sharp);
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
  const most = Math.max(1, ...courses.flatMap(values));
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

function stacked(pen: CanvasRenderingContext2D, frame: Frame, run: Run, theme: Theme): void {
  const { robots, bin_us } = run.course();
  const most = run.motion.robots;
  axes(pen, frame, most, theme);
  for (let bin = 0; bin < robots[0].length; bin++) {
    const from = across(frame, (bin * bin_us) / 1e6);
    const to = across(frame, Math.min((bin + 1) * bin_us, run.known_us) / 1e6);
    let below = 0;
    TASKS.forEach((_, task) => {
      const count = robots[task][bin];
      pen.fillStyle = TASK_COLOURS[task];
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
  pen.fillText(most.toFixed(0), LEFT - 4, TOP + 8);
  pen.fillText("0", LEFT - 4, HEIGHT - BOTTOM);
  pen.fillText(`${clock(frame.end_s)} h`, frame.width, HEIGHT - 3);
  pen.strokeRect(LEFT, TOP, frame.width - LEFT - 1, HEIGHT - TOP - BOTTOM);
}
