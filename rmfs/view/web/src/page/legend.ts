/** What the colours mean. */

import { Color } from "three";
import type { Header } from "../data/layout";
import type { Range } from "../draw/heat";
import {
  amount,
  between,
  type Entry,
  faint,
  robotEntries,
  signed,
  type Theme,
} from "../draw/palette";
import { AGE_S, POPULARITY } from "../draw/pods";
import { LONGEST_DELAY_S } from "../draw/robots";
import { clock, h } from "./dom";
import type { Store } from "./state";

export function legend(
  store: Store,
  header: Header,
  heatRange: () => Range,
): { root: HTMLElement; update: () => void } {
  const root = h("div", { className: "legend" });
  const update = () => {
    const { robots, pods, heat, overlay, theme } = store.state;
    const colours = header.themes[theme];
    const parts: HTMLElement[] = [h("h3", {}, `Robots by ${robots}`)];
    if (robots === "charge") parts.push(scale(theme, "0 %", "100 % of the battery"));
    else if (robots !== "delay") parts.push(swatches(robotEntries(header, robots, theme)));
    else parts.push(delayScale(colours.delay));
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
      parts.push(h("h3", {}, `Heat map: ${heat}${overlay ? ", B − A" : ""}`));
      parts.push(
        overlay
          ? differenceScale(theme, `${short(most)} ${unit}`)
          : scale(theme, short(least), `${short(most)} ${unit} (log.)`),
      );
    }
    const pod = { colour: colours.pod, label: "pod" };
    parts.push(h("h3", {}, pods === "plain" ? "Pods and places" : "Places"));
    parts.push(
      swatches([
        ...(pods === "plain" ? [pod] : []),
        ...stationKinds(header, theme),
        { colour: colours.elevator, label: "elevator" },
        { colour: faint(colours.pod, theme).getStyle(), label: "storage location" },
        { colour: faint(header.colours.queue_zone, theme).getStyle(), label: "queue zone" },
      ]),
    );
    root.replaceChildren(...parts);
  };
  store.listen((names) => {
    if (["robots", "pods", "heat", "overlay", "theme"].some((n) => names.has(n as "robots")))
      update();
  });
  update();
  return { root, update };
}

/** Returns an entry for each kind of station, in the order of the stations. */
function stationKinds({ stations, themes }: Header, theme: Theme): Entry[] {
  const kinds = new Map(stations.map((one, number) => [one.kind, { ...one, number }]));
  return [...kinds.values()].map(({ kind, letter, number }) => {
    return { colour: themes[theme].stations[number], label: `${kind} station (${letter})` };
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
  return bar((share) => amount(share, theme, new Color()), low, high);
}

function differenceScale(theme: Theme, most: string): HTMLElement {
  const colour = (share: number) => signed(2 * share - 1, theme, new Color());
  return bar(colour, `${most} more in A`, `${most} more in B (log.)`);
}

function delayScale(delay: string[]): HTMLElement {
  const colours = delay.map((hex) => new Color(hex));
  const high = `${LONGEST_DELAY_S} s or more waited in this task`;
  return bar((share) => between(colours, share, new Color()), "0 s", high);
}

function bar(colour: (share: number) => Color, low: string, high: string): HTMLElement {
  const stops = Array.from({ length: 9 }, (_, i) => colour(i / 8).getStyle());
  const bar = h("i", { className: "scale" });
  bar.style.background = `linear-gradient(to right, ${stops.join(", ")})`;
  return h("div", { className: "scaled" }, h("span", {}, low), bar, h("span", {}, high));
}
