/** A run as the page knows it: everything that can be asked of it at any time. */

import { decode } from "./container";
import { Events } from "./events";
import { type Course, course } from "./figures";
import { type Header, type Layout, readLayout } from "./layout";
import { Motion, readTracks } from "./motion";
import { Passages } from "./passages";
import { PodPlaces } from "./places";
import { Robots } from "./robots";
import { Stations } from "./stations";
import { Stock } from "./stock";

export class Run {
  readonly layout: Layout;
  readonly motion: Motion;
  readonly events = new Events();
  readonly places: PodPlaces;
  readonly robots: Robots;
  readonly stock: Stock;
  readonly stations: Stations;
  readonly passages: Passages;
  /** Until when the run is known, in microseconds. */
  readonly known_us: number;
  private drawn: Course | undefined;

  constructor(buffer: ArrayBuffer) {
    const container = decode<Header>(buffer);
    const header = container.header;
    this.layout = readLayout(container);
    const tracks = readTracks(container);
    this.motion = new Motion(this.layout, tracks);
    this.places = new PodPlaces(this.layout);
    this.places.extend(tracks, Number.POSITIVE_INFINITY);
    this.events.extend(container, header.details);
    this.robots = new Robots(this.layout, this.motion, this.events);
    this.stock = new Stock(this.layout, this.events);
    this.stations = new Stations(this.layout, this.events);
    this.passages = new Passages(this.layout, this.motion, this.robots);
    this.known_us = header.end_s * 1e6;
  }

  get header(): Header {
    return this.layout.header;
  }

  /** Returns the courses for the charts, worked out when they are first asked for. */
  course(): Course {
    this.drawn ??= course(this.events, this.robots, this.known_us);
    return this.drawn;
  }
}
