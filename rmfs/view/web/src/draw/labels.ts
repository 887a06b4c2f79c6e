/** Short texts that always face the viewer. */

import { CanvasTexture, Sprite, SpriteMaterial } from "three";

/** Makes a text of a height in metres. */
export function label(text: string, colour: string, height_m: number): Sprite {
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
  sprite.scale.set((height_m * canvas.width) / canvas.height, height_m, 1);
  sprite.renderOrder = 10;
  return sprite;
}
