// The runs as the page holds them: base64 arrays become typed arrays, 16-bit places become millimetres.
const DATA = JSON.parse(document.getElementById("data").textContent);
const COLOURS = ["#0072B2", "#E69F00", "#009E73", "#CC79A7"];
const DASHES = [[], [7, 4], [2, 3], [9, 3, 2, 3]];
const NO_NUMBER = 65535;
const LEVELS = 65534;

function bytes(text) {
  const raw = atob(text);
  const out = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i++) out[i] = raw.charCodeAt(i);
  return out.buffer;
}

function unpacked(run, index) {
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
  return {
    ...run, course, scalars, time, contacts: new Float32Array(bytes(run.contacts)),
    colour: COLOURS[index], dash: DASHES[index], shown: true,
  };
}

const RUNS = DATA.runs.map(unpacked);
const END = Math.max(...RUNS.map(run => run.time[run.time.length - 1]));

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
  return `${Number((value * scalar.factor).toPrecision(4))}${scalar.unit ? " " + scalar.unit : ""}`;
}
