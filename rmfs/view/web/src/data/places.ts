/** Where every pod is at any time: at a storage place, or carried by a robot. */

import type { Layout } from "./layout";
import { Piece, type Track } from "./motion";
import { Steps } from "./steps";

/** A waypoint (0 or greater), or a robot r as -1 - r. */
export type Whereabouts = number;

export class PodPlaces {
  readonly of: Steps<Whereabouts>[];

  constructor(layout: Layout, tracks: Track[]) {
    this.of = Array.from(layout.podWaypoint, (waypoint) => new Steps<Whereabouts>(waypoint));
    this.extend(tracks);
  }

  /** Takes note of the lifts and set-downs in some rows, one track per robot. */
  extend(tracks: Track[]): void {
    const moves: [number, number, Whereabouts][] = [];
    tracks.forEach((track, robot) => {
      for (let row = 0; row < track.count; row++) {
        const kind = track.kind[row];
        if (kind === Piece.LIFT) moves.push([track.start[row], track.pod[row], -1 - robot]);
        else if (kind === Piece.SET_DOWN) {
          moves.push([track.endOf(row), track.pod[row], track.from[row]]);
        }
      }
    });
    moves.sort((a, b) => a[0] - b[0]);
    for (const [time, pod, where] of moves) {
      this.of[pod].push(time, where);
    }
  }
}
