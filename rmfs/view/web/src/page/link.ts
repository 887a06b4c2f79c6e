/** The view in the address of the page, so that a link restores it. */

import { initialState, type Selection, type ViewState } from "./state";

const TEXTS = ["mode", "robots", "pods", "heat", "theme", "board", "grouping"] as const;
const NUMBERS = ["time_s", "speed", "tier", "from_s", "to_s"] as const;
const CHOSEN = ["robot", "pod", "station", "order"] as const;
const FLAGS = ["paths", "zones", "follow", "overlay"] as const;

const ALLOWED: Record<(typeof TEXTS)[number], readonly string[]> = {
  mode: ["2d", "3d"],
  robots: ["task", "state", "load", "delay", "charge"],
  pods: ["plain", "fill", "popularity", "age"],
  heat: ["off", "visits", "waiting"],
  theme: ["light", "dark"],
  board: ["stations", "orders"],
  grouping: ["order", "pod"],
};

/** Writes a state, and the cameras beside it, as the fragment of an address. */
export function toFragment(state: ViewState, cameras: number[][]): string {
  const words = new URLSearchParams();
  for (const name of [...TEXTS, ...NUMBERS]) words.set(name, String(state[name]));
  for (const name of FLAGS) words.set(name, state[name] ? "1" : "0");
  const { selection } = state;
  if (selection !== null)
    words.set("chosen", `${selection.run}.${selection.what}.${selection.index}`);
  const rounded = cameras.map((camera) =>
    camera.map((value) => Number(value.toFixed(3))).join("_"),
  );
  words.set("cameras", rounded.join("~"));
  return `#${words}`;
}

/** Reads a fragment; what it does not say, or says wrongly, is as at the beginning. */
export function fromFragment(
  fragment: string,
  begin_s: number,
  end_s: number,
): { state: ViewState; cameras: number[][] } {
  const words = new URLSearchParams(fragment.replace(/^#/, ""));
  const state = initialState(begin_s, end_s);
  // who was sent a link is to see what the sender saw
  if (words.has("time_s")) state.playing = false;
  for (const name of TEXTS) {
    const value = words.get(name);
    if (value !== null && ALLOWED[name].includes(value)) Object.assign(state, { [name]: value });
  }
  for (const name of NUMBERS) {
    const value = words.get(name);
    if (value !== null && Number.isFinite(Number(value))) state[name] = Number(value);
  }
  for (const name of FLAGS) if (words.has(name)) state[name] = words.get(name) === "1";
  state.selection = chosen(words.get("chosen"));
  const cameras = (words.get("cameras") ?? "")
    .split("~")
    .map((text) => text.split("_").map(Number));
  return {
    state,
    cameras: cameras.filter((camera) => camera.length >= 6 && camera.every(Number.isFinite)),
  };
}

function chosen(text: string | null): Selection | null {
  const [run, what, index] = (text ?? "").split(".");
  const chosen = CHOSEN.find((one) => one === what);
  return chosen === undefined ? null : { run: Number(run), what: chosen, index: Number(index) };
}
