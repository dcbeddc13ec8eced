// The plane of the vessel: view, walls, wires, arrows, and what lies under the pointer. Lengths in millimetres.
const FORCE_COLOUR = "#D55E00";
const BAR_ROOM = 36;  // pixels at the bottom, for the scale bars

class Scene {
  constructor() {
    Object.assign(this, canvasOf($("scene")));
    this.tooltip = $("tooltip");
    this.arrowFactor = 1;
    this.reset();
  }

  // After other runs were put on show.
  reset() {
    this.longest = largestForce();
    this.fitView();
  }

  // Show everything where the wires and the vessel near them are.
  fitView() {
    let [x0, y0, x1, y1] = [Infinity, Infinity, -Infinity, -Infinity];
    const hold = (x, y) => { x0 = Math.min(x0, x); y0 = Math.min(y0, y); x1 = Math.max(x1, x); y1 = Math.max(y1, y); };
    for (const run of RUNS) for (const line of run.walls) for (const [x, y] of line) hold(x, y);
    if (!Number.isFinite(x0)) for (const run of RUNS) { hold(run.box[0], run.box[1]); hold(run.box[2], run.box[3]); }
    const width = this.element.clientWidth || 1, height = Math.max((this.element.clientHeight || 1) - BAR_ROOM, 1);
    this.size = Math.max(x1 - x0, y1 - y0, 1);
    this.scale = 0.95 * Math.min(width / Math.max(x1 - x0, 1), height / Math.max(y1 - y0, 1));
    this.centre = [(x0 + x1) / 2, (y0 + y1) / 2 - BAR_ROOM / 2 / this.scale];
  }

  px(x, y) {
    return [this.element.clientWidth / 2 + (x - this.centre[0]) * this.scale, this.element.clientHeight / 2 - (y - this.centre[1]) * this.scale];
  }

  mm(px, py) {
    return [this.centre[0] + (px - this.element.clientWidth / 2) / this.scale, this.centre[1] - (py - this.element.clientHeight / 2) / this.scale];
  }

  zoom(factor, px, py) {
    const [x, y] = this.mm(px, py);
    this.scale = Math.min(Math.max(this.scale * factor, 0.05), 5000);
    this.centre = [x - (px - this.element.clientWidth / 2) / this.scale, y + (py - this.element.clientHeight / 2) / this.scale];
  }

  pan(dx, dy) { this.centre = [this.centre[0] - dx / this.scale, this.centre[1] + dy / this.scale]; }

  path(points) {
    this.pen.beginPath();
    points.forEach(([x, y], i) => this.pen[i ? "lineTo" : "moveTo"](...this.px(x, y)));
  }

  draw(time) {
    const pen = this.pen;
    pen.clearRect(0, 0, this.element.clientWidth, this.element.clientHeight);
    pen.lineJoin = "round";
    const drawn = new Set();
    for (const run of RUNS) {
      const key = JSON.stringify(run.walls);
      if (!run.shown || drawn.has(key)) continue;
      pen.setLineDash(drawn.size ? [5, 4] : []);
      drawn.add(key);
      pen.strokeStyle = "#9DB4C0"; pen.lineWidth = 2.5;
      for (const line of run.catheter) { this.path(line); pen.stroke(); }
      pen.strokeStyle = "#4D4D4D"; pen.lineWidth = 1.5;
      for (const line of run.walls) { this.path(line); pen.stroke(); }
    }
    pen.setLineDash([]);
    // Thick ones first, so that a thin one on the same way is not hidden.
    for (const run of RUNS.filter(one => one.shown).sort((a, b) => b.diameter - a.diameter)) this.drawWire(run, frameAt(run, time));
    for (const run of RUNS) if (run.shown) this.drawForces(run, frameAt(run, time));
    this.drawScaleBar();
  }

  drawWire(run, frame) {
    const pen = this.pen;
    pen.beginPath();
    let down = false;
    for (let i = 0; i < run.nodes; i++) {
      const at = 2 * (frame * run.nodes + i), x = run.course[at];
      if (Number.isNaN(x)) { down = false; continue; }
      pen[down ? "lineTo" : "moveTo"](...this.px(x, run.course[at + 1]));
      down = true;
    }
    pen.lineCap = "round";
    pen.strokeStyle = run.colour;
    pen.lineWidth = Math.max(run.diameter * this.scale, 1.5);
    pen.stroke();
    pen.lineCap = "butt";
  }

