/** The warehouse of a run: waypoints, stations, elevators, robots and pods at time zero. */

import type { Container } from "./container";
import type { RobotKind } from "./kinematics";

export interface Tier {
  length_m: number;
  width_m: number;
  height_m: number;
}

export interface Station {
  /** The word for its kind: "pick", "replenishment", or what another kind calls itself. */
  kind: string;
  /** What stands before its number where there is little room. */
  letter: string;
  /** What is counted there, in words. */
  handles: string;
  waypoint: number;
  queue: number[];
  radius_m: number;
  /** Orders open at once; 0 but at pick stations. */
  order_slots: number;
  /** How long one of what it handles keeps the station busy; 0 if that differs. */
  transfer_s: number;
}

/** The rule of a decision problem: its name, and its parameters beside it. */
export type Rule = { name: string } & Record<string, unknown>;

/** How a run that goes on is going. */
export interface Live {
  known_s: number;
  known: { motion: number; events: number };
  /** Why nothing more comes; empty while the run goes on. */
  ended: string;
  paused: boolean;
  /** Simulated seconds per second; null: as fast as it goes. */
  speed: number | null;
  controllers: Record<string, Rule>;
}

/** The header of what has come since. */
export interface News {
  live: Live;
  details: string[];
}

/** What the header of a scene says. */
export interface Header {
  title: string;
  names: { layout: string; scenario: string; controllers: string };
  seed: number;
  warmup_s: number;
  end_s: number;
  tiers: Tier[];
  stations: Station[];
  elevators: number[][];
  robot_kinds: RobotKind[];
  pod_radius_m: number;
  details: string[];
  /** Names of the SKUs, where they have other ones than their numbers. */
  sku_names: string[];
  colours: Record<string, string>;
  /** Of robots, by the words for their tasks, states and loads. */
  robot_colours: Record<"task" | "state" | "load", Record<string, string>>;
  /** Colours on a light and on a dark floor. */
  themes: Record<"light" | "dark", Colours>;
  live?: Live;
}

/** Colours on one floor. */
export interface Colours {
  pod: string;
  elevator: string;
  /** In the order of the stations. */
  stations: string[];
  /** Of robots, by the words for their tasks. */
  task: Record<string, string>;
  /** From none to much. */
  delay: string[];
}

export interface Layout {
  header: Header;
  x: Float64Array;
  y: Float64Array;
  tier: Uint8Array;
  edgeStart: Int32Array;
  edgeTarget: Int32Array;
  isStorage: Uint8Array;
  isQueue: Uint8Array;
  podWaypoint: Int32Array;
  podCapacity: Float64Array;
  robotWaypoint: Int32Array;
  robotHeading: Float64Array;
  robotKind: Uint8Array;
  skuSpace: Float64Array;
  /** Usual distance of neighbouring waypoints in m. */
  pitch_m: number;
}

export function readLayout(container: Container<Header>): Layout {
  const layout = {
    header: container.header,
    x: container.reals("x_m"),
    y: container.reals("y_m"),
    tier: container.bytes("tier"),
    edgeStart: container.integers("edge_start"),
    edgeTarget: container.integers("edge_target"),
    isStorage: container.bytes("is_storage"),
    isQueue: container.bytes("is_queue"),
    podWaypoint: container.integers("pod_waypoint"),
    podCapacity: container.reals("pod_capacity"),
    robotWaypoint: container.integers("robot_waypoint"),
    robotHeading: container.reals("robot_heading_rad"),
    robotKind: container.bytes("robot_kind"),
    skuSpace: container.reals("sku_space"),
  };
  return { ...layout, pitch_m: medianEdge(layout) };
}

function medianEdge(layout: Omit<Layout, "pitch_m">): number {
  const lengths: number[] = [];
  for (let v = 0; v < layout.x.length; v++) {
    for (let e = layout.edgeStart[v]; e < layout.edgeStart[v + 1]; e++) {
      const w = layout.edgeTarget[e];
      lengths.push(Math.hypot(layout.x[w] - layout.x[v], layout.y[w] - layout.y[v]));
    }
  }
  lengths.sort((a, b) => a - b);
  return lengths[lengths.length >> 1] ?? 1;
}

/** Returns the waypoints of a straight run after its first one, up to and with its last one. */
export function straight(layout: Layout, from: number, to: number): number[] {
  const { x, y } = layout;
  const length = Math.hypot(x[to] - x[from], y[to] - y[from]) || 1;
  const ux = (x[to] - x[from]) / length;
  const uy = (y[to] - y[from]) / length;
  const passed: number[] = [];
  for (let here = from; here !== to; ) {
    const next = ahead(layout, here, ux, uy);
    if (next < 0 || passed.length > x.length) return [to];
    passed.push(next);
    here = next;
  }
  return passed;
}

function ahead(layout: Layout, here: number, ux: number, uy: number): number {
  const { x, y, edgeStart, edgeTarget } = layout;
  for (let e = edgeStart[here]; e < edgeStart[here + 1]; e++) {
    const next = edgeTarget[e];
    const dx = x[next] - x[here];
    const dy = y[next] - y[here];
    if (dx * ux + dy * uy > 0.9999 * Math.hypot(dx, dy)) return next;
  }
  return -1;
}
