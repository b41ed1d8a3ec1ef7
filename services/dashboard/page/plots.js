// The view Plots: signals of any topic over time.
import { colour } from "./drawing.js";
import { describe } from "./signals.js";
import { element } from "./words.js";

const find = (id) => document.getElementById(id);
const PRESETS = {
  Trolley: [["crane/state", "trolley_position_m"], ["crane/reference", "axis[0].position"], ["crane/twin", "column[0].predicted"]],
  Slew: [["crane/state", "slew_angle_rad"], ["crane/reference", "axis[1].position"], ["crane/twin", "column[1].predicted"]],
  Swing: [["crane/state", "swing_radial_rad"], ["crane/state", "swing_tangential_rad"], ["crane/twin", "column[2].predicted"], ["crane/twin", "column[3].predicted"]],
  Drives: [["crane/state", "applied_v[0]"], ["crane/state", "applied_v[1]"], ["crane/state", "applied_v[2]"]],
  Commands: [["crane/demand", "control_v[0]"], ["crane/demand", "friction_v[0]"], ["crane/command", "drive_v[0]"]],
  Speeds: [["crane/state", "trolley_speed_mps"], ["crane/state", "slew_speed_radps"], ["crane/reference", "axis[0].speed"], ["crane/reference", "axis[1].speed"]],
};
const BY_SOURCE = { measured: "measured", reference: "reference", predicted: "predicted" };
// By unit: decimals of a shown value (about one count of the encoders), and the smallest range of an axis, so that counts do not fill a plot.
const DECIMALS = { m: 4, "m/s": 4, "°": 3, "°/s": 2, V: 3 };
const LEAST_RANGE = { m: 0.02, "m/s": 0.02, "°": 1, "°/s": 1, V: 1 };
const rounded = (value, unit) => Number(unit in DECIMALS ? value.toFixed(DECIMALS[unit]) : value.toPrecision(4)).toString();
const FURTHER = ["attention", "good", "target", "stop", "crane", "accent"];

class Plot {
  signals = []; // {topic, path, label, unit, colour}
  range = null; // [from_s, to_s] of a zoom; null: follows the window

