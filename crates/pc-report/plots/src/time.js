// The one time of the page: the player tells it by the event "pc:time" and is asked to go elsewhere by "pc:seek".

let now = null;
const listeners = [];

function tell(time) {
  if (Number.isFinite(time) && time !== now) {
    now = time;
    listeners.forEach((listener) => listener(time));
  }
}

export function current() {
  return now;
}

// Returns what ends the listening.
export function onTime(listener) {
  listeners.push(listener);
  return () => listeners.splice(listeners.indexOf(listener), 1);
}

// Goes to a time; a page without a player has it in its plots alone.
export function seek(time) {
  document.dispatchEvent(new CustomEvent("pc:seek", { detail: time }));
  tell(time);
}

document.addEventListener("pc:time", (event) => tell(event.detail));
