/** What is known of the chosen robot, pod, station or order, now and before. */

import { tell } from "../data/events";
import { STATES } from "../data/robots";
import { chooser, due, grouping, stationOrders, whereabouts } from "./board";
import { button, clock, h } from "./dom";
import { queues } from "./overview";
import type { Pane } from "./pane";
import type { Selection, Store } from "./state";
import { lineTile, tile } from "./tiles";

const HISTORY = 12;

type Rows = [string, string | HTMLElement][];

/** What is said of one thing: rows of names and values, and what follows them. */
interface Said {
  rows: Rows;
  more: HTMLElement[];
}

/** Returns the time of the next event of what is chosen. */
export function nextEvent(store: Store, panes: Pane[]): void {
  const { selection, time_s } = store.state;
  if (selection === null) return;
  const { events } = panes[selection.run].run;
  const next = events.after(selection.what, selection.index, time_s * 1e6 + 1);
  if (next !== undefined) store.set({ time_s: next.time_us / 1e6 });
}

/** Returns all that is said of what is chosen. */
export function details(store: Store, pane: Pane, selection: Selection): HTMLElement[] {
  const { what, index } = selection;
  const { state } = store;
  const time_us = state.time_s * 1e6;
  const { rows, more } = OF[what](store, pane, selection, time_us);
  const history = pane.run.events.before(what, index, time_us, HISTORY);
  const buttons = [
    button("next event", "Go to its next event (n)", () => nextEvent(store, [pane])),
    button("close", "Choose nothing (Esc)", () => store.set({ selection: null, follow: false })),
  ];
  if (what === "robot" || what === "pod") {
    const text = state.follow ? "stop following" : "follow";
    buttons.unshift(
      button(text, "Keep it in the middle (f)", () => store.set({ follow: !state.follow })),
    );
  }
  return [
    h("div", { className: "title" }, h("h2", {}, `${what} ${index}`), ...buttons),
    h(
      "dl",
      { className: what },
      ...rows.flatMap(([name, value]) => [h("dt", {}, name), h("dd", {}, value)]),
    ),
    ...more,
    h("h3", {}, "History"),
    h(
      "ol",
      {},
      ...history.map((one) => {
        const at = button(clock(one.time_us / 1e6), "Go there", () =>
          store.set({ time_s: one.time_us / 1e6 }),
        );
        return h("li", {}, at, h("span", {}, tell(one, what)));
      }),
    ),
  ];
}

type Teller = (store: Store, pane: Pane, chosen: Selection, time_us: number) => Said;

const ofRobot: Teller = (store, { run, poses }, { run: number, index: robot }, time_us) => {
  const pose = poses[robot];
  const task = run.robots.tasks[robot].at(time_us);
  const towards = task.station >= 0 ? ` for station ${task.station}` : "";
  const charge = `${(100 * run.robots.levels[robot].at(time_us)).toFixed(0)} %`;
  const carries = pose.pod >= 0 ? chooser(store, number, "pod", pose.pod) : "nothing";
  return {
    rows: [
      ["task", `${run.robots.words[task.kind]}${towards}`],
      ["state", STATES[run.robots.state(robot, time_us, pose)]],
      ["carries", carries],
      ["waited in this task", `${run.robots.delay_s(robot, time_us).toFixed(1)} s`],
      ...(run.robots.hasLevels ? ([["battery", charge]] as Rows) : []),
      ["place", `x ${pose.x.toFixed(2)} m, y ${pose.y.toFixed(2)} m, tier ${pose.tier}`],
    ],
    more: [],
  };
};

