// A table that sorts and filters, of any number of rows: only those in sight are in the document.
const ROW = 28;  // pixels, as the style has it
const BEYOND = 8;  // rows above and below what is in sight

// A column as the page holds it: numbers in the unit that is shown, or words. `exact` keeps the numbers as they came.
function unpackedColumn(column) {
  const number = column.kind === "f4" || column.kind === "f8";
  if (!number) {
    const values = column.kind === "words" ? column.values.map(i => column.words[i]) : column.values;
    return { ...column, number, values };
  }
  const exact = column.kind === "f8" ? new Float64Array(bytes(column.values)) : new Float32Array(bytes(column.values));
  return { ...column, number, exact, values: Float64Array.from(exact, value => value * column.factor) };
}

function cellText(column, row) {
  const value = column.values[row];
  return column.number ? numberText(value, column.digits) : value;
}

// What a filter lets through, as a function of a cell's value; null where there is no filter; undefined where the text is none.
function filterOf(column, text) {
  const given = text.trim();
  if (!given) return null;
  return column.number ? numberFilter(given, column.digits) : wordFilter(given);
}

function wordFilter(text) {
  const not = text.startsWith("!"), words = (not ? text.slice(1) : text).split("|").map(word => word.trim().toLowerCase()).filter(Boolean);
  if (!words.length) return undefined;
  return value => words.some(word => word.startsWith("=") ? value.toLowerCase() === word.slice(1).trim() : value.toLowerCase().includes(word)) !== not;
}

// What a cell shows counts, which is a rounded number: `> 3`, `<= 2`, `> 1 < 3`, `1..3`, `0.4`, `none` for cells without a number.
function numberFilter(text, digits) {
  const plain = text.replaceAll("\u2212", "-").replaceAll("\u2264", "<=").replaceAll("\u2265", ">=");
  if (/^(none|-)$/i.test(plain)) return value => !Number.isFinite(value);
  const number = "[-+]?(?:\\d+\\.?\\d*|\\.\\d+)(?:e[-+]?\\d+)?";
  const range = new RegExp(`^(${number})\\s*(?:\\.\\.|to)\\s*(${number})$`, "i").exec(plain);
  if (range) return value => rounded(value, digits) >= Number(range[1]) && rounded(value, digits) <= Number(range[2]);
  const part = new RegExp(`\\s*(>=|<=|>|<|=|)\\s*(${number})`, "iy"), tests = [];
  while (part.lastIndex < plain.length) {
    const found = part.exec(plain);
    if (!found) return undefined;
    tests.push([found[1], Number(found[2])]);
  }
  const passes = { ">": (a, b) => a > b, "<": (a, b) => a < b, ">=": (a, b) => a >= b, "<=": (a, b) => a <= b };
  const same = (a, b) => a === rounded(b, digits);
  return value => Number.isFinite(value) && tests.every(([sign, bound]) => (passes[sign] ?? same)(rounded(value, digits), bound));
}

function rounded(value, digits) { return Number(value.toPrecision(digits)); }

class Grid {
  // columns : unpacked. count : rows. options : label; last(row): it stands behind the others in any order; mark(row): class of
  // the row; chosen(row): called when a row is chosen; changed(): called when other rows are shown; wrap: long words wrap, and all
  // rows are in the document.
  constructor(root, columns, count, options) {
    Object.assign(this, { columns, count, options, root, filters: new Map(), sorted: null, active: -1, order: [] });
    this.draw = onceAFrame(() => this.rows());
    this.build();
    this.arrange();
  }

