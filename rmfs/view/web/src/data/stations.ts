/** Stations over time: units handled, visits, whether they are switched on. */

import { type Events, Kind } from "./events";
import type { Layout } from "./layout";
import type { Track } from "./motion";
import { Steps } from "./steps";

export interface StationFigures {
  /** Units picked, bundles stored or, elsewhere, pods that left, per hour within the last hour. */
  perHour: number;
  idleShare: number;
  active: boolean;
}

const HOUR_US = 3600e6;

/** Kinds of station where units or bundles are handled; at others pods are. */
const WORK = new Set(["pick", "replenishment"]);

export class Stations {
  private readonly handled: Steps<number>[];
  private readonly active: Steps<boolean>[];
  /** By waypoint, the stations in whose queue it is. */
  private readonly queuesAt: number[][] = [];

  constructor(
    private readonly layout: Layout,
    events: Events,
  ) {
    const stations = layout.header.stations;
    this.handled = stations.map(() => new Steps(0));
    this.active = stations.map(() => new Steps(true));
    stations.forEach(({ queue }, station) => {
      for (const place of queue) {
        this.queuesAt[place] ??= [];
        this.queuesAt[place].push(station);
      }
    });
    events.onEach(({ kind, station, units, time_us }) => {
      if (kind === Kind.UNIT_PICKED || kind === Kind.BUNDLE_STORED) {
        this.change(this.handled[station], time_us, 1);
      } else if (kind === Kind.VISIT_ENDED && !WORK.has(stations[station].kind)) {
        this.change(this.handled[station], time_us, 1);
      } else if (kind === Kind.STATION_SWITCHED) this.active[station].push(time_us, units > 0);
    });
  }

  /** Returns the figures of a station at a time; rates look back an hour, or to the start. */
  figures(station: number, time_us: number): StationFigures {
    const handled = this.handled[station];
    const window_us = Math.max(Math.min(HOUR_US, time_us), 1);
    const count = handled.at(time_us) - handled.at(time_us - window_us);
    const busy_us = count * this.layout.header.stations[station].transfer_s * 1e6;
    return {
      perHour: (count * HOUR_US) / window_us,
      idleShare: Math.max(1 - busy_us / window_us, 0),
      active: this.active[station].at(time_us),
    };
  }

  /**
   * Returns the robots that stand or drive within the places of each station's queue.
   *
   * @param rows - Which row of its track holds for each robot.
   */
  queues(tracks: Track[], rows: number[]): number[][] {
    const robots: number[][] = this.layout.header.stations.map(() => []);
    tracks.forEach((track, robot) => {
      if (track.count === 0) return;
      for (const station of this.queuesAt[track.from[rows[robot]]] ?? []) {
        robots[station].push(robot);
      }
    });
    return robots;
  }

  private change(steps: Steps<number>, time_us: number, by: number): void {
    steps.push(time_us, steps.last + by);
  }
}
