// Labels: words beside points, of the same size at any distance, where they hide neither points nor each other if
// there is room.

import { Vector3 } from "three";
import { positionsOf } from "./data.js";
import { radiusOf } from "./shapes/point.js";

const GAP = 5;
// Directions in which words are tried, the best first.
const SIDES = [[1, -1], [1, 1], [-1, -1], [-1, 1], [1, 0], [-1, 0], [0, -1], [0, 1]];
// What it costs to hide another label, a point, a rod; to be outside; to leave the side of the last picture.
const COSTS = { label: 100, point: 20, rod: 4, outside: 1000, change: 2, rank: 0.2 };
// A label for which there is only worse room, where it would hide a point or a label, is not shown.
const WORST = 15;

const scratch = new Vector3();

function overlap(a, b) {
  return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}

function square({ x, y }, half) {
  return { left: x - half, right: x + half, top: y - half, bottom: y + half };
}

// Whether a segment meets a rectangle, by clipping.
function meets({ from, to }, box) {
  let [first, last] = [0, 1];
  const sides = [
    [from.x - to.x, from.x - box.left], [to.x - from.x, box.right - from.x],
    [from.y - to.y, from.y - box.top], [to.y - from.y, box.bottom - from.y],
  ];
  for (const [step, room] of sides) {
    if (step === 0 && room < 0) {
      return false;
    }
    if (step < 0) {
      first = Math.max(first, room / step);
    } else if (step > 0) {
      last = Math.min(last, room / step);
    }
  }
  return first <= last;
}

export class Labels {
  constructor(data, world, parent) {
    this.data = data;
    this.world = world;
    this.layer = document.createElement("div");
    this.layer.className = "labels";
    this.layer.setAttribute("aria-hidden", "true");
    parent.append(this.layer);
    this.list = data.shapes.filter((shape) => shape.text).map((shape) => {
      const element = document.createElement("span");
      element.textContent = shape.text;
      this.layer.append(element);
      return { shape, element, side: 0, width: 0, height: 0 };
    });
  }

  // Measures the words, whose size depends on the style alone.
  measure() {
    for (const label of this.list) {
      label.width = label.element.offsetWidth;
      label.height = label.element.offsetHeight;
    }
  }

  // Places the labels; `seen` tells where on the picture a point of the view is, and how large a unit is there.
  update(numbers, seen, { width, height }) {
    if (this.list.length === 0) {
      return;
    }
    const place = (i) => seen(scratch.fromArray(numbers, i).applyMatrix4(this.world.matrix));
    const [points, rods, labels] = [[], [], []];
    for (const shape of this.data.shapes) {
      const corners = positionsOf(shape).map(place);
      if (shape.kind === "point" && corners[0].isSeen) {
        points.push(square(corners[0], radiusOf(shape) * corners[0].scale));
      }
      corners.slice(1).forEach((to, n) => rods.push({ from: corners[n], to }));
    }
    const picture = { left: 0, top: 0, right: width, bottom: height };
    for (const label of this.list) {
      const at = place(label.shape.at);
      const best = at.isSeen ? this.best(label, at, { points, rods, labels, picture }) : undefined;
      label.element.style.visibility = best ? "visible" : "hidden";
      if (best) {
        label.side = best.side;
        labels.push(best.box);
        label.element.style.transform = `translate(${best.box.left.toFixed(1)}px, ${best.box.top.toFixed(1)}px)`;
      }
    }
  }

  // The side on which a label hides least, and its place there; nothing if there is no room at all.
  best(label, at, { points, rods, labels, picture }) {
    const away = (label.shape.kind === "point" ? radiusOf(label.shape) * at.scale : 0) + GAP;
    let best;
    SIDES.forEach(([x, y], side) => {
      // Diagonally, the corner of the words is as far from the point as an edge is otherwise.
      const gap = x && y ? away * Math.SQRT1_2 : away;
      const left = at.x + x * gap + ((x - 1) * label.width) / 2;
      const top = at.y + y * gap + ((y - 1) * label.height) / 2;
      const box = { left, top, right: left + label.width, bottom: top + label.height };
      const isInside = left >= picture.left && top >= picture.top && box.right <= picture.right && box.bottom <= picture.bottom;
      const cost =
        COSTS.rank * side + (side === label.side ? 0 : COSTS.change) + (isInside ? 0 : COSTS.outside) +
        COSTS.label * labels.filter((other) => overlap(other, box)).length +
        COSTS.point * points.filter((other) => overlap(other, box)).length +
        COSTS.rod * rods.filter((rod) => meets(rod, box)).length;
      if (cost < (best?.cost ?? WORST)) {
        best = { cost, side, box };
      }
    });
    return best;
  }
}
