// The page of a study: table and chart of its points, and the point that is chosen.
const STUDY = DATA.study;
const columns = DATA.columns.map(unpackedColumn);
const OUTCOME = new Uint8Array(bytes(STUDY.outcome));  // 0 failed, 1 good, 2 not run
const KEPT = new Uint8Array(bytes(STUDY.kept));  // 0 nothing, 1 its series, 2 the whole run
const COUNT = OUTCOME.length;
const good = row => OUTCOME[row] === 1, ran = row => OUTCOME[row] !== 2;
const held = [];  // rows that stay on show beside the chosen one
const MOST_HELD = 3;

const grid = new Grid($("points"), columns, COUNT, {
  label: "points", last: row => !good(row), mark: row => good(row) ? "" : ran(row) ? "bad" : "waiting", chosen: showPoint,
});
const drawable = columns.filter(column => ["parameter", "metric", "status"].includes(column.role));
const scatter = new Scatter($("scatter"), columns, grid, { good, ran }, row => grid.choose(row));
grid.options.changed = scatter.ask;

function chooseAxes() {
  const [first, second] = drawable.filter(column => column.role === "parameter"), metric = drawable.find(column => column.role === "metric");
  const start = { x: first ?? drawable[0], y: metric ?? drawable[0], colour: second ?? null };
  const choices = {};
  for (const name of ["x", "y", "colour"]) {
    const options = drawable.map((column, i) => make("option", { value: String(i), textContent: headText(column), selected: column === start[name] }));
    if (name === "colour") options.unshift(make("option", { value: "", textContent: "(one colour)", selected: !start.colour }));
    $(name).replaceChildren(...options);
    choices[name] = () => drawable[$(name).value] ?? null;
    $(name).addEventListener("change", () => scatter.set(choices.x(), choices.y(), choices.colour()));
  }
  scatter.set(start.x, start.y, start.colour);
}

// The point

function pointName(row) { return `point ${cellText(columns[0], row)}`; }

function showPoint(row) {
  $("point").hidden = false;
  $("chosen").textContent = pointName(row);
  const status = columns.find(column => column.role === "status"), reason = columns.find(column => column.role === "reason");
  $("outcome").className = `status ${good(row) ? "good" : ran(row) ? "bad" : "waiting"}`;
  $("outcome").replaceChildren(make("b", { textContent: cellText(status, row) }), ran(row) && !good(row) ? " (not to be trusted) " : " ", cellText(reason, row));
  $("values").replaceChildren(valuesOf("parameter", row), valuesOf("metric", row));
  $("again").hidden = !STUDY.command.length;
  $("command").textContent = commandOf(row);
  $("kept").replaceChildren(...keptOf(row));
  $("hold").textContent = held.includes(row) ? "let go" : "hold";
  $("hold").disabled = !held.includes(row) && held.length >= MOST_HELD;
  putOnShow(row);
  scatter.ask();
}

function valuesOf(role, row) {
  const items = columns.filter(column => column.role === role).map(column => {
    const text = cellText(column, row), unit = column.number && column.unit && text !== "-" ? ` ${column.unit}` : "";
    return make("div", { title: column.meaning }, make("dt", { textContent: column.label }), make("dd", { textContent: text + unit }));
  });
  return make("section", {}, make("h3", { textContent: `${role}s` }), make("dl", {}, ...items));
}

// A word as a shell takes it.
function quoted(word) { return /^[\w@%+=:,./-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\"'\"'")}'`; }

// A number in SI as YAML reads it: with a point before the exponent.
function yamlNumber(value) { return String(value).replace(/^(-?\d+)e/, "$1.0e"); }

function commandOf(row) {
  const words = [...STUDY.command];
  for (const column of columns) if (column.role === "parameter") {
    const value = column.number ? yamlNumber(column.exact[row]) : STUDY.values[column.label]?.[column.values[row]] ?? column.values[row];
    words.push("--set", `${column.label}=${value}`);
  }
  return words.map(quoted).join(" ");
}

function keptOf(row) {
  const place = STUDY.elsewhere[row] ?? `points/${cellText(columns.find(column => column.role === "id"), row)}`;
  if (!KEPT[row] && !STUDY.elsewhere[row]) return ["Nothing of this point was kept but its row."];
  const link = (file, words) => make("a", { href: `${place}/${file}`, textContent: words });
  const lines = [make("p", {}, "Beside this page: ", link("run.json", `${place}/run.json`), ", ", link("series.csv", "series.csv"))];
  if (KEPT[row] === 2 || STUDY.elsewhere[row])
    lines.push(make("p", {}, "The whole run was kept: ", make("code", { textContent: `gw-exudyn report ${quoted(`${STUDY.folder}/${place}`)}` })));
  return lines;
}

// Curves

const CURVES = STUDY.curves && unpackedCurves(STUDY.curves);

// Each curve of each point: 16 bits between the lowest and the highest value of that point.
function unpackedCurves(curves) {
  return {
    ...curves, time: curves.time && new Float32Array(bytes(curves.time)),
    series: Object.fromEntries(Object.entries(curves.series).map(([name, one]) => [name, { values: new Uint16Array(bytes(one.values)), ends: new Float32Array(bytes(one.ends)) }])),
  };
}

function curveOf(name, row) {
  const { values, ends } = CURVES.series[name], low = ends[2 * row], high = ends[2 * row + 1], length = CURVES.length;
  return Float32Array.from(values.subarray(row * length, (row + 1) * length), level => level === NO_NUMBER ? NaN : low + level / LEVELS * (high - low));
}

// What the player shows of a point: the motion where the page holds it, else its curves alone; null where it has none.
function runOf(row) {
  const run = STUDY.runs[row];
  if (run) return { ...unpacked(run), name: pointName(row) };
  if (!CURVES) return null;
  const all = Object.fromEntries(Object.keys(CURVES.series).map(name => [name, curveOf(name, row)]));
  const time = CURVES.time ?? all.time, length = Object.values(all).reduce((most, one) => Math.max(most, one.findLastIndex(Number.isFinite) + 1), 0);
  if (!length) return null;
  const scalars = Object.fromEntries(Object.entries({ ...all, time }).map(([name, one]) => [name, one.slice(0, length)]));
  return { name: pointName(row), trusted: good(row), time: scalars.time, scalars, nodes: 0, course: [], walls: [], catheter: [], starts: [], contacts: [], box: [0, 0, 1, 1], diameter: 0 };
}

function putOnShow(row) {
  const runs = [row, ...held.filter(one => one !== row)].map(runOf).filter(Boolean);
  $("player").hidden = !runs.length;
  $("without").hidden = runs.length > 0;
  const moving = runs.some(run => run.nodes > 0);
  $("player").classList.toggle("still", !moving);
  setRuns(runs);
  if (runs.length) refreshPlayer();
}

$("hold").addEventListener("click", () => {
  const row = grid.active, place = held.indexOf(row);
  if (place < 0) held.push(row); else held.splice(place, 1);
  showPoint(row);
});
$("before").addEventListener("click", () => grid.move(-1));
$("after").addEventListener("click", () => grid.move(1));
$("copy").addEventListener("click", async () => {
  try {
    await navigator.clipboard.writeText($("command").textContent);
    $("copy").textContent = "copied";
  } catch {  // no leave to write there: mark it, so that a key copies it
    getSelection().selectAllChildren($("command"));
  }
});
setRuns([]);
listen($("player"));
chooseAxes();
if (COUNT) { grid.choose(STUDY.first); go(END); }
