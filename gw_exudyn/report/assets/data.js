// The runs that the player shows: base64 arrays become typed arrays, 16-bit places become millimetres.
const COLOURS = ["#0072B2", "#E69F00", "#009E73", "#CC79A7"];
const DASHES = [[], [7, 4], [2, 3], [9, 3, 2, 3]];
const NO_NUMBER = 65535;
const LEVELS = 65534;

// A run as the page holds it, for the player.
function unpacked(run) {
  const [x0, y0, x1, y1] = run.box;
  const packed = new Uint16Array(bytes(run.course));
  const course = new Float32Array(packed.length);
  for (let i = 0; i < packed.length; i += 2) {
    const known = packed[i] !== NO_NUMBER;
    course[i] = known ? x0 + packed[i] / LEVELS * (x1 - x0) : NaN;
    course[i + 1] = known ? y0 + packed[i + 1] / LEVELS * (y1 - y0) : NaN;
  }
  const scalars = {};
  for (const name in run.scalars) scalars[name] = new Float32Array(bytes(run.scalars[name]));
  const time = new Float32Array(bytes(run.time));
  scalars.time = time;
  return { ...run, course, scalars, time, contacts: new Float32Array(bytes(run.contacts)) };
}

// Runs on show, in the order of their colours, and the end of the longest, s.
const RUNS = [];
let END = 0;

function setRuns(runs) {
  RUNS.length = 0;
  runs.forEach((run, index) => RUNS.push(Object.assign(run, { colour: COLOURS[index], dash: DASHES[index], shown: true })));
  END = Math.max(0, ...RUNS.map(run => run.time[run.time.length - 1]));
}

// A series of a run; an empty one if it has none of the name.
function seriesOf(run, name) { return run.scalars[name] ?? []; }

// Index of the last frame at or before a time.
function frameAt(run, time) {
  let low = 0, high = run.time.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (run.time[middle] <= time + 1e-6) low = middle; else high = middle - 1;
  }
  return low;
}

function withUnit(name, value) {
  const scalar = DATA.scalars[name];
  if (!Number.isFinite(value)) return "-";
  return `${numberText(value * scalar.factor)}${scalar.unit ? " " + scalar.unit : ""}`;
}
