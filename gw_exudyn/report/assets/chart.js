// One curve of all runs over time or depth, with a cursor; values under the pointer.
const MARGIN = { left: 62, right: 14, top: 24, bottom: 34 };

class Chart {
  constructor() {
    Object.assign(this, canvasOf($("chart")));
    this.name = "push_force";
    this.against = "time";
  }

  // Limits [low, high] of a scalar over all shown runs, in its display unit.
  limits(name) {
    let [low, high] = [Infinity, -Infinity];
    for (const run of RUNS) if (run.shown) for (const value of seriesOf(run, name)) if (Number.isFinite(value)) {
      low = Math.min(low, value); high = Math.max(high, value);
    }
    const factor = DATA.scalars[name].factor;
    if (!(high > low)) [low, high] = [Math.min(low, 0) || 0, (Number.isFinite(high) ? high : 0) + 1e-9];
    return [low * factor, high * factor];
  }

  // Affine maps from display units to pixels.
  maps() {
    const width = this.element.clientWidth - MARGIN.left - MARGIN.right, height = this.element.clientHeight - MARGIN.top - MARGIN.bottom;
    const [x0, x1] = this.limits(this.against);
    let [y0, y1] = this.limits(this.name);
    y0 = Math.min(y0, 0); y1 = Math.max(y1, 0);
    const span = y1 - y0 || 1;
    return {
      x: value => MARGIN.left + (value - x0) / (x1 - x0) * width,
      y: value => MARGIN.top + (1 - (value - y0) / span) * height,
      back: px => x0 + (px - MARGIN.left) / width * (x1 - x0),
      x0, x1, y0, y1,
    };
  }

  draw(time) {
    const pen = this.pen, maps = this.maps();
    pen.clearRect(0, 0, this.element.clientWidth, this.element.clientHeight);
    pen.font = "12px system-ui, sans-serif";
    this.axes(maps);
    for (const run of RUNS) if (run.shown) this.curve(run, maps);
    const first = RUNS.find(run => run.shown);
    if (first) this.cursor(first, time, maps);
  }

  axes(maps) {
    const pen = this.pen;
    pen.lineWidth = 1; pen.setLineDash([]);
    for (const value of ticks(maps.y0, maps.y1)) {
      pen.strokeStyle = value === 0 ? "#666" : "#e3e3e3"; pen.fillStyle = "#404040"; pen.textAlign = "right"; pen.textBaseline = "middle";
      pen.beginPath(); pen.moveTo(MARGIN.left, maps.y(value)); pen.lineTo(this.element.clientWidth - MARGIN.right, maps.y(value)); pen.stroke();
      pen.fillText(numberText(value, 6), MARGIN.left - 6, maps.y(value));
    }
    pen.textAlign = "center"; pen.textBaseline = "top";
    const bottom = this.element.clientHeight - MARGIN.bottom;
    for (const value of ticks(maps.x0, maps.x1)) pen.fillText(numberText(value, 6), maps.x(value), bottom + 4);
    pen.fillText(headText(DATA.scalars[this.against]), this.element.clientWidth / 2, bottom + 18);
    pen.textAlign = "left";
    pen.fillText(headText(DATA.scalars[this.name]), 4, 3);
    pen.textBaseline = "alphabetic";
  }

  curve(run, maps) {
    const pen = this.pen, xs = seriesOf(run, this.against), ys = seriesOf(run, this.name);
    const fx = DATA.scalars[this.against].factor, fy = DATA.scalars[this.name].factor;
    pen.strokeStyle = run.colour; pen.lineWidth = 1.7; pen.setLineDash(run.dash);
    pen.beginPath();
    let down = false;
    for (let i = 0; i < xs.length; i++) {
      if (!Number.isFinite(ys[i])) { down = false; continue; }
      pen[down ? "lineTo" : "moveTo"](maps.x(xs[i] * fx), maps.y(ys[i] * fy));
      down = true;
    }
    pen.stroke(); pen.setLineDash([]);
  }

  cursor(run, time, maps) {
    const pen = this.pen;
    const where = this.against === "time" ? time * DATA.scalars.time.factor : seriesOf(run, this.against)[frameAt(run, time)] * DATA.scalars[this.against].factor;
    pen.strokeStyle = "#000"; pen.lineWidth = 1;
    pen.beginPath(); pen.moveTo(maps.x(where), MARGIN.top); pen.lineTo(maps.x(where), this.element.clientHeight - MARGIN.bottom); pen.stroke();
    for (const one of RUNS) if (one.shown) {
      const frame = frameAt(one, time);
      pen.fillStyle = one.colour; pen.beginPath();
      pen.arc(maps.x(seriesOf(one, this.against)[frame] * DATA.scalars[this.against].factor), maps.y(seriesOf(one, this.name)[frame] * DATA.scalars[this.name].factor), 4, 0, 7);
      pen.fill();
    }
  }

  // Time that a pixel stands for; over depth, the first time at which the first shown run was as deep.
  timeAt(px) {
    const value = this.maps().back(px) / DATA.scalars[this.against].factor;
    if (this.against === "time") return Math.min(Math.max(value, 0), END);
    const run = RUNS.find(one => one.shown);
    if (!run) return 0;
    const frame = seriesOf(run, this.against).findIndex(depth => depth >= value);
    return run.time[frame < 0 ? run.time.length - 1 : frame];
  }
}
