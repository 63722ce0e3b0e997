// The colours of the text: TOML, with the expressions of pc between quotation marks.

const PROSE = new Set(["name", "description", "reference", "kind", "file", "column", "method", "form", "text", "label", "title"]);
const NAME = /^[\p{L}_][\p{L}\p{N}_]*'*/u;
const NUMBER = /^[+-]?(?:\d[\d_]*)(?:\.\d+)?(?:[eE][+-]?\d+)?/;

function inside(stream, state) {
  const { quote } = state;
  if (stream.match(quote)) {
    state.quote = "";
    return state.isKey ? "propertyName" : "string";
  }
  if (state.isKey || state.isProse) {
    while (!stream.eol() && !stream.match(quote, false)) {
      if (stream.next() === "\\" && quote[0] === '"') {
        stream.next();
      }
    }
    return state.isKey ? "propertyName" : "string";
  }
  if (stream.eatSpace()) {
    return null;
  }
  if (stream.match(NUMBER)) {
    return "number";
  }
  if (stream.match(NAME)) {
    return stream.match(/^\s*\(/, false) ? "variableName.function" : "variableName";
  }
  stream.next();
  return "operator";
}

// A parser for CodeMirror's StreamLanguage.
export const toml = {
  name: "toml",
  startState: () => ({ section: "", key: "", isValue: false, depth: 0, quote: "", isKey: false, isProse: false }),
  copyState: (state) => ({ ...state }),
  token(stream, state) {
    if (state.quote !== "") {
      return inside(stream, state);
    }
    if (stream.sol() && state.depth === 0) {
      state.isValue = false;
    }
    if (stream.eatSpace()) {
      return null;
    }
    if (stream.peek() === "#") {
      stream.skipToEnd();
      return "comment";
    }
    if (!state.isValue && state.depth === 0 && stream.peek() === "[") {
      const [header] = stream.match(/^\[.*?\]{1,2}|^\[.*/);
      state.section = header.replace(/[[\]]/g, "").split(".")[0].trim();
      return "heading";
    }
    const quote = stream.match(/^"""|^'''|^"|^'/);
    if (quote) {
      [state.quote] = quote;
      state.isKey = !state.isValue;
      state.isProse = state.section === "model" || (PROSE.has(state.key) && state.section !== "definitions");
      return state.isKey ? "propertyName" : "string";
    }
    if (stream.eat("=")) {
      state.isValue = true;
      return "operator";
    }
    if (!state.isValue) {
      const key = stream.match(/^[^\s=#"'.,{}[\]]+/);
      if (key) {
        [state.key] = key;
        return "propertyName";
      }
      stream.next();
      return "punctuation";
    }
    if (stream.match(/^(true|false)\b/)) {
      return "bool";
    }
    if (stream.match(NUMBER)) {
      return "number";
    }
    return bracket(stream.next(), state, stream);
  },
  languageData: { commentTokens: { line: "#" }, closeBrackets: { brackets: ["(", "[", "{", '"'] } },
};

function bracket(sign, state, stream) {
  if (sign === "[" || sign === "{") {
    state.depth++;
    // Keys stand in braces again.
    state.isValue = sign === "[";
    return "bracket";
  }
  if (sign === "]" || sign === "}") {
    state.depth = Math.max(0, state.depth - 1);
    return "bracket";
  }
  if (sign === "," && state.depth > 0) {
    state.isValue = !stream.match(/^\s*("[^"]*"|[\w-]+)\s*=/, false);
  }
  return "punctuation";
}
