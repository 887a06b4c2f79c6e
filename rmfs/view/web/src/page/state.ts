/** What is being looked at, and how: everything a link restores. */

import type { Theme } from "../draw/palette";
import { ALL_TIERS, type Mode } from "../draw/placement";
import type { PodMode } from "../draw/pods";
import type { RobotMode } from "../draw/robots";

export type HeatMode = "off" | "visits" | "waiting";
export type Chosen = "robot" | "pod" | "station" | "order";
/** What the panel lists while nothing is chosen. */
export type Board = "stations" | "orders";
/** By what orders at stations are listed. */
export type Grouping = "order" | "pod";

export interface Selection {
  run: number;
  what: Chosen;
  index: number;
}

export interface ViewState {
  time_s: number;
  speed: number;
  playing: boolean;
  mode: Mode;
  tier: number;
  robots: RobotMode;
  pods: PodMode;
  heat: HeatMode;
  /** Of two runs, whether the heat map shows the difference. */
  overlay: boolean;
  /** Window of the heat map in seconds. */
  from_s: number;
  to_s: number;
  paths: boolean;
  zones: boolean;
  follow: boolean;
  theme: Theme;
  selection: Selection | null;
  board: Board;
  grouping: Grouping;
}

export const SPEEDS = [0.5, 1, 2, 5, 10, 30, 60, 300, 1000];

/** Begins at a time: playing, unless somebody would rather have nothing move of its own accord. */
export function initialState(begin_s: number, end_s: number): ViewState {
  const calm = window.matchMedia("(prefers-reduced-motion: reduce)").matches;
  const dark = window.matchMedia("(prefers-color-scheme: dark)").matches;
  return {
    time_s: begin_s,
    speed: 10,
    playing: !calm && begin_s < end_s,
    mode: "2d",
    tier: ALL_TIERS,
    robots: "task",
    pods: "plain",
    heat: "off",
    overlay: false,
    from_s: 0,
    to_s: end_s,
    paths: false,
    zones: true,
    follow: false,
    theme: dark ? "dark" : "light",
    selection: null,
    board: "stations",
    grouping: "order",
  };
}

type Listener = (changed: ReadonlySet<keyof ViewState>) => void;

/** Holds the state and tells who listens which of its parts have changed. */
export class Store {
  private readonly listeners: Listener[] = [];

  constructor(readonly state: ViewState) {}

  listen(listener: Listener): void {
    this.listeners.push(listener);
  }

  set(change: Partial<ViewState>): void {
    const names = Object.keys(change) as (keyof ViewState)[];
    const changed = new Set(names.filter((name) => change[name] !== this.state[name]));
    Object.assign(this.state, change);
    if (changed.size > 0) for (const listener of this.listeners) listener(changed);
  }
}
