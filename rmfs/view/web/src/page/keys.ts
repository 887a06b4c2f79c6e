/** The keyboard. */

import { ALL_TIERS } from "../draw/placement";
import { h } from "./dom";
import { SPEEDS, type Store } from "./state";

export interface Commands {
  toggle(): void;
  screenshot(): void;
  copyLink(): void;
  fit(): void;
  next(): void;
  help(): void;
  /** Lets a time be typed. */
  time(): void;
}

export const KEYS: [string, string][] = [
  ["space", "play, pause"],
  ["← →", "10 s back, forward (with Shift 60 s)"],
  [", .", "0.1 s back, forward"],
  ["+ −", "faster, slower"],
  ["Home End", "start, end"],
  ["g", "type a time: 10:35 (h:mm), 0:10:35 (h:mm:ss) or seconds"],
  ["o", "orders or stations"],
  ["2 3", "plan, space"],
  ["t", "next tier"],
  ["r p h", "robots by, pods by, heat map"],
  ["w q", "paths ahead, queue zones"],
  ["f n Esc", "follow, next event, choose nothing"],
  ["0", "overlook everything"],
  ["d s l ?", "dark or light, screenshot, link, this list"],
];

const CYCLES = {
  r: ["robots", ["task", "state", "load", "delay", "charge"]],
  p: ["pods", ["plain", "fill", "popularity", "age"]],
  h: ["heat", ["off", "visits", "waiting"]],
} as const;

export function listen(store: Store, commands: Commands, tiers: number, end_s: () => number): void {
  const seek = (by_s: number) => {
    store.set({ time_s: Math.min(Math.max(store.state.time_s + by_s, 0), end_s()) });
  };
  const faster = (by: number) => {
    const place = SPEEDS.indexOf(store.state.speed) + by;
    store.set({ speed: SPEEDS[Math.min(Math.max(place, 0), SPEEDS.length - 1)] });
  };
  const cycle = (key: keyof typeof CYCLES) => {
    const [name, values] = CYCLES[key];
    const place = (values as readonly string[]).indexOf(store.state[name]);
    store.set({ [name]: values[(place + 1) % values.length] });
  };
  const tier = () => {
    const next = store.state.tier + 1;
    store.set({ tier: next < tiers ? next : ALL_TIERS });
  };
  const actions: Record<string, (event: KeyboardEvent) => void> = {
    " ": commands.toggle,
    ArrowLeft: ({ shiftKey }) => seek(shiftKey ? -60 : -10),
    ArrowRight: ({ shiftKey }) => seek(shiftKey ? 60 : 10),
    ",": () => seek(-0.1),
    ".": () => seek(0.1),
    "+": () => faster(1),
    "-": () => faster(-1),
    Home: () => store.set({ time_s: 0 }),
    End: () => store.set({ time_s: end_s() }),
    "2": () => store.set({ mode: "2d" }),
    "3": () => store.set({ mode: "3d" }),
    t: tier,
    r: () => cycle("r"),
    p: () => cycle("p"),
    h: () => cycle("h"),
    w: () => store.set({ paths: !store.state.paths }),
    q: () => store.set({ zones: !store.state.zones }),
    f: () => store.set({ follow: !store.state.follow }),
    n: commands.next,
    Escape: () => store.set({ selection: null, follow: false }),
    "0": commands.fit,
    d: () => store.set({ theme: store.state.theme === "dark" ? "light" : "dark" }),
    s: commands.screenshot,
    l: commands.copyLink,
    "?": commands.help,
    g: commands.time,
    o: () => {
      const board = store.state.board === "orders" ? "stations" : "orders";
      store.set({ board, selection: null });
    },
  };
  window.addEventListener("keydown", (event) => {
    const { target, ctrlKey, metaKey, altKey } = event;
    const typing =
      target instanceof HTMLElement && target.matches("input, select, textarea, button");
    const action = actions[event.key];
    if (typing || ctrlKey || metaKey || altKey || action === undefined) return;
    event.preventDefault();
    action(event);
  });
}

/** Makes the list of keys. */
export function keyList(): HTMLDialogElement {
  const close = h("button", { textContent: "close" });
  const rows = KEYS.map(([keys, meaning]) =>
    h("tr", {}, h("td", {}, h("kbd", {}, keys)), h("td", {}, meaning)),
  );
  const drag = h(
    "p",
    {},
    "Drag to move, wheel to zoom; in space right button to move. Click on anything.",
  );
  const dialog = h("dialog", {}, h("h2", {}, "Keys"), h("table", {}, ...rows), drag, close);
  close.addEventListener("click", () => dialog.close());
  return dialog;
}