  constructor(view) {
    this.view = view;
    this.chips = element("div", { className: "chips" });
    this.area = element("div", { className: "canvas" });
    this.box = element("section", { className: "plot" }, this.chips, this.area);
    this.box.onclick = () => view.mark(this);
    this.box.ondragover = (event) => event.preventDefault();
    this.box.ondrop = (event) => { event.preventDefault(); view.mark(this); view.add(...JSON.parse(event.dataTransfer.getData("text/plain")), this); };
    new ResizeObserver(() => this.chart?.setSize(this.#size())).observe(this.area);
  }

  /** In the order of drawing: predictions first, so that they lie below. */
  get #drawn() { return [...this.signals].sort((a, b) => b.predicted - a.predicted); }

  #size() { return { width: Math.max(120, this.area.clientWidth), height: Math.max(80, this.area.clientHeight) }; }

  async add(topic, path) {
    if (this.signals.some((signal) => signal.topic === topic && signal.path === path)) return;
    const { label, unit, source } = describe(topic, path);
    const used = new Set(this.signals.map((signal) => signal.tone));
    const tone = [BY_SOURCE[source], ...FURTHER].find((name) => name && !used.has(name)) ?? "ink";
    const signal = { topic, path, label, unit, tone, predicted: source === "predicted" };
    this.signals.push(signal);
    this.rebuild();
    if (!this.view.moment) await this.view.signals.want(topic, path);
  }

  remove(signal) {
    this.signals = this.signals.filter((other) => other !== signal);
    this.rebuild();
  }

  rebuild() {
    this.chart?.destroy();
    this.chart = null;
    const units = [...new Set(this.signals.map((signal) => signal.unit))];
    this.chips.replaceChildren(...(this.signals.length ? [] : [element("span", { className: "hint" }, "empty: choose signals")]),
      ...this.signals.map((signal) => {
        signal.shown = element("span", { className: "value" });
        return element("span", { className: "chip" }, element("i", { "--c": `var(--${signal.tone})` }), signal.label, signal.shown, signal.unit ? " " + signal.unit : "", element("button", { type: "button", title: "Remove", ariaLabel: "Remove " + signal.label, onclick: (event) => { event.stopPropagation(); this.remove(signal); } }, "×"));
      }), element("button", { type: "button", className: "drop", title: "Remove this plot", ariaLabel: "Remove this plot", onclick: (event) => { event.stopPropagation(); this.view.drop(this); } }, "×"));
    if (!this.signals.length) return;
    const axis = (unit, i) => ({ scale: unit || "none", side: i ? 1 : 3, label: unit, labelSize: 18, size: 54, space: 26, stroke: colour("muted"), font: "12px Plex", labelFont: "12px Plex", grid: { show: i === 0, stroke: colour("line"), width: 1 }, ticks: { stroke: colour("line"), width: 1 } });
    this.chart = new uPlot({
      ...this.#size(),
      ms: 1,
      legend: { show: false },
      scales: { x: { time: false } },
      cursor: { sync: { key: "crane", setSeries: false }, drag: { x: true, y: false }, points: { size: 7 } },
      hooks: { setSelect: [(chart) => this.#zoom(chart)], setCursor: [(chart) => this.#readCursor(chart)] },
      axes: [{ stroke: colour("muted"), font: "12px Plex", grid: { stroke: colour("line"), width: 1 }, ticks: { stroke: colour("line"), width: 1 }, values: (chart, marks) => marks.map((mark) => mark + " s") }, ...units.slice(0, 2).map(axis)],
      // A prediction is a broad band under the thin line of what was measured: both stay visible.
      series: [{}, ...this.#drawn.map((signal) => ({ label: signal.label, scale: signal.unit || "none", stroke: colour(signal.tone) + (signal.predicted ? "66" : ""), width: signal.predicted ? 5 : 1.6, dash: signal.tone === "reference" ? [6, 4] : undefined, spanGaps: true, points: { show: false } }))],
    }, this.#data(), this.area);
    this.chart.over.ondblclick = () => { this.view.zoomTo(null); };
  }

  #zoom(chart) {
    if (chart.select.width < 4) return;
    const now_s = this.shownNow_s;
    this.view.zoomTo([now_s + chart.posToVal(chart.select.left, "x"), now_s + chart.posToVal(chart.select.left + chart.select.width, "x")]);
    chart.setSelect({ left: 0, width: 0, top: 0, height: 0 }, false);
  }

  #readCursor(chart) {
    const at = chart.cursor.idx;
    this.#drawn.forEach((signal, i) => {
      const value = at == null ? this.#last(chart.data?.[i + 1] ?? []) : chart.data[i + 1]?.[at];
      signal.shown.textContent = value == null || Number.isNaN(value) ? "—" : rounded(value, signal.unit);
    });
  }
  #last(values) {
    for (let i = values.length - 1; i >= 0; --i) if (values[i] != null) return values[i];
    return null;
  }

  #data() {
    const [from_s, to_s] = this.view.range();
    const now_s = this.shownNow_s = this.view.now_s;
    const lines = this.#drawn.map((signal) => this.view.read(signal, from_s, to_s));
    // Signals of one tick have the same time: most tables are joined without a gap.
    const tables = lines.map(([times, values]) => [times.map((time) => Math.round((time - now_s) * 1e5) / 1e5), values]);
    return tables.length === 1 ? tables[0] : uPlot.join(tables, tables.map((table) => table.slice(1).map(() => 2)));
  }

