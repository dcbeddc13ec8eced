// Any two columns against each other, a mark a row, coloured by a third; linked with the table.
const CIVIDIS = ["#00224e", "#123570", "#3b496c", "#575d6d", "#707173", "#8a8678", "#a59c74", "#c3b369", "#e1cc55", "#fee838"];
const WORD_COLOURS = ["#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#000000", "#8C6D31", "#7B4173"];
const BAD = "#D55E00";
const REACH = 18;  // pixels within which a pointer means a mark

function gradient(share) {
  const place = Math.min(Math.max(share, 0), 1) * (CIVIDIS.length - 1), below = Math.min(Math.floor(place), CIVIDIS.length - 2), part = place - below;
  const mix = channel => Math.round([below, below + 1].map(i => parseInt(CIVIDIS[i].slice(channel, channel + 2), 16)).reduce((a, b) => a + (b - a) * part));
  return `rgb(${mix(1)},${mix(3)},${mix(5)})`;
}

class Scatter {
  // columns : unpacked. good(row): the row's numbers can be trusted; only those set the limits and get colours. ran(row): it was
  // run at all. grid : the table; rows that it filters out are faint. chosen(row): called for the mark that is clicked.
  constructor(element, columns, grid, { good, ran }, chosen) {
    Object.assign(this, canvasOf(element), { columns, grid, good, ran, chosen, hovered: -1 });
    this.tooltip = $("mark");
    this.ask = onceAFrame(() => this.draw());
    element.addEventListener("pointermove", event => this.hover(this.nearest(...at(event, element))));
    element.addEventListener("pointerleave", () => this.hover(-1));
    element.addEventListener("click", event => { const row = this.nearest(...at(event, element)); if (row >= 0) chosen(row); });
    element.addEventListener("keydown", event => this.keys(event));
    new ResizeObserver(() => { this.fit(); this.ask(); }).observe(element);
  }

  set(x, y, colour) {
    Object.assign(this, { x, y, colour });
    this.ask();
  }

  // How a column lies along an axis: a number for each row, limits, and marks with their words.
  scale(column) {
    if (!column.number) {
      const words = column.words ?? [...new Set(column.values)], place = new Map(words.map((word, i) => [word, i]));
      return { column, of: row => place.get(column.values[row]), low: -0.5, high: words.length - 0.5, marks: words.map((word, i) => [i, word || "(none)"]) };
    }
    let [low, high] = this.limits(column, this.good);
    if (!(low <= high)) [low, high] = this.limits(column, () => true);
    if (!(low <= high)) [low, high] = [0, 1];
    const room = (high - low) * 0.04 || Math.abs(high) * 0.04 || 1;
    return { column, of: row => column.values[row], low: low - room, high: high + room, marks: ticks(low - room, high + room, 7).map(value => [value, numberText(value, 6)]) };
  }

  limits(column, counts) {
    let [low, high] = [Infinity, -Infinity];
    for (let row = 0; row < column.values.length; row++) {
      const value = column.values[row];
      if (Number.isFinite(value) && counts(row)) { low = Math.min(low, value); high = Math.max(high, value); }
    }
    return [low, high];
  }

  // Axes, colours, and pixels of every row; those of failed points without a number lie in a strip below the axis.
  layout() {
    const pen = this.pen, width = this.element.clientWidth, height = this.element.clientHeight;
    pen.font = "12px system-ui, sans-serif";
    const across = this.scale(this.x), up = this.scale(this.y), wide = marks => Math.max(0, ...marks.map(([, word]) => pen.measureText(clipped(word)).width));
    const left = Math.min(30 + wide(up.marks), width * 0.4), right = this.keyWidth(width), count = across.marks.length;
    const turned = !this.x.number && (wide(across.marks) + 12) * count > width - left - right;
    const top = 26, axis = height - (turned ? 34 + Math.min(90, 0.6 * wide(across.marks)) : 40), bottom = axis - this.strip();
    const x = value => left + (value - across.low) / (across.high - across.low) * (width - left - right);
    const y = value => bottom - (value - up.low) / (up.high - up.low) * (bottom - top);
    const clamp = (value, low, high) => Math.min(Math.max(value, low), high);
    const rows = this.x.values.length, px = new Float32Array(rows), py = new Float32Array(rows);
    for (let row = 0; row < rows; row++) {
      const [a, b] = [across.of(row), up.of(row)], failed = this.ran(row) && !this.good(row);
      px[row] = Number.isFinite(a) ? clamp(x(a), left, width - right) : NaN;
      py[row] = Number.isFinite(b) ? clamp(y(b), top, bottom) : failed ? axis - 8 : NaN;
    }
    return { across, up, x, y, px, py, left, right: width - right, top, bottom, axis, turned };
  }

