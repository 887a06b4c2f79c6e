/** What is being looked at, and how: everything a link restores. */

import type { Theme } from "../draw/palette";
import { ALL_TIERS, type Mode } from "../draw/placement";
import type { PodMode } from "../draw/pods";
import type { RobotMode } from "../draw/robots";

export type HeatMode = "off" | "visits" | "waiting";
export type Chosen = "robot" | "pod" | "station";

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
  /** Window of the heat map in seconds. */
  from_s: number;
  to_s: number;
  paths: boolean;
  zones: boolean;
  follow: boolean;
  theme: Theme;
  selection: Selection | null;
}

export const SPEEDS = [0.5, 1, 2, 5, 10, 30, 60, 300, 1000];

export function initialState(end_s: number): ViewState {
  const dark = window.matchMedia("(prefers-color-scheme: dark)").matches;
  return {
    time_s: 0,
    speed: 10,
    playing: false,
    mode: "2d",
    tier: ALL_TIERS,
    robots: "task",
    pods: "plain",
    heat: "off",
    from_s: 0,
    to_s: end_s,
    paths: false,
    zones: true,
    follow: false,
    theme: dark ? "dark" : "light",
    selection: null,
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
