/** Where every pod is at any time: at a storage location, or carried by a robot. */

import type { Layout } from "./layout";
import { Piece, type Track } from "./motion";
import { countUpTo } from "./search";
import { Steps } from "./steps";

/** A waypoint (0 or greater), or a robot r as -1 - r. */
export type Whereabouts = number;

export class PodPlaces {
  readonly of: Steps<Whereabouts>[];
  /** All moves, by time: when, and which pod. */
  private readonly times: number[] = [];
  private readonly pods: number[] = [];
  private known_us = -1;

  constructor(layout: Layout) {
    this.of = Array.from(layout.podWaypoint, (waypoint) => new Steps<Whereabouts>(waypoint));
  }

  /** Takes note of the lifts and set-downs up to a time that were not known before. */
  extend(tracks: Track[], until_us: number): void {
    const moves: [number, number, Whereabouts][] = [];
    const isNew = (time_us: number) => this.known_us < time_us && time_us <= until_us;
    tracks.forEach((track, robot) => {
      for (let row = Math.max(track.rowAt(this.known_us), 0); row < track.count; row++) {
        const kind = track.kind[row];
        const [start, end] = [track.start[row], track.endOf(row)];
        if (kind === Piece.LIFT && isNew(start)) moves.push([start, track.pod[row], -1 - robot]);
        else if (kind === Piece.SET_DOWN && isNew(end)) {
          moves.push([end, track.pod[row], track.from[row]]);
        }
      }
    });
    moves.sort((a, b) => a[0] - b[0]);
    for (const [time, pod, where] of moves) {
      this.of[pod].push(time, where);
      this.times.push(time);
      this.pods.push(pod);
    }
    this.known_us = until_us;
  }

  /** Calls back for every pod that is lifted or set down between two times. */
  moved(from_us: number, to_us: number, callback: (pod: number) => void): void {
    const [early, late] = from_us < to_us ? [from_us, to_us] : [to_us, from_us];
    const end = countUpTo(this.times, late);
    for (let i = countUpTo(this.times, early); i < end; i++) callback(this.pods[i]);
  }
}
