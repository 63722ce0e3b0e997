// The line that says how things are.

import { counted } from "./diagnostics.js";
import { duration } from "./numbers.js";

// Work that is done sooner is not announced.
const SOON = 150;

export class Status {
  constructor(root, go) {
    this.root = root;
    this.light = root.querySelector(".light");
    this.words = root.querySelector(".words");
    this.problems = root.querySelector(".problems");
    this.note = root.querySelector(".note");
    this.list = [];
    this.problems.addEventListener("click", () => this.list.length > 0 && go(this.list[0]));
  }

  begin() {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.say("busy", "computing…"), SOON);
  }

  done(milliseconds) {
    clearTimeout(this.timer);
    this.say(this.list.some(({ severity }) => (severity ?? "error") === "error") ? "bad" : "good", duration(milliseconds));
  }

  lost(message) {
    clearTimeout(this.timer);
    this.say("bad", message);
  }

  diagnose(list) {
    this.list = list;
    const words = counted(list);
    // The same words again are not read out.
    if (this.problems.textContent !== words) {
      this.problems.textContent = words;
    }
    this.problems.disabled = list.length === 0;
    this.problems.title = list.length > 0 ? `Go to line ${list[0].line}` : "";
  }

  // A word that goes away by itself.
  tell(words, isBad = false) {
    clearTimeout(this.fading);
    this.note.textContent = words;
    this.note.classList.toggle("bad", isBad);
    this.fading = setTimeout(() => (this.note.textContent = ""), isBad ? 12_000 : 4000);
  }

  say(light, words) {
    this.light.dataset.state = light;
    this.words.textContent = words;
  }
}
