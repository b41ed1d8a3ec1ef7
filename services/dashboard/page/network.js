// The view Network: processes and topics, with rates, losses and delays computed from the received samples.
import { element } from "./words.js";

const find = (id) => document.getElementById(id);
const SVG = "http://www.w3.org/2000/svg";
// Places in the flow of one tick, from the measurement to the command.
const PLACES = { plant: [100, 190], hardware_bridge: [100, 190], trajectory_planner: [345, 60], anti_swing: [345, 190], tracking: [590, 125], friction_compensation: [850, 125], supervisor: [850, 300], twin: [345, 310], operator: [590, 395], recorder: [100, 395] };
// Long lines go around the boxes: the point that bends them.
const BENDS = { "plant>friction_compensation": [470, 262], "plant>supervisor": [470, 292], "supervisor>plant": [490, 345], "plant>tracking": [330, 132], "trajectory_planner>supervisor": [560, 255], "supervisor>trajectory_planner": [790, 0], "anti_swing>friction_compensation": [620, 225], "operator>plant": [300, 420] };
const SHORT = { trajectory_planner: "planner", friction_compensation: "friction comp.", hardware_bridge: "bridge", operator: "operators" };

export class NetworkView {
  #wiring = null;
  #traffic = null;
  #visible = false;

  constructor(link) {
    link.listen("dashboard/traffic", (traffic) => { this.#traffic = traffic; this.#draw(); });
  }

  async shown(view) {
    this.#visible = view === "network";
    if (!this.#visible) return;
    this.#wiring ??= await fetch("/api/graph").then((answer) => answer.json()).catch(() => null);
    this.#draw();
  }

  #draw() {
    if (!this.#visible || !this.#traffic) return;
    this.#drawProcesses(this.#traffic.processes);
    find("other-versions").replaceChildren(...this.#traffic.other_versions.map((other) => element("li", {}, other.explanation)));
    find("other-versions").hidden = this.#traffic.other_versions.length === 0;
    this.#drawTopics(this.#traffic);
    if (this.#wiring) this.#drawGraph();
  }

  #drawProcesses(processes) {
    const head = ["Process", "Controller", "DDS", "Number", "State", "Ticks", "Lost", "Late", "Rejected", "Foreign", "Step mean", "Step longest"];
    const rows = processes.map((p) => row([
      element("td", {}, element("i", { className: "dot" + (p.silent ? " bad" : "") }), p.name.replace(/_/g, " ")),
      text(p.controller.replace(/_/g, " ")), text(p.vendor), number(p.pid), text(p.silent ? "silent" : p.phase, p.silent),
      number(p.ticks), number(p.lost, p.lost > 0), number(p.late), number(p.rejected, p.rejected > 0), number(p.foreign, p.foreign > 0),
      number(p.step_mean_us.toFixed(0) + " µs"), number(p.step_max_us.toFixed(0) + " µs")]));
    find("process-table").replaceChildren(header(head, ["Controller", "DDS", "State"]), element("tbody", {}, ...rows));
  }

  #drawTopics({ topics, delay_bounds_us: bounds }) {
    const head = ["Topic", "Written by", "Rate", "Samples", "Lost", "Late", "Duplicate", "Delay median", "99 %", "longest", "Jitter 99 %", `Delays ${bounds[0]} µs … ${bounds.at(-1) / 1000} ms`];
    const rows = topics.map((t) => {
      const flows = t.rate_hz !== null, most = Math.max(1, ...t.delay_histogram);
      return row([
        element("td", {}, element("i", { className: "dot" + (flows ? "" : t.every_tick && t.samples ? " bad" : " idle") }), t.topic),
        text(t.samples ? t.writer.replace(/_/g, " ") : "—"), number(flows ? t.rate_hz.toFixed(1) + " Hz" : "—"), number(t.samples), number(t.every_tick ? t.lost : "—", t.every_tick && t.lost > 0),
        number(t.every_tick ? t.late : "—"), number(t.every_tick ? t.duplicate : "—"), ...["p50", "p99", "max"].map((q) => number(t.delay_us ? milliseconds(t.delay_us[q]) : "—")),
        number(t.jitter_us && t.every_tick ? milliseconds(t.jitter_us.p99) : "—"),
        element("td", {}, t.every_tick && t.samples ? element("span", { className: "histogram", title: t.delay_histogram.map((n, i) => `${i ? bounds[i - 1] : 0}–${bounds[i] ?? "∞"} µs: ${n}`).join("\n") },
          ...t.delay_histogram.map((n) => element("i", { "--h": (100 * Math.log1p(n) / Math.log1p(most)).toFixed(0) + "%" }))) : "")]);
    });
    find("topic-table").replaceChildren(header(head, ["Written by"]), element("tbody", {}, ...rows));
  }

  #drawGraph() {
    const heard = new Map(this.#traffic.processes.map((p) => [p.name, p]));
    const flowing = new Map(this.#traffic.topics.map((t) => [t.topic, t]));
    const shown = this.#wiring.filter((component) => heard.has(component.component));
    const edges = new Map();
    const add = (from, to, topic) => {
      const key = from + ">" + to;
      if (from !== to) edges.set(key, { from, to, topics: [...(edges.get(key)?.topics ?? []), topic] });
    };
    for (const reader of shown)
      for (const { topic } of reader.reads) {
        if (topic === "crane/request") { add("operator", reader.component, topic); continue; }
        for (const writer of shown) if (writer.writes.some((write) => write.topic === topic)) add(writer.component, reader.component, topic);
      }
    const svg = node("svg", { viewBox: "0 0 950 440", role: "img", "aria-label": "Processes and topics" });
    for (const edge of edges.values()) svg.append(...arrow(edge, flowing));
    for (const name of [...heard.keys(), "operator"]) if (PLACES[name]) svg.append(...place(name, heard.get(name)));
    find("graph").replaceChildren(svg);
  }
}

const milliseconds = (us) => us < 1000 ? us.toFixed(0) + " µs" : (us / 1000).toFixed(1) + " ms";
const row = (cells) => element("tr", {}, ...cells);
const text = (value, bad = false) => element("td", { className: "text" + (bad ? " bad" : "") }, value || "—");
const number = (value, bad = false) => element("td", { className: bad ? "bad" : "" }, String(value));
const header = (names, texts) => element("thead", {}, element("tr", {}, ...names.map((name) => element("th", { className: texts.includes(name) ? "text" : "" }, name))));

function node(name, attributes, ...children) {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

function place(name, process) {
  const [x, y] = PLACES[name], colour = !process ? "var(--muted)" : process.silent ? "var(--stop)" : "var(--good)";
  const label = (SHORT[name] ?? name).replace(/_/g, " ");
  const width = 140;
  return [node("rect", { x: x - width / 2, y: y - 22, width, height: 44, rx: 7, fill: "var(--raised)", stroke: colour, "stroke-width": process ? 1.6 : 1 }),
    node("text", { x, y: y - 2, "text-anchor": "middle", fill: "var(--ink)", "font-size": 14, "font-weight": 600 }, label),
    node("text", { x, y: y + 14, "text-anchor": "middle", fill: "var(--muted)", "font-size": 12 }, process ? (process.silent ? "silent" : process.vendor + ", " + process.phase) : "any number")];
}

function arrow({ from, to, topics }, flowing) {
  const [x1, y1] = PLACES[from] ?? [0, 0], [x2, y2] = PLACES[to] ?? [0, 0];
  if (!PLACES[from] || !PLACES[to]) return [];
  const live = topics.filter((topic) => flowing.get(topic)?.rate_hz != null);
  const lost = topics.some((topic) => flowing.get(topic)?.every_tick && flowing.get(topic).lost > 0);
  const colour = live.length === 0 ? "var(--line)" : lost ? "var(--attention)" : "var(--measured)";
  // Bent to the side, so that the two directions do not cover each other.
  const dx = x2 - x1, dy = y2 - y1, length = Math.hypot(dx, dy) || 1, bend = Math.min(46, 14 + length * 0.06);
  const [mx, my] = BENDS[`${from}>${to}`.replace("hardware_bridge", "plant")] ?? [(x1 + x2) / 2 - dy / length * bend, (y1 + y2) / 2 + dx / length * bend];
  const edge = (x, y, toX, toY) => {
    const ux = toX - x, uy = toY - y, scale = Math.min(73 / Math.max(1e-6, Math.abs(ux)), 25 / Math.max(1e-6, Math.abs(uy)));
    return [x + ux * Math.min(1, scale), y + uy * Math.min(1, scale)];
  };
  const [ax, ay] = edge(x1, y1, mx, my), [bx, by] = edge(x2, y2, mx, my);
  const angle = Math.atan2(by - my, bx - mx);
  const head = [[0, 0], [-9, -4], [-9, 4]].map(([px, py]) => [bx + px * Math.cos(angle) - py * Math.sin(angle), by + px * Math.sin(angle) + py * Math.cos(angle)].map((v) => v.toFixed(1)).join(",")).join(" ");
  const title = topics.map((topic) => `${topic}: ${flowing.get(topic)?.rate_hz?.toFixed(0) ?? 0} Hz`).join("\n");
  return [node("path", { d: `M${ax},${ay} Q${mx},${my} ${bx},${by}`, fill: "none", stroke: colour, "stroke-width": live.length ? 1.6 : 1 }, node("title", {}, title)),
    node("polygon", { points: head, fill: colour }),
    node("text", { x: (ax + 2 * mx + bx) / 4, y: (ay + 2 * my + by) / 4 + 4, "text-anchor": "middle", fill: "var(--muted)", "font-size": 11.5, stroke: "var(--panel)", "stroke-width": 3, "paint-order": "stroke" }, topics.map((topic) => topic.replace("crane/", "")).join(", "))];
}
