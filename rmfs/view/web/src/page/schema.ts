/** Fields of a form, made from the declaration of parameters (JSON Schema). */

import { h } from "./dom";
import { inWords, spoken, withoutUnit } from "./words";

export interface Schema {
  $ref?: string;
  $defs?: Record<string, Schema>;
  allOf?: Schema[];
  anyOf?: Schema[];
  oneOf?: Schema[];
  type?: string;
  const?: unknown;
  enum?: unknown[];
  default?: unknown;
  description?: string;
  properties?: Record<string, Schema>;
  minimum?: number;
  maximum?: number;
}

export interface Field {
  root: HTMLElement;
  /** Returns the value; undefined where nothing is said. */
  read(): unknown;
}

type Definitions = Record<string, Schema>;
type Values = Record<string, unknown>;

/** Makes the fields of all properties of a schema. */
export function form(schema: Schema, values: Values): Field {
  return group(schema, values, schema.$defs ?? {});
}

/** Returns what differs between two values of a form, by key. */
export function changes(before: unknown, after: unknown, key: string): Values {
  if (JSON.stringify(before) === JSON.stringify(after) || after === undefined) return {};
  if (isTable(before) && isTable(after) && variant(before) === variant(after)) {
    return Object.assign(
      {},
      ...Object.keys(after).map((name) => changes(before[name], after[name], `${key}.${name}`)),
    );
  }
  return after === null ? {} : { [key]: withoutNulls(after) };
}

/** Leaves out what is not said, at any depth. */
export function withoutNulls(value: unknown): unknown {
  if (!isTable(value)) return value;
  const said = Object.entries(value).filter(([, inner]) => inner !== null && inner !== undefined);
  return Object.fromEntries(said.map(([name, inner]) => [name, withoutNulls(inner)]));
}

function isTable(value: unknown): value is Values {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}

/** The keys by which alternatives are told apart. */
const TAGS = ["name", "mode", "kind", "distribution", "source"];

function variant(table: Values): string {
  return TAGS.map((tag) => String(table[tag])).join();
}

function resolved(schema: Schema, known: Definitions): Schema {
  const [only] = schema.allOf ?? [];
  const ref = schema.$ref ?? only?.$ref;
  if (ref === undefined) return schema;
  const { $ref, allOf, ...own } = schema;
  return { ...known[ref.replace("#/$defs/", "")], ...own };
}

function group(schema: Schema, values: Values, known: Definitions): Field {
  const fields = Object.entries(schema.properties ?? {}).map(([name, property]) => {
    const whole = resolved(property, known);
    const value = name in values ? values[name] : whole.default;
    return { name, schema: whole, field: field(whole, value, known) };
  });
  const shown = fields.filter(({ schema: { const: fixed } }) => fixed === undefined);
  return {
    root: h(
      "div",
      { className: "fields" },
      ...shown.map(({ name, schema: { description }, field: { root } }) =>
        row(name, description ?? "", root),
      ),
    ),
    read: () =>
      Object.fromEntries(fields.map(({ name, field: inner }) => [name, read(name, inner)])),
  };
}

function read(name: string, inner: Field): unknown {
  try {
    return inner.read();
  } catch (reason) {
    throw new Error(`${name}: ${reason instanceof Error ? reason.message : reason}`);
  }
}

function row(name: string, description: string, root: HTMLElement): HTMLElement {
  const about = h("small", {}, withoutUnit(description, inWords(name).unit));
  if (root.matches(".fields, .alternatives")) {
    const summary = h("summary", { title: name }, inWords(name).words, " ", about);
    return h("details", {}, summary, root);
  }
  const { words, unit } = inWords(name);
  const after = h("output", { className: "unit" }, unit);
  if (unit === "s" && root instanceof HTMLInputElement) {
    const say = () => {
      after.textContent = `${unit} ${spoken(root.valueAsNumber)}`;
    };
    root.addEventListener("input", say);
    say();
  }
  return h("label", { title: `${name}: ${description}` }, h("span", {}, words), root, after, about);
}

