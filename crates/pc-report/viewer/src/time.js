// The one time of the page, which the viewer shares with plots: it tells where it is by the event "pc:time", and is asked to go
// elsewhere by "pc:seek".

export function tell(time) {
  document.dispatchEvent(new CustomEvent("pc:time", { detail: time }));
}

export function onSeek(go) {
  document.addEventListener("pc:seek", (event) => go(event.detail));
}
