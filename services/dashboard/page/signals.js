// Signals: columns of topics over time, kept for two minutes, filled from the dashboard's history when they are
// first asked for. Time is that of the sample: s since 1970 by the clock of the crane, mapped to this dashboard's.

import { COORDINATES } from "./coordinates.js";

export const KEPT_S = 120;
const CAPACITY = 16384;

const NAMES_OF_COORDINATES = COORDINATES.map((coordinate) => coordinate.driven ? coordinate.name : `${coordinate.axis} swing`);
const PREDICTED = COORDINATES.map((_, i) => i).filter((i) => COORDINATES[i].name !== "hoist"); // columns of the twin
const UNITS = { mps: "m/s", mps2: "m/s²", radps: "°/s", rad: "°", m: "m", v: "V", us: "µs", ns: "s", s: "s" };
const OF_AXIS = { position: "", speed: "/s", acceleration: "/s²" };
const unitOf = (index) => UNITS[COORDINATES[index].unit];
const SOURCES = { "crane/state": "measured", "crane/reference": "reference", "crane/twin": "predicted" };
const NAMES = { "applied_v": "drive voltage", "drive_v": "drive voltage", "swing_radial_rad": "radial swing", "swing_tangential_rad": "tangential swing", "swing_radial_radps": "radial swing rate", "swing_tangential_radps": "tangential swing rate", "predicted": "position" };

/** What a column is called in plain English, its unit on the page, the factor to it, and the kind of its source. */
export function describe(topic, path) {
  const index = path.match(/\[(\d)\]/)?.[1];
  const bare = path.replace(/^header\./, "").replace(/^(axis|column)\[\d\]\./, "").replace(/\[\d\]$/, "");
  const suffix = bare.match(/_(mps2|mps|radps|rad|m|v|us|ns|s)$/)?.[1];
  let unit = UNITS[suffix] ?? "", where = "", source = SOURCES[topic] ?? topic.replace("crane/", "").replace(/_/g, " ");
  if (path.startsWith("column[")) {
    where = NAMES_OF_COORDINATES[PREDICTED[index]];
    unit = unitOf(PREDICTED[index]);
    if (bare !== "predicted") source = "twin";
  } else if (path.startsWith("counts[")) {
    where = NAMES_OF_COORDINATES[index];
  } else if (index !== undefined) {
    const coordinate = COORDINATES[index];
    where = coordinate?.driven ? coordinate.name : index;
    if (coordinate?.driven && bare in OF_AXIS) unit = unitOf(index) + OF_AXIS[bare];
  }
  const words = where.endsWith("swing") && bare === "predicted" ? "" : NAMES[bare] ?? bare.replace(suffix ? new RegExp(`_${suffix}$`) : "", "").replace(/[_.]/g, " ");
  const factor = unit.startsWith("°") ? 180 / Math.PI : suffix === "ns" ? 1e-9 : 1;
  return { label: [source, where, words].filter(Boolean).join(" "), unit, factor, source };
}

class Topic {
  columns = new Map(); // path -> Float64Array
  time = new Float64Array(CAPACITY);
  next = 0;
  count = 0;
}

export class Signals {
  #link;
  #topics = new Map();
  #offset_s = null; // arrival - sample time: the smallest seen is that of the fastest sample

  constructor(link) {
    this.#link = link;
  }

  /** Time of a sample on the page's axis. */
  timeOf(sample) {
    const sampled_s = sample.get("header.sample_time_ns") * 1e-9;
    if (!(sampled_s > 0)) return sample.time_s;
    const offset_s = sample.time_s - sampled_s;
    if (this.#offset_s === null || offset_s < this.#offset_s || offset_s > this.#offset_s + 5) this.#offset_s = offset_s;
    return sampled_s + this.#offset_s;
  }

  /** Begins to keep a signal. */
  async want(topic, path) {
    let kept = this.#topics.get(topic);
    if (kept?.columns.has(path)) return;
    if (!kept) {
      kept = new Topic();
      this.#topics.set(topic, kept);
      this.#link.listen(topic, (sample) => this.#add(kept, sample));
    }
    kept.columns.set(path, new Float64Array(CAPACITY).fill(NaN));
    await this.#refill(topic, kept);
  }

  async #refill(topic, kept) {
    const samples = await this.#link.history(topic);
    kept.next = kept.count = 0;
    kept.last_s = -Infinity;
    for (const sample of samples) this.#add(kept, sample);
  }

  #add(kept, sample) {
    const time_s = this.timeOf(sample);
    if (time_s <= kept.last_s) return; // the history and the live samples overlap
    kept.last_s = time_s;
    kept.time[kept.next] = time_s;
    for (const [path, values] of kept.columns) values[kept.next] = sample.get(path);
    kept.next = (kept.next + 1) % CAPACITY;
    kept.count = Math.min(kept.count + 1, CAPACITY);
  }

  /** [times, values] of a signal between two times, scaled to its unit. */
  read(topic, path, from_s, to_s) {
    const kept = this.#topics.get(topic), values = kept?.columns.get(path);
    if (!values) return [[], []];
    const { factor } = describe(topic, path);
    const times = [], scaled = [];
    for (let i = 0; i < kept.count; ++i) {
      const at = (kept.next - kept.count + i + CAPACITY) % CAPACITY;
      if (kept.time[at] < from_s || kept.time[at] > to_s) continue;
      times.push(kept.time[at]);
      scaled.push(values[at] * factor);
    }
    return [times, scaled];
  }

  newest_s(topic) { return this.#topics.get(topic)?.last_s ?? -Infinity; }
}
