// The view Operate.
import { AdaptationPanel } from "./adaptation.js";
import { drawRequests, drawSeat } from "./desk.js";
import { JibMap } from "./jib_map.js";
import { Scene } from "./scene.js";
import { SwingPlot } from "./swing_plot.js";
import { AXES, STATES, element, fixed, meaningOf, plain } from "./words.js";

const TRAIL_S = 10;
const STALE_MS = 1000, LOOK_MS = 200; // crane/state arrives every tick: after this time without one, the values are unknown
const LEGEND = [["measured", "", "Load, measured"], ["target", "dashed", "Target and planned path"], ["reference", "dashed", "Aim, not sent"], ["crane", "", "Crane"]];
const UNHEARD = { heard: false, state: null, cause: "NONE", remedy: "the dashboard does not answer: use the wired emergency stop if the crane must stop" };
const find = (id) => document.getElementById(id);

export class OperateView {
  #aim = null;
  #pose = null;
  #drawn = true; // false: there is something new to draw
  #newNumbers = false;
  #heard_ms = -Infinity; // arrival of the newest crane/state
  #trail = [];
  #shown = new Map(); // id -> text

  constructor(link, desk) {
    this.link = link;
    this.desk = desk;
    this.scene = new Scene(find("scene"));
    this.map = new JibMap(find("map"), (aim) => this.#aimAt(aim));
    this.swing = new SwingPlot(find("swing"));
    this.adaptation = new AdaptationPanel(link);
    find("scene-legend").replaceChildren(...LEGEND.map(([name, style, text]) => element("span", {}, element("i", { className: style, "--c": `var(--${name})` }), text)));
    find("view-home").onclick = () => this.scene.lookFrom("side");
    find("view-top").onclick = () => this.scene.lookFrom("top");
    find("mode").onchange = ({ target }) => desk.ask({ kind: "mode", mode: target.value });
    this.#buildAxes();
    this.#buildHud();
    desk.addEventListener("change", () => this.#drawDesk());
    desk.addEventListener("message", () => Object.assign(find("answer"), { textContent: desk.message.text }).dataset.kind = desk.message.kind);
    desk.addEventListener("ask", ({ detail }) => this.#ask(detail));
    link.listen("crane/state", (sample) => this.#takeState(sample));
    const loop = () => {
      if (!this.#drawn) this.#draw();
      if (this.#newNumbers) this.#drawNumbers();
      requestAnimationFrame(loop);
    };
    requestAnimationFrame(loop);
    setInterval(() => { this.#newNumbers ||= this.#stale; }, LOOK_MS);
    document.addEventListener("themechange", () => { this.scene.repaint(); this.#drawn = false; });
    window.addEventListener("resize", () => { this.#drawn = this.#pose === null; });
  }

  get #stale() { return performance.now() - this.#heard_ms > STALE_MS; }

  #takeState(sample) {
    this.#heard_ms = performance.now();
    const pose = { x: sample.get("trolley_position_m"), slew: sample.get("slew_angle_rad"), cable: sample.get("cable_length_m"), radial: sample.get("swing_radial_rad"), tangential: sample.get("swing_tangential_rad") };
    this.state = sample;
    this.#pose = pose;
    const last = this.#trail.at(-1), moved = !last || ["x", "slew", "cable", "radial", "tangential"].some((key) => last[key] !== pose[key]);
    if (moved) this.#trail.push({ ...pose, time_s: sample.time_s });
    const kept = this.#trail.findIndex(({ time_s }) => time_s >= sample.time_s - TRAIL_S);
    if (kept > 0) this.#trail.splice(0, kept);
    else if (kept < 0) this.#trail.splice(0, this.#trail.length - 1); // at rest: the last place stays
    if (moved || kept > 0) this.#drawn = false;
    this.#newNumbers = true;
  }

  get #rig() { return this.desk.about.rig; }
  #target() {
    const move = this.desk.situation?.move;
    const moving = ["HOLD", "RUN"].includes(this.desk.situation?.state);
    if (!move || !moving || !this.#pose) return null;
    const [x, slew, cable] = move.target.map((value, i) => value ?? [this.#pose.x, this.#pose.slew, this.#pose.cable][i]);
    return { x, slew, cable, radial: 0, tangential: 0 };
  }

  #draw() {
    this.#drawn = true;
    if (!this.#pose || find("view-operate").hidden) return;
    const target = this.#target();
    this.scene.show(this.#pose, target, this.#rig);
    this.map.trail = this.swing.trail = this.#trail;
    this.map.draw(this.#pose, target, this.#aim && { ...this.#pose, radial: 0, tangential: 0, ...this.#aim }, this.#rig);
    this.swing.draw(this.#rig?.swing_limit_rad ?? 0.7);
  }

  #buildHud() {
    find("hud").replaceChildren(...[["Trolley", "hud-trolley"], ["Slew", "hud-slew"], ["Cable", "hud-hoist"], ["Swing", "hud-swing"]]
      .flatMap(([label, id]) => [element("dt", {}, label), element("dd", { id })]));
  }

  #drawNumbers() {
    this.#newNumbers = false;
    if (find("view-operate").hidden) return;
    const shown = this.#shown, stale = this.#stale;
    find("view-operate").classList.toggle("stale", stale);
    const put = (id, value, unit) => {
      if (shown.get(id) === value) return;
      shown.set(id, value);
      find(id).replaceChildren(value, element("small", {}, unit));
    };
    const write = (id, text) => {
      if (shown.get(id) !== text) find(id).textContent = text;
      shown.set(id, text);
    };
    if (stale) {
      for (const { key, unit } of AXES) {
        put("hud-" + key, "—", unit);
        for (const name of ["volts-", "speed-"]) write(name + key, "—");
        write("brake-" + key, "brake unknown");
      }
      put("hud-swing", "—", "°");
      return;
    }
    AXES.forEach((axis, i) => {
      put("hud-" + axis.key, fixed(this.state.get(axis.state) * axis.factor, axis.digits), axis.unit);
      write("volts-" + axis.key, fixed(this.state.get(`applied_v[${i}]`), 2) + " V");
      write("speed-" + axis.key, fixed(this.state.get(axis.speed) * axis.factor, 2) + " " + axis.speedUnit);
      const known = this.state.get(`position_known[${i}]`);
      write("brake-" + axis.key, known ? (this.state.get(`brake_closed[${i}]`) ? "brake closed" : "brake open") : "not homed");
    });
    put("hud-swing", (Math.hypot(this.#pose.radial, this.#pose.tangential) * 180 / Math.PI).toFixed(1), "°");
  }

  #buildAxes() {
    const rows = AXES.map((axis) => element("tr", { id: "axis-" + axis.key },
      element("td", {}, axis.label, element("div", { className: "brake", id: "brake-" + axis.key })),
      element("td", { className: "number" }, element("span", { id: "speed-" + axis.key }, "—"), element("div", { className: "brake", id: "volts-" + axis.key }, "—")),
      element("td", {}, element("label", {}, element("input", { id: "target-" + axis.key, type: "number", step: "any", inputMode: "decimal", placeholder: "stay", ariaLabel: axis.label + " target" }), " " + axis.unit))));
    const form = find("axes");
    form.replaceChildren(element("table", {}, element("thead", {}, element("tr", {}, element("th", {}, "Axis"), element("th", {}, "Speed, drive"), element("th", {}, "Go to"))), element("tbody", {}, ...rows)),
      element("div", { className: "row" }, element("button", { type: "button", id: "clear" }, "Clear"), element("button", { type: "submit", className: "primary", id: "ask-move", disabled: true }, "Move there")));
    form.oninput = () => this.#readAim();
    find("clear").onclick = () => { form.reset(); this.#readAim(); };
    form.onsubmit = (event) => { event.preventDefault(); this.#move(); };
  }

  #wanted() {
    const wanted = {};
    for (const axis of AXES) {
      const text = find("target-" + axis.key).value;
      if (text !== "" && Number.isFinite(Number(text))) wanted[axis.field] = Number(text) / axis.factor;
    }
    return wanted;
  }
  #readAim() {
    const wanted = this.#wanted(), aim = {};
    if ("trolley_m" in wanted) aim.x = wanted.trolley_m;
    if ("slew_rad" in wanted) aim.slew = wanted.slew_rad;
    if ("hoist_m" in wanted) aim.cable = wanted.hoist_m;
    this.#aim = Object.keys(aim).length ? aim : null;
    this.#drawn = false;
    this.#drawDesk();
  }
  #aimAt({ x, slew }) {
    find("target-trolley").value = x.toFixed(3);
    if (slew !== undefined && !find("axis-slew").hidden) find("target-slew").value = (slew * 180 / Math.PI).toFixed(1);
    this.#readAim();
  }

  async #move() {
    if (await this.desk.ask({ kind: "move", ...this.#wanted() })) {
      find("axes").reset();
      this.#readAim();
    }
  }

  #ask(kind) {
    if (kind !== "home") return this.desk.ask({ kind });
    // The hoist first: a short cable swings less; the slew axis last (as `crane home`).
    const axes = this.desk.situation.axes, unknown = ["hoist", "trolley", "slew"].find((name) => axes.some((axis) => axis.name === name && axis.present && !axis.known));
    return unknown ? this.desk.ask({ kind: "home", axis: unknown }) : this.desk.say("the position of every axis is known: nothing to home", "good");
  }

  #drawDesk() {
    const { desk } = this, { situation } = desk;
    drawSeat(desk, find("seat"));
    drawRequests(desk, find("requests"));
    const wanted = Object.keys(this.#wanted()).length > 0, moves = desk.answerTo("move");
    find("ask-move").disabled = !(wanted && desk.mine && moves.accepted);
    find("ask-move").title = !desk.mine ? "take the controls first" : moves.reason || (wanted ? "" : "enter a target, or click on the map");
    find("mode").disabled = !desk.mine || desk.lost;
    if (!situation) return;
    if (situation.mode && !desk.waiting.has("mode")) find("mode").value = situation.mode;
    this.#drawSituation(desk.lost ? UNHEARD : situation);
    situation.axes?.forEach((axis) => { find("axis-" + axis.name).hidden = !axis.present; });
    if (situation.axes) this.#configure(situation.axes);
  }

  #configure(axes) {
    const soft = (i) => {
      const margin = this.#rig?.axes[i].soft_margin ?? 0;
      return [axes[i].low_limit + margin, axes[i].high_limit - margin];
    };
    const kind = axes[1].present ? "tower" : "gantry";
    this.map.configure({ x: soft(0), slew: soft(1), hard: { x: [axes[0].low_limit, axes[0].high_limit], slew: [axes[1].low_limit, axes[1].high_limit] } }, kind);
    const cable = axes[2].present ? axes[2].high_limit : (this.#pose?.cable ?? 1);
    this.scene.configure({ reach: axes[0].high_limit, height: cable + 0.35, kind });
    find("map-title").textContent = kind === "tower" ? "Jib from above" : "Bridge from above";
    this.#drawn = this.#pose === null;
  }

  #drawSituation(situation) {
    const [name, tone] = STATES[situation.state] ?? [this.desk.lost ? "Unknown" : "No supervisor", "stop"];
    find("situation").dataset.tone = tone;
    find("situation").dataset.state = situation.state ?? "";
    find("state-name").textContent = name;
    find("state-meaning").textContent = situation.heard ? meaningOf(this.link.idl, "SupervisorState", "STATE_" + situation.state) : "";
    const hasCause = !situation.heard || situation.cause !== "NONE";
    find("cause").hidden = !hasCause;
    if (!hasCause) return;
    find("cause-name").textContent = situation.latch ? plain("bridge: " + situation.latch.reason) : plain(situation.heard ? situation.cause : "silence");
    find("cause-meaning").textContent = situation.latch ? situation.latch.explanation : situation.homing && situation.cause === "HOMING_FAILED" ? plain(situation.homing.failure) : situation.heard ? meaningOf(this.link.idl, "Cause", "CAUSE_" + situation.cause) : "";
    const remedy = situation.latch?.remedy || (situation.cause === "HOMING_FAILED" && situation.homing?.remedy) || situation.remedy;
    find("remedy").textContent = remedy.charAt(0).toUpperCase() + remedy.slice(1) + ".";
  }
}

