/** What is known of the chosen robot, pod or station, now and before. */

import { tell } from "../data/events";
import { STATES } from "../data/robots";
import { button, clock, h } from "./dom";
import { overview, queues } from "./overview";
import type { Pane } from "./pane";
import type { Selection, Store } from "./state";

const HISTORY = 12;
const CONTENTS = 8;

type Rows = [string, string][];

/** Makes the panel; `update` brings it to the present. */
export function panel(store: Store, panes: Pane[]): { root: HTMLElement; update: () => void } {
  const root = h("section", { className: "details" });
  const all = overview(store, panes);
  const update = () => {
    const { selection } = store.state;
    if (selection !== null) {
      root.replaceChildren(...details(store, panes[selection.run], selection));
      return;
    }
    if (all.root.parentElement !== root) root.replaceChildren(all.root);
    all.update();
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

function robotRows({ run, poses }: Pane, robot: number, time_us: number): Rows {
  const pose = poses[robot];
  const task = run.robots.tasks[robot].at(time_us);
  const towards = task.station >= 0 ? ` for station ${task.station}` : "";
  const charge = `${(100 * run.robots.levels[robot].at(time_us)).toFixed(0)} %`;
  return [
    ["task", `${run.robots.words[task.kind]}${towards}`],
    ["state", STATES[run.robots.state(robot, time_us, pose)]],
    ["carries", pose.pod >= 0 ? `pod ${pose.pod}` : "nothing"],
    ["waited in this task", `${run.robots.delay_s(robot, time_us).toFixed(1)} s`],
    ...(run.robots.hasLevels ? [["battery", charge] as [string, string]] : []),
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
  const { kind, handles, order_slots, transfer_s } = pane.run.header.stations[station];
  const figures = pane.run.stations.figures(station, time_us);
  const rows: Rows = [
    ["kind", `${kind} station${figures.active ? "" : " (switched off)"}`],
    [handles, `${figures.perHour.toFixed(0)} per h (last hour)`],
    [
      "in its queue",
      queues(pane)
        [station].map((robot) => `robot ${robot}`)
        .join(", ") || "nobody",
    ],
  ];
  if (transfer_s > 0)
    rows.splice(2, 0, ["idle share", `${(100 * figures.idleShare).toFixed(1)} % (last hour)`]);
  if (order_slots > 0)
    rows.splice(1, 0, ["open orders", `${figures.openOrders} of ${order_slots}`]);
  return rows;
}
