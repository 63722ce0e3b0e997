// The viewer and the plots, which are scripts of their own and know nothing of this page.

import { byId } from "./elements.js";

let isFirst = true;

// Shows a motion; the first one plays at once, where things may move.
export function showScene(data) {
  const { player } = byId("player");
  const isThere = data !== null && data.times !== "";
  byId("no-scene").hidden = isThere;
  if (player && isThere) {
    player.replace(data);
    byId("player").hidden = false;
    if (isFirst && !window.matchMedia("(prefers-reduced-motion: reduce)").matches) {
      byId("player").querySelector("[data-action=play]").click();
    }
    isFirst = false;
  } else if (player) {
    byId("player").hidden = true;
  }
}

export function showPlots(data) {
  byId("no-plots").hidden = data.charts.length > 0;
  byId("plots").plots.replace(data);
}
