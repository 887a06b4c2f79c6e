/** What happened besides motion, by time and by whom it concerns. */

import type { Container } from "./container";
import { firstWhere } from "./search";

export const Kind = {
  STOCK: 0,
  TASK: 1,
  ORDER_CREATED: 2,
  ORDER_ASSIGNED: 3,
  UNIT_PICKED: 4,
  ORDER_COMPLETED: 5,
  BUNDLE_CREATED: 6,
  BUNDLE_ASSIGNED: 7,
  BUNDLE_STORED: 8,
  VISIT_STARTED: 9,
  VISIT_ENDED: 10,
  STATION_SWITCHED: 11,
  CONTROLLER_EXCHANGED: 12,
  BATTERY_LEVEL: 13,
  ORDER_LINE: 14,
  ORDER_DUE: 15,
  ORDER_CUT: 16,
  ORDER_CANCELLED: 17,
  PART_COMPLETED: 18,
  UNITS_BOUND: 19,
  UNITS_UNBOUND: 20,
} as const;

export interface Happening {
  time_us: number;
  kind: number;
  robot: number;
  pod: number;
  station: number;
  order: number;
  sku: number;
  units: number;
  detail: string;
}

export type Subject = "robot" | "pod" | "station" | "order";

/** What happens to bundles, whose numbers stand in the column of the orders. */
const OF_BUNDLES: ReadonlySet<number> = new Set([
  Kind.BUNDLE_CREATED,
  Kind.BUNDLE_ASSIGNED,
  Kind.BUNDLE_STORED,
]);

/** What belongs to an order from the start, and is no event of its history. */
const STATED: ReadonlySet<number> = new Set([Kind.ORDER_LINE, Kind.ORDER_DUE]);

/** All events of a run, with the numbers of those that concern each robot, pod, station and order. */
export class Events {
  readonly all: Happening[] = [];
  private readonly of: Record<Subject, number[][]> = { robot: [], pod: [], station: [], order: [] };
  private readonly listeners: ((happening: Happening) => void)[] = [];

  /** Calls back for every event there is and every one that comes. */
  onEach(listener: (happening: Happening) => void): void {
    this.all.forEach(listener);
    this.listeners.push(listener);
  }

  /** Adds the events of a container, whose column `detail` points at `details`. */
  extend(container: Container<unknown>, details: string[]): void {
    const time = container.reals("events.time_us");
    const kind = container.bytes("events.kind");
    const [robot, pod, station, order, sku, units, detail] = NUMBERS.map((name) =>
      container.integers(`events.${name}`),
    );
    for (let i = 0; i < time.length; i++) {
      const happening = {
        time_us: time[i],
        kind: kind[i],
        robot: robot[i],
        pod: pod[i],
        station: station[i],
        order: order[i],
        sku: sku[i],
        units: units[i],
        detail: details[detail[i]] ?? "",
      };
      this.add(happening);
    }
  }

  private add(happening: Happening): void {
    const number = this.all.push(happening) - 1;
    for (const listener of this.listeners) listener(happening);
    // a course, and nothing that happens to a robot
    if (happening.kind === Kind.BATTERY_LEVEL || STATED.has(happening.kind)) return;
    const bundle = OF_BUNDLES.has(happening.kind);
    for (const subject of SUBJECTS) {
      if (bundle && subject === "order") continue;
      const index = happening[subject];
      if (index >= 0) {
        const lists = this.of[subject];
        lists[index] ??= [];
        lists[index].push(number);
      }
    }
  }

  /** Returns the last `limit` events of a subject up to a time, newest first. */
  before(subject: Subject, index: number, time_us: number, limit: number): Happening[] {
    const numbers = this.of[subject][index] ?? [];
    const found: Happening[] = [];
    for (let i = this.countUpTo(numbers, time_us) - 1; i >= 0 && found.length < limit; i--) {
      found.push(this.all[numbers[i]]);
    }
    return found;
  }

  /** Returns the first event of a subject after a time. */
  after(subject: Subject, index: number, time_us: number): Happening | undefined {
    const numbers = this.of[subject][index] ?? [];
    return this.all[numbers[this.countUpTo(numbers, time_us)]];
  }

  private countUpTo(numbers: number[], time_us: number): number {
    return firstWhere(numbers.length, (place) => this.all[numbers[place]].time_us > time_us);
  }
}

const SUBJECTS: Subject[] = ["robot", "pod", "station", "order"];
const NUMBERS = ["robot", "pod", "station", "order", "sku", "units", "detail"] as const;

const WORDS = [
  "in stock",
  "task",
  "order arrives",
  "order assigned",
  "unit picked",
  "order completed",
  "bundle arrives",
  "bundle assigned",
  "bundle stored",
  "at the station",
  "leaves the station",
  "station switched",
  "controller exchanged",
  "battery",
  "order line",
  "order due",
  "order cut",
  "order cancelled",
  "part completed",
  "pod brought for",
  "pod no longer brought for",
];

/** Says in a few words what happened to a subject, which is not named again. */
export function tell(happening: Happening, subject: Subject): string {
  const { kind, order, sku, units, detail } = happening;
  const others = (["station", "pod", "robot"] as const).filter(
    (name) => name !== subject && happening[name] >= 0,
  );
  const named = [
    detail,
    ...others.map((name) => `${name} ${happening[name]}`),
    order >= 0 && subject !== "order"
      ? `${OF_BUNDLES.has(kind) ? "bundle" : "order"} ${order}`
      : "",
    sku >= 0 ? `SKU ${sku}` : "",
    units > 1 ? `${units} units` : "",
  ];
  const told = named.filter((word) => word !== "").join(", ");
  return told === "" ? WORDS[kind] : `${WORDS[kind]}: ${told}`;
}
