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
  const now = h("output", { id: "now" });
  const speeds = SPEEDS.map((speed) => [String(speed), `${speed}×`] as const);
  const speed = choice("speed", speeds, (value) => store.set({ speed: Number(value) }));
  speed.select.id = "speed";
  const span = heatWindow(store, warmup_s, end_s);
  const root = h("footer", { className: "timeline" }, play, slider, now, speed.root, span);
  if (live) root.prepend(live);
  const update = () => {
    const { state } = store;
    const end = end_s();
    play.textContent = state.playing ? "❚❚" : "▶";
    slider.max = String(end);
    slider.value = String(state.time_s);
    now.textContent = `${clock(state.time_s)} / ${clock(end)} h${state.time_s < warmup_s ? " (warm-up)" : ""}`;
    speed.select.value = String(state.speed);
    span.hidden = state.heat === "off";
  };
  store.listen(update);
  update();
  return root;
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
