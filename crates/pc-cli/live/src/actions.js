// The buttons for commands, each with the line that does the same in a terminal.

import { commandLine } from "./commands.js";
import { byId, element } from "./elements.js";

// What a button shows: a tab of the page, what the command prints, or a file.
const BUTTONS = [
  ["run", "Run", "tab", "plots", "Integrates the motion."],
  ["check", "Check", "output", "", "Consistency, conserved quantities, steady motions near the start."],
  ["derive", "Derive", "output", "", "The equations in the chosen form, as text."],
  ["theory", "Theory", "output", "", "Brackets, integrals, measures, steady motions, reductions."],
  ["linearize", "Linearize", "output", "", "Matrices, eigenvalues and modes about the start, an equilibrium or a steady motion."],
  ["equilibria", "Equilibria", "output", "", "Equilibria near the start, with their stability."],
  ["sweep", "Sweep", "file", "", "The motion for many values of a parameter, as a table."],
  ["report", "Report", "file", "", "All of this on one page."],
  ["animate", "Animation", "file", "", "A page with nothing but the motion."],
  ["csv", "Table", "file", "", "The motion as numbers."],
  ["png", "Picture", "file", "", "One still, at the time that is shown."],
  ["latex", "LaTeX", "file", "", "The equations for a paper."],
  ["c", "C", "file", "", "The equations as C99."],
  ["rust", "Rust", "file", "", "The equations as Rust."],
  ["fmu", "FMU", "file", "", "A Functional Mock-up Unit, version 3."],
  ["notebook", "Notebook", "file", "", "A notebook with this model, for Jupyter."],
];

export class Actions {
  // `does` has functions tab(name), output(kind, words, line) and file(kind); `state` tells what the lines contain.
  constructor(root, does, state) {
    this.state = state;
    this.lines = BUTTONS.map(([kind, words, how, tab, hint]) => {
      const line = element("code");
      const copy = element("button", {
        type: "button", className: "quiet copy", textContent: "copy", "aria-label": `Copy the command line of ${words}`,
        onclick: () => this.copy(line.textContent, copy),
      });
      const button = element("button", {
        type: "button", className: "action", textContent: words, title: hint,
        onclick: () => (how === "tab" ? does.tab(tab) : does[how](kind, words)),
      });
      const has = commandLine(kind, state()) !== undefined;
      const beside = has
        ? element("div", { className: "line" }, line, copy)
        : element("span", { className: "soft", textContent: hint });
      root.append(element("div", { className: "command" }, button, beside));
      return { kind, line };
    });
    this.update();
  }

  update() {
    this.lines.forEach(({ kind, line }) => (line.textContent = commandLine(kind, this.state()) ?? ""));
  }

  async copy(text, button) {
    try {
      await navigator.clipboard.writeText(text);
      button.textContent = "copied";
    } catch {
      // Without leave to copy, the line is selected, for the reader to do it.
      getSelection().selectAllChildren(button.previousElementSibling);
      button.textContent = "selected";
    }
    setTimeout(() => (button.textContent = "copy"), 1500);
  }
}

// The choice of the parameter of a sweep.
export function offerNames(names) {
  const list = byId("vary");
  if (names.join("\n") !== [...list.options].map(({ value }) => value).join("\n")) {
    const before = list.value;
    list.replaceChildren(...names.map((name) => new Option(name, name)));
    list.value = names.includes(before) ? before : (names[0] ?? "");
  }
}
