/** What is known of the chosen robot, pod or station, now and before. */

import { tell } from "../data/events";
import { STATES, TASKS } from "../data/robots";
import { button, clock, h } from "./dom";
import type { Pane } from "./pane";
import type { Chosen, Selection, Store } from "./state";

const HISTORY = 12;
const CONTENTS = 8;

type Rows = [string, string][];

/** Makes the panel; `update` fills it anew. */
export function panel(store: Store, panes: Pane[]): { root: HTMLElement; update: () => void } {
  const root = h("section", { className: "details" });
  const update = () => {
    const { selection } = store.state;
    if (selection === null) root.replaceChildren(...overview(store, panes));
    else root.replaceChildren(...details(store, panes[selection.run], selection));
  };
  return { root, update };
}

/** Returns the time of the next event of what is chosen. */
export function nextEvent(store: Store, panes: Pane[]): void {
  const { selection, time_s } = store.state;
  if (selection === null) return;
  const { events } = panes[selection.run].run;
  const next = events.after(selection.what, selection.index, time_s * 1e6 + 1);
  if (next !== undefined) store.set({ time_s: next.time_us / 1e6 });
}

function overview(store: Store, panes: Pane[]): HTMLElement[] {
  return panes.flatMap(({ run }, number) => {
    const time_us = store.state.time_s * 1e6;
    const rows = run.header.stations.map((station, index) => {
      const figures = run.stations.figures(index, time_us);
      const name = `${station.kind === "pick" ? "P" : "R"}${index}`;
      const row = h(
        "tr",
        { title: "Choose this station" },
        h(
          "td",
          {},
          button(name, "Choose", () => choose(store, number, "station", index)),
        ),
        h("td", {}, station.order_slots > 0 ? `${figures.openOrders}/${station.order_slots}` : ""),
        h("td", {}, figures.perHour.toFixed(0)),
        h("td", {}, `${(100 * figures.idleShare).toFixed(0)} %`),
        h("td", {}, String(queue(panes[number], index).length)),
      );
      if (!figures.active) row.className = "off";
      return row;
    });
    const heads = ["", "open orders", "units, bundles/h", "idle", "queue"];
    return [
      h("h2", {}, `Stations${panes.length > 1 ? ` of ${"AB"[number]}` : ""}`),
      h("table", {}, h("tr", {}, ...heads.map((text) => h("th", {}, text))), ...rows),
    ];
  });
}

function details(store: Store, pane: Pane, selection: Selection): HTMLElement[] {
  const { what, index, run } = selection;
  const { state } = store;
  const time_us = state.time_s * 1e6;
  const rows = { robot: robotRows, pod: podRows, station: stationRows }[what](pane, index, time_us);
  const history = pane.run.events.before(what, index, time_us, HISTORY);
  const buttons = [
    button("close", "Choose nothing (Esc)", () => store.set({ selection: null, follow: false })),
    button("next event", "Go to its next event (n)", () => nextEvent(store, [pane])),
  ];
  if (what !== "station") {
    const text = state.follow ? "stop following" : "follow";
    buttons.push(
      button(text, "Keep it in the middle (f)", () => store.set({ follow: !state.follow })),
    );
  }
  return [
    h("h2", {}, `${what} ${index}`),
    h("div", { className: "buttons" }, ...buttons),
    h("dl", {}, ...rows.flatMap(([name, value]) => [h("dt", {}, name), h("dd", {}, value)])),
    h("h3", {}, "History"),
    h(
      "ol",
      {},
      ...history.map((one) => {
        const at = button(clock(one.time_us / 1e6), "Go there", () =>
          store.set({ time_s: one.time_us / 1e6 }),
        );
        return h("li", {}, at, ` ${tell(one, what)}`);
      }),
    ),
  ].map((element) => {
    element.dataset.run = String(run);
    return element;
  });
}

function choose(store: Store, run: number, what: Chosen, index: number): void {
  store.set({ selection: { run, what, index } });
}

function robotRows({ run, poses }: Pane, robot: number, time_us: number): Rows {
  const pose = poses[robot];
  const task = run.robots.tasks[robot].at(time_us);
  const towards = task.station >= 0 ? ` for station ${task.station}` : "";
  return [
    ["task", `${TASKS[task.kind]}${towards}`],
    ["state", STATES[run.robots.state(robot, time_us, pose)]],
    ["carries", pose.pod >= 0 ? `pod ${pose.pod}` : "nothing"],
    ["waited in this task", `${run.robots.delay_s(robot, time_us).toFixed(1)} s`],
    ["place", `x ${pose.x.toFixed(2)} m, y ${pose.y.toFixed(2)} m, tier ${pose.tier}`],
  ];
}

function podRows({ run }: Pane, pod: number, time_us: number): Rows {
  const where = run.places.of[pod].at(time_us);
  const contents = run.stock.contents(pod, time_us);
  const used = run.stock.used[pod].at(time_us);
  const shown = contents.slice(0, CONTENTS).map(([sku, units]) => `${units} × SKU ${sku}`);
  if (contents.length > CONTENTS) shown.push(`${contents.length - CONTENTS} SKUs more`);
  return [
    ["place", where < 0 ? `on robot ${-1 - where}` : `waypoint ${where}`],
    [
      "space used",
      `${used.toFixed(1)} of ${run.layout.podCapacity[pod]} units (${(100 * run.stock.fill(pod, time_us)).toFixed(0)} %)`,
    ],
    ["units picked so far", String(run.stock.picked[pod].at(time_us))],
    [
      "last visit",
      run.stock.wasVisited(pod, time_us)
        ? `${clock(run.stock.age_s(pod, time_us))} h ago`
        : "none so far",
    ],
    ["holds", shown.join(", ") || "nothing"],
  ];
}

function stationRows(pane: Pane, station: number, time_us: number): Rows {
  const { kind, order_slots } = pane.run.header.stations[station];
  const figures = pane.run.stations.figures(station, time_us);
  const rows: Rows = [
    ["kind", `${kind} station${figures.active ? "" : " (switched off)"}`],
    [
      kind === "pick" ? "units picked" : "bundles stored",
      `${figures.perHour.toFixed(0)} per h (last hour)`,
    ],
    ["idle share", `${(100 * figures.idleShare).toFixed(1)} % (last hour)`],
    [
      "in its queue",
      queue(pane, station)
        .map((robot) => `robot ${robot}`)
        .join(", ") || "nobody",
    ],
  ];
  if (kind === "pick")
    rows.splice(1, 0, ["open orders", `${figures.openOrders} of ${order_slots}`]);
  return rows;
}

/** Returns the robots that stand or drive within the places of a station's queue. */
function queue({ run, poses }: Pane, station: number): number[] {
  const places = new Set(run.header.stations[station].queue);
  const { tracks } = run.motion;
  return poses.flatMap((pose, robot) =>
    tracks[robot].count > 0 && places.has(tracks[robot].from[pose.row]) ? [robot] : [],
  );
}
