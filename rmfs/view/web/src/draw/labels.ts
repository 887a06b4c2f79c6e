/** Short texts that always face the viewer, and stay readable from afar. */

import { CanvasTexture, Sprite, SpriteMaterial } from "three";

/** Height of a text: so many metres, or so many pixels if that is more. */
const HEIGHT_M = 1.1;
const LEAST_PX = 13;

/** Makes a text. */
export function label(text: string, colour: string): Sprite {
  const canvas = document.createElement("canvas");
  const pen = canvas.getContext("2d");
  const size = 48;
  const font = `600 ${size}px system-ui, sans-serif`;
  if (pen !== null) {
    pen.font = font;
    canvas.width = Math.ceil(pen.measureText(text).width) + 8;
    canvas.height = Math.ceil(size * 1.3);
    pen.font = font;
    pen.fillStyle = colour;
    pen.textBaseline = "middle";
    pen.fillText(text, 4, canvas.height / 2);
  }
  const material = new SpriteMaterial({ map: new CanvasTexture(canvas), depthTest: false });
  const sprite = new Sprite(material);
  sprite.userData.slenderness = canvas.width / canvas.height;
  sprite.renderOrder = 10;
  resize(sprite, 0);
  return sprite;
}

/** Gives a text its size where a pixel shows so many metres. */
export function resize(sprite: Sprite, pixel_m: number): void {
  const height_m = Math.max(HEIGHT_M, LEAST_PX * pixel_m);
  sprite.scale.set(height_m * sprite.userData.slenderness, height_m, 1);
}
