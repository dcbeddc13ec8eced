// The player: time, keys, pointers, and what they do to scene and chart.
const scene = new Scene();
const chart = new Chart();
let time = 0, playing = false, last = 0;

function show() {
  scene.draw(time);
  chart.draw(time);
  $("scrub").value = String(END > 0 ? 1000 * time / END : 0);
  $("clock").textContent = `${time.toFixed(2)} s`;
  readings();
}

const ask = onceAFrame(show);
function go(to) { time = Math.min(Math.max(to, 0), END); ask(); }

function readings() {
  const shown = RUNS.filter(run => run.shown);
  const rows = scalarNames(shown).filter(name => name !== "time").map(name =>
    `<tr title="${DATA.scalars[name].meaning}"><td>${DATA.scalars[name].label}</td>` +
    shown.map(run => `<td data-reading="${name}">${withUnit(name, seriesOf(run, name)[frameAt(run, time)])}</td>`).join("") + "</tr>");
  const head = shown.map(run => { const cell = document.createElement("th"); cell.textContent = run.name; return cell.outerHTML; }).join("");
  $("readings").innerHTML = `<div class="wide"><table><thead><tr><th>at ${time.toFixed(2)} s</th>${head}</tr></thead><tbody>${rows.join("")}</tbody></table></div>`;
}

function play(on) {
  playing = on;
  $("play").textContent = on ? "pause" : "play";
  if (!on) return;
  if (time >= END) time = 0;
  last = performance.now();
  requestAnimationFrame(tick);
}

function tick(now) {
  if (!playing) return;
  go(time + (now - last) / 1000 * Number($("rate").value));
  last = now;
  if (time >= END) play(false); else requestAnimationFrame(tick);
}

// One frame of the finest run, on or back.
function step(count) {
  const run = RUNS.reduce((fine, one) => one.time.length > fine.time.length ? one : fine);
  const frame = Math.min(Math.max(frameAt(run, time) + count, 0), run.time.length - 1);
  go(run.time[frame]);
}

// Names of the scalars of any of the runs.
function scalarNames(runs) { return [...new Set(runs.flatMap(run => Object.keys(run.scalars)))]; }

function legend() {
  $("legend").replaceChildren();
  for (const run of RUNS) {
    const label = document.createElement("label"), box = document.createElement("input"), line = document.createElement("i");
    box.type = "checkbox"; box.checked = true; line.style.borderColor = run.colour;
    if (run.dash.length) line.style.borderTopStyle = "dashed";
    box.addEventListener("change", () => { run.shown = box.checked; ask(); });
    label.append(box, line, `${run.name}${run.trusted ? "" : " (not to be trusted)"}`);
    $("legend").append(label);
  }
}

function keys(event) {
  if (event.defaultPrevented) return;
  if (event.target.matches("select, input[type=range], summary") && event.key !== " ") return;
  if (event.target.matches("button, select, summary, input[type=checkbox]") && event.key === " ") return;
  const far = event.shiftKey ? 10 : 1, middle = [scene.element.clientWidth / 2, scene.element.clientHeight / 2];
  const actions = {
    " ": () => play(!playing), ArrowRight: () => step(far), ArrowLeft: () => step(-far), Home: () => go(0), End: () => go(END),
    "+": () => scene.zoom(1.25, ...middle), "-": () => scene.zoom(0.8, ...middle), "0": () => scene.fitView(),
  };
  if (!actions[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
  event.preventDefault();
  actions[event.key]();
  ask();
}

// Pointers on the scene: one drags or reads, two pinch.
const down = new Map();

function sceneMoved(event) {
  const place = at(event, scene.element), before = down.get(event.pointerId);
  if (!before) { scene.read(...place, time); return; }
  if (down.size === 1) scene.pan(place[0] - before[0], place[1] - before[1]);
  if (down.size === 2) {
    const other = [...down].find(([id]) => id !== event.pointerId)[1];
    const apart = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]);
    if (apart(before, other) > 0) scene.zoom(apart(place, other) / apart(before, other), (place[0] + other[0]) / 2, (place[1] + other[1]) / 2);
  }
  down.set(event.pointerId, place);
  ask();
}

// hears : what hears the keys.
function listen(hears) {
  $("play").addEventListener("click", () => play(!playing));
  $("scrub").addEventListener("input", event => go(END * Number(event.target.value) / 1000));
  $("fit").addEventListener("click", () => { scene.fitView(); ask(); });
  $("arrows").addEventListener("input", event => { scene.arrowFactor = 10 ** Number(event.target.value); ask(); });
  $("curve").addEventListener("change", event => { chart.name = event.target.value; ask(); });
  $("against").addEventListener("change", event => { chart.against = event.target.value; ask(); });
  hears.addEventListener("keydown", keys);
  const stage = scene.element;
  stage.addEventListener("pointerdown", event => { stage.setPointerCapture(event.pointerId); down.set(event.pointerId, at(event, stage)); scene.read(...at(event, stage), time); });
  stage.addEventListener("pointermove", sceneMoved);
  for (const end of ["pointerup", "pointercancel"]) stage.addEventListener(end, event => down.delete(event.pointerId));
  stage.addEventListener("pointerleave", () => { scene.tooltip.hidden = true; });
  stage.addEventListener("wheel", event => { event.preventDefault(); scene.zoom(event.deltaY < 0 ? 1.15 : 1 / 1.15, ...at(event, stage)); ask(); }, { passive: false });
  const curve = chart.element;
  curve.addEventListener("pointerdown", event => { curve.setPointerCapture(event.pointerId); play(false); go(chart.timeAt(at(event, curve)[0])); });
  curve.addEventListener("pointermove", event => { if (event.buttons) go(chart.timeAt(at(event, curve)[0])); });
  const resized = new ResizeObserver(() => { scene.fit(); chart.fit(); ask(); });
  resized.observe(stage);
  resized.observe(curve);
}

// The curves there are to choose from; the one on show stays, if there is one of its name.
function curveNames() {
  const names = scalarNames(RUNS).filter(name => !["time", "insertion_depth"].includes(name));
  if (!names.includes(chart.name)) chart.name = names[0];
  $("curve").replaceChildren(...names.map(name => make("option", { value: name, textContent: DATA.scalars[name].label, selected: name === chart.name })));
}

// After other runs were put on show.
function refreshPlayer() {
  play(false);
  legend();
  curveNames();
  scene.fit(); chart.fit(); scene.reset();
  go(time);
}
