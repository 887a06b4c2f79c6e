/** Courses for the charts: throughput, backlog, charge, robots by task, in bins of equal length. */

import { type Events, Kind } from "./events";
import type { Robots } from "./robots";

export interface Course {
  /** Length of a bin in microseconds; bin k ends at (k + 1) times that. */
  bin_us: number;
  unitsPerHour: number[];
  /** Orders that wait for a station; one that is split waits until its first part has one. */
  backlog: number[];
  /** What is in the batteries in the mean of the robots at the end of each bin, in per cent. */
  charge: number[];
  /** Robots with each of the tasks at the end of each bin. */
  robots: number[][];
}

const SHORTEST_US = 60e6;
const BINS = 240;

/** Works out the courses from the start to `end_us`. */
export function course(events: Events, robots: Robots, end_us: number): Course {
  const bin_us = Math.max(SHORTEST_US, Math.ceil(end_us / BINS / SHORTEST_US) * SHORTEST_US);
  const count = Math.max(Math.ceil(end_us / bin_us), 1);
  const picked = new Array<number>(count).fill(0);
  const joined = new Array<number>(count).fill(0);
  const unassigned = new Set<number>();
  let late = 0;
  for (const { time_us, kind, order, units } of events.all) {
    const bin = Math.min(Math.floor(time_us / bin_us), count - 1);
    if (kind === Kind.UNIT_PICKED) {
      picked[bin] += units;
      if (time_us >= end_us - bin_us) late += units;
    }
    if (kind === Kind.ORDER_CREATED) {
      unassigned.add(order);
      joined[bin]++;
    } else if (kind === Kind.ORDER_ASSIGNED || kind === Kind.ORDER_CANCELLED) {
      // further parts of a split order are assigned later
      if (unassigned.delete(order)) joined[bin]--;
    }
  }
  // the last bin is not over: its rate looks back as far as those of the others do
  picked[count - 1] = late;
  let waiting = 0;
  return {
    bin_us,
    unitsPerHour: picked.map((units) => (units * 3600e6) / Math.max(Math.min(bin_us, end_us), 1)),
    backlog: joined.map((change) => {
      waiting += change;
      return waiting;
    }),
    charge: meanLevels(robots, count, bin_us, end_us),
    robots: byTask(robots, count, bin_us, end_us),
  };
}

function meanLevels(robots: Robots, count: number, bin_us: number, end_us: number): number[] {
  if (!robots.hasLevels) return [];
  const { levels } = robots;
  return Array.from({ length: count }, (_, bin) => {
    const time_us = Math.min((bin + 1) * bin_us, end_us);
    return levels.reduce((sum, steps) => sum + 100 * steps.at(time_us), 0) / levels.length;
  });
}

function byTask(robots: Robots, count: number, bin_us: number, end_us: number): number[][] {
  const table = robots.words.map(() => new Array<number>(count).fill(0));
  for (const steps of robots.tasks) {
    for (let bin = 0; bin < count; bin++) {
      table[steps.at(Math.min((bin + 1) * bin_us, end_us)).kind][bin]++;
    }
  }
  return table;
}
