// The viewer and the plots, which are scripts of their own and know nothing of this page.

import { byId } from "./elements.js";

export function showScene(data) {
  const { player } = byId("player");
  const isThere = data !== null && data.times !== "";
  byId("no-scene").hidden = isThere;
  if (player && isThere) {
    player.replace(data);
    byId("player").hidden = false;
  } else if (player) {
    byId("player").hidden = true;
  }
}

export function showPlots(data) {
  byId("no-plots").hidden = data.charts.length > 0;
  byId("plots").plots.replace(data);
}
