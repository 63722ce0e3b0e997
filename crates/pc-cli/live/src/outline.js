// What stands where in the text of a model: sections, and entries on one line.

const HEADER = /^\s*\[\[?\s*([^\]]+?)\s*\]\]?/;
const ENTRY = /^(\s*)("(?:[^"\\]|\\.)*"|'[^']*'|[^\s=#"'[\]{},]+)(\s*=\s*)/;

const plain = (key) => (/^["']/.test(key) ? key.slice(1, -1) : key);

// A path such as `bodies."rod 1"` in its parts.
export function pathOf(header) {
  return (header.match(/"[^"]*"|'[^']*'|[^.\s]+/g) ?? []).map(plain);
}

// The end of the value that begins at `from` of a line: before a comment and the spaces before it.
function endOfValue(line, from) {
  let quote = "";
  let end = from;
  for (let i = from; i < line.length; i++) {
    const sign = line[i];
    if (quote !== "") {
      i += sign === "\\" && quote === '"' ? 1 : 0;
      quote = sign === quote ? "" : quote;
    } else if (sign === '"' || sign === "'") {
      quote = sign;
    } else if (sign === "#") {
      break;
    }
    end = line[i]?.trim() ? i + 1 : end;
  }
  return Math.max(end, from);
}

// All headers and entries: { path, isHeader } and { path, key, value, from, to, comment }, `from` and `to` being the ends
// of the value in the text, `start` the place of the line.
export function outline(text) {
  const found = [];
  let path = [];
  let start = 0;
  let long = "";
  let depth = 0;
  for (const line of text.split("\n")) {
    const fences = line.match(/"""|'''/g) ?? [];
    const entry = long === "" && depth === 0 ? ENTRY.exec(line) : null;
    const header = long === "" && depth === 0 ? HEADER.exec(line) : null;
    if (header) {
      path = pathOf(header[1]);
      found.push({ path, isHeader: true, start });
    } else if (entry) {
      const from = entry[0].length;
      const to = endOfValue(line, from);
      const comment = line.slice(to).match(/#\s*(.*)$/)?.[1]?.trim() ?? "";
      found.push({ path, key: plain(entry[2]), value: line.slice(from, to), from: start + from, to: start + to, comment, start });
    }
    if (!header && long === "") {
      depth = Math.max(0, depth + balance(line));
    }
    for (const fence of fences) {
      long = long === "" ? fence : fence === long ? "" : long;
    }
    start += line.length + 1;
  }
  return found;
}

// The brackets that a line leaves open, without those in strings and comments.
function balance(line) {
  const bare = line.replace(/"(?:[^"\\]|\\.)*"|'[^']*'/g, "").replace(/#.*$/, "");
  return (bare.match(/\[/g)?.length ?? 0) - (bare.match(/\]/g)?.length ?? 0);
}

// The path of the section at a place, and the keys that it has already.
export function sectionAt(text, place) {
  let path = [];
  let keys = [];
  for (const item of outline(text)) {
    if (item.isHeader) {
      if (item.start > place) {
        break;
      }
      path = item.path;
      keys = [];
    } else {
      keys.push(item.key);
    }
  }
  return { path, keys };
}

// Sections whose keys are names in expressions, with what these are called.
const NAMING = {
  parameters: "parameter", inputs: "input", functions: "function", definitions: "definition", coordinates: "coordinate",
  quasi_velocities: "quasi-velocity", states: "state", outputs: "output", constraints: "constraint",
};

// Names that expressions of a model may contain: [{ name, kind, comment }].
export function names(text) {
  const known = new Map();
  const add = (name, kind, comment = "") => known.has(name) || known.set(name, { name, kind, comment });
  for (const { path, isHeader, key, comment } of outline(text)) {
    const kind = NAMING[path[0]];
    if (kind && isHeader && path.length === 2) {
      add(path[1], kind);
    } else if (kind && !isHeader && path.length === 1) {
      add(key, kind, comment);
      if (kind === "coordinate") {
        add(`${key}'`, "velocity");
      }
    }
  }
  return [...known.values()];
}

// The comments on the lines of parameters and starts, by name.
export function comments(text) {
  const entries = outline(text).filter(({ isHeader, path }) => !isHeader && path.length === 1 && path[0] in NAMING);
  return new Map(entries.map(({ key, comment }) => [key, comment]));
}

// The change of the text that gives a parameter or a start another value; undefined where it stands in no single place.
export function changed(text, name, value) {
  const sections = ["parameters", "coordinates", "quasi_velocities", "states"];
  for (const { path, key, isHeader, value: old, from, to } of outline(text)) {
    if (isHeader || !sections.includes(path[0])) {
      continue;
    }
    const isOwn = path.length === 1 && key === name && !old.startsWith("{");
    const isStart = path.length === 2 && path[1] === name && key === "start";
    if (isOwn || isStart) {
      return { from, to, insert: asToml(value) };
    }
    const inside = path.length === 1 && key === name && /\bstart\s*=\s*("[^"]*"|[^\s,}]+)/.exec(old);
    if (inside) {
      const at = from + inside.index + inside[0].length - inside[1].length;
      return { from: at, to: at + inside[1].length, insert: asToml(value) };
    }
  }
  return undefined;
}

// A number of TOML needs digits on both sides of its point, and is not whole by accident.
function asToml(value) {
  return /^-?\d+$/.test(value) ? `${value}.0` : value;
}
