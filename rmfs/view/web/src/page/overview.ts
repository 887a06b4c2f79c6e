/** All stations at a glance. */

import { button, h } from "./dom";
import type { Pane } from "./pane";
import type { Store } from "./state";

const HEADS = ["", "open orders", "units, bundles/h", "idle", "queue"];

/** Makes a table of stations per run; `update` writes what has changed of the rows in sight. */
export function overview(store: Store, panes: Pane[]): { root: HTMLElement; update: () => void } {
  const tables = panes.map((pane, number) => stationTable(store, pane, number));
  const root = h("div", {});
  tables.forEach(({ table }, number) => {
    root.append(h("h2", {}, `Stations${panes.length > 1 ? ` of ${"AB"[number]}` : ""}`), table);
  });
  const update = () => {
    for (const one of tables) one.update();
  };
  return { root, update };
}

/** Returns the robots in the queue of each station. */
export function queues({ run, poses }: Pane): number[][] {
  const rows = poses.map(({ row }) => row);
  return run.stations.queues(run.motion.tracks, rows);
}

function stationTable(store: Store, pane: Pane, run: number) {
  const { stations } = pane.run.header;
  const rows = stations.map(({ letter }, index) => {
    const name = `${letter}${index}`;
    const choose = () => store.set({ selection: { run, what: "station", index } });
    const figures = HEADS.slice(1).map(() => h("td", {}));
    const row = h("tr", {}, h("td", {}, button(name, "Choose this station", choose)), ...figures);
    return { row, figures };
  });
  const heads = HEADS.map((text) => h("th", {}, text));
  const table = h("table", {}, h("tr", {}, ...heads), ...rows.map(({ row }) => row));
  const inSight = new Set<Element>();
  const observer = new IntersectionObserver((changes) => {
    for (const { target, isIntersecting } of changes) {
      if (isIntersecting) inSight.add(target);
      else inSight.delete(target);
    }
  });
  for (const { row } of rows) observer.observe(row);
  const update = () => {
    const waiting = queues(pane);
    rows.forEach(({ row, figures }, index) => {
      if (!inSight.has(row)) return;
      const now = pane.run.stations.figures(index, store.state.time_s * 1e6);
      const slots = stations[index].order_slots;
      const texts = [
        slots > 0 ? `${pane.run.orders.countOpen(index, store.state.time_s * 1e6)}/${slots}` : "",
        now.perHour.toFixed(0),
        stations[index].transfer_s > 0 ? `${(100 * now.idleShare).toFixed(0)} %` : "",
        String(waiting[index].length),
      ];
      figures.forEach((cell, n) => {
        if (cell.textContent !== texts[n]) cell.textContent = texts[n];
      });
      row.classList.toggle("off", !now.active);
    });
  };
  return { table, update };
}
