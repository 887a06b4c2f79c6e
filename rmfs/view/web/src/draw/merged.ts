/** Bodies in one mesh whose corners are computed here. */

import {
  BufferAttribute,
  BufferGeometry,
  type Color,
  DynamicDrawUsage,
  type Material,
  Mesh,
  type Raycaster,
} from "three";
import { type Bodies, changed, type Struck, type Triple } from "./bodies";

export class Merged implements Bodies {
  readonly mesh: Mesh;
  /** Corners of the shape: their places, and how bright they are. */
  private corners = new Float32Array();
  private shades = new Float32Array();
  private triangles = 0;
  private places = new BufferAttribute(new Float32Array(), 3);
  private tints = new BufferAttribute(new Float32Array(), 3);
  private readonly colours: Float32Array;

  constructor(
    shape: BufferGeometry,
    material: Material,
    private readonly count: number,
  ) {
    material.vertexColors = true;
    this.mesh = new Mesh(new BufferGeometry(), material);
    this.mesh.frustumCulled = false;
    this.colours = new Float32Array(3 * count).fill(1);
    this.reshape(shape);
  }

  reshape(shape: BufferGeometry): void {
    const position = shape.getAttribute("position");
    this.corners = new Float32Array(position.array);
    const shade = shape.getAttribute("color");
    this.shades = new Float32Array(position.count).map((_, k) => (shade ? shade.getX(k) : 1));
    const { count } = this;
    const corners = position.count;
    const face = Array.from(shape.index?.array ?? Array(corners).keys());
    this.triangles = face.length / 3;
    this.places = dynamic(3 * corners * count);
    this.tints = dynamic(3 * corners * count);
    const indices = new Uint32Array(face.length * count);
    for (let i = 0; i < count; i++) {
      for (let k = 0; k < face.length; k++) indices[i * face.length + k] = i * corners + face[k];
    }
    this.mesh.geometry.dispose();
    this.mesh.geometry = new BufferGeometry();
    this.mesh.geometry.setIndex(new BufferAttribute(indices, 1));
    this.mesh.geometry.setAttribute("position", this.places);
    this.mesh.geometry.setAttribute("color", this.tints);
    for (let i = 0; i < count; i++) this.tint(i);
  }

  place(index: number, at: Triple, size: Triple, heading = 0): void {
    const { corners } = this;
    const to = this.places.array;
    const cos = Math.cos(heading);
    const sin = Math.sin(heading);
    for (let k = 0, o = index * corners.length; k < corners.length; k += 3, o += 3) {
      const x = corners[k] * size.x;
      const y = corners[k + 1] * size.y;
      to[o] = at.x + cos * x - sin * y;
      to[o + 1] = at.y + sin * x + cos * y;
      to[o + 2] = at.z + corners[k + 2] * size.z;
    }
    changed(this.places, index, corners.length);
  }

  hide(index: number): void {
    const size = this.corners.length;
    this.places.array.fill(0, size * index, size * index + size);
    changed(this.places, index, size);
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
    this.tint(index);
  }

  struck(ray: Raycaster): Struck | undefined {
    // what was known of their extent is out of date
    this.mesh.geometry.boundingSphere = null;
    const [first] = ray.intersectObject(this.mesh, false);
    if (first?.faceIndex == null) return undefined;
    return { index: Math.floor(first.faceIndex / this.triangles), away: first.distance };
  }

  private tint(index: number): void {
    const { shades, colours } = this;
    const to = this.tints.array;
    const size = 3 * shades.length;
    for (let k = 0; k < shades.length; k++) {
      for (let c = 0; c < 3; c++) to[size * index + 3 * k + c] = shades[k] * colours[3 * index + c];
    }
    changed(this.tints, index, size);
  }
}

function dynamic(length: number): BufferAttribute {
  return new BufferAttribute(new Float32Array(length), 3).setUsage(DynamicDrawUsage);
}