  draw() {
    if (!this.chart) return;
    const [from_s, to_s] = this.view.range();
    this.chart.setData(this.#data(), false);
    const scales = {};
    for (const unit of new Set(this.signals.map((signal) => signal.unit || "none"))) scales[unit] = this.#extent(unit);
    this.chart.batch(() => {
      this.chart.setScale("x", { min: from_s - this.shownNow_s, max: to_s - this.shownNow_s });
      for (const [unit, range] of Object.entries(scales)) this.chart.setScale(unit, range);
    });
    this.#readCursor(this.chart);
  }

  #extent(unit) {
    let min = Infinity, max = -Infinity;
    this.#drawn.forEach((signal, i) => {
      if ((signal.unit || "none") !== unit) return;
      for (const value of this.chart.data[i + 1] ?? []) if (value != null && Number.isFinite(value)) { if (value < min) min = value; if (value > max) max = value; }
    });
    if (min > max) return { min: -1, max: 1 };
    const room = Math.max((max - min) * 0.08, ((LEAST_RANGE[unit] ?? 2e-3) - (max - min)) / 2);
    return { min: min - room, max: max + room };
  }
}

export class PlotsView {
  #plots = [];
  #marked = null;
  #paused_s = null;
  #zoom = null;
  #visible = false;
  moment = null; // data around a fault: {title, at_s, samples by topic}

