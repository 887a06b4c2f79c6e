/** Room on the page: the panel beside the picture can be made wider, parts of it fold. */

import { h } from "./dom";

const LEAST_PX = 260;
/** The picture keeps at least so much of the page. */
const PICTURE = 0.3;
const STEP_PX = 20;
const WIDTH = "rmfs-panel-px";

/** Makes the panel with a handle that makes it wider or narrower; its width is remembered. */
export function aside(...inside: HTMLElement[]): HTMLElement {
  const handle = h("div", { className: "handle", tabIndex: 0, role: "separator" });
  handle.title = "Drag to make the panel wider or narrower; a double click undoes it";
  handle.ariaLabel = "width of the panel";
  handle.ariaOrientation = "vertical";
  const root = h("aside", {}, handle, ...inside);
  const set = (width_px: number) => {
    const most = (1 - PICTURE) * window.innerWidth;
    const width = Math.round(Math.min(Math.max(width_px, LEAST_PX), most));
    document.body.style.setProperty("--panel", `${width}px`);
    handle.ariaValueNow = String(width);
    remember(WIDTH, String(width));
  };
  const kept = Number(recall(WIDTH));
  if (kept > 0) set(kept);
  handle.addEventListener("pointerdown", (event) => {
    handle.setPointerCapture(event.pointerId);
    event.preventDefault();
  });
  handle.addEventListener("pointermove", ({ clientX, pointerId }) => {
    if (handle.hasPointerCapture(pointerId)) set(window.innerWidth - clientX);
  });
  handle.addEventListener("dblclick", () => {
    document.body.style.removeProperty("--panel");
    remember(WIDTH, "");
  });
  handle.addEventListener("keydown", (event) => {
    const by = { ArrowLeft: STEP_PX, ArrowRight: -STEP_PX }[event.key];
    if (by === undefined) return;
    event.stopPropagation();
    set(root.clientWidth + by);
  });
  return root;
}

/** Puts a part of the page under a heading that folds it; whether it is folded is remembered. */
export function folding(
  name: string,
  title: string,
  part: { root: HTMLElement; update: () => void },
): { root: HTMLElement; update: () => void } {
  const key = `rmfs-folded-${name}`;
  const root = h(
    "details",
    { open: recall(key) !== "yes", className: `folding ${name}-part` },
    h("summary", {}, title),
    part.root,
  );
  const update = () => {
    if (root.open) part.update();
  };
  root.addEventListener("toggle", () => {
    remember(key, root.open ? "" : "yes");
    update();
  });
  return { root, update };
}

/** Keeps a text for the next time the page is opened; where that is forbidden, for this time. */
function remember(key: string, text: string): void {
  try {
    if (text === "") localStorage.removeItem(key);
    else localStorage.setItem(key, text);
  } catch {
    // a page in a frame may have no storage
  }
}

function recall(key: string): string {
  try {
    return localStorage.getItem(key) ?? "";
  } catch {
    return "";
  }
}