  build() {
    this.counted = make("output", { className: "counted" });
    this.clear = make("button", { type: "button", textContent: "clear filters", onclick: () => this.clearFilters() });
    this.body = make("tbody");
    this.head = make("thead");
    this.widths = make("colgroup");
    this.table = make("table", { role: "grid", "aria-label": this.options.label, "aria-rowcount": String(this.count + 1) }, this.widths, this.head, this.body);
    this.port = make("div", { className: this.options.wrap ? "port wrap" : "port", tabIndex: 0, role: "group", "aria-label": `${this.options.label}: rows` }, this.table);
    const bar = make("div", { className: "controls" }, this.counted, this.clear);
    if (this.columns.some(column => !column.open)) bar.append(this.chooser());
    this.root.append(bar, this.port);
    this.port.addEventListener("scroll", this.draw);
    this.port.addEventListener("keydown", event => this.keys(event));
    this.body.addEventListener("click", event => { const row = event.target.closest("tr[data-row]"); if (row) this.choose(Number(row.dataset.row)); });
    new ResizeObserver(this.draw).observe(this.port);
    this.heads();
  }

  // Which columns are shown.
  chooser() {
    const boxes = this.columns.map(column => {
      const box = make("input", { type: "checkbox", checked: column.open, onchange: () => { column.open = box.checked; this.heads(); this.draw(); } });
      return make("label", { title: column.meaning }, box, ` ${headText(column)}`);
    });
    const all = make("button", { type: "button", textContent: "all", onclick: () => boxes.forEach(label => { const box = label.firstChild; if (!box.checked) box.click(); }) });
    return make("details", { className: "chooser" }, make("summary", { textContent: "columns" }), make("div", {}, all, ...boxes));
  }

  heads() {
    this.open = this.columns.filter(column => column.open);
    const names = make("tr", { "aria-rowindex": "1" }), filters = make("tr", { className: "filters" });
    this.widths.replaceChildren(...this.open.map(column => {
      const wide = make("col");
      wide.style.width = `${this.width(column)}px`;
      return wide;
    }));
    this.table.style.width = `${this.open.reduce((sum, column) => sum + this.width(column), 0)}px`;
    for (const column of this.open) {
      const button = make("button", { type: "button", textContent: headText(column).replace(/([._])/g, "$1\u200b"), title: column.meaning || "sort", onclick: () => this.sort(column) });
      names.append(make("th", { scope: "col", className: column.number ? "number" : "", "aria-sort": this.direction(column) }, button));
      filters.append(make("td", {}, this.filterBox(column)));
    }
    this.head.replaceChildren(names, filters);
  }

  direction(column) { return this.sorted?.column !== column ? "none" : this.sorted.down ? "descending" : "ascending"; }

  filterBox(column) {
    const box = make("input", {
      type: "text", value: this.filters.get(column)?.text ?? "", placeholder: column.number ? "> 3 or 1..2" : "text", spellcheck: false, autocomplete: "off",
      title: column.number ? "> 3, <= 2, > 1 < 3, 1..2, 0.4, or none" : "part of a word; a|b for either, !a for all but a, =a for no more than a",
      oninput: () => this.filter(column, box.value), "aria-label": `filter ${headText(column)}`,
    });
    if (column.kind !== "words" || column.words.length > 30) return box;
    const list = make("datalist", { id: `${this.root.id}-${this.columns.indexOf(column)}` }, ...column.words.filter(Boolean).map(word => make("option", { value: word })));
    box.setAttribute("list", list.id);
    return make("span", {}, box, list);
  }

  // Pixels that the head's longest word and the widest of many cells need.
  width(column) {
    if (column.wide) return column.wide;
    const step = Math.max(1, Math.floor(this.count / 2000));
    let most = Math.max(10, ...headText(column).split(/[\s._]+/).map(word => word.length + 3), headText(column).length / 3);
    for (let row = 0; row < this.count; row += step) most = Math.max(most, cellText(column, row).length);
    return column.wide = Math.round(22 + 8 * Math.min(most, this.options.wrap ? 24 : 40));
  }

  filter(column, text) {
    const test = filterOf(column, text), box = this.head.querySelectorAll("input")[this.open.indexOf(column)];
    if (box) box.setAttribute("aria-invalid", String(test === undefined));
    if (test) this.filters.set(column, { text, test }); else this.filters.delete(column);
    this.arrange();
  }

  clearFilters() {
    this.filters.clear();
    this.heads();
    this.arrange();
  }

