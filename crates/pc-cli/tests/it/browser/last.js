// Last on the page: reports the layout to the surrounding page.
window.addEventListener("load", function () {
  function box(element) { return element.getBoundingClientRect(); }
  function look() {
    document.querySelectorAll("details").forEach(function (d) { d.open = true; });
    var root = document.documentElement, maths = Array.from(document.querySelectorAll("math"));
    var flat = maths.filter(function (m) { return !(box(m).width > 2 && box(m).height > 2); });
    // A formula taller than a page would be cut off in print.
    var tall = maths.filter(function (m) { return box(m).height > 900; });
    // A browser that does not know the elements writes their text on one line.
    var fractions = Array.from(document.querySelectorAll("mfrac"));
    var lying = fractions.filter(function (f) { return box(f.children[0]).bottom > box(f.children[1]).top + 1; });
    var player = document.getElementById("player"), frames = null, painted = 0;
    if (player && player.player) {
      frames = FRAMES.map(function (n) { player.player.show(n); return player.player.frame(); });
      painted = player.player.pixels();
    }
    var plots = Array.from(document.querySelectorAll(".live .uplot"));
    document.dispatchEvent(new CustomEvent("pc:time", { detail: 0.5 }));
    var marked = plots.filter(function (p) { return box(p).height > 200 && !p.querySelector(".now").hidden; });
    // A piece of an equation that is wider than the page.
    var cut = Array.from(document.querySelectorAll(".formula")).filter(function (f) { return f.scrollWidth > f.clientWidth + 1; });
    // Pictures on buttons are small.
    var pictures = Array.from(document.querySelectorAll("svg:not([aria-hidden])")).filter(function (s) { return !s.closest(".live"); });
    var small = pictures.filter(function (s) { return box(s).width < 100 || box(s).height < 50; });
    parent.postMessage(JSON.stringify({
      wrong: window.wrong,
      width: window.innerWidth,
      overflow: root.scrollWidth - root.clientWidth,
      dark: window.matchMedia("(prefers-color-scheme: dark)").matches,
      background: getComputedStyle(document.body).backgroundColor,
      ink: getComputedStyle(document.body).color,
      formulas: maths.length,
      flat: flat.map(function (m) { return m.textContent.slice(0, 60); }),
      tall: tall.map(function (m) { return m.textContent.slice(0, 60); }),
      fractions: fractions.length,
      lying: lying.map(function (f) { return f.textContent.slice(0, 60); }),
      small: small.length,
      font: Array.from(document.fonts).some(function (f) { return f.status === "loaded"; }),
      cut: cut.map(function (f) { return f.textContent.slice(0, 60); }),
      plots: plots.length,
      marked: marked.length,
      requests: performance.getEntriesByType("resource").map(function (e) { return e.name; }),
      frames: frames,
      painted: painted
    }), "*");
  }
  setTimeout(look, 200);
});
