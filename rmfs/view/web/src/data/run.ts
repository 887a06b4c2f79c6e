/** A run as the page knows it: everything that can be asked of it at any time. */

import { decode } from "./container";
import { Events } from "./events";
import { type Course, course } from "./figures";
import { type Header, type Layout, type Live, type News, readLayout } from "./layout";
import { Motion, readTracks } from "./motion";
import { Orders } from "./orders";
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
  readonly orders: Orders;
  readonly passages: Passages;
  /** Until when the run is known, in microseconds. */
  known_us: number;
  /** How the run goes on, if it does. */
  live: Live | undefined;
  private drawn: Course | undefined;

  constructor(buffer: ArrayBuffer) {
    const container = decode<Header>(buffer);
    const header = container.header;
    this.layout = readLayout(container);
    const tracks = readTracks(container);
    this.motion = new Motion(this.layout, tracks);
    this.places = new PodPlaces(this.layout);
    this.live = header.live;
    const known_s = this.live?.known_s ?? Number.POSITIVE_INFINITY;
    this.places.extend(tracks, known_s * 1e6);
    this.events.extend(container, header.details);
    this.robots = new Robots(this.layout, this.motion, this.events);
    this.stock = new Stock(this.layout, this.events);
    this.stations = new Stations(this.layout, this.events);
    this.orders = new Orders(this.events);
    this.passages = new Passages(this.layout, this.motion, this.robots);
    this.known_us = Math.min(known_s, header.end_s) * 1e6;
  }

  /** Adds what has come since. */
  extend(buffer: ArrayBuffer): void {
    const container = decode<News>(buffer);
    const { live, details } = container.header;
    const news = readTracks(container);
    this.motion.tracks.forEach((track, robot) => {
      track.extend(news[robot]);
    });
    this.places.extend(this.motion.tracks, live.known_s * 1e6);
    this.events.extend(container, details);
    this.live = live;
    this.known_us = live.known_s * 1e6;
    this.drawn = undefined;
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