  constructor(link, signals) {
    this.link = link;
    this.signals = signals;
    for (const name of ["Trolley", "Slew", "Swing"]) this.#open(PRESETS[name]);
    this.#mark = this.#plots[0];
    find("signal-presets").replaceChildren(...Object.entries(PRESETS).map(([name, list]) => element("button", { type: "button", onclick: () => { this.#open(list); } }, name)));
    find("plot-add").onclick = () => this.#open([]);
    find("plot-pause").onclick = () => this.#pause(this.#paused_s === null && !this.moment);
    find("plot-csv").onclick = () => this.#exportCsv();
    find("plot-window").onchange = () => this.zoomTo(null);
    find("signal-search").oninput = () => this.#list();
    link.addEventListener("change", () => { if (link.state === "live") { this.#list(); } });
    document.addEventListener("themechange", () => { for (const plot of this.#plots) plot.rebuild(); });
    // At most 20 pictures a second, and at most a third of the time of a slow computer.
    let due_ms = 0;
    const loop = (now_ms) => {
      if (this.#visible && now_ms >= due_ms) {
        const begin_ms = performance.now();
        for (const plot of this.#plots) plot.draw();
        due_ms = now_ms + Math.max(45, 3 * (performance.now() - begin_ms));
      }
      requestAnimationFrame(loop);
    };
    requestAnimationFrame(loop);
  }

  set #mark(plot) {
    this.#marked = plot;
    for (const other of this.#plots) other === plot ? other.box.setAttribute("aria-current", "true") : other.box.removeAttribute("aria-current");
  }
  mark(plot) { this.#mark = plot; }

  shown(view) {
    this.#visible = view === "plots";
    if (this.#visible) for (const plot of this.#plots) for (const { topic, path } of plot.signals) this.signals.want(topic, path);
    if (this.#visible) requestAnimationFrame(() => { for (const plot of this.#plots) plot.rebuild(); });
  }

  #open(list) {
    const plot = new Plot(this);
    this.#plots.push(plot);
    find("plot-area").append(plot.box);
    for (const [topic, path] of list) plot.add(topic, path);
    if (!list.length) plot.rebuild();
    this.#mark = plot;
  }
  drop(plot) {
    plot.chart?.destroy();
    plot.box.remove();
    this.#plots = this.#plots.filter((other) => other !== plot);
    if (this.#marked === plot) this.#mark = this.#plots.at(-1) ?? null;
  }
  add(topic, path, plot = this.#marked) {
    if (!plot) this.#open([[topic, path]]);
    else plot.add(topic, path);
  }

  get now_s() {
    if (this.moment) return this.moment.at_s;
    return this.#paused_s ?? Math.max(this.signals.newest_s("crane/state"), this.signals.newest_s("crane/supervisor"), 0);
  }
  range() {
    if (this.#zoom) return this.#zoom;
    if (this.moment) return [this.moment.at_s - 10, this.moment.at_s + 5];
    return [this.now_s - Number(find("plot-window").value), this.now_s];
  }
  read(signal, from_s, to_s) {
    if (!this.moment) return this.signals.read(signal.topic, signal.path, from_s, to_s);
    const samples = (this.moment.samples.get(signal.topic) ?? []).filter(({ time_s }) => time_s >= from_s && time_s <= to_s);
    const { factor } = describe(signal.topic, signal.path);
    return [samples.map(({ time_s }) => time_s), samples.map(({ sample }) => sample.get(signal.path) * factor)];
  }

  zoomTo(range) {
    this.#zoom = range;
    if (range && !this.moment) this.#pause(true, false);
  }
  #pause(paused, reset = true) {
    this.moment = null;
    if (paused) this.#paused_s ??= this.now_s;
    else this.#paused_s = null;
    if (reset) this.#zoom = null;
    this.#label();
  }
  #label() {
    find("plot-pause").textContent = this.moment ? "Back to live" : this.#paused_s === null ? "Pause" : "Continue";
    find("plot-hint").textContent = this.moment ? `Data around ${this.moment.title}; 0 s is its first cause.` : "Click a signal to add it to the marked plot, or drag it there. Drag over a plot to zoom, double-click to return.";
  }

  /** Shows 10 s before to 5 s after a fault. */
  async showMoment(fault) {
    const samples = new Map();
    const topics = new Set(this.#plots.flatMap((plot) => plot.signals.map((signal) => signal.topic)));
    await Promise.all([...topics].map(async (topic) => samples.set(topic, (await this.link.history(topic, "&fault=" + fault.number)).map((sample) => ({ time_s: this.signals.timeOf(sample), sample })))));
    this.#zoom = null;
    this.moment = { title: fault.first.what, at_s: Number(BigInt(fault.first.at_ns) / 1000n) * 1e-6, samples };
    this.#label();
  }

  #list() {
    const wanted = find("signal-search").value.toLowerCase().split(/\s+/).filter(Boolean);
    const groups = [];
    for (const topic of this.link.topics) {
      const rows = this.link.decoders.get(topic).columns.filter(({ kind, path }) => kind !== "string" && path !== "crc32c").map((column) => ({ ...column, ...describe(topic, column.path) }))
        .sort((a, b) => a.path.startsWith("header.") - b.path.startsWith("header."))
        .filter((column) => wanted.every((word) => `${topic} ${column.path} ${column.label}`.toLowerCase().includes(word)));
      if (!rows.length) continue;
      groups.push(element("h3", {}, topic), ...rows.map((column) => element("li", {}, element("button", {
        type: "button", draggable: true, title: [column.path, column.meaning].filter(Boolean).join(": "), onclick: () => this.add(topic, column.path),
        ondragstart: (event) => event.dataTransfer.setData("text/plain", JSON.stringify([topic, column.path])) }, column.label, element("small", {}, column.unit)))));
    }
    find("signal-list").replaceChildren(...groups);
  }

  #exportCsv() {
    const signals = this.#plots.flatMap((plot) => plot.signals);
    const [from_s, to_s] = this.range(), now_s = this.now_s;
    const rows = new Map();
    signals.forEach((signal, i) => {
      const [times, values] = this.read(signal, from_s, to_s), { factor } = describe(signal.topic, signal.path);
      times.forEach((time, k) => {
        const key = (time - now_s).toFixed(5);
        if (!rows.has(key)) rows.set(key, new Array(signals.length).fill(""));
        rows.get(key)[i] = values[k] / factor; // the file is in SI units, as all files of the project
      });
    });
    const names = signals.map(({ topic, path }) => `${topic.replace("crane/", "")}.${path}`);
    const sorted = [...rows].sort(([a], [b]) => a - b);
    const text = [["time_s", ...names].join(","), ...sorted.map(([time, values]) => [time, ...values].join(","))].join("\n") + "\n";
    const save = element("a", { href: URL.createObjectURL(new Blob([text], { type: "text/csv" })), download: "crane.csv" });
    save.click();
    setTimeout(() => URL.revokeObjectURL(save.href), 1000);
  }
}
