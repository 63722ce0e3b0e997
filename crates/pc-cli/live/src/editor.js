// The editor of the text.

import { autocompletion, closeBrackets, closeBracketsKeymap, completionKeymap } from "@codemirror/autocomplete";
import { defaultKeymap, history, historyKeymap, indentWithTab } from "@codemirror/commands";
import { bracketMatching, HighlightStyle, indentUnit, StreamLanguage, syntaxHighlighting } from "@codemirror/language";
import { lintGutter, lintKeymap, setDiagnostics } from "@codemirror/lint";
import { highlightSelectionMatches, search, searchKeymap } from "@codemirror/search";
import { EditorState } from "@codemirror/state";
import {
  drawSelection, dropCursor, EditorView, highlightActiveLine, highlightActiveLineGutter, highlightSpecialChars, keymap,
  lineNumbers,
} from "@codemirror/view";
import { tags } from "@lezer/highlight";
import { complete } from "./completion.js";
import { placed } from "./diagnostics.js";
import { toml } from "./toml.js";

// Colours from the custom properties of the page, which are light or dark.
const COLOURS = HighlightStyle.define([
  { tag: tags.heading, color: "var(--code-section)", fontWeight: "600" },
  { tag: tags.propertyName, color: "var(--code-key)" },
  { tag: tags.string, color: "var(--code-string)" },
  { tag: [tags.number, tags.bool], color: "var(--code-number)" },
  { tag: tags.function(tags.variableName), color: "var(--code-function)" },
  { tag: tags.variableName, color: "var(--ink)" },
  { tag: [tags.operator, tags.punctuation, tags.bracket], color: "var(--soft)" },
  { tag: tags.comment, color: "var(--code-comment)", fontStyle: "italic" },
]);

export class Editor {
  // `actions` are { changed, save, compute }; `schema` is filled later.
  constructor(parent, text, actions) {
    this.schema = {};
    const run = (action) => () => {
      action();
      return true;
    };
    const own = [
      { key: "Mod-s", run: run(actions.save), preventDefault: true },
      { key: "Mod-Enter", run: run(actions.compute), preventDefault: true },
    ];
    const extensions = [
      lineNumbers(), highlightActiveLineGutter(), highlightSpecialChars(), history(), drawSelection(), dropCursor(),
      StreamLanguage.define(toml), syntaxHighlighting(COLOURS), bracketMatching(), closeBrackets(), highlightActiveLine(),
      highlightSelectionMatches(), search({ top: true }), lintGutter(), indentUnit.of("    "), EditorView.lineWrapping,
      autocompletion({ override: [(context) => this.complete(context)], icons: false }),
      keymap.of([
        ...own, ...closeBracketsKeymap, ...defaultKeymap, ...searchKeymap, ...historyKeymap, ...completionKeymap, ...lintKeymap,
        indentWithTab,
      ]),
      EditorView.contentAttributes.of({
        "aria-label": "Text of the model. Escape, then Tab, leaves the editor.",
        spellcheck: "false", autocapitalize: "off", autocorrect: "off",
      }),
      EditorView.updateListener.of((update) => update.docChanged && actions.changed()),
    ];
    this.view = new EditorView({ parent, state: EditorState.create({ doc: text, extensions }) });
  }

  get text() {
    return this.view.state.doc.toString();
  }

  complete({ state, pos, explicit }) {
    const found = complete(state.doc.toString(), pos, this.schema, explicit);
    return found && { ...found, validFor: /^[\p{L}\p{N}_'-]*$/u };
  }

  // Shows what pc says. `text` is that to which it was said; where the text is another by now, later news will come.
  report(list, text) {
    if (text !== this.text) {
      return;
    }
    const diagnostics = list.map((one) => {
      const { help, ...rest } = placed(one, text);
      return { ...rest, source: "pc", renderMessage: () => worded(rest.message, help) };
    });
    this.view.dispatch(setDiagnostics(this.view.state, diagnostics));
  }

  // Goes to a place that a diagnostic names.
  show(diagnostic) {
    const { from, to } = placed(diagnostic, this.text);
    this.view.dispatch({ selection: { anchor: from, head: to }, effects: EditorView.scrollIntoView(from, { y: "center" }) });
    this.view.focus();
  }

  change(change) {
    this.view.dispatch({ changes: change, userEvent: "input" });
  }
}

function worded(message, help) {
  const element = document.createElement("div");
  element.className = "diagnostic";
  element.append(message);
  if (help) {
    const line = document.createElement("div");
    line.className = "help";
    line.textContent = help;
    element.append(line);
  }
  return element;
}
