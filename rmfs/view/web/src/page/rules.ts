/** Choosing the rule of a decision problem, and its parameters. */

import type { Rule } from "../data/layout";
import { choice, h } from "./dom";
import { form, type Schema, withoutNulls } from "./schema";

export interface ProblemForm {
  meaning: string;
  rules: Record<string, { about: string; schema: Schema }>;
}

export type Problems = Record<string, ProblemForm>;

/** Makes the choice among the rules of a problem, with the fields of the chosen one below. */
export function ruleField(
  { rules }: ProblemForm,
  present: Rule,
): { root: HTMLElement; read(): Rule } {
  const about = h("small", {});
  const inside = h("div", {});
  let read = (): unknown => ({});
  const options = Object.keys(rules).map((name) => [name, name] as const);
  const show = (name: string) => {
    const fields = form(rules[name].schema, name === present.name ? present : {});
    about.textContent = rules[name].about;
    inside.replaceChildren(fields.root);
    read = fields.read;
  };
  const { root, select } = choice("rule", options, show);
  select.value = present.name;
  show(present.name);
  return {
    root: h("div", { className: "rule" }, root, about, inside),
    read: () => ({ name: select.value, ...(withoutNulls(read()) as object) }),
  };
}
