// Sliders for parameters and starts.

import { element } from "./elements.js";
import { read, written } from "./numbers.js";
import { partOf, rangeOf, stepped, widened } from "./ranges.js";

class Slider {
  constructor({ name, value, unit }, isStart, tell) {
    Object.assign(this, { name, value, isStart, tell, given: value, range: rangeOf(value, isStart) });
    const words = isStart ? `Start of ${name}` : name;
    this.label = element("label", { className: "slider-name", textContent: name });
    this.track = element("input", {
      type: "range", "aria-label": words, title: "A double click sets the value of the text again",
    });
    this.field = element("input", {
      type: "text", inputMode: "decimal", autocomplete: "off", className: "slider-value", "aria-label": `${words}, exactly`,
    });
    this.unit = element("span", { className: "soft", textContent: unit ?? "" });
    this.reset = element("button", {
      type: "button", className: "quiet", textContent: "↺", title: "Value of the text",
      "aria-label": `Set ${words} as in the text`,
      onclick: () => this.set(this.given),
    });
    this.write = element("button", {
      type: "button", className: "quiet", textContent: "✎", title: "Write into the text",
      "aria-label": `Write ${words} into the text`,
      onclick: () => tell.write(name, written(this.value)),
    });
    this.row = element("div", { className: "slider" }, this.label, this.track, this.field, this.write, this.reset);
    this.track.addEventListener("input", () => this.set(stepped(this.range, Number(this.track.value)), true));
    for (const target of [this.track, this.label]) {
      target.addEventListener("dblclick", () => this.set(this.given));
    }
    this.field.addEventListener("change", () => this.set(read(this.field.value) ?? this.value));
    this.field.addEventListener("keydown", (event) => {
      const way = { ArrowUp: 1, ArrowDown: -1 }[event.key];
      if (way) {
        event.preventDefault();
        this.set(Number((this.value + way * this.range.step * (event.shiftKey ? 10 : 1)).toPrecision(12)));
      }
    });
    this.show();
  }

  get isChanged() {
    return this.value !== this.given;
  }

  set(value, isSliding = false) {
    this.range = isSliding ? this.range : widened(this.range, value);
    const isOther = value !== this.value;
    this.value = value;
    this.show();
    if (isOther) {
      this.tell.changed();
    }
  }

  // The text says another value by now, which ends what was set here.
  give(value) {
    if (value !== this.given) {
      Object.assign(this, { given: value, value, range: rangeOf(value, this.isStart) });
      this.show();
    }
  }

  describe(comment) {
    this.row.title = comment;
  }

  show() {
    const { low, high, step } = this.range;
    Object.assign(this.track, { min: low, max: high, step, value: this.value });
    this.track.style.setProperty("--part", partOf(this.range, this.value));
    this.track.style.setProperty("--given", partOf(this.range, this.given));
    this.field.value = written(this.value);
    this.row.classList.toggle("changed", this.isChanged);
    this.reset.disabled = this.write.disabled = !this.isChanged;
  }
}

export class Sliders {
  // `tell` is { changed, write }.
  constructor(root, tell) {
    Object.assign(this, { root, tell, sliders: new Map() });
    this.parts = ["Parameters", "Starts"].map((title) => {
      const list = element("div", { className: "slider-list" });
      const part = element("details", { open: true, hidden: true }, element("summary", { textContent: title }), list);
      root.append(part);
      return { part, list };
    });
    this.empty = element("p", { className: "soft", textContent: "Parameters and starts of the model can be changed here." });
    root.append(this.empty);
  }

  // Takes what the text gives; sliders that stay keep their places, and values that are set.
  give(parameters, starts, comments) {
    const known = new Set();
    [parameters, starts].forEach((list, which) => {
      const rows = list.map((one) => {
        const key = `${which} ${one.name}`;
        known.add(key);
        const there = this.sliders.get(key);
        there?.give(one.value);
        const slider = there ?? new Slider(one, which === 1, this.tell);
        slider.describe(comments.get(one.name) ?? "");
        this.sliders.set(key, slider);
        return slider.row;
      });
      const { part, list: place } = this.parts[which];
      part.hidden = rows.length === 0;
      // Rows that are in their places already are left alone, for one of them may be held.
      if (rows.length !== place.children.length || rows.some((row, i) => place.children[i] !== row)) {
        place.replaceChildren(...rows);
      }
    });
    for (const key of this.sliders.keys()) {
      if (!known.has(key)) {
        this.sliders.delete(key);
      }
    }
    this.empty.hidden = known.size > 0;
  }

  // Values other than those of the text, as text by name.
  values() {
    const changed = [...this.sliders.values()].filter(({ isChanged }) => isChanged);
    return Object.fromEntries(changed.map(({ name, value }) => [name, written(value)]));
  }

  // The value and the range of a parameter, the first if there is no such name.
  find(name) {
    const all = [...this.sliders.values()];
    return all.find((slider) => slider.name === name) ?? all[0];
  }

  names() {
    return [...this.sliders.values()].map(({ name }) => name);
  }

  reset() {
    const changed = [...this.sliders.values()].filter(({ isChanged }) => isChanged);
    changed.forEach((slider) => {
      slider.value = slider.given;
      slider.show();
    });
    if (changed.length > 0) {
      this.tell.changed();
    }
  }
}
