// The panel Adaptation of the view Operate: what the friction compensation has learnt, how sure it is, and why an axis does not learn.
// It appears with the first sample of crane/adaptation: a crane whose rig file adapts no axis has no such topic.
import { AXES, element, fixed, meaningOf } from "./words.js";

const PERIOD_MS = 500; // the estimates change slowly
const GONE_MS = 3000;
const ALARMING = ["FREEZE_LIMIT_CYCLE", "FREEZE_ROLLED_BACK", "FREEZE_IMPLAUSIBLE"];
const find = (id) => document.getElementById(id);
const with_deviation = (value, deviation, digits) => `${fixed(value, digits)} ± ${fixed(deviation, digits)}`;

/** What an axis does: {phase: "off", "frozen", "learning"; tone; text}. */
export function activityOf(sample, idl, axis) {
  const nameOf = (enumeration, field) => idl.enums.get(enumeration)[sample.get(`axis[${axis}].${field}`)]?.name ?? "";
  const phase = nameOf("AdaptationPhase", "phase").replace("ADAPTATION_", "").toLowerCase();
  if (phase !== "frozen") return { phase, tone: phase === "learning" ? "good" : "calm", text: phase === "learning" ? "Learning" : "Not adapted" };
  const reason = nameOf("AdaptationFreeze", "freeze");
  const [why, end] = meaningOf(idl, "AdaptationFreeze", reason).split("; ");
  return { phase, tone: ALARMING.includes(reason) ? "stop" : "attention", text: `Frozen: ${why.charAt(0).toLowerCase()}${why.slice(1)}${end ? "; " + end : ""}` };
}

function directionOf(sample, path, name) {
  const get = (field) => sample.get(`${path}.${field}`);
  return element("tr", {}, element("td", {}, name),
    element("td", { className: "number" }, with_deviation(get("coulomb_v"), get("coulomb_std_v"), 3)),
    element("td", { className: "number" }, with_deviation(get("static_v"), get("static_std_v"), 3)),
    element("td", { className: "number" }, get("used_coulomb_v").toFixed(3)));
}

function axisOf(sample, idl, axis) {
  const { phase, tone, text } = activityOf(sample, idl, axis);
  if (phase === "off") return [];
  const path = `axis[${axis}]`, get = (field) => sample.get(`${path}.${field}`);
  const { key, label } = AXES[axis];
  const times = (count, one, many) => count === 1 ? `1 ${one}` : `${count} ${many}`;
  return [element("section", { id: "adaptation-" + key, dataset: { phase } },
    element("h3", {}, label, element("meter", { min: 0, max: 1, value: get("confidence"), title: "accuracy of the Coulomb friction; 0: that of the rig file; 1: exact in both directions" }),
      element("span", { className: "hint" }, `confidence ${(100 * get("confidence")).toFixed(0)} %`)),
    element("p", { className: "activity", dataset: { tone } }, text),
    element("table", {}, element("thead", {}, element("tr", {}, ...["", "Coulomb [V]", "Break-away [V]", "In use [V]"].map((head) => element("th", {}, head)))),
      element("tbody", {}, directionOf(sample, path + ".positive", "forward"), directionOf(sample, path + ".negative", "back"))),
    element("p", { className: "hint" }, `${times(get("installed"), "set of levels", "sets of levels")} installed, ${times(get("roll_backs"), "roll-back", "roll-backs")}`))];
}

export class AdaptationPanel {
  #drawn_ms = 0;

  constructor(link) {
    this.link = link;
    link.listen("crane/adaptation", (sample) => this.#take(sample));
    setInterval(() => { if (performance.now() - this.#drawn_ms > GONE_MS) find("adaptation").hidden = true; }, GONE_MS);
  }

  #take(sample) {
    const now_ms = performance.now();
    if (now_ms - this.#drawn_ms < PERIOD_MS) return;
    this.#drawn_ms = now_ms;
    find("adaptation").hidden = false;
    if (find("view-operate").hidden) return;
    const mean = (name, deviation, factor, digits) => with_deviation(sample.get(name) * factor, sample.get(deviation) * factor, digits);
    find("adaptation-axes").replaceChildren(...[0, 1].flatMap((axis) => axisOf(sample, this.link.idl, axis)));
    const degrees = 180 / Math.PI;
    find("adaptation-load").replaceChildren(...[
      ["Payload", mean("load_mass_kg", "load_mass_std_kg", 1, 2) + " kg"],
      ["Pendulum", mean("pendulum_length_m", "pendulum_length_std_m", 1, 3) + " m"],
      ["Swing at rest, radial", mean("swing_offset_rad[0]", "swing_offset_std_rad[0]", degrees, 2) + "°"],
      ["tangential", mean("swing_offset_rad[1]", "swing_offset_std_rad[1]", degrees, 2) + "°"],
    ].flatMap(([name, value]) => [element("dt", {}, name), element("dd", {}, value)]));
  }
}
