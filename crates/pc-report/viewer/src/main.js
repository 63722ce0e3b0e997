// The viewer: reads the motion from the page, and shows it where there is WebGL.

import { Anchor, anchorsOf, MODEL, NOTHING } from "./anchors.js";
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
import { Pace } from "./pace.js";
import { Pose } from "./pose.js";
import { ScaleBar } from "./scalebar.js";
import { Shapes } from "./shapes/shapes.js";
import { Stage } from "./stage.js";
import { Theme } from "./theme.js";
import { onSeek, tell } from "./time.js";
import { Trails } from "./trails.js";

// A longer time between two pictures is not made up for.
const LONGEST_STEP = 0.5;

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
    this.pose = new Pose(data);
    this.pace = new Pace();
    this.theme = new Theme(root);
    this.stage = new Stage(this.canvas, context, this.extent);
    const { world } = this.stage;
    this.shapes = new Shapes(data, this.extent.size);
    this.trails = new Trails(data);
    this.showsTrails = this.trails.areWanted;
    world.add(this.shapes.group, this.trails.group);
    this.ground = new Ground(this.extent, world);
    this.stage.scene.add(this.ground.group);
    this.labels = new Labels(data, world, box);
    this.scaleBar = new ScaleBar(this.extent.size, box);
    this.compass = new Compass(world, box);
    this.viewpoint = new Viewpoint(isStill);
    this.anchor = new Anchor(data, this.extent, world, this.extent.follows ? MODEL : NOTHING);
    this.actions = this.listActions();
    this.controls = new Controls(root, this.clock, this.trails, this.actions);
    this.controls.offer(anchorsOf(data), this.anchor.chosen, (chosen) => this.follow(chosen));
    this.size = { width: 0, height: 0 };
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
    for (const part of [this.stage, this.ground, this.shapes, this.trails]) {
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
    if (before.width > 0 && this.fitted && this.viewpoint.goal().distance === this.fitted.distance) {
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
    this.scaleBar.update(size.height / (2 * viewpoint.halfHeight()), size.width);
    this.compass.update(directions);
    if (this.told !== clock.now) {
      this.told = clock.now;
      tell(clock.now);
    }
    this.controls.update({ loop: clock.loops, trails: this.showsTrails, flat: viewpoint.isFlat });
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

const root = document.getElementById("player");
const context = root.querySelector("canvas").getContext("webgl2", { alpha: true, antialias: true });
if (context) {
  const data = decoded(document.getElementById("player-data").textContent);
  root.player = new Viewer(root, data, context).hook();
} else {
  document.getElementById("player-excuse").hidden = false;
}
