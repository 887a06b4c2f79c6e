/** The orders at pick stations: by order, with its lines, or by pod, with the orders it is brought for. */

import type { Bringing, Stay } from "../data/orders";
import { button, choice, clock, h, renew } from "./dom";
import type { Pane } from "./pane";
import type { Chosen, Grouping, Store } from "./state";
import { lineTile, tile } from "./tiles";

/** Of more pick stations than this, those that are looked at are unfolded by hand. */
const UNFOLDED = 8;

const OLDER =
  "This run was recorded before lines, due times and pods under way were; only what was picked is known.";

interface Part {
  root: HTMLElement;
  update(): void;
}

/** Makes the orders of all pick stations of all runs, a part that folds for each station. */
export function board(store: Store, panes: Pane[]): Part {
  const by = grouping(store);
  const root = h("div", { className: "board" }, by.root);
  const parts: (() => void)[] = [];
  panes.forEach((pane, run) => {
    const { stations } = pane.run.header;
    const picking = [...stations.keys()].filter((index) => stations[index].order_slots > 0);
    if (panes.length > 1) root.append(h("h2", {}, `Orders of ${"AB"[run]}`));
    if (pane.run.live === undefined && !pane.run.orders.hasLines) root.append(h("p", {}, OLDER));
    for (const index of picking) {
      const made = stationPart(store, pane, run, index, picking.length <= UNFOLDED);
      root.append(made.root);
      parts.push(made.update);
    }
  });
  const update = () => {
    for (const one of parts) one();
  };
  return { root, update };
}

/** Makes the choice between orders and pods. */
export function grouping(store: Store): { root: HTMLElement } {
  const options: [Grouping, string][] = [
    ["order", "order: its lines and pods"],
    ["pod", "pod: the orders that wait for it"],
  ];
  const made = choice("by", options, (value) => store.set({ grouping: value as Grouping }));
  made.select.id = "choose-grouping";
  const follow = () => {
    made.select.value = store.state.grouping;
  };
  store.listen(follow);
  follow();
  return { root: h("div", { className: "by" }, made.root) };
}

function stationPart(store: Store, pane: Pane, run: number, index: number, open: boolean): Part {
  const { letter } = pane.run.header.stations[index];
  const told = h("span", {});
  const rows = h("div", {});
  const name = button(`${letter}${index}`, "Choose this station", () =>
    store.set({ selection: { run, what: "station", index } }),
  );
  const root = h("details", { open, className: "station" }, h("summary", {}, name, told), rows);
  root.dataset.station = String(index);
  root.addEventListener("toggle", () => update());
  const update = () => {
    const time_us = store.state.time_s * 1e6;
    const { orders, header } = pane.run;
    const pods = orders.bringing(index, time_us).size;
    const slots = header.stations[index].order_slots;
    const count = orders.countOpen(index, time_us);
    told.textContent = `${count} of ${slots} orders, ${pods} pods under way`;
    if (root.open) renew(rows, stationOrders(store, pane, run, index));
  };
  return { root, update };
}

/** Returns the orders of a station as they are now. */
export function stationOrders(store: Store, pane: Pane, run: number, station: number): HTMLElement {
  const time_us = store.state.time_s * 1e6;
  const { orders } = pane.run;
  const rows =
    store.state.grouping === "order"
      ? orders.staying(station, time_us).map((stay) => orderRow(store, pane, run, stay))
      : [...orders.bringing(station, time_us)].map(([pod, list]) =>
          podRow(store, pane, run, pod, list),
        );
  const none = store.state.grouping === "order" ? "no orders" : "no pods under way for orders";
  const root = h("div", { className: "orders" });
  root.append(...(rows.length > 0 ? rows : [h("p", { className: "none" }, none)]));
  return root;
}

function orderRow(store: Store, pane: Pane, run: number, stay: Stay): HTMLElement {
  const { order, station, queued } = stay;
  const { orders, header } = pane.run;
  const time_us = store.state.time_s * 1e6;
  const lines = orders.lines(order, time_us, station);
  const pods = new Set(lines.flatMap((line) => line.bringing.map(({ pod }) => pod)));
  const tiles = lines.map((line) => lineTile(header, line));
  const row = h(
    "div",
    { className: `order${queued ? " queued" : ""}` },
    chooser(store, run, "order", order, `#${order}`),
    h("span", { className: "tiles" }, ...tiles),
    h("span", { className: "pods" }, ...[...pods].map((pod) => chooser(store, run, "pod", pod))),
    due(orders.course(order)?.due_s, store.state.time_s),
  );
  row.dataset.order = String(order);
  return row;
}

function podRow(store: Store, pane: Pane, run: number, pod: number, list: Bringing[]): HTMLElement {
  const { robot, station } = list[0];
  const wanted = list.map(({ order, sku, units }) =>
    h(
      "span",
      { className: "wanted" },
      chooser(store, run, "order", order, `#${order}`),
      tile(pane.run.header, sku, units),
    ),
  );
  const row = h(
    "div",
    { className: "order" },
    chooser(store, run, "pod", pod),
    h("span", { className: "tiles" }, ...wanted),
    h("span", { className: "where" }, whereabouts(pane, pod, robot, station, store)),
  );
  row.dataset.pod = String(pod);
  return row;
}

/** Says how far a pod has come on its way to a station. */
export function whereabouts(
  { run }: Pane,
  pod: number,
  robot: number,
  station: number,
  store: Store,
): string {
  const time_us = store.state.time_s * 1e6;
  if (run.places.of[pod].at(time_us) >= 0) return `robot ${robot} fetches it`;
  if (run.robots.served[robot].at(time_us) === station) return "at the station";
  const track = run.motion.tracks[robot];
  const place = track.count > 0 ? track.from[track.rowAt(time_us)] : -1;
  const queueing = run.header.stations[station].queue.includes(place);
  return queueing ? "in the queue" : `on robot ${robot}`;
}

/** Makes a button that chooses something. */
export function chooser(
  store: Store,
  run: number,
  what: Chosen,
  index: number,
  text = `${what} ${index}`,
): HTMLButtonElement {
  const made = button(text, `Choose ${what} ${index}`, () =>
    store.set({ selection: { run, what, index } }),
  );
  made.dataset.chooses = `${run}.${what}.${index}`;
  return made;
}

/** Says when an order is due: when that is, and whether it has passed. */
export function due(due_s: number | undefined, time_s: number): HTMLElement {
  if (due_s === undefined) return h("span", { className: "due" });
  const left_s = due_s - time_s;
  const text = left_s < 0 ? `${clock(-left_s)} late` : `due ${clock(due_s)}`;
  const made = h("span", { className: `due${left_s < 0 ? " late" : ""}` }, text);
  made.title = `due at ${clock(due_s)} h, ${left_s < 0 ? "late by" : "in"} ${clock(Math.abs(left_s))} h`;
  return made;
}
