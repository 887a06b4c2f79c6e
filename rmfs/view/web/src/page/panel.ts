/** Beside the picture: stations and orders at a glance, or what is known of the one that is chosen. */

import { board } from "./board";
import { details } from "./details";
import { button, h, renew } from "./dom";
import { overview } from "./overview";
import type { Pane } from "./pane";
import type { Board, Store } from "./state";

const BOARDS: [Board, string][] = [
  ["stations", "Stations"],
  ["orders", "Orders"],
];

/** Makes the panel; `update` brings it to the present. */
export function panel(store: Store, panes: Pane[]): { root: HTMLElement; update: () => void } {
  const root = h("section", { className: "details" });
  const parts = { stations: overview(store, panes), orders: board(store, panes) };
  const tabs = BOARDS.map(([name, text]) => {
    const tab = button(text, `Show ${name}`, () => store.set({ board: name, selection: null }));
    tab.id = `tab-${name}`;
    return tab;
  });
  const head = h("nav", { className: "tabs" }, ...tabs);
  const frame = h("div", { className: "all" });
  const chosen = h("div", { className: "chosen" });
  root.append(head, frame, chosen);
  const update = () => {
    const { selection, board: shown } = store.state;
    BOARDS.forEach(([name], n) => {
      tabs[n].ariaPressed = String(name === shown && selection === null);
    });
    frame.hidden = selection !== null;
    chosen.hidden = selection === null;
    if (selection !== null) {
      renew(chosen, h("div", {}, ...details(store, panes[selection.run], selection)));
      return;
    }
    const part = parts[shown];
    if (part.root.parentElement !== frame) frame.replaceChildren(part.root);
    part.update();
  };
  return { root, update };
}