function field(schema: Schema, value: unknown, known: Definitions): Field {
  if (schema.const !== undefined) return { root: h("span"), read: () => schema.const };
  const options = (schema.oneOf ?? schema.anyOf ?? []).map((one) => resolved(one, known));
  const real = options.filter(({ type }) => type !== "null");
  if (real.length > 0) {
    const optional = real.length < options.length;
    if (real.every(({ properties }) => properties)) {
      return alternatives(real, optional, value, known);
    }
    if (real.length > 1) return json(value);
    return field({ ...schema, ...real[0], anyOf: [], oneOf: [] }, value, known);
  }
  if (schema.properties) return group(schema, isTable(value) ? value : {}, known);
  if (schema.enum) return choice(schema.enum, value);
  if (schema.type === "boolean") return flag(value);
  if (schema.type === "integer" || schema.type === "number") return number(schema, value);
  if (schema.type === "string") return text(value);
  return json(value);
}

/** Chooses one of several groups of fields, told apart by a fixed value in each. */
function alternatives(
  options: Schema[],
  optional: boolean,
  value: unknown,
  known: Definitions,
): Field {
  const tags = options.map(tagOf);
  const present = isTable(value) ? options.findIndex((_, n) => matches(tags[n], value)) : -1;
  const select = h("select", {});
  if (optional) select.append(h("option", { value: "-1", textContent: "none" }));
  tags.forEach((tag, n) => {
    select.append(h("option", { value: String(n), textContent: tag?.[1] ?? "given" }));
  });
  const inside = h("div", {});
  let chosen: Field | undefined;
  const choose = (n: number, given: Values) => {
    chosen = n >= 0 ? group(options[n], given, known) : undefined;
    inside.replaceChildren(...(chosen ? [chosen.root] : []));
  };
  const first = present >= 0 || optional ? present : 0;
  select.value = String(first);
  choose(first, isTable(value) ? value : {});
  select.addEventListener("change", () => choose(Number(select.value), {}));
  const alone = options.length === 1 && !optional;
  return {
    root: h("div", { className: "alternatives" }, ...(alone ? [inside] : [select, inside])),
    read: () => (chosen === undefined ? null : chosen.read()),
  };
}

function tagOf({ properties }: Schema): [string, string] | undefined {
  const found = Object.entries(properties ?? {}).find(
    ([, { const: fixed }]) => fixed !== undefined,
  );
  return found && [found[0], String(found[1].const)];
}

function matches(tag: [string, string] | undefined, value: Values): boolean {
  return tag === undefined || value[tag[0]] === tag[1];
}

function choice(options: unknown[], value: unknown): Field {
  const made = options.map((one) => h("option", { value: String(one), textContent: String(one) }));
  const select = h("select", {}, ...made);
  if (value !== undefined) select.value = String(value);
  return { root: select, read: () => options[select.selectedIndex] };
}

function flag(value: unknown): Field {
  const box = h("input", { type: "checkbox", checked: value === true });
  return { root: box, read: () => box.checked };
}

function number({ type, minimum, maximum }: Schema, value: unknown): Field {
  const input = h("input", { type: "number", step: type === "integer" ? "1" : "any" });
  if (minimum !== undefined) input.min = String(minimum);
  if (maximum !== undefined) input.max = String(maximum);
  if (typeof value === "number") input.value = String(value);
  return {
    root: input,
    read: () => {
      if (!input.validity.valid) throw new Error(input.validationMessage);
      return input.value === "" ? null : input.valueAsNumber;
    },
  };
}

function text(value: unknown): Field {
  const input = h("input", { type: "text", value: typeof value === "string" ? value : "" });
  return { root: input, read: () => (input.value === "" && !value ? null : input.value) };
}

/** A value of any other kind, as JSON says it. */
function json(value: unknown): Field {
  const said = value === undefined || value === null ? "" : JSON.stringify(value);
  const input = h("textarea", { value: said, rows: 1 });
  return {
    root: input,
    read: () => {
      if (input.value.trim() === "") return null;
      try {
        return JSON.parse(input.value) as unknown;
      } catch {
        throw new Error(`not JSON: ${input.value}`);
      }
    },
  };
}
