/** Where robots drive and wait within a window of time: what heat maps show. */

import { type Layout, straight } from "./layout";
import { DRIVES, type Motion, Piece } from "./motion";
import type { Robots } from "./robots";

export type Count = "visits" | "waiting";

export class Passages {
  private readonly ways = new Map<number, number[]>();

  constructor(
    private readonly layout: Layout,
    private readonly motion: Motion,
    private readonly robots: Robots,
  ) {}

  /**
   * Counts per waypoint within [begin, end), in microseconds.
   *
   * Visits: how often a robot drove onto it, told where the run that passes it ends. Waiting:
   * seconds that robots with a task stood there, at stations too.
   */
  count(what: Count, begin: number, end: number): Float64Array {
    const counts = new Float64Array(this.layout.x.length);
    this.motion.tracks.forEach((track, robot) => {
      if (track.count === 0) return;
      for (let row = Math.max(track.rowAt(begin), 0); row < track.count; row++) {
        if (track.start[row] >= end) break;
        if (what === "visits") this.visit(counts, robot, row, begin, end);
        else this.wait(counts, robot, row, begin, end);
      }
    });
    return counts;
  }

  private visit(counts: Float64Array, robot: number, row: number, begin: number, end: number) {
    const track = this.motion.tracks[robot];
    const done = track.endOf(row);
    const kind = track.kind[row];
    if (done < begin || done >= end || (!DRIVES.has(kind) && kind !== Piece.RIDE)) return;
    const to = track.to[row];
    if (kind === Piece.RIDE) counts[to]++;
    else for (const waypoint of this.way(track.from[row], to)) counts[waypoint]++;
  }

  private wait(counts: Float64Array, robot: number, row: number, begin: number, end: number) {
    const track = this.motion.tracks[robot];
    if (track.kind[row] !== Piece.HOLD) return;
    const from = Math.max(track.start[row], begin);
    const until = Math.min(track.endOf(row), end);
    if (this.robots.isIdle(robot, from)) return;
    counts[track.from[row]] += Math.max(until - from, 0) / 1e6;
  }

  private way(from: number, to: number): number[] {
    const key = from * this.layout.x.length + to;
    let way = this.ways.get(key);
    if (way === undefined) {
      way = straight(this.layout, from, to);
      this.ways.set(key, way);
    }
    return way;
  }
}
