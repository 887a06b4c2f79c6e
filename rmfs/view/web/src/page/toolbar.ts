/** The choices above the picture. */

import { ALL_TIERS } from "../draw/placement";
import { button, choice, h, tick } from "./dom";
import type { Store, ViewState } from "./state";

export interface Actions {
  screenshot(): void;
  copyLink(): void;
  help(): void;
  fit(): void;
  /** Opens the form that starts a run, where that is possible. */
  start?(): void;
}

type Key = "mode" | "robots" | "pods" | "heat";

const CHOICES: [Key, string, [string, string][]][] = [
  [
    "mode",
    "View",
    [
      ["2d", "plan (2D)"],
      ["3d", "space (3D)"],
    ],
  ],
  [
    "robots",
    "Robots by",
    [
      ["task", "task"],
      ["state", "state"],
      ["load", "load"],
      ["delay", "delay"],
      ["charge", "charge"],
    ],
  ],
  [
    "pods",
    "Pods by",
    [
      ["plain", "nothing"],
      ["fill", "fill"],
      ["popularity", "popularity"],
      ["age", "age of visit"],
    ],
  ],
  [
    "heat",
    "Heat map",
    [
      ["off", "off"],
      ["visits", "visits"],
      ["waiting", "waiting"],
    ],
  ],
];

/** Makes the toolbar; it follows the state. `comparable`: there are two runs on one floor. */
export function toolbar(
  store: Store,
  tiers: number,
  comparable: boolean,
  actions: Actions,
): HTMLElement {
  const follow: (() => void)[] = [];
  const root = h("header", { className: "toolbar" });
  for (const [key, label, options] of CHOICES) {
    const made = choice(label, options, (value) => store.set({ [key]: value }));
    made.select.id = `choose-${key}`;
    follow.push(() => {
      made.select.value = store.state[key];
    });
    root.append(made.root);
  }
  if (tiers > 1) {
    const numbers = Array.from({ length: tiers }, (_, n) => [String(n), `tier ${n}`] as const);
    const all = [[String(ALL_TIERS), "all"] as const, ...numbers];
    const made = choice("Tier", all, (value) => store.set({ tier: Number(value) }));
    made.select.id = "choose-tier";
    follow.push(() => {
      made.select.value = String(store.state.tier);
    });
    root.append(made.root);
  }
  const ticks: ["paths" | "zones" | "overlay", string][] = [
    ["paths", "paths ahead"],
    ["zones", "queue zones"],
    ...(comparable ? ([["overlay", "overlay: B − A"]] as ["overlay", string][]) : []),
  ];
  for (const [key, label] of ticks) {
    const made = tick(label, (on) => store.set({ [key]: on }));
    made.box.id = `tick-${key}`;
    follow.push(() => {
      made.box.checked = store.state[key];
    });
    root.append(made.root);
  }
  root.append(
    h("span", { className: "gap" }),
    button("fit", "Overlook everything (0)", actions.fit),
    button("theme", "Dark or light (d)", () => store.set({ theme: other(store.state) })),
    button("picture", "Save a screenshot (s)", actions.screenshot),
    button("link", "Copy a link to this very view (l)", actions.copyLink),
    button("?", "Keys (?)", actions.help),
  );
  if (actions.start) root.append(button("new run", "Start a run from a form", actions.start));
  const update = () => {
    for (const one of follow) one();
  };
  store.listen(update);
  update();
  return root;
}

function other(state: ViewState): ViewState["theme"] {
  return state.theme === "dark" ? "light" : "dark";
}
