/** Shapes with their light and shade in the colours of their corners, so that no lamp is needed. */

import { BufferAttribute, type BufferGeometry, MeshBasicMaterial } from "three";

const TOP = 1;
const SIDE_X = 0.82;
const SIDE_Y = 0.68;

/** Darkens the sides of a shape; the material of `shadedMaterial` shows it. */
export function shaded<Shape extends BufferGeometry>(shape: Shape): Shape {
  const normals = shape.getAttribute("normal");
  const colours = new Float32Array(3 * normals.count);
  for (let corner = 0; corner < normals.count; corner++) {
    const [x, y, z] = [normals.getX(corner), normals.getY(corner), normals.getZ(corner)];
    const shade = TOP * z * z * (z > 0 ? 1 : 0.5) + SIDE_X * x * x + SIDE_Y * y * y;
    colours.fill(shade, 3 * corner, 3 * corner + 3);
  }
  shape.setAttribute("color", new BufferAttribute(colours, 3));
  return shape;
}

/** The material of shaded shapes, white where nothing else is said. */
export function shadedMaterial(colour = "#ffffff"): MeshBasicMaterial {
  return new MeshBasicMaterial({ color: colour, vertexColors: true });
}
