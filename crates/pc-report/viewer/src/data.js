// The motion as the page contains it: shapes, arrows, times, and the numbers of all of them still by still.

// Shapes with a colour of their own; the others have that of rods.
const COLOURED = new Set(["point", "disc", "ring", "sphere", "box", "mesh", "trace"]);
const COLOURS = 8;

// Numbers in IEEE 754 single precision, least significant byte first, encoded in base 64.
function numbers(text) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const view = new DataView(bytes.buffer);
  return Float32Array.from({ length: bytes.length / 4 }, (_, i) => view.getFloat32(4 * i, true));
}

// A surface of triangles, and how far it reaches from the origin of its axes along each of them.
function surface({ corners: packed, faces }) {
  const corners = numbers(packed);
  const reach = [0, 0, 0];
  corners.forEach((x, i) => {
    reach[i % 3] = Math.max(reach[i % 3], Math.abs(x));
  });
  return { corners, faces: Uint32Array.from(numbers(faces)), reach };
}

// From the text of the data, or from what is already read from it.
export function decoded(source) {
  const { shapes: listed, arrows = [], meshes: surfaces = [], times, frames, gravity, up, width: all } = typeof source === "string" ? JSON.parse(source) : source;
  const meshes = surfaces.map(surface);
  let width = 0;
  let hue = 0;
  const shapes = listed.map(([kind, count, words]) => {
    const shape = { kind, at: width, count, text: words, hue: hue % COLOURS };
    if (kind === "mesh") {
      shape.mesh = meshes[Number(words)];
    }
    width += count;
    hue += COLOURED.has(kind) ? 1 : 0;
    return shape;
  });
  return {
    shapes,
    arrows: arrows.map(([quantity, of, at, vector]) => ({ quantity, of, at, vector })),
    width: all ?? width,
    // The direction in which things are seen to fall.
    down: up ? up.map((part) => -part) : gravity,
    times: numbers(times),
    stills: numbers(frames),
  };
}

// The offsets of the positions among the numbers of a shape.
export function positionsOf(shape) {
  if (shape.kind === "line" || shape.kind === "spring") {
    return Array.from({ length: shape.count / 3 }, (_, i) => shape.at + 3 * i);
  }
  return [shape.at];
}

const finite = (x) => (Number.isFinite(x) ? Math.abs(x) : 0);

// How far a shape reaches from its position along each of the fixed axes.
export function reachOf(shape, numbers, start = 0) {
  const at = start + shape.at;
  const own = (k) => finite(numbers[at + k]);
  if (shape.kind === "disc" || shape.kind === "ring") {
    const normal = [own(3), own(4), own(5)];
    const square = normal.reduce((sum, x) => sum + x * x, 0) || 1;
    return normal.map((x) => own(6) * Math.sqrt(Math.max(0, 1 - (x * x) / square)));
  }
  if (shape.kind === "sphere") {
    return [own(3), own(3), own(3)];
  }
  if (shape.kind === "box") {
    return [6, 9, 12].map((row) => (own(row) * own(3) + own(row + 1) * own(4) + own(row + 2) * own(5)) / 2);
  }
  if (shape.kind === "mesh") {
    const { reach } = shape.mesh;
    return [3, 6, 9].map((row) => own(row) * reach[0] + own(row + 1) * reach[1] + own(row + 2) * reach[2]);
  }
  return [0, 0, 0];
}
