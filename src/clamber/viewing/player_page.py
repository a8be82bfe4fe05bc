# ruff: noqa: E501 - a page, not code
"""The page of the player: HTML, style and script; `player` puts the title and the data into it."""

from typing import Final

PAGE: Final = r"""<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>@TITLE@</title>
<style>
:root { --ink: #22303c; --quiet: #6e7b87; --faint: #dce1e6; --wall: #f7f8fa; --accent: #0072b2; }
* { box-sizing: border-box; }
body { margin: 0; height: 100vh; display: grid; grid-template-rows: auto minmax(0, 1fr) auto; color: var(--ink);
  background: #fff; font: 14px/1.4 system-ui, "DejaVu Sans", sans-serif; }
header { padding: 12px 18px 8px; }
h1 { margin: 0; font-size: 17px; min-height: 24px; }
header p { margin: 0; color: var(--quiet); font-size: 13px; }
main { display: grid; grid-template-columns: minmax(0, 1fr) 350px; gap: 14px; padding: 0 18px; min-height: 0; }
#wall { width: 100%; height: 100%; background: var(--wall); border: 1px solid var(--faint); border-radius: 6px; display: block; }
aside { display: flex; flex-direction: column; min-height: 0; gap: 10px; }
dl { margin: 0; display: grid; grid-template-columns: 94px 1fr; gap: 2px 6px; font-size: 13px; }
dt { color: var(--quiet); } dd { margin: 0; }
h2 { font-size: 13px; margin: 0 0 4px; }
.bar { display: grid; grid-template-columns: 134px 1fr 80px; gap: 6px; align-items: center; font-size: 12px; height: 18px; }
.bar span:first-child { text-align: right; white-space: nowrap; overflow: hidden; text-overflow: ellipsis; }
.bar span:last-child { font-variant-numeric: tabular-nums; }
.track { background: var(--faint); height: 10px; position: relative; }
.track i { position: absolute; inset: 0 auto 0 0; width: 2px; margin-left: -1px; background: #c1272d; }
.fill { position: absolute; inset: 0 auto 0 0; }
#list { overflow-y: auto; flex: 1; min-height: 60px; margin: 0; padding: 0; list-style: none; font-size: 12.5px;
  border: 1px solid var(--faint); border-radius: 6px; }
#list li { padding: 2px 8px; cursor: pointer; display: flex; gap: 8px; align-items: center; }
#list li:hover { background: var(--wall); }
#list li.now { background: #e4eff7; font-weight: 600; }
#list i { width: 10px; height: 10px; border-radius: 2px; flex: none; }
#list b { color: var(--quiet); font-weight: 400; min-width: 26px; text-align: right; font-variant-numeric: tabular-nums; }
footer { display: grid; grid-template-columns: auto auto auto minmax(0, 1fr) auto; gap: 8px; align-items: center; padding: 10px 18px 12px; }
button, select { font: inherit; color: inherit; background: #fff; border: 1px solid #b9c2cb; border-radius: 6px; padding: 4px 10px; cursor: pointer; }
button:focus-visible, select:focus-visible, input:focus-visible { outline: 2px solid var(--accent); outline-offset: 1px; }
#play { min-width: 76px; background: var(--accent); border-color: var(--accent); color: #fff; }
#time { width: 100%; margin: 0; accent-color: var(--accent); display: block; }
#strip { width: 100%; height: 12px; display: block; cursor: pointer; border-radius: 2px; }
#legend { display: flex; gap: 12px; font-size: 11.5px; color: var(--quiet); margin-top: 3px; flex-wrap: wrap; }
#legend i { width: 10px; height: 10px; display: inline-block; margin-right: 4px; border-radius: 2px; }
@media (max-width: 760px) { body { height: auto; } main { grid-template-columns: 1fr; } #wall { height: 70vh; } #list { max-height: 220px; } }
</style>
</head>
<body>
<header><h1 id="head"></h1><p id="title"></p></header>
<main>
<canvas id="wall" role="img" aria-label="The robot in its world"></canvas>
<aside>
<dl id="facts"></dl>
<div><h2 id="gauges"></h2><div id="bars"></div></div>
<h2 id="counted" style="margin:0"></h2><ol id="list"></ol>
</aside>
</main>
<footer>
<button id="play">Play</button>
<button id="back" aria-label="One step back" title="One step back (left arrow)">&#8249;</button>
<button id="on" aria-label="One step on" title="One step on (right arrow)">&#8250;</button>
<div><input id="time" type="range" min="0" step="any" aria-label="Time"><canvas id="strip" ></canvas>
<div id="legend"></div></div>
<select id="speed" aria-label="Speed"><option value="0.25">0.25 ×</option><option value="0.5">0.5 ×</option><option value="1" selected>1 ×</option>
<option value="2">2 ×</option><option value="4">4 ×</option></select>
</footer>
<script id="data" type="application/json">@DATA@</script>
<script>
"use strict";
const D = JSON.parse(document.getElementById("data").textContent);
const el = id => document.getElementById(id), wall = el("wall"), strip = el("strip");
const RATE = 15, F = D.frames;
// Frame k is fully shown at time starts[k]; the picture passes evenly from frame to frame and then rests.
const starts = []; let total = 0;
for (const f of F) { starts.push(total); total += f[1] / RATE; }
const firstFrame = D.steps.map((_, s) => { let k = F.findIndex(f => f[0] > s); return k < 0 ? F.length - 1 : Math.max(k - 1, 0); });
let now = 0, playing = false, last = 0, shown = -1;
el("title").textContent = D.title; el("counted").textContent = D.noun + "s"; el("time").max = total;

D.rows.forEach(name => { const dt = document.createElement("dt"); dt.textContent = name; el("facts").append(dt, document.createElement("dd")); });
const facts = [...el("facts").querySelectorAll("dd")], G = D.bars;
el("gauges").textContent = G.title + (G.limits.length > 1 ? " (lines: limits)" : " (line: limit)");
const rows = G.names.map((name, k) => {
  const row = document.createElement("div");
  row.className = "bar";
  row.innerHTML = "<span></span><div class=track><div class=fill></div></div><span></span>";
  row.firstChild.textContent = name;
  for (const share of G.limits) { const line = document.createElement("i"); line.style.left = 100 * share + "%"; row.children[1].append(line); }
  el("bars").append(row);
  return [row.querySelector(".fill"), row.lastChild];
});
const items = D.steps.map((s, k) => {
  const li = document.createElement("li"), i = document.createElement("i"), b = document.createElement("b");
  i.style.background = k ? D.palette.strip[s.grade] : "transparent";
  b.textContent = k; li.append(i, b, s.action); li.onclick = () => jump(k); el("list").append(li);
  return li;
});
D.palette.words.forEach((w, k) => {
  const s = document.createElement("span"), i = document.createElement("i");
  i.style.background = D.palette.strip[k]; s.append(i, w); el("legend").append(s);
});
el("legend").prepend(D.strip + ":"); strip.setAttribute("aria-label", D.strip);

function frameAt(t) { let lo = 0, hi = F.length - 1; while (lo < hi) { const m = (lo + hi + 1) >> 1; starts[m] <= t ? lo = m : hi = m - 1; } return lo; }
function mix(a, b, u) { return a.map((v, k) => v + (b[k] - v) * u); }
function between(t) {
  const k = frameAt(t), a = F[k], b = F[Math.min(k + 1, F.length - 1)];
  const gap = 1 / RATE, rest = a[1] / RATE - gap, u = Math.min(1, Math.max(0, (t - starts[k] - rest) / gap));
  if (u === 0 || a === b) return { step: a[0], at: a[2], angles: a[3], marks: a[4], values: a[5] };
  const turn = v => v - 2 * Math.PI * Math.round(v / (2 * Math.PI));
  return { step: b[0], at: mix(a[2], b[2], u), angles: a[3].map((v, k) => v + turn(b[3][k] - v) * u),
    marks: a[4].map((v, k) => v === b[4][k] ? v : -1), values: mix(a[5], b[5], u) };
}
function fit(canvas) {
  const r = window.devicePixelRatio || 1, w = Math.round(canvas.clientWidth * r), h = Math.round(canvas.clientHeight * r);
  if (canvas.width !== w || canvas.height !== h) { canvas.width = w; canvas.height = h; }
  const g = canvas.getContext("2d"); g.setTransform(r, 0, 0, r, 0, 0); return g;
}
function draw() {
  const s = between(now), g = fit(wall), W = wall.clientWidth, H = wall.clientHeight, B = D.bounds, m = 34;
  const k = Math.min((W - m - 12) / (B[1] - B[0]), (H - m - 22) / (B[3] - B[2]));
  const ox = m + (W - m - 12 - k * (B[1] - B[0])) / 2, oy = 22 + (H - m - 22 - k * (B[3] - B[2])) / 2;
  const X = x => ox + (x - B[0]) * k, Y = y => oy + (B[3] - y) * k;
  const path = pts => { g.beginPath(); pts.forEach((p, q) => q ? g.lineTo(X(p[0]), Y(p[1])) : g.moveTo(X(p[0]), Y(p[1]))); };
  const text = (words, x, y, colour) => { g.lineWidth = 3; g.strokeStyle = "#fff"; g.strokeText(words, x, y); g.fillStyle = colour; g.fillText(words, x, y); };
  g.clearRect(0, 0, W, H); g.lineJoin = g.lineCap = "round";
  g.fillStyle = "#fff"; g.fillRect(X(B[0]), Y(B[3]), k * (B[1] - B[0]), k * (B[3] - B[2]));
  g.strokeStyle = "#dce1e6"; g.lineWidth = 1; g.strokeRect(X(B[0]), Y(B[3]), k * (B[1] - B[0]), k * (B[3] - B[2]));
  axes(g, X, Y, B, k);
  g.save(); g.beginPath(); g.rect(X(B[0]), Y(B[3]), k * (B[1] - B[0]), k * (B[3] - B[2])); g.clip();
  for (const b of D.blocks ?? []) { path(b.corners); g.closePath(); g.fillStyle = b.colour; g.fill(); g.strokeStyle = "#6e7b87"; g.lineWidth = 1; g.stroke(); }
  for (const q of D.forbidden) {
    path(q); g.closePath(); g.save(); g.fillStyle = "#eceef1"; g.fill(); g.clip(); g.strokeStyle = "#aab3bc"; g.lineWidth = 1; g.beginPath();
    for (let d = -H; d < W; d += 9) { g.moveTo(d, H); g.lineTo(d + H, 0); } g.stroke(); g.restore();
    path(q); g.closePath(); g.strokeStyle = "#6e7b87"; g.stroke();
  }
  for (const q of D.goals) {
    path(q.corners); g.closePath(); g.globalAlpha = q.last ? .2 : .11; g.fillStyle = D.palette.goal; g.fill(); g.globalAlpha = 1;
    g.setLineDash(q.last ? [] : [5, 4]); g.strokeStyle = D.palette.goal; g.lineWidth = 1.2; g.stroke(); g.setLineDash([]);
  }
  g.restore(); g.font = "12px system-ui, sans-serif"; g.textAlign = "left"; g.textBaseline = "bottom";
  for (const q of D.goals) { const x = Math.min(...q.corners.map(c => c[0])), y = Math.max(...q.corners.map(c => c[1])), w = g.measureText(q.label).width;
    text(q.label, Math.min(X(x) + 2, W - w - 4), Y(y) - 2, "#4f6b20"); }
  robot({ g, s, X, Y, k, W, H, path, text }); gauge(s.values); describe(s.step);
}
function gauge(values) {
  values.forEach((v, q) => { const [fill, value] = rows[q], u = (Math.abs(v) - G.low[q]) / (G.high[q] - G.low[q]);
    fill.style.width = 100 * Math.min(Math.max(u, 0), 1) + "%"; fill.style.background = u < G.calm[0] || u > G.calm[1] ? D.palette.alert : G.colours[q];
    value.textContent = (v / G.unit[1]).toFixed(G.unit[2]).replace(/^-(0\.?0*)$/, "$1") + " " + G.unit[0]; });
}
function axes(g, X, Y, B, k) {
  const u = D.unit[1], span = Math.max(B[1] - B[0], B[3] - B[2]) / u, every = [3, 5, 6, 10, 12, 20, 24, 50, 96, 200, 500, 1e9].find(e => span / e <= 8 && (D.unit[0] !== "in" || e % 3 === 0 || e > 1e8));
  g.font = "11px system-ui, sans-serif"; g.fillStyle = "#6e7b87"; g.textBaseline = "top"; g.textAlign = "center";
  for (let v = Math.ceil(B[0] / u / every) * every; v * u <= B[1]; v += every) g.fillText(v + (v ? "" : " " + D.unit[0]), X(v * u), Y(B[2]) + 5);
  g.textAlign = "right"; g.textBaseline = "middle";
  for (let v = Math.ceil(B[2] / u / every) * every; v * u <= B[3]; v += every) g.fillText(v, X(B[0]) - 6, Y(v * u));
}
@ROBOT@
function describe(step) {
  el("time").value = now; drawStrip(step);
  if (step === shown) return;
  const s = D.steps[step]; if (items[shown]) items[shown].classList.remove("now");
  shown = step; items[step].classList.add("now");
  const list = el("list"), top = items[step].offsetTop - list.offsetTop;
  if (top < list.scrollTop + 20 || top > list.scrollTop + list.clientHeight - 50) list.scrollTop = top - list.clientHeight / 2;
  el("head").textContent = step ? D.noun + " " + step + " of " + (D.steps.length - 1) + ": " + s.action : "Start";
  el("head").style.color = s.grade === 0 ? D.palette.alert : "";
  s.facts.forEach((words, k) => { facts[k].textContent = words; });
  facts[facts.length - 1].style.color = [D.palette.alert, "#b35900", "", ""][s.grade];
}
function drawStrip(step) {
  const g = fit(strip), W = strip.clientWidth, H = strip.clientHeight; g.clearRect(0, 0, W, H);
  for (let s = 0; s < D.steps.length; s++) { const a = starts[s ? firstFrame[s - 1] : 0] / total * W, b = s === D.steps.length - 1 ? W : starts[firstFrame[s]] / total * W;
    if (s) { g.fillStyle = D.palette.strip[D.steps[s].grade]; g.fillRect(a, 0, Math.max(b - a, 1) + .5, H); } }
  g.fillStyle = "#22303c"; g.fillRect(now / total * W - 1, 0, 2, H);
}
function jump(step) { const k = firstFrame[Math.max(0, Math.min(step, D.steps.length - 1))]; now = starts[k]; play(false); draw(); }
function play(on) { playing = on; el("play").textContent = on ? "Pause" : "Play"; if (on) { if (now >= total - .01) now = 0; last = performance.now(); requestAnimationFrame(tick); } }
function tick(t) { if (!playing) return; now += Math.max(0, t - last) / 1000 * Number(el("speed").value); last = t;
  if (now >= total) { now = total; play(false); } draw(); if (playing) requestAnimationFrame(tick); }
el("play").onclick = () => play(!playing);
el("back").onclick = () => jump(shown - 1); el("on").onclick = () => jump(shown + 1);
el("time").oninput = e => { now = Number(e.target.value); play(false); draw(); };
strip.onclick = e => { now = e.offsetX / strip.clientWidth * total; play(false); draw(); };
addEventListener("keydown", e => { if (e.target.tagName === "SELECT") return;
  if (e.key === " " && e.target.tagName !== "BUTTON") { e.preventDefault(); play(!playing); }
  if (e.key === "ArrowLeft" || e.key === "ArrowRight") { e.preventDefault(); jump(shown + (e.key === "ArrowLeft" ? -1 : 1)); } });
addEventListener("resize", draw);
const asked = /^#step=(\d+)$/.exec(location.hash);
asked ? jump(Number(asked[1])) : draw();
</script>
</body>
</html>
"""
"""`@TITLE@`, `@ROBOT@` and `@DATA@` are replaced.

The data is JSON as `player.player_data` makes it. The robot's script defines `robot(draw)`, which draws one moment: `draw`
has the canvas `g`, the moment `s` with `at`, `angles` and `marks` (`view.Spread`), from metres to pixels `X`, `Y` and the
scale `k`, the canvas's size `W`, `H`, `path(points)` and `text(words, x, y, colour)`.
"""
