/** Bodies drawn from one shape by the graphics card. */

import {
  type BufferGeometry,
  type Color,
  DynamicDrawUsage,
  InstancedBufferAttribute,
  InstancedMesh,
  type Material,
  type Raycaster,
} from "three";
import { type Bodies, changed, type Struck, type Triple } from "./bodies";

export class Instances implements Bodies {
  readonly mesh: InstancedMesh;
  private readonly matrix: Float32Array;
  private readonly colours: Float32Array;
  private readonly tints: InstancedBufferAttribute;

  constructor(shape: BufferGeometry, material: Material, count: number) {
    this.mesh = new InstancedMesh(shape, material, Math.max(count, 1));
    this.mesh.count = count;
    this.mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    this.mesh.frustumCulled = false;
    this.matrix = this.mesh.instanceMatrix.array as Float32Array;
    this.colours = new Float32Array(3 * Math.max(count, 1)).fill(1);
    this.tints = new InstancedBufferAttribute(this.colours, 3);
    this.mesh.instanceColor = this.tints;
  }

  reshape(shape: BufferGeometry): void {
    this.mesh.geometry = shape;
  }

  place(index: number, at: Triple, size: Triple, heading = 0): void {
    const m = this.matrix;
    const o = 16 * index;
    const cos = Math.cos(heading);
    const sin = Math.sin(heading);
    m[o] = cos * size.x;
    m[o + 1] = sin * size.x;
    m[o + 4] = -sin * size.y;
    m[o + 5] = cos * size.y;
    m[o + 10] = size.z;
    m[o + 12] = at.x;
    m[o + 13] = at.y;
    m[o + 14] = at.z;
    m[o + 15] = 1;
    changed(this.mesh.instanceMatrix, index, 16);
  }

  hide(index: number): void {
    this.matrix.fill(0, 16 * index, 16 * index + 16);
    changed(this.mesh.instanceMatrix, index, 16);
  }

  paint(index: number, { r, g, b }: Color): void {
    const c = this.colours;
    const o = 3 * index;
    if (c[o] === Math.fround(r) && c[o + 1] === Math.fround(g) && c[o + 2] === Math.fround(b)) {
      return;
    }
    c[o] = r;
    c[o + 1] = g;
    c[o + 2] = b;
    changed(this.tints, index, 3);
  }

  struck(ray: Raycaster): Struck | undefined {
    // what was known of their extent is out of date
    this.mesh.boundingSphere = null;
    const [first] = ray.intersectObject(this.mesh, false);
    if (first?.instanceId === undefined) return undefined;
    return { index: first.instanceId, away: first.distance };
  }
}
