/** The form that starts a run, made from the declared parameters. */

import type { Rule } from "../data/layout";
import { button, choice, h } from "./dom";
import { Preview } from "./preview";
import { type Problems, ruleField } from "./rules";
import { changes, type Field, form, type Schema } from "./schema";
import { ask } from "./sources";

interface Part {
  schema: Schema;
  values: Record<string, unknown>;
}

interface Offer {
  names: Record<string, string[]>;
  chosen: Record<string, string>;
  layout: Part;
  scenario: Part;
  controllers: { problems: Problems; values: Record<string, Rule> };
}

/** A part of the form: what its fields say, by key, where that differs from the file. */
type Read = () => Record<string, unknown>;

/** Fills an element with the form. */
export async function startForm(root: HTMLElement, chosen: Record<string, string> = {}) {
  const dark = window.matchMedia("(prefers-color-scheme: dark)").matches;
  document.documentElement.dataset.theme ??= dark ? "dark" : "light";
  const query = new URLSearchParams(chosen);
  const offer = (await (await ask(`form?${query}`)).json()) as Offer;
  const files = Object.entries(offer.names).map(([part, names]) => {
    const options = names.map((name) => [name, name] as const);
    const made = choice(part, options, (name) => {
      void startForm(root, { ...offer.chosen, [part]: name });
    });
    made.select.id = `start-${part}`;
    made.select.value = offer.chosen[part];
    return made.root;
  });
  const seed = h("input", { type: "number", min: "0", step: "1", value: "0", id: "start-seed" });
  const speed = h("input", { type: "number", min: "0", step: "any", id: "start-speed" });
  speed.placeholder = "as fast as it goes";
  const out = h("input", {
    type: "text",
    id: "start-out",
    placeholder: "named after what is chosen",
  });
  const trace = h("input", { type: "checkbox", checked: true, id: "start-trace" });
  const message = h("p", { className: "wrong", role: "alert" });
  const reads: Read[] = [];
  const sections = [
    section("Layout: the warehouse", part("layout", offer.layout, reads)),
    section("Scenario: orders, stock and time", part("scenario", offer.scenario, reads)),
    section("Controllers: the rules that decide", controllers(offer, reads)),
  ];
  const preview = new Preview();
  const changed = () => {
    try {
      preview.show(offer.chosen.layout, said(reads.slice(0, 1)));
    } catch (reason) {
      preview.refuse(reason);
    }
  };
  const start = button("start the run", "Starts it and goes to its page", () => {
    message.textContent = "";
    begin().catch((reason: unknown) => {
      message.textContent = reason instanceof Error ? reason.message : String(reason);
      start.disabled = false;
    });
  });
  start.id = "start-run";
  const begin = async () => {
    const set = said(reads);
    start.disabled = true;
    const answer = await ask("start", {
      ...offer.chosen,
      set,
      seed: Number(seed.value),
      speed: speed.value === "" ? null : Number(speed.value),
      trace: trace.checked,
      ...(out.value === "" ? {} : { out: out.value }),
    });
    location.href = ((await answer.json()) as { url: string }).url;
  };
  root.className = "start";
  root.replaceChildren(
    h("h1", {}, "A new run"),
    h("div", { className: "files" }, ...files),
    h(
      "div",
      { className: "built" },
      h("div", {}, ...sections),
      h(
        "div",
        { className: "begin" },
        labelled("seed", seed),
        labelled("simulated seconds per second", speed),
        labelled("folder below results/", out),
        labelled("write its trace", trace),
        start,
        message,
        // last: its height changes when it answers, which must move nothing that is clicked
        preview.root,
      ),
    ),
  );
  sections[0].addEventListener("input", changed);
  sections[0].addEventListener("change", changed);
  changed();
}

/** Returns what the parts of the form say, by key. */
function said(reads: Read[]): Record<string, unknown> {
  return Object.assign({}, ...reads.map((read) => read())) as Record<string, unknown>;
}

function labelled(text: string, input: HTMLElement): HTMLElement {
  return h("label", {}, h("span", {}, text), input);
}

function section(title: string, ...inside: HTMLElement[]): HTMLElement {
  return h("details", { className: "part" }, h("summary", {}, h("h2", {}, title)), ...inside);
}

function part(name: string, { schema, values }: Part, reads: Read[]): HTMLElement {
  const fields: Field = form(schema, values);
  const before = fields.read();
  reads.push(() => changes(before, fields.read(), name));
  return fields.root;
}

function controllers({ controllers: { problems, values } }: Offer, reads: Read[]): HTMLElement {
  const rows = Object.entries(problems).map(([problem, offered]) => {
    const field = ruleField(offered, values[problem]);
    const before = JSON.stringify(field.read());
    reads.push(() => {
      const rule = field.read();
      const changed = JSON.stringify(rule) !== before;
      return changed ? { [`controllers.${problem}`]: rule } : {};
    });
    field.root.id = `start-${problem}`;
    const name = h("summary", {}, problem, " ", h("small", {}, offered.meaning));
    return h("details", {}, name, field.root);
  });
  return h("div", { className: "fields" }, ...rows);
}
