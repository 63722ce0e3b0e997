(function () {
  "use strict";
  var root = document.getElementById("player");
  var data = JSON.parse(document.getElementById("player-data").textContent);
  function numbers(text) {
    var raw = atob(text), bytes = new Uint8Array(raw.length), i;
    for (i = 0; i < raw.length; i++) { bytes[i] = raw.charCodeAt(i); }
    return new Float32Array(bytes.buffer);
  }
  var times = numbers(data.times), frames = numbers(data.frames), shapes = [], width = 0;
  data.shapes.forEach(function (s) { shapes.push({ kind: s[0], at: width, count: s[1], text: s[2] }); width += s[1]; });
  var count = times.length, canvas = root.querySelector("canvas"), pen = canvas.getContext("2d");
  var slider = root.querySelector("input[type=range]"), button = root.querySelector("button");
  var speed = root.querySelector("select"), clock = root.querySelector("output");
  var frame = 0, now = times[0], playing = false, last = null;

  // The middle and the size of all that moves; up is against gravity, else z, else y in a plane.
  var low = [1 / 0, 1 / 0, 1 / 0], high = [-1 / 0, -1 / 0, -1 / 0];
  var least = low.slice(), most = high.slice(), across = [0, 0, 0];
  function stretch(p, r) {
    for (var k = 0; k < 3; k++) {
      if (isFinite(p[k])) {
        low[k] = Math.min(low[k], p[k] - r);
        high[k] = Math.max(high[k], p[k] + r);
        least[k] = Math.min(least[k], p[k]);
        most[k] = Math.max(most[k], p[k]);
      }
    }
  }
  function vector(f, i) { var n = f * width + i; return [frames[n], frames[n + 1], frames[n + 2]]; }
  for (var f = 0; f < count; f++) {
    shapes.forEach(function (s) {
      var r = s.kind === "disc" ? frames[f * width + s.at + 6] : s.kind === "sphere" ? frames[f * width + s.at + 3] : 0;
      if (s.kind === "box") {
        var e = vector(f, s.at + 3);
        r = Math.hypot(e[0], e[1], e[2]) / 2;
      }
      stretch(vector(f, s.at), Math.abs(r) || 0);
      // Discs that stand in the plane of the motion, and what turns, take space.
      if (s.kind === "disc") { vector(f, s.at + 3).forEach(function (n, k) { across[k] = Math.max(across[k], Math.abs(n)); }); }
      if (s.kind === "axes" || s.kind === "box") { across = [1, 1, 1]; }
      if (s.kind === "line" || s.kind === "spring") {
        for (var i = 3; i < s.count; i += 3) { stretch(vector(f, s.at + i), 0); }
      }
    });
  }
  var middle = [0, 1, 2].map(function (k) { return isFinite(low[k]) ? (low[k] + high[k]) / 2 : 0; });
  var extent = [0, 1, 2].map(function (k) { return isFinite(low[k]) ? high[k] - low[k] : 0; });
  var size = Math.max(extent[0], extent[1], extent[2]) || 1;
  var spread = [0, 1, 2].map(function (k) { return isFinite(least[k]) ? most[k] - least[k] : 0; });
  var flat = spread.lastIndexOf(Math.min(spread[0], spread[1], spread[2]));
  var planar = spread[flat] < 1e-6 * size && across[(flat + 1) % 3] < 1e-6 && across[(flat + 2) % 3] < 1e-6;
  var g = data.gravity, up = planar && flat === 2 ? 1 : 2, steepest = 0;
  for (var k = 0; k < 3; k++) { if (Math.abs(g[k]) > steepest) { steepest = Math.abs(g[k]); up = k; } }
  if (planar && up === flat) { up = flat === 2 ? 1 : 2; }
  var sign = g[up] > 0 ? -1 : 1;
  // Right, away and up as axes of space, a right-handed system.
  var right = planar ? 3 - up - flat : (up + 1) % 3, away = 3 - up - right;
  var handed = (right + 1) % 3 === away ? 1 : -1;
  var yaw = planar ? 0 : -0.6, pitch = planar ? 0 : 0.35, zoom = 1;

  function project(p) {
    var x = p[right] - middle[right], y = handed * (p[away] - middle[away]), z = sign * (p[up] - middle[up]);
    if (sign < 0) { y = -y; }
    var cy = Math.cos(yaw), sy = Math.sin(yaw), cp = Math.cos(pitch), sp = Math.sin(pitch);
    var u = cy * x - sy * y, v = sy * x + cy * y;
    var depth = cp * v - sp * z, h = sp * v + cp * z;
    var far = 4 * size, s = planar ? 1 : far / (far + depth);
    var room = planar
      ? Math.min(canvas.width / (extent[right] || size), canvas.height / (extent[up] || size))
      : Math.min(canvas.width, 1.1 * canvas.height) / size;
    var scale = 0.85 * room * zoom * s;
    return { x: canvas.width / 2 + u * scale, y: canvas.height / 2 - h * scale, depth: depth, scale: scale };
  }
  function colour(name) { return getComputedStyle(root).getPropertyValue(name).trim() || "#888"; }
  function path(points, close) {
    pen.beginPath();
    points.forEach(function (p, i) { if (i === 0) { pen.moveTo(p.x, p.y); } else { pen.lineTo(p.x, p.y); } });
    if (close) { pen.closePath(); }
  }
  function add(p, a, n) { return [p[0] + a * n[0], p[1] + a * n[1], p[2] + a * n[2]]; }
  function cross(a, b) { return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]; }
  function unit(a) { var l = Math.hypot(a[0], a[1], a[2]) || 1; return [a[0] / l, a[1] / l, a[2] / l]; }

  function draw() {
    var dot = 4 * (window.devicePixelRatio || 1), list = [], hue = 0;
    pen.clearRect(0, 0, canvas.width, canvas.height);
    pen.lineJoin = "round";
    pen.lineCap = "round";
    shapes.forEach(function (s) {
      var at = vector(frame, s.at), p = project(at), mine = colour("--c" + hue % 8);
      if (["point", "disc", "sphere", "box", "trace"].indexOf(s.kind) > -1) { hue++; }
      list.push({ depth: p.depth, paint: function () { paint(s, at, p, mine, dot); } });
    });
    list.sort(function (a, b) { return b.depth - a.depth; });
    list.forEach(function (item) { item.paint(); });
    clock.textContent = "t = " + now.toFixed(3);
    slider.value = frame;
    slider.setAttribute("aria-valuetext", "t = " + now.toFixed(3));
  }
  function paint(s, at, p, mine, dot) {
    var i, points = [];
    pen.strokeStyle = colour("--ink");
    pen.fillStyle = mine;
    pen.lineWidth = dot / 2;
    if (s.kind === "point" || s.kind === "sphere") {
      var r = s.kind === "sphere" ? frames[frame * width + s.at + 3] * p.scale : 1.4 * dot;
      pen.beginPath();
      pen.arc(p.x, p.y, Math.max(Math.abs(r), 1), 0, 2 * Math.PI);
      pen.fill();
      if (s.text) { words(s.text, p.x + 2 * dot, p.y - 1.5 * dot, dot); }
    } else if (s.kind === "line") {
      for (i = 0; i < s.count; i += 3) { points.push(project(vector(frame, s.at + i))); }
      path(points, false);
      pen.stroke();
    } else if (s.kind === "disc") {
      var n = unit(vector(frame, s.at + 3)), radius = frames[frame * width + s.at + 6];
      var a = unit(cross(n, Math.abs(n[0]) > 0.9 ? [0, 1, 0] : [1, 0, 0])), b = cross(n, a);
      for (i = 0; i < 48; i++) {
        var turn = i * Math.PI / 24;
        points.push(project(add(add(at, radius * Math.cos(turn), a), radius * Math.sin(turn), b)));
      }
      path(points, true);
      pen.globalAlpha = 0.35;
      pen.fill();
      pen.globalAlpha = 1;
      pen.strokeStyle = mine;
      pen.stroke();
    } else if (s.kind === "box") {
      var edges = vector(frame, s.at + 3), corners = [];
      for (i = 0; i < 8; i++) {
        var local = [((i & 1) - 0.5) * edges[0], ((i >> 1 & 1) - 0.5) * edges[1], ((i >> 2) - 0.5) * edges[2]];
        corners.push(project(turned(at, s.at + 6, local)));
      }
      [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]].forEach(function (face) {
        path(face.map(function (c) { return corners[c]; }), true);
        pen.globalAlpha = 0.2;
        pen.fill();
        pen.globalAlpha = 1;
        pen.strokeStyle = mine;
        pen.stroke();
      });
    } else if (s.kind === "axes") {
      [[1, 0, 0], [0, 1, 0], [0, 0, 1]].forEach(function (e, axis) {
        pen.strokeStyle = colour("--c" + axis);
        var length = 0.12 * size;
        path([p, project(turned(at, s.at + 3, [length * e[0], length * e[1], length * e[2]]))], false);
        pen.stroke();
      });
    } else if (s.kind === "spring") {
      var to = vector(frame, s.at + 3), way = [to[0] - at[0], to[1] - at[1], to[2] - at[2]];
      var end = project(to), dx = end.x - p.x, dy = end.y - p.y, length = Math.hypot(dx, dy) || 1;
      points.push(p);
      for (i = 1; i < 22; i++) {
        var side = i > 1 && i < 21 ? (i % 2 ? 1 : -1) * 2 * dot : 0, q = project(add(at, i / 22, way));
        points.push({ x: q.x - side * dy / length, y: q.y + side * dx / length });
      }
      points.push(end);
      path(points, false);
      pen.stroke();
    } else if (s.kind === "trace") {
      for (i = 0; i <= frame; i++) { points.push(project(vector(i, s.at))); }
      path(points, false);
      pen.strokeStyle = mine;
      pen.stroke();
    } else if (s.kind === "text") {
      words(s.text, p.x, p.y, dot);
    }
  }
  function turned(at, i, v) {
    var r = frame * width + i, out = [0, 0, 0];
    for (var k = 0; k < 3; k++) {
      out[k] = at[k] + frames[r + 3 * k] * v[0] + frames[r + 3 * k + 1] * v[1] + frames[r + 3 * k + 2] * v[2];
    }
    return out;
  }
  function words(text, x, y, dot) {
    pen.fillStyle = colour("--soft");
    pen.font = 3 * dot + "px system-ui, sans-serif";
    pen.fillText(text, x, y);
  }
  function show(n) { frame = Math.max(0, Math.min(count - 1, n)); now = times[frame]; draw(); }
  function play(on) { playing = on; last = null; button.textContent = on ? "Pause" : "Play"; if (on) { requestAnimationFrame(step); } }
  function step(stamp) {
    if (!playing) { return; }
    var direction = times[count - 1] < times[0] ? -1 : 1;
    if (last !== null) { now += direction * (stamp - last) / 1000 * Number(speed.value); }
    last = stamp;
    if ((times[count - 1] - now) * direction <= 0) { now = times[0]; frame = 0; }
    while (frame + 1 < count && (times[frame + 1] - now) * direction <= 0) { frame++; }
    draw();
    requestAnimationFrame(step);
  }
  function fit() {
    var ratio = window.devicePixelRatio || 1;
    canvas.width = Math.max(1, Math.round(canvas.clientWidth * ratio));
    canvas.height = Math.max(1, Math.round(canvas.clientHeight * ratio));
    draw();
  }
  button.addEventListener("click", function () { play(!playing); });
  slider.addEventListener("input", function () { play(false); show(Number(slider.value)); });
  var held = null;
  canvas.addEventListener("pointerdown", function (e) { held = [e.clientX, e.clientY]; canvas.setPointerCapture(e.pointerId); });
  canvas.addEventListener("pointermove", function (e) {
    if (!held) { return; }
    turn((e.clientX - held[0]) / 150, (e.clientY - held[1]) / 150);
    held = [e.clientX, e.clientY];
  });
  canvas.addEventListener("pointerup", function () { held = null; });
  canvas.addEventListener("keydown", function (e) {
    var by = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] }[e.key];
    if (by) { turn(by[0], by[1]); e.preventDefault(); }
    if (e.key === "+" || e.key === "-") { zoom *= e.key === "+" ? 1.1 : 1 / 1.1; draw(); }
    if (e.key === " ") { play(!playing); e.preventDefault(); }
  });
  canvas.addEventListener("wheel", function (e) {
    if (!e.ctrlKey && document.activeElement !== canvas) { return; }
    zoom *= Math.exp(-e.deltaY / 500);
    e.preventDefault();
    draw();
  }, { passive: false });
  function turn(a, b) { yaw += a; pitch = Math.max(-1.5, Math.min(1.5, pitch + b)); draw(); }
  window.addEventListener("resize", fit);
  if (window.matchMedia) { window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw); }
  slider.max = count - 1;
  root.hidden = false;
  // What the player shows, for those who look at it from outside.
  root.player = { show: show, frame: function () { return Array.from(frames.slice(frame * width, (frame + 1) * width)); } };
  fit();
})();