  // Up, down, and back to the first order.
  sort(column) {
    const again = this.sorted?.column === column;
    this.sorted = again && this.sorted.down ? null : { column, down: again };
    this.head.querySelectorAll("th").forEach((head, i) => head.setAttribute("aria-sort", this.direction(this.open[i])));
    this.arrange();
  }

  arrange() {
    const tests = [...this.filters], order = [];
    for (let row = 0; row < this.count; row++) if (tests.every(([column, { test }]) => test(column.values[row]))) order.push(row);
    if (this.sorted) order.sort(this.comparison());
    this.order = order;
    this.shown = new Uint8Array(this.count);
    for (const row of order) this.shown[row] = 1;
    this.counted.textContent = order.length === this.count ? `${this.count} rows` : `${order.length} of ${this.count} rows`;
    this.clear.disabled = !this.filters.size;
    this.port.scrollTop = 0;
    this.draw();
    this.options.changed?.();
  }

  // What has no number stands last, and what `last` says before it, whichever way the rest goes.
  comparison() {
    const { column, down } = this.sorted, values = column.values, sign = down ? -1 : 1, last = this.options.last ?? (() => false);
    const words = new Intl.Collator("en", { numeric: true });
    return (a, b) => {
      const rank = row => column.number && !Number.isFinite(values[row]) ? 2 : column.number && last(row) ? 1 : 0;
      return rank(a) - rank(b) || (rank(a) < 2 ? sign * (column.number ? values[a] - values[b] : words.compare(values[a], values[b])) : 0) || a - b;
    };
  }

  rows() {
    const all = this.options.wrap, sight = [this.port.scrollTop, this.port.scrollTop + this.port.clientHeight];
    const top = all ? 0 : Math.max(0, Math.floor(sight[0] / ROW) - BEYOND);
    const end = all ? this.order.length : Math.min(this.order.length, Math.ceil(sight[1] / ROW) + BEYOND);
    const room = height => make("tr", { className: "room", "aria-hidden": "true" }, make("td", { colSpan: this.open.length, style: `height:${height}px` }));
    const found = [];
    if (top > 0) found.push(room(top * ROW));
    for (let place = top; place < end; place++) found.push(this.row(this.order[place], place));
    if (end < this.order.length) found.push(room((this.order.length - end) * ROW));
    if (!this.order.length) found.push(make("tr", {}, make("td", { colSpan: this.open.length, textContent: "no row passes the filters" })));
    this.body.replaceChildren(...found);
  }

  row(row, place) {
    const cells = this.open.map(column => {
      const text = cellText(column, row);
      return make("td", { className: column.number ? "number" : "", textContent: text, title: text.length > 40 ? text : "" });
    });
    const mark = this.options.mark?.(row) ?? "";
    return make("tr", { className: mark, "data-row": String(row), "aria-rowindex": String(place + 2), "aria-selected": String(row === this.active) }, ...cells);
  }

  // Make a row the chosen one, and bring it into sight.
  choose(row, tell = true) {
    this.active = row;
    const place = this.order.indexOf(row), above = this.head.offsetHeight;
    if (place >= 0 && !this.options.wrap) {
      const top = place * ROW, high = this.port.clientHeight - above;
      if (top < this.port.scrollTop) this.port.scrollTop = top;
      if (top + ROW > this.port.scrollTop + high) this.port.scrollTop = top + ROW - high;
    }
    this.rows();
    if (tell) this.options.chosen?.(row);
  }

  // The chosen row, so many places on in the order on show.
  move(count) {
    if (!this.order.length) return;
    const place = this.order.indexOf(this.active);
    this.choose(this.order[place < 0 ? 0 : Math.min(Math.max(place + count, 0), this.order.length - 1)]);
  }

  keys(event) {
    if (event.target !== this.port || event.ctrlKey || event.metaKey || event.altKey) return;
    const page = Math.max(1, Math.floor(this.port.clientHeight / ROW) - 3), all = this.order.length;
    const moves = { ArrowDown: 1, ArrowUp: -1, PageDown: page, PageUp: -page, Home: -all, End: all };
    if (!(event.key in moves)) return;
    event.preventDefault();
    this.move(moves[event.key]);
  }
}