  strip() {
    for (let row = 0; row < this.y.values.length; row++) if (this.ran(row) && !this.good(row) && this.y.number && !Number.isFinite(this.y.values[row])) return 22;
    return 0;
  }

  keyWidth(width) {
    if (!this.colour) return 16;
    return Math.min(width * 0.35, this.colour.number ? 92 : 130);
  }

  draw() {
    const pen = this.pen, place = this.place = this.layout();
    pen.clearRect(0, 0, this.element.clientWidth, this.element.clientHeight);
    this.axes(place);
    this.paint = this.colours();
    const rows = this.x.values.length, drawn = [[], [], []];
    for (let row = 0; row < rows; row++) drawn[this.grid.shown[row] ? this.good(row) ? 1 : 2 : 0].push(row);
    const size = rows > 2000 ? 2.5 : rows > 300 ? 3.5 : 4.5;
    for (const row of drawn.flat()) this.mark(row, size);
    for (const row of [this.grid.active, this.hovered]) if (row >= 0) this.ring(row, size);
    this.key(place);
  }

  mark(row, size) {
    const pen = this.pen, x = this.place.px[row], y = this.place.py[row], shown = this.grid.shown[row];
    if (!(Number.isFinite(x) && Number.isFinite(y))) return;
    if (!this.ran(row)) {
      pen.strokeStyle = "#a0a0a0"; pen.lineWidth = 1; pen.setLineDash([]);
      pen.beginPath(); pen.arc(x, y, size, 0, 7); pen.stroke();
      return;
    }
    if (!this.good(row)) {
      size = Math.max(size, 4);
      pen.strokeStyle = shown ? BAD : "#e8cdbf"; pen.lineWidth = 1.8; pen.setLineDash([]);
      pen.beginPath(); pen.moveTo(x - size, y - size); pen.lineTo(x + size, y + size); pen.moveTo(x + size, y - size); pen.lineTo(x - size, y + size); pen.stroke();
      return;
    }
    pen.fillStyle = shown ? this.paint(row) : "#e4e4e4";
    pen.beginPath(); pen.arc(x, y, size, 0, 7); pen.fill();
    if (shown && size > 3) { pen.strokeStyle = "#40404080"; pen.lineWidth = 0.6; pen.stroke(); }
  }

  ring(row, size) {
    const pen = this.pen, x = this.place.px[row], y = this.place.py[row];
    if (!(Number.isFinite(x) && Number.isFinite(y))) return;
    pen.strokeStyle = "#000"; pen.lineWidth = 2; pen.setLineDash([]);
    pen.beginPath(); pen.arc(x, y, size + 4, 0, 7); pen.stroke();
  }

  axes({ across, up, x, y, left, right, top, bottom, axis, turned }) {
    const pen = this.pen;
    pen.lineWidth = 1; pen.setLineDash([]); pen.textBaseline = "middle";
    const grid = (x0, y0, x1, y1) => { pen.strokeStyle = "#e3e3e3"; pen.beginPath(); pen.moveTo(x0, y0); pen.lineTo(x1, y1); pen.stroke(); };
    for (const [value, word] of up.marks) {
      grid(left, y(value), right, y(value));
      pen.fillStyle = "#404040"; pen.textAlign = "right"; pen.fillText(clipped(word), left - 6, y(value));
    }
    for (const [value, word] of across.marks) {
      grid(x(value), top, x(value), bottom);
      pen.fillStyle = "#404040"; pen.textAlign = turned ? "right" : "center";
      pen.save(); pen.translate(x(value) + (turned ? 4 : 0), axis + 11);
      if (turned) pen.rotate(-0.6);
      pen.fillText(clipped(word), 0, 0); pen.restore();
    }
    pen.strokeStyle = "#666"; pen.beginPath(); pen.moveTo(left, top); pen.lineTo(left, bottom); pen.lineTo(right, bottom); pen.stroke();
    if (axis > bottom) { pen.fillStyle = BAD; pen.textAlign = "right"; pen.fillText("failed", left - 6, axis - 8); }
    pen.fillStyle = "#202020"; pen.textBaseline = "alphabetic"; pen.textAlign = "left";
    pen.fillText(headText(this.y), 6, 14);
    pen.textAlign = "right";
    pen.fillText(headText(this.x), right, this.element.clientHeight - 6);
  }

