/** What draws: a graphics card, or the processor in its place. */

const SOFTWARE = /swiftshader|llvmpipe|software|basic render/i;

let known: boolean | undefined;

/**
 * Returns whether a processor draws instead of a graphics card.
 *
 * Then edges stay rough, pixels are as large as those of the page, and bodies are drawn as one mesh:
 * drawing the same body many times, cheap for a card, costs a processor as many draw calls.
 */
export function inSoftware(): boolean {
  known ??= probe();
  return known;
}

function probe(): boolean {
  const context = document.createElement("canvas").getContext("webgl2");
  const told = context?.getExtension("WEBGL_debug_renderer_info");
  const name = told ? context?.getParameter(told.UNMASKED_RENDERER_WEBGL) : "";
  context?.getExtension("WEBGL_lose_context")?.loseContext();
  return SOFTWARE.test(String(name));
}
