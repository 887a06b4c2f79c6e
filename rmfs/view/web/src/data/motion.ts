/** Where every robot is at any time: rows of a trace, computed by the robots' own kinematics. */

import type { Column, Container } from "./container";
import { turn, wayAt } from "./kinematics";
import type { Layout } from "./layout";
import { countUpTo } from "./search";

export const Piece = {
  HOLD: 0,
  TURN: 1,
  RUN: 2,
  RIDE: 3,
  LIFT: 4,
  SET_DOWN: 5,
  GUIDED: 6,
} as const;

/** Pieces in which a robot drives over waypoints. */
export const DRIVES: ReadonlySet<number> = new Set([Piece.RUN, Piece.GUIDED]);

export interface Pose {
  x: number;
  y: number;
  heading: number;
  /** The tier, and that to which the robot rides; `ride` says how far it has come, 0 to 1. */
  tier: number;
  tierTo: number;
  ride: number;
  kind: number;
  /** The carried pod or -1. */
  pod: number;
  row: number;
}

export function newPose(): Pose {
  return { x: 0, y: 0, heading: 0, tier: 0, tierTo: 0, ride: 0, kind: 0, pod: -1, row: 0 };
}

/** The rows of one robot, by time; a row ends where the next begins. */
export class Track {
  count = 0;
  end = 0;
  private cursor = 0;

  constructor(
    public start: Float64Array,
    public kind: Uint8Array,
    public from: Int32Array,
    public to: Int32Array,
    public heading0: Float32Array,
    public heading1: Float32Array,
    public pod: Int32Array,
    public topSpeed: Float32Array,
  ) {
    this.count = start.length;
  }

  /** Adds rows; they take the place of what was known from the first of them on. */
  extend(rows: Track): void {
    if (rows.count === 0) return;
    let kept = countUpTo(this.start, rows.start[0], this.count);
    while (kept > 0 && this.start[kept - 1] === rows.start[0]) kept--;
    const count = kept + rows.count;
    this.start = joined(this.start, kept, rows.start);
    this.kind = joined(this.kind, kept, rows.kind);
    this.from = joined(this.from, kept, rows.from);
    this.to = joined(this.to, kept, rows.to);
    this.heading0 = joined(this.heading0, kept, rows.heading0);
    this.heading1 = joined(this.heading1, kept, rows.heading1);
    this.pod = joined(this.pod, kept, rows.pod);
    this.topSpeed = joined(this.topSpeed, kept, rows.topSpeed);
    this.count = count;
    this.end = rows.end;
    this.cursor = Math.min(this.cursor, count - 1);
  }

  /** Returns when a row ends, in microseconds. */
  endOf(row: number): number {
    return row + 1 < this.count ? this.start[row + 1] : this.end;
  }

  /** Returns the row that holds at a time; -1 if there are no rows. */
  rowAt(time_us: number): number {
    const near = this.cursor;
    for (let row = near; row < Math.min(near + 3, this.count); row++) {
      if (this.start[row] <= time_us && (row + 1 === this.count || time_us < this.start[row + 1])) {
        this.cursor = row;
        return row;
      }
    }
    if (this.count === 0) return -1;
    this.cursor = Math.max(countUpTo(this.start, time_us, this.count) - 1, 0);
    return this.cursor;
  }
}

/** Returns the first `kept` values and others behind them, in the same memory if there is room. */
function joined<Values extends Column>(values: Values, kept: number, more: Values): Values {
  const length = kept + more.length;
  let room = values;
  if (length > values.length) {
    room = new (values.constructor as new (length: number) => Values)(2 * length);
    room.set(values.subarray(0, kept));
  }
  room.set(more, kept);
  return room;
}

/** Reads the rows of all robots from a container; they share its memory. */
export function readTracks(container: Container<unknown>): Track[] {
  const first = container.integers("motion.robot_start");
  const ends = container.reals("motion.end_us");
  const start = container.reals("motion.t0_us");
  const kind = container.bytes("motion.kind");
  const from = container.integers("motion.from_wp");
  const to = container.integers("motion.to_wp");
  const heading0 = container.singles("motion.heading0_rad");
  const heading1 = container.singles("motion.heading1_rad");
  const pod = container.integers("motion.pod");
  const topSpeed = container.singles("motion.top_speed_m_s");
  return Array.from(ends, (end, robot) => {
    const [a, b] = [first[robot], first[robot + 1]];
    const track = new Track(
      start.subarray(a, b),
      kind.subarray(a, b),
      from.subarray(a, b),
      to.subarray(a, b),
      heading0.subarray(a, b),
      heading1.subarray(a, b),
      pod.subarray(a, b),
      topSpeed.subarray(a, b),
    );
    track.end = end;
    return track;
  });
}

/** The motion of a fleet. */
export class Motion {
  constructor(
    readonly layout: Layout,
    readonly tracks: Track[],
  ) {}

  get robots(): number {
    return this.tracks.length;
  }

  /** Writes where a robot is at a time (microseconds) into `pose`. */
  pose(robot: number, time_us: number, pose: Pose): Pose {
    const track = this.tracks[robot];
    const row = track.rowAt(time_us);
    if (row < 0) return this.atStart(robot, pose);
    const { x, y, tier } = this.layout;
    const from = track.from[row];
    const to = track.to[row];
    const kind = track.kind[row];
    pose.row = row;
    pose.kind = kind;
    pose.pod = track.pod[row];
    pose.x = x[from];
    pose.y = y[from];
    pose.tier = tier[from];
    pose.tierTo = pose.tier;
    pose.ride = 0;
    pose.heading = track.heading1[row];
    const passed_us = Math.max(time_us - track.start[row], 0);
    if (kind === Piece.RUN) {
      const length = Math.hypot(x[to] - x[from], y[to] - y[from]);
      const own = this.layout.header.robot_kinds[this.layout.robotKind[robot]];
      const way = length > 0 ? wayAt(own, track.topSpeed[row], length, passed_us / 1e6) : 0;
      const share = length > 0 ? way / length : 0;
      pose.x += share * (x[to] - x[from]);
      pose.y += share * (y[to] - y[from]);
    } else if (kind === Piece.TURN || kind === Piece.RIDE || kind === Piece.GUIDED) {
      const whole_us = track.endOf(row) - track.start[row];
      const share = whole_us > 0 ? Math.min(passed_us / whole_us, 1) : 1;
      if (kind === Piece.TURN) {
        const before = track.heading0[row];
        pose.heading = before + share * turn(before, track.heading1[row]);
      } else {
        pose.x += share * (x[to] - x[from]);
        pose.y += share * (y[to] - y[from]);
        if (kind === Piece.RIDE) {
          pose.tierTo = tier[to];
          pose.ride = share;
        }
      }
    }
    return pose;
  }

  private atStart(robot: number, pose: Pose): Pose {
    const { layout } = this;
    const place = layout.robotWaypoint[robot];
    return Object.assign(pose, newPose(), {
      x: layout.x[place],
      y: layout.y[place],
      heading: layout.robotHeading[robot],
      tier: layout.tier[place],
      tierTo: layout.tier[place],
    });
  }
}
