/** The ways robots are about to drive: up to their next stop with a purpose. */

import {
  BufferAttribute,
  BufferGeometry,
  DynamicDrawUsage,
  LineBasicMaterial,
  LineSegments,
} from "three";
import { DRIVES, Piece, type Pose } from "../data/motion";
import type { Run } from "../data/run";
import type { Placement } from "./placement";

const MOST_RUNS = 40;
const MOST_SEGMENTS = 40_000;

export class Paths {
  readonly lines: LineSegments;
  private readonly points = new Float32Array(6 * MOST_SEGMENTS);
  private readonly attribute = new BufferAttribute(this.points, 3);
  private used = 0;

  constructor(
    private readonly run: Run,
    colour: string,
  ) {
    this.attribute.setUsage(DynamicDrawUsage);
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", this.attribute);
    this.lines = new LineSegments(geometry, new LineBasicMaterial({ color: colour }));
    this.lines.frustumCulled = false;
  }

  clear(): void {
    this.used = 0;
  }

  /** Adds the way of a robot from where it is to its next lift, set-down or station. */
  add(robot: number, pose: Pose, time_us: number, placement: Placement): void {
    const track = this.run.motion.tracks[robot];
    const { x, y, tier } = this.run.layout;
    const height = placement.mode === "2d" ? 0.9 : 0.1;
    const served = this.run.robots.served[robot];
    let hereX = pose.x;
    let hereY = pose.y;
    let runs = 0;
    for (let row = pose.row; row < track.count && runs < MOST_RUNS; row++) {
      const kind = track.kind[row];
      const transfer = kind === Piece.LIFT || kind === Piece.SET_DOWN;
      if (row > pose.row && (transfer || served.at(track.start[row]) >= 0)) break;
      if (!DRIVES.has(kind)) continue;
      const to = track.to[row];
      const floor = tier[to];
      if (placement.shown[floor] && (row > pose.row || time_us < track.endOf(row))) {
        const z = placement.z[floor] + height;
        this.segment(hereX + placement.x[floor], hereY, x[to] + placement.x[floor], y[to], z);
      }
      hereX = x[to];
      hereY = y[to];
      runs++;
    }
  }

  finish(): void {
    this.lines.geometry.setDrawRange(0, 2 * this.used);
    this.attribute.clearUpdateRanges();
    this.attribute.addUpdateRange(0, 6 * this.used);
    this.attribute.needsUpdate = this.used > 0;
  }

  private segment(x0: number, y0: number, x1: number, y1: number, z: number): void {
    if (this.used >= MOST_SEGMENTS) return;
    const { points } = this;
    const o = 6 * this.used++;
    points[o] = x0;
    points[o + 1] = y0;
    points[o + 3] = x1;
    points[o + 4] = y1;
    points[o + 2] = points[o + 5] = z;
  }
}