const ofPod: Teller = (store, pane, { run: number, index: pod }, time_us) => {
  const { run } = pane;
  const where = run.places.of[pod].at(time_us);
  const used = run.stock.used[pod].at(time_us);
  const share = (100 * run.stock.fill(pod, time_us)).toFixed(0);
  const place = where < 0 ? chooser(store, number, "robot", -1 - where) : `waypoint ${where}`;
  const age = `${clock(run.stock.age_s(pod, time_us))} h ago`;
  const contents = run.stock.contents(pod, time_us);
  const units = contents.reduce((sum, [, count]) => sum + count, 0);
  const waiting = waitingFor(pane, pod, time_us).map(([order, sku, count]) =>
    h(
      "span",
      { className: "wanted" },
      chooser(store, number, "order", order, `#${order}`),
      tile(run.header, sku, count),
    ),
  );
  return {
    rows: [
      ["place", place],
      ["space used", `${used.toFixed(1)} of ${run.layout.podCapacity[pod]} (${share} %)`],
      ["picked", `${run.stock.picked[pod].at(time_us)} units`],
      ["last visit", run.stock.wasVisited(pod, time_us) ? age : "none so far"],
    ],
    more: [
      h("h3", {}, `Orders that wait for it${waiting.length > 0 ? "" : ": none"}`),
      h("div", { className: "tiles" }, ...waiting),
      h("h3", {}, `Holds ${units} units of ${contents.length} SKUs`),
      h(
        "div",
        { className: "tiles holds" },
        ...contents.map(([sku, count]) => tile(run.header, sku, count)),
      ),
    ],
  };
};

/** Returns order, SKU and units of what a pod is brought for. */
function waitingFor({ run }: Pane, pod: number, time_us: number): [number, number, number][] {
  const stations = [...run.header.stations.keys()];
  return stations.flatMap((station) =>
    (run.orders.bringing(station, time_us).get(pod) ?? []).map(
      ({ order, sku, units }) => [order, sku, units] as [number, number, number],
    ),
  );
}

const ofStation: Teller = (store, pane, { run: number, index: station }, time_us) => {
  const { kind, handles, order_slots, transfer_s } = pane.run.header.stations[station];
  const figures = pane.run.stations.figures(station, time_us);
  const queue = queues(pane)[station].map((robot) => chooser(store, number, "robot", robot));
  const rows: Rows = [["kind", `${kind} station${figures.active ? "" : " (switched off)"}`]];
  const open = pane.run.orders.countOpen(station, time_us);
  if (order_slots > 0) rows.push(["open orders", `${open} of ${order_slots}`]);
  rows.push([handles, `${figures.perHour.toFixed(0)} per h`]);
  if (transfer_s > 0) rows.push(["idle share", `${(100 * figures.idleShare).toFixed(1)} %`]);
  const list = h("span", { className: "tiles" }, ...queue);
  rows.push(["in its queue", queue.length > 0 ? list : "nobody"]);
  if (order_slots === 0) return { rows, more: [] };
  const by = grouping(store).root;
  return { rows, more: [by, stationOrders(store, pane, number, station)] };
};

const ofOrder: Teller = (store, pane, { run: number, index: order }, time_us) => {
  const { orders, header } = pane.run;
  const told = orders.course(order);
  if (told === undefined || !orders.exists(order, time_us)) {
    return { rows: [["state", "has not arrived yet"]], more: [] };
  }
  const lines = orders.lines(order, time_us);
  const here = told.stays.filter((stay) => stay.from_us <= time_us && time_us < stay.to_us);
  const stations = here.map(({ station, queued }) => {
    const name = `${header.stations[station].letter}${station}${queued ? " (queued)" : ""}`;
    return chooser(store, number, "station", station, name);
  });
  const picked = lines.reduce((sum, line) => sum + line.picked, 0);
  const units = lines.reduce((sum, line) => sum + line.units, 0);
  const rows: Rows = [
    ["state", orders.phase(order, time_us)],
    ["station", h("span", { className: "tiles" }, ...stations)],
    ["arrived", `${clock(told.created_us / 1e6)} h`],
    ["due", due(told.due_s, Math.min(time_us, told.completed_us) / 1e6)],
    ["picked", `${picked} of ${units || told.units} units`],
  ];
  const table = lines.map((line) => {
    const pods = line.bringing.flatMap(({ pod, robot, station }) => [
      chooser(store, number, "pod", pod),
      h("span", { className: "where" }, whereabouts(pane, pod, robot, station, store)),
    ]);
    const state =
      line.picked >= line.units
        ? "picked"
        : pods.length === 0
          ? "no pod under way"
          : `${line.picked} of ${line.units} picked`;
    return h(
      "div",
      { className: "order" },
      lineTile(header, line),
      h("span", { className: "where" }, state),
      h("span", { className: "pods" }, ...pods),
    );
  });
  return { rows, more: [h("h3", {}, "Lines"), h("div", { className: "orders" }, ...table)] };
};

const OF: Record<Selection["what"], Teller> = {
  robot: ofRobot,
  pod: ofPod,
  station: ofStation,
  order: ofOrder,
};
