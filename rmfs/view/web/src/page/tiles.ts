/** SKUs as coloured tiles: a SKU has the same colour wherever it is shown. */

import type { Header } from "../data/layout";
import type { Line } from "../data/orders";
import { h } from "./dom";

/** Hues of neighbouring numbers are far apart. */
const GOLDEN_ANGLE = 137.508;

export interface Face {
  text: string;
  title: string;
  background: string;
  ink: string;
}

/** Letters in colours: the name of such a SKU is a letter and a colour. */
const LETTER = /^(\p{L}) ([a-z]+)$/u;

/** Returns how a SKU is written. */
export function face({ sku_names }: Pick<Header, "sku_names">, sku: number): Face {
  const name = sku_names[sku] ?? String(sku);
  const [, letter, colour] = LETTER.exec(name) ?? [];
  const title = name === String(sku) ? `SKU ${sku}` : `SKU ${sku}: ${name}`;
  if (letter !== undefined && CSS.supports("color", colour)) {
    return { text: letter.toUpperCase(), title, background: colour, ink: inkOn(colour) };
  }
  const hue = (sku * GOLDEN_ANGLE) % 360;
  return { text: name, title, background: `hsl(${hue.toFixed(0)} 70% 84%)`, ink: "#1b1f24" };
}

/** Makes the tile of some units of a SKU. */
export function tile(header: Header, sku: number, units: number): HTMLElement {
  const { text, title, background, ink } = face(header, sku);
  const made = h("span", { className: "tile", title: `${title}: ${units} units` }, text);
  if (units !== 1) made.append(h("small", {}, `×${units}`));
  made.style.background = background;
  made.style.color = ink;
  return made;
}

/** Makes the tile of an order line, which says how far it has come. */
export function lineTile(header: Header, line: Line): HTMLElement {
  const { sku, units, picked, bringing } = line;
  const made = tile(header, sku, units);
  const coming = bringing.reduce((sum, one) => sum + one.units, 0);
  const done = units > 0 && picked >= units;
  made.classList.add(done ? "picked" : picked + coming >= units ? "coming" : "lacking");
  if (picked > 0 && !done) made.append(h("small", {}, `${picked}✓`));
  const pods = bringing.map(({ pod, units: some }) => `${some} on pod ${pod}`);
  const { title } = face(header, sku);
  made.title = `${title}: ${picked} of ${units} picked${pods.length > 0 ? `, ${pods.join(", ")}` : ""}`;
  return made;
}

/** Returns black or white, whichever is easier to read on a colour. */
function inkOn(colour: string): string {
  const pen = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
  if (pen === null) return "#000000";
  pen.fillStyle = colour;
  pen.fillRect(0, 0, 1, 1);
  const [r, g, b] = pen.getImageData(0, 0, 1, 1).data;
  const light = [r, g, b].map((value) => {
    const share = value / 255;
    return share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4;
  });
  const luminance = 0.2126 * light[0] + 0.7152 * light[1] + 0.0722 * light[2];
  return luminance > 0.179 ? "#000000" : "#ffffff";
}
