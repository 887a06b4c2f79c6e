/** What robots are doing and why: task, state, load and delay. */

import { type Events, Kind } from "./events";
import type { Header, Layout } from "./layout";
import { DRIVES, type Motion, Piece, type Pose } from "./motion";
import { Steps } from "./steps";

/** Returns the words for tasks in the order in which they are numbered. */
export function tasksOf(header: Header): string[] {
  return Object.keys(header.robot_colours.task);
}

export const STATES = [
  "driving",
  "turning",
  "lifting, setting down",
  "in an elevator",
  "queueing",
  "waiting",
  "served",
  "idle",
] as const;

export interface Task {
  /** Index into the words for tasks. */
  kind: number;
  station: number;
}

const [DRIVING, TURNING, TRANSFER, RIDING, QUEUEING, WAITING, SERVED, IDLE] = STATES.keys();

export class Robots {
  readonly tasks: Steps<Task>[];
  /** The station that serves the robot, or -1. */
  readonly served: Steps<number>[];
  /** What is in the battery of each robot, as a share of its capacity. */
  readonly levels: Steps<number>[];
  /** The words for tasks. */
  readonly words: string[];
  private readonly rest: number;

  constructor(
    private readonly layout: Layout,
    private readonly motion: Motion,
    events: Events,
  ) {
    const robots = Array.from(layout.robotWaypoint);
    this.words = tasksOf(layout.header);
    this.rest = this.words.indexOf("rest");
    this.tasks = robots.map(() => new Steps<Task>({ kind: this.rest, station: -1 }));
    this.served = robots.map(() => new Steps<number>(-1));
    this.levels = robots.map(() => new Steps<number>(1));
    events.onEach(({ kind, robot, time_us, station, units, detail }) => {
      if (kind === Kind.TASK) {
        this.tasks[robot].push(time_us, { kind: this.words.indexOf(detail), station });
      } else if (kind === Kind.VISIT_STARTED) this.served[robot].push(time_us, station);
      else if (kind === Kind.VISIT_ENDED) this.served[robot].push(time_us, -1);
      else if (kind === Kind.BATTERY_LEVEL) this.levels[robot].push(time_us, units / 1000);
    });
  }

  /** Whether it is known what is in the batteries. */
  get hasLevels(): boolean {
    return this.levels.some(({ times }) => times.length > 0);
  }

  /** Returns an index into `STATES`. */
  state(robot: number, time_us: number, pose: Pose): number {
    if (DRIVES.has(pose.kind)) return DRIVING;
    if (pose.kind === Piece.TURN) return TURNING;
    if (pose.kind === Piece.RIDE) return RIDING;
    if (pose.kind !== Piece.HOLD) return TRANSFER;
    if (this.served[robot].at(time_us) >= 0) return SERVED;
    if (this.isIdle(robot, time_us)) return IDLE;
    const track = this.motion.tracks[robot];
    const queueing = track.count > 0 && this.layout.isQueue[track.from[pose.row]] === 1;
    return queueing ? QUEUEING : WAITING;
  }

  /** Returns whether a robot has no task but to rest. */
  isIdle(robot: number, time_us: number): boolean {
    return this.tasks[robot].at(time_us).kind === this.rest;
  }

  /** Returns for how long (s) the robot has stood with a way to go since its task began. */
  delay_s(robot: number, time_us: number): number {
    const since = this.tasks[robot].since(time_us);
    if (since === undefined || this.isIdle(robot, time_us)) return 0;
    const track = this.motion.tracks[robot];
    let stood = 0;
    for (let row = track.rowAt(time_us); row >= 0 && track.endOf(row) > since; row--) {
      if (track.kind[row] !== Piece.HOLD) continue;
      const begin = Math.max(track.start[row], since);
      const end = Math.min(track.endOf(row), time_us);
      // at a station a robot is served, before that it waits
      const visit = this.served[robot];
      const reached = visit.at(end - 1) >= 0 ? (visit.since(end - 1) ?? end) : end;
      stood += Math.max(Math.min(end, reached) - begin, 0);
    }
    return stood / 1e6;
  }
}
