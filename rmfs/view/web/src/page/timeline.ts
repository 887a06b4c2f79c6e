/** Playing, seeking, speed, and the window of the heat map. */

import { button, choice, clock, h } from "./dom";
import { SPEEDS, type Store, type ViewState } from "./state";

/** Makes the timeline; `end_s` says how far it reaches, which grows in a live run. */
export function timeline(
  store: Store,
  warmup_s: number,
  end_s: () => number,
  live?: HTMLElement,
): HTMLElement {
  const play = button("▶", "Play or pause (space)", () => toggle(store, end_s()));
  play.id = "play";
  const slider = h("input", { type: "range", min: "0", step: "any", id: "seek" });
  slider.ariaLabel = "time";
  slider.addEventListener("input", () => store.set({ time_s: Number(slider.value) }));
  const now = timeField(store, end_s);
  const whole = h("output", { id: "now" });
  const speeds = SPEEDS.map((speed) => [String(speed), `${speed}×`] as const);
  const speed = choice("speed", speeds, (value) => store.set({ speed: Number(value) }));
  speed.select.id = "speed";
  const span = heatWindow(store, warmup_s, end_s);
  const root = h(
    "footer",
    { className: "timeline" },
    play,
    slider,
    now.root,
    whole,
    speed.root,
    span,
  );
  if (live) root.prepend(live);
  const update = () => {
    const { state } = store;
    const end = end_s();
    play.textContent = state.playing ? "❚❚" : "▶";
    slider.max = String(end);
    slider.value = String(state.time_s);
    now.update();
    whole.textContent = `/ ${clock(end)} h${state.time_s < warmup_s ? " (warm-up)" : ""}`;
    speed.select.value = String(state.speed);
    span.hidden = state.heat === "off";
  };
  store.listen(update);
  update();
  return root;
}

/** Makes the field that shows the time, and goes to the one that is typed. */
function timeField(store: Store, end_s: () => number) {
  const root = h("input", { type: "text", id: "time", size: 8, title: "Type a time (g)" });
  root.ariaLabel = "time to go to";
  const update = () => {
    if (document.activeElement !== root) root.value = clock(store.state.time_s);
  };
  root.addEventListener("focus", () => root.select());
  root.addEventListener("blur", update);
  root.addEventListener("keydown", ({ key }) => {
    if (key === "Escape") root.value = "";
    if (key === "Escape" || key === "Enter") root.blur();
  });
  root.addEventListener("change", () => {
    const time_s = readTime(root.value, end_s());
    if (time_s !== undefined) store.set({ time_s, playing: false });
  });
  return { root, update };
}

/**
 * Reads a time: h:mm:ss, seconds, or h:mm; the latter is taken as m:ss where the run does not last
 * so long. Returns nothing if it is no time of the run.
 */
export function readTime(text: string, end_s: number): number | undefined {
  const parts = text.trim().split(":");
  if (!parts.every((part) => /^\d+(\.\d+)?$/.test(part)) || parts.length > 3) return undefined;
  const [first, second = 0, third = 0] = parts.map(Number);
  if (parts.length === 1) return Math.min(first, end_s);
  const hours_s = 3600 * first + 60 * second + third;
  const minutes_s = 60 * first + second;
  const time_s = parts.length === 2 && hours_s > end_s ? minutes_s : hours_s;
  return Math.min(time_s, end_s);
}

/** Plays or pauses; at the end it begins again. */
export function toggle(store: Store, end_s: number): void {
  const { playing, time_s } = store.state;
  const over = !playing && time_s >= end_s;
  store.set({ playing: !playing, ...(over ? { time_s: 0 } : {}) });
}

const SPANS: [string, string][] = [
  ["", "heat window…"],
  ["all", "whole run"],
  ["measured", "measured time"],
  ["300", "last 5 min"],
  ["3600", "last hour"],
];

function heatWindow(store: Store, warmup_s: number, end_s: () => number): HTMLElement {
  const field = (key: "from_s" | "to_s", label: string) => {
    const input = h("input", { type: "number", min: "0", step: "60", id: `heat-${key}` });
    input.addEventListener("change", () => store.set({ [key]: Number(input.value) }));
    store.listen(() => {
      input.value = String(Math.round(store.state[key]));
    });
    input.value = String(Math.round(store.state[key]));
    return h("label", {}, h("span", {}, label), input, " s");
  };
  const spans = choice("", SPANS, (value) => {
    store.set(spanOf(value, store.state, warmup_s, end_s()));
    spans.select.value = "";
  });
  return h(
    "span",
    { className: "window" },
    spans.root,
    field("from_s", "from"),
    field("to_s", "to"),
  );
}

function spanOf(
  value: string,
  { time_s }: ViewState,
  warmup_s: number,
  end_s: number,
): Partial<ViewState> {
  if (value === "all") return { from_s: 0, to_s: end_s };
  if (value === "measured") return { from_s: warmup_s, to_s: end_s };
  return { from_s: Math.max(time_s - Number(value), 0), to_s: time_s };
}
