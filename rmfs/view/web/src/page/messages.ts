/** A message in place of the picture. */

import { h } from "./dom";

/** Shows why there is nothing to see. */
export function fail(reason: string): void {
  document.title = "rmfs: cannot be shown";
  document.body.replaceChildren(
    h(
      "div",
      { className: "failure", role: "alert" },
      h("h1", {}, "This run cannot be shown"),
      h("p", {}, reason),
    ),
  );
}
