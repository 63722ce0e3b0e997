// Trails: the path of a point up to now, brighter where the point was last. Each is a ribbon of constant width on
// the screen, made once for the whole motion, of which the future is not drawn.

import {
  BufferAttribute, BufferGeometry, Color, DoubleSide, Group, Mesh, ShaderMaterial, Vector2,
} from "three";
import { isSimple } from "./extent.js";

const WIDTH = 3;
// What is left of the oldest part, and the part of the motion during which a trail fades.
const FAINTEST = 0.3;
const FADING = 0.35;

const VERTEX = /* glsl */ `
  attribute vec3 other;
  attribute float side;
  attribute float still;
  uniform vec2 screen;
  uniform float width;
  varying float at;
  void main() {
    vec4 here = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
    vec4 there = projectionMatrix * modelViewMatrix * vec4(other, 1.0);
    vec2 way = (there.xy / there.w - here.xy / here.w) * screen;
    float size = length(way);
    vec2 ahead = size > 1e-6 ? way / size : vec2(1.0, 0.0);
    // Each end looks to the other, and stands out a little, so that corners are closed.
    vec2 across = vec2(-ahead.y, ahead.x) * side - 0.5 * ahead;
    here.xy += across * width / screen * here.w;
    at = still;
    gl_Position = here;
  }
`;

const FRAGMENT = /* glsl */ `
  uniform vec3 colour;
  uniform vec3 paper;
  uniform float now;
  uniform float fading;
  varying float at;
  void main() {
    if (at > now) discard;
    // Mixed with paper rather than transparent: where pieces overlap, nothing is seen of that.
    gl_FragColor = vec4(mix(paper, colour, mix(${FAINTEST}, 1.0, exp((at - now) / fading))), 1.0);
    #include <colorspace_fragment>
  }
`;

// Four corners for each segment between two stills at which the point is known.
function ribbon(data, offset) {
  const { stills, width } = data;
  const place = (n) => Array.from(stills.subarray(n * width + offset, n * width + offset + 3));
  const [position, other, side, still, index] = [[], [], [], [], []];
  for (let n = 0; n + 1 < data.times.length; n++) {
    const [a, b] = [place(n), place(n + 1)];
    if (![...a, ...b].every(Number.isFinite)) {
      continue;
    }
    const first = side.length;
    position.push(...a, ...a, ...b, ...b);
    other.push(...b, ...b, ...a, ...a);
    // Looking back from the second end, left is right.
    side.push(1, -1, -1, 1);
    still.push(n, n, n + 1, n + 1);
    index.push(first, first + 1, first + 2, first + 2, first + 1, first + 3);
  }
  const geometry = new BufferGeometry();
  const attribute = (list, count) => new BufferAttribute(new Float32Array(list), count);
  geometry.setAttribute("position", attribute(position, 3));
  geometry.setAttribute("other", attribute(other, 3));
  geometry.setAttribute("side", attribute(side, 1));
  geometry.setAttribute("still", attribute(still, 1));
  geometry.setIndex(index);
  return geometry;
}

export class Trails {
  // Those of the model; if it has none, one for each point with a label and each sphere, or else for each point.
  constructor(data) {
    const own = data.shapes.filter((shape) => shape.kind === "trace");
    const points = data.shapes.filter((shape) => shape.kind === "point" || shape.kind === "sphere");
    const bodies = points.filter((shape) => shape.text || shape.kind === "sphere");
    const others = bodies.length > 0 ? bodies : points;
    this.areWanted = own.length > 0 || isSimple(data);
    this.screen = new Vector2(1, 1);
    this.group = new Group();
    this.list = (own.length > 0 ? own : others).map((shape) => {
      const uniforms = {
        colour: { value: new Color() },
        paper: { value: new Color() },
        now: { value: 0 },
        fading: { value: Math.max(1, FADING * data.times.length) },
        width: { value: WIDTH },
        screen: { value: this.screen },
      };
      const material = new ShaderMaterial({
        uniforms, vertexShader: VERTEX, fragmentShader: FRAGMENT, side: DoubleSide,
      });
      const mesh = new Mesh(ribbon(data, shape.at), material);
      mesh.frustumCulled = false;
      this.group.add(mesh);
      return { hue: shape.hue, uniforms };
    });
  }

  colour(theme) {
    this.list.forEach(({ hue, uniforms }) => {
      uniforms.colour.value.copy(theme.curves[hue]);
      uniforms.paper.value.copy(theme.panel);
    });
  }

  update(position) {
    this.list.forEach(({ uniforms }) => (uniforms.now.value = position));
  }

  resize(width, height) {
    this.screen.set(width, height);
  }
}
