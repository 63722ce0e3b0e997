// The command lines that do what the page does.

// An argument as a shell reads it.
export function quoted(argument) {
  return /^[\p{L}\p{N}_@%+=:,./-]+$/u.test(argument) ? argument : `'${argument.replaceAll("'", "'\\''")}'`;
}

// Options that all commands have: values other than those of the text.
function settings({ set = {} }) {
  return given(Object.entries(set));
}

// What a sweep varies has no single value.
const unvaried = ({ set = {}, vary: range }) => given(Object.entries(set).filter(([name]) => name !== range?.name));

function given(entries) {
  return entries.flatMap(([name, value]) => ["--set", `${name}=${value}`]);
}

const form = (state) => (state.form ? ["--form", state.form] : []);
const end = (state) => (state.tEnd ? ["--t-end", state.tEnd] : []);
// The forms that can be integrated, and those of which source can be written.
const INTEGRATED = new Set(["poincare", "canonical", "reduced", "lie-poisson", "orthonormal", "voronets"]);
const WRITTEN = new Set(["poincare", "reduced", "orthonormal", "voronets"]);
const only = (forms) => (state) => (forms.has(state.form) ? form(state) : []);
const to = (ending) => ({ stem }) => ["-o", `${stem}${ending}`];
const vary = ({ vary: range }) => ["--vary", range ? `${range.name}=${range.low}:${range.high}:${range.count}` : "NAME=FROM:TO:N"];

// By the name of a button: the command, and what follows the name of the model.
const COMMANDS = {
  run: ["run", settings, only(INTEGRATED), end, to(".csv")],
  check: ["check", settings],
  derive: ["derive", settings, form],
  theory: ["theory", settings],
  linearize: ["linearize", settings],
  equilibria: ["equilibria", settings],
  sweep: ["sweep", unvaried, vary, only(INTEGRATED), end, to(".csv")],
  report: ["report", settings, only(INTEGRATED), end, to(".html")],
  animate: ["animate", settings, end, to(".html")],
  png: ["animate", settings, end, ({ at }) => (at === undefined ? [] : ["--time", at]), to(".png")],
  csv: ["run", settings, only(INTEGRATED), end, to(".csv")],
  latex: ["derive", settings, form, () => ["--format", "latex"], to(".tex")],
  c: ["emit", () => ["--lang", "c"], settings, only(WRITTEN), ({ stem }) => ["-o", `${stem}-c`]],
  rust: ["emit", () => ["--lang", "rust"], settings, only(WRITTEN), ({ stem }) => ["-o", `${stem}-rust`]],
  fmu: ["emit", () => ["--fmu", "3"], settings, only(WRITTEN), to(".fmu")],
};

export const KINDS = Object.keys(COMMANDS);

// `state` is { model, set, form, tEnd, vary, at }, values as text. There is none for a notebook.
export function commandLine(kind, state) {
  if (!(kind in COMMANDS)) {
    return undefined;
  }
  const [command, ...parts] = COMMANDS[kind];
  const whole = { ...state, stem: stemOf(state.model) };
  const rest = parts.flatMap((part) => part(whole));
  return ["pc", command, state.model, ...rest].map(String).map(quoted).join(" ");
}

// The name of a file without its folder and its ending.
export function stemOf(model) {
  return model.replace(/^.*\//, "").replace(/\.toml$/, "") || "model";
}
