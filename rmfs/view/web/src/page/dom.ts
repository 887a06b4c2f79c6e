/** Making elements of the page. */

type Child = Node | string;

/** Makes an element with properties and children. */
export function h<Name extends keyof HTMLElementTagNameMap>(
  name: Name,
  properties: Partial<HTMLElementTagNameMap[Name]> = {},
  ...children: Child[]
): HTMLElementTagNameMap[Name] {
  const element = document.createElement(name);
  Object.assign(element, properties);
  element.append(...children);
  return element;
}

/** Makes a labelled choice among texts. */
export function choice(
  label: string,
  options: readonly (readonly [value: string, text: string])[],
  chosen: (value: string) => void,
): { root: HTMLElement; select: HTMLSelectElement } {
  const select = h(
    "select",
    {},
    ...options.map(([value, text]) => h("option", { value, textContent: text })),
  );
  select.addEventListener("change", () => chosen(select.value));
  return { root: h("label", {}, h("span", {}, label), select), select };
}

export function button(text: string, title: string, pressed: () => void): HTMLButtonElement {
  const made = h("button", { type: "button", textContent: text, title });
  made.addEventListener("click", pressed);
  return made;
}

/** Makes a labelled box to tick. */
export function tick(
  label: string,
  changed: (on: boolean) => void,
): { root: HTMLElement; box: HTMLInputElement } {
  const box = h("input", { type: "checkbox" });
  box.addEventListener("change", () => changed(box.checked));
  return { root: h("label", { className: "tick" }, box, label), box };
}

/** Writes a time as h:mm:ss. */
export function clock(time_s: number): string {
  const whole = Math.floor(time_s + 1e-6);
  const two = (value: number) => String(value).padStart(2, "0");
  return `${Math.floor(whole / 3600)}:${two(Math.floor(whole / 60) % 60)}:${two(whole % 60)}`;
}

/**
 * Makes what is inside an element look as inside another one. What is the same stays, so that a
 * button which is being pressed is still there when it is let go.
 */
export function renew(old: Element, made: Element): void {
  const before = [...old.children];
  const after = [...made.children];
  after.forEach((child, n) => {
    const present = before[n];
    if (present === undefined) old.append(child);
    else if (present.isEqualNode(child)) return;
    else if (isFrame(present) && isFrame(child) && sameTag(present, child)) renew(present, child);
    else present.replaceWith(child);
  });
  for (const child of before.slice(after.length)) child.remove();
}

/** Whether an element holds other elements and no text of its own. */
function isFrame(element: Element): boolean {
  return [...element.childNodes].every((node) => node.nodeType === Node.ELEMENT_NODE);
}

function sameTag(one: Element, other: Element): boolean {
  return one.cloneNode(false).isEqualNode(other.cloneNode(false));
}
