/** What pods hold: space used, units picked so far, last visit, contents. */

import { type Events, Kind } from "./events";
import type { Layout } from "./layout";
import { Steps } from "./steps";

export class Stock {
  readonly used: Steps<number>[];
  readonly picked: Steps<number>[];
  readonly visited: Steps<number>[];

  constructor(
    private readonly layout: Layout,
    private readonly events: Events,
  ) {
    const pods = Array.from(layout.podWaypoint);
    this.used = pods.map(() => new Steps(0));
    this.picked = pods.map(() => new Steps(0));
    this.visited = pods.map(() => new Steps(0));
    events.onEach(({ kind, pod, sku, units, time_us }) => {
      const sign = SIGNS[kind];
      if (sign !== undefined) {
        this.used[pod].push(time_us, this.used[pod].last + sign * units * layout.skuSpace[sku]);
      }
      if (kind === Kind.UNIT_PICKED) this.picked[pod].push(time_us, this.picked[pod].last + units);
      // who comes for energy brings no pod
      if (kind === Kind.VISIT_STARTED && pod >= 0) this.visited[pod].push(time_us, time_us);
    });
  }

  /** Returns the share of a pod's capacity that is used. */
  fill(pod: number, time_us: number): number {
    return this.used[pod].at(time_us) / this.layout.podCapacity[pod];
  }

  /** Returns whether a pod has been at a station. */
  wasVisited(pod: number, time_us: number): boolean {
    return this.visited[pod].since(time_us) !== undefined;
  }

  /** Returns the time since the pod's last visit to a station, or since the start (s). */
  age_s(pod: number, time_us: number): number {
    return (time_us - this.visited[pod].at(time_us)) / 1e6;
  }

  /** Returns the units on a pod by SKU, most first. */
  contents(pod: number, time_us: number): [number, number][] {
    const units = new Map<number, number>();
    const past = this.events.before("pod", pod, time_us, Number.POSITIVE_INFINITY);
    for (const { kind, sku, units: count } of past) {
      const sign = SIGNS[kind];
      if (sign !== undefined) units.set(sku, (units.get(sku) ?? 0) + sign * count);
    }
    return [...units].filter(([, count]) => count > 0).sort((a, b) => b[1] - a[1]);
  }
}

const SIGNS: Partial<Record<number, number>> = {
  [Kind.STOCK]: 1,
  [Kind.BUNDLE_STORED]: 1,
  [Kind.UNIT_PICKED]: -1,
};
