/** What never moves: floors, roads, storage locations, queue zones, stations and elevators. */

import {
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  CylinderGeometry,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshBasicMaterial,
  PlaneGeometry,
  type Sprite,
} from "three";
import type { Colours, Layout } from "../data/layout";
import { type Bodies, bodies } from "./bodies";
import { label, resize } from "./labels";
import { faint, GROUND, type Theme } from "./palette";
import type { Placement } from "./placement";
import { shaded, shadedMaterial } from "./shapes";

const FLAT = { x: 1, y: 1, z: 1 };

/** Draws the floors; they are made anew when the theme changes. */
export class Floor {
  readonly group = new Group();
  /** The stations' bodies, in the order of the stations. */
  readonly stations: Mesh[] = [];
  private readonly tiers: Group[];
  private readonly labels: Sprite[] = [];
  private pixel_m = 0;
  private readonly zones: Bodies[] = [];

  constructor(
    private readonly layout: Layout,
    private readonly theme: Theme,
  ) {
    this.tiers = layout.header.tiers.map(() => new Group());
    this.group.add(...this.tiers);
    this.tiers.forEach((tier, number) => {
      tier.add(this.ground(number), this.roads(number));
      const storage = this.cells(number, layout.isStorage, this.colours.pod, 0.8);
      const zone = this.cells(number, layout.isQueue, layout.header.colours.queue_zone, 1);
      this.zones.push(zone);
      tier.add(storage.mesh, zone.mesh);
    });
    this.addStations();
    this.addElevators();
    if (this.tiers.length > 1) this.nameTiers();
  }

  /** Keeps the texts readable where a pixel shows so many metres. */
  scaleLabels(pixel_m: number): void {
    if (pixel_m === this.pixel_m) return;
    this.pixel_m = pixel_m;
    for (const text of this.labels) resize(text, pixel_m);
  }

  /** Puts the tiers where they are to be drawn. */
  arrange(placement: Placement): void {
    this.tiers.forEach((tier, number) => {
      tier.position.set(placement.x[number], 0, placement.z[number]);
      tier.visible = placement.shown[number];
    });
  }

  showZones(shown: boolean): void {
    for (const zone of this.zones) zone.mesh.visible = shown;
  }

  private get colours(): Colours {
    return this.layout.header.themes[this.theme];
  }

  private ground(tier: number): Mesh {
    const { length_m, width_m } = this.layout.header.tiers[tier];
    const material = new MeshBasicMaterial({ color: GROUND[this.theme].floor });
    if (tier > 0) Object.assign(material, { transparent: true, opacity: 0.35, depthWrite: false });
    const ground = new Mesh(new PlaneGeometry(length_m + 1, width_m + 1), material);
    ground.position.set(length_m / 2, width_m / 2, -0.03);
    return ground;
  }

  private roads(tier: number): LineSegments {
    const { x, y, edgeStart, edgeTarget, isStorage } = this.layout;
    const points: number[] = [];
    for (let v = 0; v < x.length; v++) {
      if (this.layout.tier[v] !== tier || isStorage[v]) continue;
      for (let e = edgeStart[v]; e < edgeStart[v + 1]; e++) {
        const w = edgeTarget[e];
        if (!isStorage[w]) points.push(x[v], y[v], 0, x[w], y[w], 0);
      }
    }
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(points), 3));
    return new LineSegments(geometry, new LineBasicMaterial({ color: GROUND[this.theme].line }));
  }

  private cells(tier: number, wanted: Uint8Array, colour: string, side: number): Bodies {
    const { x, y, pitch_m } = this.layout;
    const here: number[] = [];
    for (let v = 0; v < x.length; v++) {
      if (wanted[v] && this.layout.tier[v] === tier) here.push(v);
    }
    const cells = bodies(
      new PlaneGeometry(side * pitch_m, side * pitch_m),
      new MeshBasicMaterial(),
      here.length,
    );
    const shade = faint(colour, this.theme);
    here.forEach((v, i) => {
      cells.place(i, { x: x[v], y: y[v], z: -0.01 }, FLAT);
      cells.paint(i, shade);
    });
    return cells;
  }

  private addStations(): void {
    const { x, y, tier, header } = this.layout;
    header.stations.forEach((station, number) => {
      const { letter, waypoint, radius_m } = station;
      const size_m = 1.6 * radius_m;
      const body = new Mesh(
        shaded(new CylinderGeometry(size_m, size_m, 0.06, 24).rotateX(Math.PI / 2)),
        shadedMaterial(this.colours.stations[number]),
      );
      body.position.set(x[waypoint], y[waypoint], 0.02);
      this.stations.push(body);
      this.tiers[tier[waypoint]].add(body);
      const { length_m, width_m } = header.tiers[tier[waypoint]];
      // beside the station, on the side that is nearer to the wall
      const [dx, dy] = outward(x[waypoint], y[waypoint], length_m, width_m);
      const name = `${letter}${number}`;
      const away = size_m + 0.2;
      this.write(name, tier[waypoint], x[waypoint] + away * dx, y[waypoint] + away * dy, [dx, dy]);
    });
  }

  private nameTiers(): void {
    for (const number of this.tiers.keys()) this.write(`tier ${number}`, number, 0, 0, [1, -1]);
  }

  /** Writes a text that reaches from a point of a tier into a direction. */
  private write(name: string, tier: number, x: number, y: number, [dx, dy]: [number, number]) {
    const text = label(name, GROUND[this.theme].text);
    text.center.set(0.5 - dx / 2, 0.5 - dy / 2);
    text.position.set(x, y, 0.6);
    this.labels.push(text);
    this.tiers[tier].add(text);
  }

  private addElevators(): void {
    const { x, y, tier, pitch_m, header } = this.layout;
    const side = 0.9 * pitch_m;
    for (const waypoint of header.elevators.flat()) {
      const body = new Mesh(
        shaded(new BoxGeometry(side, side, 0.05)),
        shadedMaterial(this.colours.elevator),
      );
      body.position.set(x[waypoint], y[waypoint], 0);
      this.tiers[tier[waypoint]].add(body);
    }
  }
}

function outward(x: number, y: number, length_m: number, width_m: number): [number, number] {
  const walls: [number, [number, number]][] = [
    [x, [-1, 0]],
    [length_m - x, [1, 0]],
    [y, [0, -1]],
    [width_m - y, [0, 1]],
  ];
  walls.sort((a, b) => a[0] - b[0]);
  return walls[0][1];
}
