// What all pages share: the data, packed arrays, elements, canvases, numbers as text.
const DATA = JSON.parse(document.getElementById("data").textContent);
const $ = id => document.getElementById(id);

function bytes(text) {
  const raw = atob(text);
  const out = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i++) out[i] = raw.charCodeAt(i);
  return out.buffer;
}

// An element with its properties (attributes where the name has a dash or is a role) and children.
function make(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties))
    if (name.includes("-") || name === "role") element.setAttribute(name, value); else element[name] = value;
  element.append(...children);
  return element;
}

function canvasOf(element) {
  const pen = element.getContext("2d");
  const fit = () => {
    const ratio = window.devicePixelRatio || 1;
    element.width = Math.max(1, Math.round(element.clientWidth * ratio));
    element.height = Math.max(1, Math.round(element.clientHeight * ratio));
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  };
  return { element, pen, fit };
}

// Where a pointer is in an element, in its pixels.
function at(event, element) {
  const box = element.getBoundingClientRect();
  return [event.clientX - box.left, event.clientY - box.top];
}

function niceStep(span) {
  const power = 10 ** Math.floor(Math.log10(span || 1));
  return [1, 2, 5, 10].map(step => step * power).find(step => step >= span * (1 - 1e-9));
}

// Round numbers between two limits, about `count` of them.
function ticks(low, high, count = 5) {
  const step = niceStep((high - low) / count), out = [];
  for (let value = Math.ceil(low / step - 1e-9) * step; value <= high + 1e-9 * step; value += step) out.push(Number(value.toPrecision(12)));
  return out;
}

function numberText(value, digits = 4) { return Number.isFinite(value) ? String(Number(value.toPrecision(digits))).replace("-", "\u2212") : "-"; }
function headText({ label, unit }) { return unit ? `${label} [${unit}]` : label; }

// What is next in the queue of the browser's frames, once, however often it is asked for.
function onceAFrame(draw) {
  let asked = false;
  return () => { if (!asked) { asked = true; requestAnimationFrame(() => { asked = false; draw(); }); } };
}
