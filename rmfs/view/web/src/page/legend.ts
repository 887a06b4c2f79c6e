/** What the colours mean. */

import { Color } from "three";
import type { Header } from "../data/layout";
import type { Range } from "../draw/heat";
import { amount, type Entry, faint, robotEntries, type Theme } from "../draw/palette";
import { AGE_S, POPULARITY } from "../draw/pods";
import { LONGEST_DELAY_S } from "../draw/robots";
import { clock, h } from "./dom";
import type { Store } from "./state";

export function legend(
  store: Store,
  header: Header,
  heatRange: () => Range,
): { root: HTMLElement; update: () => void } {
  const root = h("section", { className: "legend" });
  const update = () => {
    const { robots, pods, heat, theme } = store.state;
    const { colours } = header;
    const parts: HTMLElement[] = [h("h2", {}, "Legend")];
    parts.push(h("h3", {}, `Robots by ${robots}`));
    if (robots === "charge") parts.push(scale(theme, "0 %", "100 % of the battery"));
    else if (robots !== "delay") parts.push(swatches(robotEntries(header, robots)));
    else parts.push(scale(theme, "0 s", `${LONGEST_DELAY_S} s or more waited in this task`));
    if (pods !== "plain") parts.push(h("h3", {}, `Pods by ${POD_WORDS[pods]}`));
    if (pods === "fill") parts.push(scale(theme, "0 %", "100 % of the space used"));
    if (pods === "popularity") {
      const { least, most } = POPULARITY;
      parts.push(scale(theme, String(least), `${most} units picked so far (log.)`));
    }
    if (pods === "age") {
      const { least, most } = AGE_S;
      parts.push(scale(theme, clock(least), `${clock(most)} h since the last visit (log.)`));
    }
    if (heat !== "off") {
      const { least, most } = heatRange();
      const unit = heat === "visits" ? "visits" : "s waited";
      parts.push(h("h3", {}, `Heat map: ${heat}`));
      parts.push(scale(theme, short(least), `${short(most)} ${unit} (log.)`));
    }
    const pod = { colour: colours.storage, label: "pod" };
    parts.push(h("h3", {}, pods === "plain" ? "Pods and places" : "Places"));
    parts.push(
      swatches([
        ...(pods === "plain" ? [pod] : []),
        ...stationKinds(header),
        { colour: colours.elevator, label: "elevator" },
        { colour: faint(colours.storage, theme).getStyle(), label: "storage place" },
        { colour: faint(colours.queue_zone, theme).getStyle(), label: "queue zone" },
      ]),
    );
    root.replaceChildren(...parts);
  };
  store.listen((names) => {
    if (["robots", "pods", "heat", "theme"].some((n) => names.has(n as "robots"))) update();
  });
  update();
  return { root, update };
}

/** Returns an entry for each kind of station, in the order of the stations. */
function stationKinds({ stations }: Header): Entry[] {
  const kinds = new Map(stations.map((one) => [one.kind, one]));
  return [...kinds.values()].map(({ kind, letter, colour }) => {
    return { colour, label: `${kind} station (${letter})` };
  });
}

const POD_WORDS = { plain: "", fill: "fill", popularity: "popularity", age: "age of visit" };

function short(value: number): string {
  return value >= 100 || Number.isInteger(value) ? value.toFixed(0) : value.toPrecision(2);
}

function swatches(entries: Entry[]): HTMLElement {
  return h(
    "ul",
    {},
    ...entries.map(({ colour, label }) => {
      const patch = h("i", {});
      patch.style.background = colour;
      return h("li", {}, patch, label);
    }),
  );
}

function scale(theme: Theme, low: string, high: string): HTMLElement {
  const stops = Array.from({ length: 9 }, (_, i) => amount(i / 8, theme, new Color()).getStyle());
  const bar = h("i", { className: "scale" });
  bar.style.background = `linear-gradient(to right, ${stops.join(", ")})`;
  return h("div", { className: "scaled" }, h("span", {}, low), bar, h("span", {}, high));
}