  // What gives each trusted row its colour.
  colours() {
    const column = this.colour;
    if (!column) return () => WORD_COLOURS[0];
    if (column.number) {
      const [low, high] = this.limits(column, this.good);
      this.range = [low, high];
      return row => Number.isFinite(column.values[row]) ? gradient(high > low ? (column.values[row] - low) / (high - low) : 0.5) : "#ffffff";
    }
    const words = column.words ?? [...new Set(column.values)];
    return row => WORD_COLOURS[words.indexOf(column.values[row]) % WORD_COLOURS.length];
  }

  key({ right, top, bottom }) {
    const column = this.colour, pen = this.pen, left = right + 14;
    if (!column) return;
    pen.textAlign = "left"; pen.textBaseline = "middle"; pen.fillStyle = "#202020";
    if (column.number) {
      const high = bottom - top;
      for (let i = 0; i < high; i++) { pen.fillStyle = gradient(1 - i / high); pen.fillRect(left, top + i, 12, 1.5); }
      pen.fillStyle = "#404040";
      for (const [value, place] of [[this.range[1], top + 5], [(this.range[0] + this.range[1]) / 2, (top + bottom) / 2], [this.range[0], bottom - 5]])
        pen.fillText(numberText(value, 3), left + 17, place);
      return;
    }
    const words = (column.words ?? [...new Set(column.values)]).slice(0, Math.floor((bottom - top) / 17));
    words.forEach((word, i) => {
      pen.fillStyle = WORD_COLOURS[i % WORD_COLOURS.length];
      pen.beginPath(); pen.arc(left + 4, top + 8 + 17 * i, 4, 0, 7); pen.fill();
      pen.fillStyle = "#404040"; pen.fillText(clipped(word, 15), left + 13, top + 8 + 17 * i);
    });
  }

  // The row whose mark is nearest, of those that pass the filters; -1 where none is near.
  nearest(px, py) {
    if (!this.place) return -1;
    let best = -1, least = REACH;
    for (const row of this.grid.order) {
      const far = Math.hypot(this.place.px[row] - px, this.place.py[row] - py);
      if (far < least) { best = row; least = far; }
    }
    return best;
  }

  hover(row) {
    this.tooltip.hidden = row < 0;
    this.element.style.cursor = row < 0 ? "" : "pointer";
    if (row >= 0) {
      const told = [...new Set([this.columns[0], this.x, this.y, this.colour, ...this.columns.filter(column => column.role === "status")])].filter(Boolean);
      this.tooltip.textContent = told.map(column => `${column.label} ${cellText(column, row)}${column.unit ? " " + column.unit : ""}`).join("\n");
      this.tooltip.style.left = `${Math.max(4, Math.min(this.place.px[row] + 14, this.element.clientWidth - 220))}px`;
      this.tooltip.style.top = `${Math.min(this.place.py[row] + 12, this.element.clientHeight - 90)}px`;
    }
    if (row !== this.hovered) { this.hovered = row; this.ask(); }
  }

  // Left and right go through the marks from left to right; home and end to the first and the last.
  keys(event) {
    if (!["ArrowLeft", "ArrowRight", "Home", "End"].includes(event.key) || !this.place || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    const { px, py } = this.place, order = this.grid.order.filter(row => Number.isFinite(px[row]) && Number.isFinite(py[row]));
    if (!order.length) return;
    order.sort((a, b) => px[a] - px[b] || py[b] - py[a] || a - b);
    const now = order.indexOf(this.grid.active), step = event.key === "ArrowRight" ? 1 : -1;
    const next = event.key === "Home" ? 0 : event.key === "End" ? order.length - 1 : now < 0 ? 0 : Math.min(Math.max(now + step, 0), order.length - 1);
    this.chosen(order[next]);
  }
}

function clipped(word, most = 22) { return word.length > most ? `${word.slice(0, most - 1)}\u2026` : word; }
