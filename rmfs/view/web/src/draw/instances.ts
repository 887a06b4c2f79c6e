/** Many bodies of one shape in one draw call, each with its place, size and colour. */

import {
  type BufferGeometry,
  type Color,
  DynamicDrawUsage,
  InstancedBufferAttribute,
  InstancedMesh,
  type Material,
} from "three";

export class Instances {
  readonly mesh: InstancedMesh;
  private readonly matrix: Float32Array;
  private readonly colours: Float32Array;

  constructor(geometry: BufferGeometry, material: Material, count: number) {
    this.mesh = new InstancedMesh(geometry, material, Math.max(count, 1));
    this.mesh.count = count;
    this.mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    this.mesh.frustumCulled = false;
    this.matrix = this.mesh.instanceMatrix.array as Float32Array;
    this.colours = new Float32Array(3 * Math.max(count, 1)).fill(1);
    this.mesh.instanceColor = new InstancedBufferAttribute(this.colours, 3);
  }

  /** Puts a body somewhere, turned about the vertical and stretched. */
  place(
    index: number,
    at: { x: number; y: number; z: number },
    size: { x: number; y: number; z: number },
    heading = 0,
  ): void {
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
    this.mesh.instanceMatrix.needsUpdate = true;
  }

  /** Makes a body vanish until it is placed again. */
  hide(index: number): void {
    this.matrix.fill(0, 16 * index, 16 * index + 16);
    this.mesh.instanceMatrix.needsUpdate = true;
  }

  paint(index: number, colour: Color): void {
    this.colours[3 * index] = colour.r;
    this.colours[3 * index + 1] = colour.g;
    this.colours[3 * index + 2] = colour.b;
    if (this.mesh.instanceColor !== null) this.mesh.instanceColor.needsUpdate = true;
  }
}
