// What may stand at a place of the text: sections, keys, words from a list, and names in expressions.

import { names, outline, sectionAt } from "./outline.js";

const FUNCTIONS = [
  "sin", "cos", "tan", "cot", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "exp", "log", "sqrt",
  "abs", "sign", "min", "max", "step", "d",
];
const CONSTANTS = ["pi", "t"];

// All schemas that a schema may mean, with references resolved.
function alternatives(schema, root, depth = 0) {
  if (!schema || typeof schema !== "object" || depth > 8) {
    return [];
  }
  const own = [schema];
  if (schema.$ref) {
    const target = schema.$ref.replace(/^#\//, "").split("/").reduce((at, key) => at?.[key], root);
    own.push(...alternatives(target, root, depth + 1));
  }
  for (const key of ["anyOf", "oneOf", "allOf"]) {
    (schema[key] ?? []).forEach((other) => own.push(...alternatives(other, root, depth + 1)));
  }
  return own;
}

// The schemas of what stands in a section or an entry.
function schemasAt(root, path) {
  let at = alternatives(root, root);
  for (const key of path) {
    const below = at.flatMap((schema) => alternatives(schema.items, root).concat(schema));
    at = below.flatMap((schema) => {
      // Where any key may stand, the same follows each; `false` says that none may.
      return alternatives(schema.properties?.[key] ?? schema.additionalProperties, root);
    });
  }
  return at.flatMap((schema) => alternatives(schema.items, root).concat(schema));
}

function keysOf(schemas) {
  const keys = new Map();
  for (const { properties } of schemas) {
    for (const [key, { description }] of Object.entries(properties ?? {})) {
      if (!keys.has(key)) {
        keys.set(key, description ?? "");
      }
    }
  }
  return keys;
}

// Whether a place of a line is between quotation marks, and where these begin.
export function quoteAt(before) {
  let quote = "";
  let start = -1;
  for (let i = 0; i < before.length; i++) {
    const sign = before[i];
    if (quote !== "") {
      i += sign === "\\" && quote === '"' ? 1 : 0;
      if (sign === quote) {
        quote = "";
      }
    } else if (sign === '"' || sign === "'") {
      [quote, start] = [sign, i];
    } else if (sign === "#") {
      return { isComment: true };
    }
  }
  return quote === "" ? undefined : { quote, start };
}

// { from, options } with { label, apply, detail, info, type }; null where nothing is known.
export function complete(text, place, schema, isAsked = false) {
  const lineStart = text.lastIndexOf("\n", place - 1) + 1;
  const before = text.slice(lineStart, place);
  const header = /^\s*\[\[?\s*([\w-]*)$/.exec(before);
  if (header) {
    return { from: place - header[1].length, options: sections(text, schema, before, text.slice(place)) };
  }
  const { path, keys } = sectionAt(text, place);
  const quoted = quoteAt(before);
  if (quoted?.isComment) {
    return null;
  }
  if (quoted) {
    const key = keyOf(text, place);
    const isValue = before.slice(0, quoted.start).includes("=") || key !== undefined;
    return isValue ? words(text, place, schemasAt(schema, [...path, key].filter(Boolean)), before.slice(quoted.start + 1)) : null;
  }
  const start = /^\s*([\w-]*)$/.exec(before);
  if (start && (start[1] !== "" || isAsked)) {
    const options = [...keysOf(schemasAt(schema, path))]
      .filter(([key]) => !keys.includes(key) || key === start[1])
      .map(([key, info]) => ({ label: key, apply: `${key} = `, info, type: "property" }));
    return options.length > 0 && path.length > 0 ? { from: place - start[1].length, options } : null;
  }
  return null;
}

function sections(text, schema, before, after) {
  const there = new Set(outline(text).filter(({ isHeader }) => isHeader).map(({ path }) => path[0]));
  const isDouble = before.includes("[[");
  const rest = /^\]*/.exec(after)[0].length;
  return Object.entries(schema.properties ?? {})
    .filter(([key, { type }]) => type === "array" || !there.has(key))
    .map(([key, { type, description }]) => {
      const isList = type === "array";
      const close = "]".repeat(Math.max(0, (isList ? 2 : 1) - rest));
      return { label: key, apply: `${isList && !isDouble ? "[" : ""}${key}${close}`, info: description, type: "namespace" };
    });
}

// The key of the entry that contains a place.
function keyOf(text, place) {
  const entries = outline(text).filter(({ isHeader, start }) => !isHeader && start <= place);
  return entries.at(-1)?.key;
}

function words(text, place, schemas, string) {
  const listed = schemas.flatMap((schema) => schema.enum ?? (schema.const === undefined ? [] : [schema.const]));
  if (listed.length > 0) {
    const options = [...new Set(listed)].map((label) => ({ label: String(label), type: "enum" }));
    return { from: place - string.length, options };
  }
  if (schemas.length > 0 && !schemas.some(isExpression)) {
    return null;
  }
  const word = /[\p{L}_][\p{L}\p{N}_]*'*$/u.exec(string)?.[0] ?? "";
  if (word === "") {
    return null;
  }
  const own = names(text).map(({ name, kind, comment }) => ({
    label: name,
    apply: kind === "function" ? `${name}(` : name,
    detail: kind,
    info: comment || undefined,
    type: "variable",
    boost: 2,
  }));
  const common = FUNCTIONS.map((name) => ({ label: name, apply: `${name}(`, type: "function" }));
  const constants = CONSTANTS.map((name) => ({ label: name, detail: name === "t" ? "time" : undefined, type: "constant" }));
  const known = new Set(own.map(({ label }) => label));
  const others = [...common, ...constants].filter(({ label }) => !known.has(label));
  return { from: place - word.length, options: [...own, ...others] };
}

// An expression is text or a number.
function isExpression({ type }) {
  return Array.isArray(type) && type.includes("number");
}
