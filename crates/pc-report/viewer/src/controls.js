// The buttons, the slider and the lists below the picture.

import { name, picture } from "./icons.js";
import { roundNumbers, written } from "./numbers.js";

// How many times slower and faster than at first the motion can be played.
const RANGE = 20;

const BUTTONS = {
  back: ["Step back", ","], ahead: ["Step ahead", "."], loop: ["Repeat", "l"], trails: ["Trails", "t"],
  fit: ["Fit", "f"], flat: ["Without perspective", "o"], full: ["Full screen"],
};
const VIEWS = { front: ["From the front", "1"], side: ["From the side", "2"], top: ["From above", "3"] };

export class Controls {
  constructor(root, clock, trails, actions) {
    this.root = root;
    this.clock = clock;
    this.find = (action) => root.querySelector(`[data-action="${action}"]`);
    this.slider = root.querySelector("input[type=range]");
    this.output = root.querySelector("output");
    this.end = clock.text(clock.times[clock.last]);
    for (const [action, [words, key]] of Object.entries(BUTTONS)) {
      picture(this.find(action), action);
      name(this.find(action), words, key);
    }
    for (const [action, [words, key]] of Object.entries(VIEWS)) {
      name(this.find(action), words, key);
    }
    root.querySelectorAll("[data-action]").forEach((button) => {
      button.addEventListener("click", actions[button.dataset.action]);
    });
    this.find("trails").hidden = trails.list.length === 0;
    this.find("full").hidden = !document.fullscreenEnabled;
    this.slider.max = clock.last;
    this.slider.addEventListener("input", () => actions.show(Number(this.slider.value)));
    this.addSpeeds();
  }

  addSpeeds() {
    const { clock } = this;
    const list = this.root.querySelector("[data-list=speed]");
    const speeds = new Set([1, ...roundNumbers(clock.speed / RANGE, clock.speed * RANGE)]);
    for (const speed of [...speeds].sort((a, b) => a - b)) {
      const isFirst = speed === clock.speed;
      list.append(new Option(`${written(speed)}\u00d7`, speed, isFirst, isFirst));
    }
    list.addEventListener("change", () => (clock.speed = Number(list.value)));
  }

  // Lists what the view may follow, as pairs of a value and words.
  offer(anchors, chosen, choose) {
    const list = this.root.querySelector("[data-list=follow]");
    list.append(...anchors.map(([value, words]) => new Option(words, value, value === chosen, value === chosen)));
    list.addEventListener("change", () => choose(list.value));
  }

  // Shows the time, and which buttons are pressed.
  update(pressed) {
    const { clock } = this;
    const play = this.find("play");
    picture(play, clock.isPlaying ? "pause" : "play");
    name(play, clock.isPlaying ? "Pause" : "Play", "space");
    const time = clock.text();
    this.output.textContent = `${time} / ${this.end}`;
    this.slider.value = clock.still;
    this.slider.setAttribute("aria-valuetext", `t = ${time}`);
    for (const [action, isPressed] of Object.entries(pressed)) {
      this.find(action).setAttribute("aria-pressed", String(isPressed));
    }
  }
}
