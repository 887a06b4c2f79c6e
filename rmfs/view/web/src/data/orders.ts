/** Orders over time: what they want, where they are, what is picked, which pods are brought for them. */

import { type Events, type Happening, Kind } from "./events";

/** The time that an order, or a part of one, spends at a station or queued for it. */
export interface Stay {
  order: number;
  station: number;
  from_us: number;
  to_us: number;
  /** Whether it is still in the backlog, and only promised to the station. */
  queued: boolean;
}

/** A pod under way to a station for units of an order. */
export interface Bringing {
  order: number;
  sku: number;
  pod: number;
  robot: number;
  station: number;
  units: number;
}

export interface Line {
  sku: number;
  /** Where it is to be picked, if that is known: lines of one order may go to several stations. */
  station: number;
  units: number;
  picked: number;
  /** What is on pods under way. */
  bringing: Bringing[];
}

export type Phase = "waiting" | "open" | "completed" | "cancelled";

interface Told {
  created_us: number;
  due_s: number | undefined;
  units: number;
  /** Lines as they come to be known; a cut starts them anew. */
  lines: Happening[];
  /** Units bound to pods, given back and picked. */
  moves: Happening[];
  stays: Stay[];
  completed_us: number;
  cancelled_us: number;
}

export class Orders {
  /** Whether lines, due times and bound pods were recorded, which older runs have not. */
  hasLines = false;
  private readonly told: Told[] = [];
  private readonly at: Stay[][] = [];

  constructor(events: Events) {
    events.onEach((one) => this.add(one));
  }

  /** Returns what is at a station, or queued for it, at a time: what has been there longest first. */
  staying(station: number, time_us: number): Stay[] {
    return (this.at[station] ?? []).filter(
      ({ from_us, to_us }) => from_us <= time_us && time_us < to_us,
    );
  }

  /** Whether there is an order of a number at a time. */
  exists(order: number, time_us = Number.POSITIVE_INFINITY): boolean {
    return (this.told[order]?.created_us ?? Number.POSITIVE_INFINITY) <= time_us;
  }

  /** Returns the course of an order in single times. */
  course(order: number): Readonly<Told> | undefined {
    return this.told[order];
  }

  phase(order: number, time_us: number): Phase {
    const told = this.told[order];
    if (told.completed_us <= time_us) return "completed";
    if (told.cancelled_us <= time_us) return "cancelled";
    return told.stays.some(({ from_us, queued }) => !queued && from_us <= time_us)
      ? "open"
      : "waiting";
  }

  /** Returns the lines of an order at a time, those of one station if it is named. */
  lines(order: number, time_us: number, station = -1): Line[] {
    const told = this.told[order];
    const lines = new Map<number, Line>();
    for (const { kind, time_us: when, sku, units, station: where } of told.lines) {
      if (when > time_us) break;
      if (kind === Kind.ORDER_CUT) lines.clear();
      else lines.set(sku, { sku, units, station: where, picked: 0, bringing: [] });
    }
    for (const move of told.moves) {
      if (move.time_us > time_us) break;
      let line = lines.get(move.sku);
      if (line === undefined) {
        // of an older run no more is known than what was picked
        line = { sku: move.sku, units: 0, station: move.station, picked: 0, bringing: [] };
        lines.set(move.sku, line);
      }
      if (move.kind === Kind.UNIT_PICKED) {
        line.picked += move.units;
        line.units = Math.max(line.units, line.picked);
      }
      bring(line.bringing, move);
    }
    const all = [...lines.values()];
    for (const line of all) line.bringing = line.bringing.filter(({ units }) => units > 0);
    return station < 0 ? all : all.filter((line) => line.station < 0 || line.station === station);
  }

  /** Returns what is brought to a station at a time, for each pod in the order in which it began. */
  bringing(station: number, time_us: number): Map<number, Bringing[]> {
    const pods = new Map<number, Bringing[]>();
    const seen = new Set<number>();
    for (const { order } of this.staying(station, time_us)) {
      if (seen.has(order)) continue;
      seen.add(order);
      for (const line of this.lines(order, time_us)) {
        for (const one of line.bringing) {
          if (one.station !== station) continue;
          const list = pods.get(one.pod) ?? [];
          list.push(one);
          pods.set(one.pod, list);
        }
      }
    }
    return pods;
  }

  /** Returns how many orders are open at a station at a time. */
  countOpen(station: number, time_us: number): number {
    return this.staying(station, time_us).filter(({ queued }) => !queued).length;
  }

  private add(one: Happening): void {
    const { kind, order, time_us, station, units } = one;
    if (order < 0 || !OF_ORDERS.has(kind)) return;
    if (kind === Kind.ORDER_CREATED) {
      this.told[order] = fresh(time_us, units);
      return;
    }
    const told = this.told[order];
    if (told === undefined) return;
    if (kind === Kind.ORDER_LINE || kind === Kind.ORDER_CUT) {
      told.lines.push(one);
      this.hasLines = true;
    } else if (kind === Kind.ORDER_DUE) told.due_s = units;
    else if (kind === Kind.ORDER_ASSIGNED) this.arrive(told, one, false);
    else if (kind === Kind.PART_COMPLETED) leave(told, station, time_us);
    else if (kind === Kind.ORDER_COMPLETED) {
      told.completed_us = time_us;
      for (const stay of told.stays) stay.to_us = Math.min(stay.to_us, time_us);
    } else if (kind === Kind.ORDER_CANCELLED) told.cancelled_us = time_us;
    else {
      told.moves.push(one);
      // a pod may be brought for an order that has no slot yet
      if (kind === Kind.UNITS_BOUND) this.arrive(told, one, true);
    }
  }

  private arrive(told: Told, { order, station, time_us }: Happening, queued: boolean): void {
    const present = told.stays.find((stay) => stay.station === station && stay.to_us > time_us);
    if (present !== undefined) {
      if (queued || !present.queued) return;
      present.to_us = time_us;
    }
    const stay = { order, station, queued, from_us: time_us, to_us: Number.POSITIVE_INFINITY };
    told.stays.push(stay);
    this.at[station] ??= [];
    this.at[station].push(stay);
  }
}

const OF_ORDERS: ReadonlySet<number> = new Set([
  Kind.ORDER_CREATED,
  Kind.ORDER_ASSIGNED,
  Kind.UNIT_PICKED,
  Kind.ORDER_COMPLETED,
  Kind.ORDER_LINE,
  Kind.ORDER_DUE,
  Kind.ORDER_CUT,
  Kind.ORDER_CANCELLED,
  Kind.PART_COMPLETED,
  Kind.UNITS_BOUND,
  Kind.UNITS_UNBOUND,
]);

function fresh(created_us: number, units: number): Told {
  return {
    created_us,
    units,
    due_s: undefined,
    lines: [],
    moves: [],
    stays: [],
    completed_us: Number.POSITIVE_INFINITY,
    cancelled_us: Number.POSITIVE_INFINITY,
  };
}

function leave({ stays }: Told, station: number, time_us: number): void {
  for (const stay of stays) {
    if (stay.station === station) stay.to_us = Math.min(stay.to_us, time_us);
  }
}

/** Counts units that are bound to a pod, given back, or picked from it. */
function bring(list: Bringing[], { kind, order, sku, pod, robot, station, units }: Happening) {
  let found = list.find((one) => one.pod === pod && one.station === station);
  if (found === undefined) {
    found = { order, sku, pod, robot, station, units: 0 };
    list.push(found);
  }
  found.robot = robot;
  found.units += kind === Kind.UNITS_BOUND ? units : -units;
}
