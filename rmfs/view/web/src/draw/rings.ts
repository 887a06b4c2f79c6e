/** Rings around what is chosen. */

import { Group, Mesh, MeshBasicMaterial, RingGeometry } from "three";

export interface Spot {
  x: number;
  y: number;
  z: number;
  shown: boolean;
}

export class Rings {
  readonly group = new Group();
  private readonly shape = new RingGeometry(0.62, 0.8, 40);
  private readonly material = new MeshBasicMaterial({
    color: "#E6007E",
    depthTest: false,
    transparent: true,
  });

  /** Shows a ring at each of some places, so high above their floors. */
  show(spots: Spot[], above_m: number): void {
    while (this.group.children.length < spots.length) {
      const ring = new Mesh(this.shape, this.material);
      ring.renderOrder = 9;
      this.group.add(ring);
    }
    this.group.children.forEach((ring, n) => {
      const spot = spots[n];
      ring.visible = spot?.shown ?? false;
      if (spot !== undefined) ring.position.set(spot.x, spot.y, spot.z + above_m);
    });
  }
}
