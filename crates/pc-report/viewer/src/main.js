// The viewer: reads the motion from the page, and shows it where there is WebGL. A page may also give it motions one after
// the other, by `document.getElementById("player").player.replace(data)`, where `data` is what stands in a page otherwise.

import { Vector3 } from "three";
import { Anchor, anchorsOf, MODEL, NOTHING } from "./anchors.js";
import { ArrowButtons } from "./arrowbuttons.js";
import { Arrows } from "./arrows.js";
import { VIEWS, Viewpoint } from "./camera.js";
import { Clock } from "./clock.js";
import { Compass } from "./compass.js";
import { Controls } from "./controls.js";
import { decoded } from "./data.js";
import { measured } from "./extent.js";
import { listenToGestures } from "./gestures.js";
import { Ground } from "./ground.js";
import { listenToKeys } from "./keys.js";
import { Labels } from "./labels.js";
import { Legend } from "./legend.js";
import { Pace } from "./pace.js";
import { Pose } from "./pose.js";
import { ScaleBar } from "./scalebar.js";
import { Shapes } from "./shapes/shapes.js";
import { dispose, Stage } from "./stage.js";
import { Theme } from "./theme.js";
import { onSeek, tell } from "./time.js";
import { Trails } from "./trails.js";

// A longer time between two pictures is not made up for.
const LONGEST_STEP = 0.5;
// A view that nobody has changed is fitted again to another motion where that needs so much more or less room.
const [ROOMY, TIGHT] = [1.6, 0.97];
// A motion of another order of size is looked at as a whole.
const OTHER_SIZE = 10;

class Viewer {
  constructor(root, data, context) {
    this.root = root;
    this.canvas = root.querySelector("canvas");
    const box = root.querySelector(".stage");
    this.box = box;
    this.isAlone = root.hasAttribute("data-alone");
    const isStill = window.matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.extent = measured(data);
    this.clock = new Clock(data.times);
    this.pace = new Pace();
    this.theme = new Theme(root);
    this.stage = new Stage(this.canvas, context, this.extent);
    this.viewpoint = new Viewpoint(isStill);
    this.size = { width: 0, height: 0 };
    this.shownArrows = new Set();
    this.arrowButtons = new ArrowButtons(root, this.shownArrows, () => this.request());
    this.build(data, this.extent.follows ? MODEL : NOTHING);
    this.showsTrails = this.trails.areWanted;
    this.actions = this.listActions();
    this.controls = new Controls(root, this.clock, this.trails, this.actions);
    this.controls.offer(anchorsOf(data), this.anchor.chosen);
    this.picture = 0;
    this.listen();
    root.hidden = false;
    this.resize();
    this.colour();
    this.look(this.firstView(), true);
    this.draw();
    if (this.isAlone && !isStill) {
      this.actions.play();
    }
  }

  // Makes what depends on the motion.
  build(data, followed) {
    const { extent, stage: { scene, world }, box } = this;
    this.pose = new Pose(data);
    this.shapes = new Shapes(data, extent.size);
    this.trails = new Trails(data);
    this.arrows = new Arrows(data, extent.size);
    this.arrowButtons.offer(this.arrows.longest);
    world.add(this.shapes.group, this.trails.group, this.arrows.group);
    this.ground = new Ground(extent, world);
    scene.add(this.ground.group);
    this.labels = new Labels(data, world, box);
    this.scaleBar = new ScaleBar(extent.size, box);
    this.legend = new Legend(box);
    this.compass = new Compass(world, box);
    this.anchor = new Anchor(data, extent, world, followed);
  }