  drawForces(run, frame) {
    if (!(this.longest > 0)) return;
    const perNewton = 0.13 * this.size * this.arrowFactor / this.longest;
    for (let i = run.starts[frame]; i < run.starts[frame + 1]; i++) {
      const [x, y, fx, fy, owner] = run.contacts.subarray(5 * i, 5 * i + 5);
      this.arrow(this.px(x, y), this.px(x + fx * perNewton, y + fy * perNewton), owner === 0 ? FORCE_COLOUR : "#7d97a5");
    }
  }

  arrow([x0, y0], [x1, y1], colour) {
    const pen = this.pen, length = Math.hypot(x1 - x0, y1 - y0);
    if (length < 2) return;
    const [ux, uy] = [(x1 - x0) / length, (y1 - y0) / length], head = Math.min(8, length * 0.5);
    pen.strokeStyle = pen.fillStyle = colour; pen.lineWidth = 1.8;
    pen.beginPath(); pen.moveTo(x0, y0); pen.lineTo(x1 - ux * head, y1 - uy * head); pen.stroke();
    pen.beginPath(); pen.moveTo(x1, y1);
    pen.lineTo(x1 - ux * head - uy * head * 0.45, y1 - uy * head + ux * head * 0.45);
    pen.lineTo(x1 - ux * head + uy * head * 0.45, y1 - uy * head - ux * head * 0.45);
    pen.fill();
  }

  // Bars of a round length and of a round force.
  drawScaleBar() {
    const pen = this.pen, bottom = this.element.clientHeight - 14;
    const bar = (left, length, words, colour) => {
      pen.strokeStyle = pen.fillStyle = colour; pen.lineWidth = 3; pen.font = "12px system-ui, sans-serif";
      pen.beginPath(); pen.moveTo(left, bottom); pen.lineTo(left + length, bottom); pen.stroke();
      pen.fillText(words, left, bottom - 6);
    };
    const millimetres = roundDown(120 / this.scale);
    bar(14, millimetres * this.scale, `${millimetres} mm`, "#4D4D4D");
    if (this.longest > 0) {
      const perNewton = 0.13 * this.size * this.arrowFactor / this.longest * this.scale;
      const force = roundDown(120 / perNewton);
      bar(170, force * perNewton, `${withUnit("push_force", force)} on the wall`, FORCE_COLOUR);
    }
  }

  // What is nearest to the pointer, within 12 pixels: a contact, or else a place on a wire.
  read(px, py, time) {
    let best = null;
    for (const run of RUNS) {
      if (!run.shown) continue;
      const frame = frameAt(run, time);
      for (let i = run.starts[frame]; i < run.starts[frame + 1]; i++) {
        const [x, y, fx, fy, owner] = run.contacts.subarray(5 * i, 5 * i + 5), [cx, cy] = this.px(x, y);
        const far = Math.hypot(cx - px, cy - py) - 4;
        if (far < 12 && (!best || far < best.far))
          best = { far, text: `${run.name}\n${owner === 0 ? "vessel" : "catheter"} wall: ${withUnit("push_force", Math.hypot(fx, fy))}\nx ${x.toFixed(2)}, y ${y.toFixed(2)} mm` };
      }
      for (let i = 0; i < run.nodes; i++) {
        const at = 2 * (frame * run.nodes + i), [nx, ny] = this.px(run.course[at], run.course[at + 1]);
        const far = Math.hypot(nx - px, ny - py);
        if (far < 12 && (!best || far < best.far))
          best = { far, text: `${run.name}\nx ${run.course[at].toFixed(2)}, y ${run.course[at + 1].toFixed(2)} mm${i === run.nodes - 1 ? " (tip)" : ""}` };
      }
    }
    this.tooltip.hidden = !best;
    if (best) {
      this.tooltip.textContent = best.text;
      this.tooltip.style.left = `${Math.min(px + 14, this.element.clientWidth - 190)}px`;
      this.tooltip.style.top = `${py + 14}px`;
    }
  }
}

function largestForce() {
  let largest = 0;
  for (const run of RUNS)
    for (let i = 0; i < run.contacts.length; i += 5)
      if (run.contacts[i + 4] === 0) largest = Math.max(largest, Math.hypot(run.contacts[i + 2], run.contacts[i + 3]));
  return largest;
}

function roundDown(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return [5, 2, 1].map(step => step * power).find(step => step <= value * (1 + 1e-9));
}
