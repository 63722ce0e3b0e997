// What keys do.

const TURN = 0.1;
const ZOOM = 1.15;

// Keys that elements of the page use themselves.
function isTaken(event) {
  const { target, key } = event;
  if (event.ctrlKey || event.metaKey || event.altKey) {
    return true;
  }
  if (target.matches("input, select, textarea")) {
    return key !== "." && key !== ",";
  }
  return target.matches("button, a, summary") && (key === " " || key === "Enter");
}

// `actions` are functions by name; the keys are those of `element`.
export function listenToKeys(element, viewpoint, actions) {
  const turn = (yaw, pitch) => () => {
    viewpoint.turn(yaw, pitch);
    actions.changed();
  };
  const zoom = (factor) => () => {
    viewpoint.zoom(factor);
    actions.changed();
  };
  const keys = {
    " ": actions.play,
    ArrowLeft: turn(-TURN, 0), ArrowRight: turn(TURN, 0), ArrowUp: turn(0, TURN), ArrowDown: turn(0, -TURN),
    "+": zoom(ZOOM), "=": zoom(ZOOM), "-": zoom(1 / ZOOM),
    ".": actions.ahead, ",": actions.back,
    f: actions.fit, l: actions.loop, o: actions.flat, t: actions.trails,
    1: actions.front, 2: actions.side, 3: actions.top,
  };
  element.addEventListener("keydown", (event) => {
    const action = keys[event.key];
    if (action && !isTaken(event)) {
      action();
      event.preventDefault();
    }
  });
}
