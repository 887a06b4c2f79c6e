/** Colours: those that come with the run for kinds, magma for amounts. */

import { Color, ColorManagement } from "three";
import type { Header } from "../data/layout";
import { STATES, tasksOf } from "../data/robots";

// colours reach the screen as they are written here: nothing is lit, so nothing is converted
ColorManagement.enabled = false;

export type Theme = "light" | "dark";

const LOADS = ["without pod", "with pod"];

/** What robots are told apart by; the words and their colours come with the run. */
export type Kinds = "task" | "state" | "load";

function words(header: Header, kinds: Kinds): readonly string[] {
  return { task: tasksOf(header), state: STATES, load: LOADS }[kinds];
}

/** Returns the colours of robots, in the order in which tasks, states and loads are numbered. */
export function robotColours(header: Header, kinds: Kinds, theme: Theme): string[] {
  const colours = kinds === "task" ? header.themes[theme].task : header.robot_colours[kinds];
  return words(header, kinds).map((word) => colours[word]);
}

/** Lines of runs in charts, in the order of the runs. */
export const LINES: Record<Theme, readonly string[]> = {
  light: ["#0072B2", "#C24E00"],
  dark: ["#56B4E9", "#FF9A4D"],
};

export const GROUND: Record<Theme, { back: string; floor: string; line: string; text: string }> = {
  light: { back: "#F4F5F7", floor: "#FFFFFF", line: "#D0D0D0", text: "#1B1F24" },
  dark: { back: "#101418", floor: "#1B2128", line: "#3A434D", text: "#E6EAEE" },
};

/** Returns the colour of places on the floor: faint, so that what stands on them stands out. */
export function faint(colour: string, theme: Theme): Color {
  return new Color(GROUND[theme].floor).lerp(new Color(colour), 0.25);
}

const MAGMA = [
  "#000004",
  "#180F3D",
  "#440F76",
  "#721F81",
  "#9E2F7F",
  "#CD4071",
  "#F1605D",
  "#FD9668",
  "#FECA8D",
  "#FCFDBF",
].map((hex) => new Color(hex));

/**
 * Writes the colour of a share, 0 to 1, into `into`: a part of magma that stands out from the floor,
 * the stronger the more.
 */
export function amount(share: number, theme: Theme, into: Color): Color {
  const clipped = Math.min(Math.max(share, 0), 1);
  return between(MAGMA, theme === "light" ? 0.92 - 0.82 * clipped : 0.22 + 0.75 * clipped, into);
}

/** Writes the colour at a share of the way along some colours into `into`. */
export function between(colours: readonly Color[], share: number, into: Color): Color {
  const place = Math.min(Math.max(share, 0), 1) * (colours.length - 1);
  const left = Math.min(Math.floor(place), colours.length - 2);
  return into.copy(colours[left]).lerp(colours[left + 1], place - left);
}

/** Returns the place of a value between two others on a logarithmic scale, 0 to 1. */
export function logShare(value: number, least: number, most: number): number {
  if (!(value > 0) || !(most > least)) return value > 0 ? 1 : 0;
  return Math.log(value / least) / Math.log(most / least);
}

export interface Entry {
  colour: string;
  label: string;
}

/** Returns what the colours of robots mean. */
export function robotEntries(header: Header, kinds: Kinds, theme: Theme): Entry[] {
  const colours = robotColours(header, kinds, theme);
  return words(header, kinds).map((label, i) => ({ label, colour: colours[i] }));
}

/** Writes the colour of a share, -1 (run A) to 1 (run B), into `into`; none has that of the floor. */
export function signed(share: number, theme: Theme, into: Color): Color {
  const [a, b] = LINES[theme];
  const strength = 0.15 + 0.85 * Math.min(Math.abs(share), 1);
  return into
    .set(GROUND[theme].floor)
    .lerp(OTHER.set(share < 0 ? a : b), share === 0 ? 0 : strength);
}

const OTHER = new Color();
