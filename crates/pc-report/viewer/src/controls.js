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
    this.find("full").hidden = !document.fullscreenEnabled;
    this.slider.addEventListener("input", () => actions.show(Number(this.slider.value)));
    const list = (name) => root.querySelector(`[data-list=${name}]`);
    this.speeds = list("speed");
    this.speeds.addEventListener("change", () => (clock.speed = Number(this.speeds.value)));
    this.anchors = list("follow");
    this.anchors.addEventListener("change", () => actions.follow(this.anchors.value));
    this.measure(trails);
  }

  // Takes the times of the motion from the clock.
  measure(trails) {
    const { clock } = this;
    this.end = clock.text(clock.times[clock.last]);
    this.slider.max = clock.last;
    this.find("trails").hidden = trails.list.length === 0;
    // A speed that is listed already leaves the list as it is.
    if (![...this.speeds.options].some(({ value }) => Number(value) === clock.speed)) {
      this.listSpeeds();
    }
    this.speeds.value = clock.speed;
  }

  listSpeeds() {
    const { speed: now } = this.clock;
    const speeds = [...new Set([1, ...roundNumbers(now / RANGE, now * RANGE)])].sort((a, b) => a - b);
    this.speeds.replaceChildren(...speeds.map((speed) => new Option(`${written(speed)}\u00d7`, speed, speed === now)));
  }

  // Lists what the view may follow, as pairs of a value and words.
  offer(anchors, chosen) {
    const options = anchors.map(([value, words]) => new Option(words, value, value === chosen, value === chosen));
    this.anchors.replaceChildren(...options);
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