  // Shows another motion in the same view, at the same time and with the same options.
  replace(data) {
    const { clock, extent: before, trails, anchor, viewpoint } = this;
    const old = [this.shapes.group, this.trails.group, this.arrows.group, this.ground.group];
    [this.labels.layer, this.scaleBar.element, this.legend.element, this.compass.svg].forEach((element) => element.remove());
    const wasFitted = this.isFitted();
    const origin = new Vector3(...before.middle);
    const isDefault = anchor.chosen === (before.follows ? MODEL : NOTHING);
    const isAlike = described(data) === described(this.pose.data);
    const extent = measured(data, isAlike ? before.follows : undefined);
    this.extent = extent;
    this.stage.measure(extent);
    clock.replace(data.times);
    const anchors = anchorsOf(data);
    const isThere = !isDefault && anchors.some(([value]) => value === anchor.chosen);
    this.build(data, isThere ? anchor.chosen : extent.follows ? MODEL : NOTHING);
    if (trails.areWanted !== this.trails.areWanted) {
      this.showsTrails = this.trails.areWanted;
    }
    this.trails.resize(this.size.width, this.size.height);
    this.labels.measure();
    this.controls.measure(this.trails);
    this.controls.offer(anchors, this.anchor.chosen);
    this.colour();
    // A motion of the same model that leaves its plane is looked at as before.
    const directions = isAlike ? ["isTop", "right", "up"] : ["flat", "isTop", "right", "up"];
    const isTurned = directions.some((key) => String(before[key]) !== String(extent[key]));
    const scale = before.size / extent.size;
    if (isTurned || this.anchor.chosen !== anchor.chosen || Math.abs(Math.log10(scale)) > Math.log10(OTHER_SIZE)) {
      this.look(isTurned ? this.firstView() : {}, true);
    } else {
      const isFixed = anchor.chosen === NOTHING;
      viewpoint.keep(scale, isFixed ? origin.applyMatrix4(this.stage.world.matrix) : new Vector3());
      this.fitted = wasFitted ? { ...this.fitted, distance: viewpoint.goal().distance } : undefined;
      this.refit();
    }
    this.draw();
    // Only now, so that programs of the graphics card that are needed again are not made anew.
    old.forEach(dispose);
  }

  // Whether nobody has changed the view since it was fitted.
  isFitted() {
    return this.fitted !== undefined && this.viewpoint.goal().distance === this.fitted.distance;
  }

  // Fits a view that nobody has changed, if the motion is now too large or too small for it.
  refit() {
    if (!this.isFitted()) {
      return;
    }
    const { distance, yaw, pitch } = this.viewpoint.goal();
    const part = distance / this.viewpoint.fitted(this.anchor.balls(), { yaw, pitch }).distance;
    if (part < TIGHT || part > ROOMY) {
      this.look({});
    }
  }

  // A motion in a plane is seen at a right angle, without perspective.
  firstView() {
    const { flat, isTop } = this.extent;
    this.viewpoint.isFlat = flat !== undefined;
    return flat === undefined ? VIEWS.space : isTop ? VIEWS.top : VIEWS.front;
  }

  listActions() {
    const { clock, viewpoint } = this;
    const changed = () => this.request();
    const does = (change) => () => {
      change();
      changed();
    };
    const show = (n) => {
      clock.isPlaying = false;
      clock.show(n);
      changed();
    };
    return {
      changed,
      show,
      play: does(() => {
        this.stamp = undefined;
        if (clock.isPlaying) {
          clock.isPlaying = false;
        } else {
          clock.start();
        }
      }),
      back: () => show(clock.still - 1),
      ahead: () => show(clock.still + 1),
      loop: does(() => (clock.loops = !clock.loops)),
      trails: does(() => (this.showsTrails = !this.showsTrails)),
      fit: () => this.look({}),
      flat: does(() => (viewpoint.isFlat = !viewpoint.isFlat)),
      front: () => this.look(VIEWS.front),
      side: () => this.look(VIEWS.side),
      top: () => this.look(VIEWS.top),
      follow: (chosen) => this.follow(chosen),
      full: () => (document.fullscreenElement ? document.exitFullscreen() : this.root.requestFullscreen()),
    };
  }

  listen() {
    const { canvas, viewpoint, actions } = this;
    listenToGestures(canvas, viewpoint, this.isAlone, actions.changed);
    listenToKeys(this.isAlone ? document.body : this.root, viewpoint, actions);
    this.theme.watch(() => {
      this.colour();
      this.request();
    });
    new ResizeObserver(() => {
      this.resize();
      this.draw();
    }).observe(this.box);
    canvas.addEventListener("webglcontextrestored", actions.changed);
    onSeek((time) => {
      this.clock.isPlaying = false;
      this.clock.seek(time);
      actions.changed();
    });
    // What comes later on the page listens by then.
    window.addEventListener("load", () => tell(this.clock.now));
  }

  // Looks from a direction at all there is.
  look(angles, isSudden) {
    const { yaw, pitch } = { ...this.viewpoint.goal(), ...angles };
    this.fitted = this.viewpoint.fitted(this.anchor.balls(), { yaw, pitch });
    this.viewpoint.go({ yaw, pitch, ...this.fitted }, isSudden);
    this.request();
  }

  follow(chosen) {
    this.anchor.chosen = chosen;
    this.look({});
  }

