// The ground below all motion, and the wall behind a motion in an upright plane: grids that end nowhere, and the
// shadows on them.

import {
  BufferGeometry, Color, CustomBlending, DoubleSide, Group, Line, LineBasicMaterial, Mesh, OneFactor, OneMinusSrcAlphaFactor,
  PlaneGeometry, ShaderMaterial, ShadowMaterial, SrcAlphaFactor, Vector2, Vector3,
} from "three";
import { roundBelow, smoothStep } from "./numbers.js";
import { SHADED } from "./stage.js";

// The height of a direction that counts as none.
const LEVEL = 1e-3;
// Half the width of the grid, in units of the size of the model.
const REACH = 9;
// Lines of the grid in the size of the model, and every how many is a strong one.
const LINES = 5;
const STRONG = 5;
// Half the height of a picture up to which lines stay as close.
const ROOM = 1.6;
// How far the wall is behind the plane of the motion.
const BEHIND = 0.07;

// Drawn before all else, and behind it, though it is not opaque: what lies on the ground is not hidden by it.
const UNDERNEATH = {
  transparent: false, depthWrite: false, blending: CustomBlending, blendSrc: SrcAlphaFactor,
  blendDst: OneMinusSrcAlphaFactor, blendSrcAlpha: OneFactor, blendDstAlpha: OneMinusSrcAlphaFactor,
};

const VERTEX = /* glsl */ `
  uniform vec2 offset;
  uniform float coarse;
  varying vec2 place;
  varying vec2 apart;
  void main() {
    place = position.xy * coarse + offset;
    apart = position.xy;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position * coarse, 1.0);
  }
`;

const FRAGMENT = /* glsl */ `
  uniform vec3 colour;
  uniform float opacity;
  uniform float spacing;
  uniform float reach;
  varying vec2 place;
  varying vec2 apart;
  // Lines a little more than a pixel wide, which vanish where they would be closer than a few pixels.
  float lines(float space) {
    vec2 at = place / space;
    vec2 pixel = fwidth(at);
    vec2 near = 1.0 - smoothstep(vec2(0.3), vec2(1.3), abs(fract(at - 0.5) - 0.5) / pixel);
    near *= 1.0 - smoothstep(0.08, 0.3, pixel);
    return max(near.x, near.y);
  }
  void main() {
    float strength = max(0.45 * lines(spacing), lines(spacing * ${STRONG}.0));
    float fading = 1.0 - smoothstep(0.1, 1.0, length(apart) / reach);
    gl_FragColor = vec4(colour, strength * opacity * fading * fading);
    #include <colorspace_fragment>
  }
`;

// A plane with a grid and shadows, perpendicular to its third axis.
class Sheet {
  constructor(size) {
    this.spacing = roundBelow(size / LINES) / size;
    this.group = new Group();
    const plane = new PlaneGeometry(2 * REACH, 2 * REACH);
    const uniforms = {
      colour: { value: new Color() },
      opacity: { value: 1 },
      spacing: { value: this.spacing },
      reach: { value: REACH },
      offset: { value: new Vector2() },
      coarse: { value: 1 },
    };
    this.grid = new ShaderMaterial({
      uniforms, vertexShader: VERTEX, fragmentShader: FRAGMENT, side: DoubleSide, ...UNDERNEATH,
    });
    this.shadow = new ShadowMaterial(UNDERNEATH);
    const grid = new Mesh(plane, this.grid);
    // No larger than what may be in the shade.
    const shadow = new Mesh(new PlaneGeometry(3 * SHADED, 3 * SHADED), this.shadow);
    shadow.receiveShadow = true;
    [shadow, grid].forEach((mesh, i) => {
      mesh.renderOrder = i - 2;
      mesh.frustumCulled = false;
      this.group.add(mesh);
    });
  }

  colour(theme) {
    this.grid.uniforms.colour.value.copy(theme.soft);
    this.shade = theme.isDark ? 0.5 : 0.2;
    this.lined = theme.isDark ? 0.4 : 0.42;
    this.fade(1);
  }

  fade(part) {
    this.group.visible = part > 0;
    this.grid.uniforms.opacity.value = part * this.lined;
    this.shadow.opacity = part * this.shade;
  }

  // Stays around what is looked at; `along` and `across` are its coordinates in the plane of the sheet from
  // where the lines cross. Where a greater height is seen, strong lines take the place of the others.
  stay(along, across, halfHeight) {
    const coarse = STRONG ** Math.ceil(Math.log(halfHeight / ROOM) / Math.log(STRONG));
    const { offset, spacing, coarse: shown } = this.grid.uniforms;
    shown.value = coarse;
    spacing.value = this.spacing * coarse;
    const period = spacing.value * STRONG;
    offset.value.set(along % period, across % period);
  }
}

export class Ground {
  constructor(extent, world) {
    const { size, low, high, isUpright } = extent;
    this.origin = new Vector3().applyMatrix4(world.matrix);
    const corners = [low, high].map((p) => new Vector3(...p.map((x) => (Number.isFinite(x) ? x : 0))));
    const [a, b] = corners.map((p) => p.applyMatrix4(world.matrix));
    this.floor = new Sheet(size);
    this.floor.group.rotation.x = -Math.PI / 2;
    this.height = Math.min(a.y, b.y);
    this.group = new Group();
    const ends = new BufferGeometry().setFromPoints([new Vector3(-1, 0, 0), new Vector3(1, 0, 0)]);
    this.edge = new Line(ends, new LineBasicMaterial());
    this.edge.frustumCulled = false;
    this.group.add(this.floor.group, this.edge);
    if (isUpright) {
      this.wall = new Sheet(size);
      this.back = Math.min(a.z, b.z) - BEHIND;
      this.group.add(this.wall.group);
    }
  }

  colour(theme) {
    this.floor.colour(theme);
    this.wall?.colour(theme);
    this.edge.material.color.copy(theme.soft);
  }

  // For a view from this direction, of which half the height is seen.
  follow(target, { right, back }, halfHeight) {
    this.floor.group.position.set(target.x, this.height, target.z);
    this.floor.stay(target.x - this.origin.x, this.origin.z - target.z, halfHeight);
    // Seen from below, the ground would hide what is above it.
    let seen = smoothStep(-0.3, -0.02, back.y);
    if (this.wall) {
      this.wall.group.position.set(target.x, target.y, this.back);
      this.wall.stay(target.x - this.origin.x, target.y - this.origin.y, halfHeight);
      const front = smoothStep(0.6, 0.95, back.z);
      this.wall.fade(front);
      seen *= 1 - front;
    }
    this.floor.fade(seen);
    // Looked at along it, the ground is a line.
    this.edge.visible = !this.wall && Math.abs(back.y) < LEVEL;
    this.edge.position.set(target.x, this.height, target.z);
    this.edge.rotation.y = Math.atan2(-right.z, right.x);
    this.edge.scale.x = REACH * Math.max(1, halfHeight);
  }
}
