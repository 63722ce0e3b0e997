// Turning, moving and zooming with a mouse, a pen or fingers.

const TURN = Math.PI / 420;
const WHEEL = 1 / 500;
const LINE = 16;

// `isEager`: the wheel zooms at once, not only while the picture has the focus, so that a long page still scrolls.
export function listenToGestures(canvas, viewpoint, isEager, changed) {
  const held = new Map();
  const place = (event) => {
    const { left, top } = canvas.getBoundingClientRect();
    return { x: event.clientX - left, y: event.clientY - top };
  };
  // A place in units of half the height from the middle, y upwards.
  const fromMiddle = ({ x, y }) => {
    const half = canvas.clientHeight / 2;
    return [(x - canvas.clientWidth / 2) / half, 1 - y / half];
  };
  const middle = () => {
    const all = [...held.values()];
    const mean = (key) => all.reduce((sum, at) => sum + at[key], 0) / all.length;
    const [x, y] = [mean("x"), mean("y")];
    return { x, y, spread: Math.hypot(all[0].x - x, all[0].y - y) };
  };
  const drop = (event) => held.delete(event.pointerId);

  canvas.addEventListener("pointerdown", (event) => {
    held.set(event.pointerId, place(event));
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!held.has(event.pointerId)) {
      return;
    }
    const before = middle();
    held.set(event.pointerId, place(event));
    const after = middle();
    const [x, y] = [after.x - before.x, after.y - before.y];
    const height = canvas.clientHeight;
    if (held.size > 1) {
      viewpoint.pan(x / height, -y / height);
      if (before.spread > 0 && after.spread > 0) {
        viewpoint.zoom(after.spread / before.spread, ...fromMiddle(after));
      }
    } else if (event.buttons > 1 || event.shiftKey || event.ctrlKey || event.metaKey) {
      viewpoint.pan(x / height, -y / height);
    } else {
      viewpoint.turn(-x * TURN, y * TURN);
    }
    changed();
  });
  canvas.addEventListener("pointerup", drop);
  canvas.addEventListener("pointercancel", drop);
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("wheel", (event) => {
    if (!isEager && !event.ctrlKey && document.activeElement !== canvas) {
      return;
    }
    const pixels = event.deltaMode === 0 ? event.deltaY : event.deltaY * LINE;
    viewpoint.zoom(Math.exp(-pixels * WHEEL), ...fromMiddle(place(event)));
    event.preventDefault();
    changed();
  }, { passive: false });
}