  colour() {
    for (const part of [this.stage, this.ground, this.shapes, this.trails, this.arrows]) {
      part.colour(this.theme);
    }
  }

  resize() {
    const [width, height] = [Math.max(1, this.box.clientWidth), Math.max(1, this.box.clientHeight)];
    const before = this.size;
    if (width === before.width && height === before.height) {
      return;
    }
    this.size = { width, height };
    this.viewpoint.aspect = width / height;
    this.stage.resize(width, height, 1);
    this.trails.resize(width, height);
    this.labels.measure();
    // A view that nobody has changed stays fitted.
    if (before.width > 0 && this.isFitted()) {
      this.look({}, true);
    }
  }

  // Draws with the next picture of the screen.
  request() {
    this.picture ||= requestAnimationFrame((stamp) => this.step(stamp));
  }

  step(stamp) {
    this.picture = 0;
    const seconds = Math.min((stamp - (this.stamp ?? stamp)) / 1000, LONGEST_STEP);
    if (this.clock.isPlaying) {
      this.clock.advance(seconds);
    }
    const isTurning = this.viewpoint.advance(seconds);
    const goesOn = this.clock.isPlaying || isTurning;
    this.pace.measure(seconds);
    this.stage.resize(this.size.width, this.size.height, goesOn ? this.pace.scale : 1);
    this.draw();
    this.stamp = goesOn ? stamp : undefined;
    if (goesOn) {
      this.request();
    }
  }

  draw() {
    const { clock, pose, viewpoint, size } = this;
    const position = clock.position();
    pose.set(position);
    this.shapes.update(pose.numbers);
    this.arrows.update(pose.numbers, this.shownArrows);
    this.trails.group.visible = this.showsTrails;
    this.trails.update(position);
    this.anchor.at(position, viewpoint.anchor);
    viewpoint.update();
    const { target } = viewpoint;
    const directions = viewpoint.directions();
    this.stage.lightAt(target);
    this.ground.follow(target, directions, viewpoint.halfHeight());
    this.stage.render(viewpoint.camera);
    this.labels.update(pose.numbers, (point) => viewpoint.seen(point, size), size);
    const perSize = size.height / (2 * viewpoint.halfHeight());
    this.scaleBar.update(perSize, size.width);
    this.legend.update(this.shownArrows, (quantity) => (this.arrows.scale(quantity) * perSize) / this.extent.size, size.width);
    this.compass.update(directions);
    if (this.told !== clock.now) {
      this.told = clock.now;
      tell(clock.now);
    }
    this.controls.update({ loop: clock.loops, trails: this.showsTrails, flat: viewpoint.isFlat });
    this.arrowButtons.update();
  }

  // What is on the screen, for those who look at it from outside.
  hook() {
    return {
      show: (n) => {
        this.clock.isPlaying = false;
        this.clock.show(n);
        this.draw();
      },
      frame: () => Array.from(this.pose.numbers),
      held: () => ({ ...this.stage.renderer.info.memory, programs: this.stage.renderer.info.programs.length }),
      pixels: () => this.pixels(),
    };
  }

  // The number of pixels that shapes and trails cover.
  pixels() {
    this.ground.group.visible = false;
    this.draw();
    const copy = document.createElement("canvas");
    const { width, height } = Object.assign(copy, { width: this.canvas.width, height: this.canvas.height });
    const pen = copy.getContext("2d", { willReadFrequently: true });
    pen.drawImage(this.canvas, 0, 0);
    this.ground.group.visible = true;
    this.draw();
    const { data } = pen.getImageData(0, 0, width, height);
    let count = 0;
    for (let i = 3; i < data.length; i += 4) {
      count += data[i] > 0 ? 1 : 0;
    }
    return count;
  }
}

// The shapes in words, to compare.
function described({ shapes }) {
  return JSON.stringify(shapes.map(({ kind, count, text }) => [kind, count, text]));
}

const root = document.getElementById("player");
const context = root.querySelector("canvas").getContext("webgl2", { alpha: true, antialias: true });
if (context) {
  let viewer;
  const replace = (data) => {
    if (viewer) {
      viewer.replace(decoded(data));
    } else {
      viewer = new Viewer(root, decoded(data), context);
      Object.assign(root.player, viewer.hook());
    }
  };
  root.player = { replace };
  const given = document.getElementById("player-data");
  if (given) {
    replace(given.textContent);
  }
} else {
  document.getElementById("player-excuse").hidden = false;
}
