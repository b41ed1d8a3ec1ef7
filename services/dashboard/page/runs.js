// The views Runs and Diagnose: recordings of a directory, what each says, up to four side by side, and what the simulation gets wrong.
import { element } from "./words.js";

const find = (id) => document.getElementById(id);
const MOST_COMPARED = 4, LOOK_AGAIN_MS = 700;
const TONES = ["measured", "target", "predicted", "crane"]; // of the compared runs, in the order of choosing
const PLOTS = [["trolley_m", "Trolley, m"], ["slew_deg", "Slew, °"], ["swing_radial_deg", "Swing radial, °"], ["swing_tangential_deg", "Swing tangential, °"], ["trolley_v", "Trolley drive, V"], ["slew_v", "Slew drive, V"]];

/** Recordings and jobs of the dashboard; asked for while a view shows them. */
export class RunsModel extends EventTarget {
  runs = [];
  jobs = [];
  directory = "";
  starts = false;
  results = new Map(); // job -> result.json

  constructor(desk) {
    super();
    this.desk = desk;
  }

  async look() {
    const [runs, jobs] = await Promise.all(["/api/runs", "/api/jobs"].map((path) => fetch(path).then((answer) => answer.json()).catch(() => null)));
    if (runs) Object.assign(this, { runs: runs.runs, directory: runs.directory, starts: runs.starts, longestUpload: runs.longest_upload_bytes });
    if (jobs) this.jobs = jobs.jobs;
    this.dispatchEvent(new Event("change"));
    if (this.jobs.some((job) => job.state === "running" || job.state === "waiting")) this.#again();
  }
  #again() {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.look(), LOOK_AGAIN_MS);
  }

  /** @returns the job that reviews a run; null: refused, and `problem` says why */
  async start(path, body) {
    const answer = await this.desk.post(path, body);
    this.problem = answer.error ?? "";
    await this.look();
    return answer.ok ? answer.job : null;
  }

  async upload(file) {
    this.problem = file.size > this.longestUpload ? `${file.name} is larger than ${this.longestUpload >> 20} MB: put it into the directory of the dashboard` : "";
    if (!this.problem) this.problem = (await this.desk.upload("/api/uploads/" + encodeURIComponent(file.name), file)).error ?? "";
    await this.look();
  }

  async resultOf(job) {
    if (!this.results.has(job)) {
      const answer = await fetch(`/api/jobs/${job}/result`).catch(() => null);
      if (!answer?.ok) return null;
      this.results.set(job, await answer.json());
    }
    return this.results.get(job);
  }
}

const size = (bytes) => bytes < 1e6 ? (bytes / 1e3).toFixed(0) + " kB" : (bytes / 1e6).toFixed(1) + " MB";
const date = (seconds) => new Date(seconds * 1000).toLocaleString([], { dateStyle: "short", timeStyle: "short" });
const report = (job, title) => element("a", { href: `/api/jobs/${job}/report`, target: "_blank", rel: "noopener", className: "report-link" }, title);

function emptyText(model) {
  if (!model.directory) return "This dashboard was started without a directory of recordings: add --runs DIRECTORY.";
  return `No recording is in ${model.directory}.`;
}

export class RunsView {
  #chosen = []; // names, in the order of choosing
  #jobs = new Map(); // name -> job
  #drawn = "";

  constructor(model) {
    this.model = model;
    model.addEventListener("change", () => this.#draw());
    document.addEventListener("themechange", () => { this.#drawn = ""; this.#draw(); });
  }

  shown(view) {
    this.visible = view === "runs";
    if (this.visible) this.model.look();
  }

  async #toggle(name, chosen) {
    this.#chosen = this.#chosen.filter((other) => other !== name);
    if (chosen && this.#chosen.length < MOST_COMPARED) {
      this.#chosen.push(name);
      const job = await this.model.start("/api/runs/review", { run: name });
      if (job === null) this.#chosen = this.#chosen.filter((other) => other !== name);
      else this.#jobs.set(name, job);
    }
    this.#draw();
  }

  async #draw() {
    if (!this.visible) return;
    const { runs, problem } = this.model;
    const recordings = runs.filter((run) => run.recording);
    find("runs-hint").textContent = recordings.length ? `${this.model.directory} — choose up to ${MOST_COMPARED}` : emptyText(this.model);
    find("runs-problem").textContent = problem ?? "";
    const list = find("runs-list"), key = JSON.stringify([recordings, this.#chosen]);
    if (list.dataset.key !== key) { // a box stays the same element: a click ends on the element on which it began
      list.dataset.key = key;
      list.replaceChildren(...recordings.map((run) => {
        const at = this.#chosen.indexOf(run.name);
        const box = element("input", { type: "checkbox", checked: at >= 0, disabled: run.too_large || (at < 0 && this.#chosen.length >= MOST_COMPARED), onchange: (event) => this.#toggle(run.name, event.target.checked) });
        return element("li", { dataset: { run: run.name } }, element("label", { "--tone": at >= 0 ? `var(--${TONES[at]})` : "transparent" }, box, element("b", {}, run.name), element("small", {}, `${date(run.changed_s)}, ${size(run.bytes)}${run.too_large ? ", too large to open here" : ""}`)));
      }));
    }
    await this.#drawReviews();
  }

  async #drawReviews() {
    const cards = [], opened = [];
    for (const [at, name] of this.#chosen.entries()) {
      const job = this.model.jobs.find((one) => one.id === this.#jobs.get(name));
      const result = job?.state === "done" ? await this.model.resultOf(job.id) : null;
      const heading = element("h3", { "--tone": `var(--${TONES[at]})` }, element("i", {}), name);
      if (result) {
        opened.push({ at, name, result });
        cards.push(element("article", { className: "panel review", dataset: { run: name } }, heading, ...result.sentences.map((sentence) => element("p", {}, sentence)),
          element("p", { className: "hint" }, `${result.duration_s.toFixed(1)} s; largest swing ${result.largest_swing_radial_deg.toFixed(2)}° radial, ${result.largest_swing_tangential_deg.toFixed(2)}° tangential`), report(job.id, "Open the whole review")));
      } else {
        cards.push(element("article", { className: "panel review" }, heading, element("p", { className: job?.problem ? "bad" : "hint" }, job?.problem || "is being read …")));
      }
    }
    const key = JSON.stringify([opened.map((one) => [one.name, one.at]), cards.length]);
    find("runs-reviews").replaceChildren(...cards);
    if (key === this.#drawn) return;
    this.#drawn = key;
    this.#drawPlots(opened);
  }

  /** One plot for each signal; every run begins at 0 s. */
  #drawPlots(opened) {
    const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();
    const area = find("runs-plots");
    area.replaceChildren();
    if (!opened.length) return;
    const boxes = PLOTS.map(([, title]) => element("div", { className: "panel" }, element("p", { className: "eyebrow" }, title)));
    area.append(...boxes); // all of them first: their width depends on their number
    for (const [i, [key]] of PLOTS.entries()) {
      const box = boxes[i];
      const joined = window.uPlot.join(opened.map(({ result }) => [result.curves.time_s, result.curves[key]]));
      const axis = { stroke: colour("muted"), grid: { stroke: colour("line") }, ticks: { stroke: colour("line") } };
      new window.uPlot({ width: Math.max(200, box.clientWidth - 32), height: 180, scales: { x: { time: false } }, legend: { show: false }, axes: [axis, axis],
        series: [{}, ...opened.map(({ at, name }) => ({ label: name, stroke: colour(TONES[at]), width: 1.5, spanGaps: true }))] }, joined, box);
    }
  }
}

export class DiagnoseView {
  #use = new Map(); // name -> "train", "test"

  constructor(model) {
    this.model = model;
    model.addEventListener("change", () => this.#draw());
    find("diagnose-start").onclick = () => this.#start();
    find("diagnose-upload").onchange = async (event) => {
      for (const file of event.target.files) await model.upload(file);
      event.target.value = "";
    };
  }

  shown(view) {
    this.visible = view === "diagnose";
    if (this.visible) this.model.look();
  }

  #named(use) { return [...this.#use].filter(([, chosen]) => chosen === use).map(([name]) => name); }

  async #start() {
    await this.model.start("/api/runs/diagnose", { train: this.#named("train"), test: this.#named("test") });
  }

  async #draw() {
    if (!this.visible) return;
    const { model } = this;
    find("diagnose-hint").textContent = model.runs.length ? "The model is fitted to the training runs; the test runs only confirm the result." : emptyText(model);
    find("diagnose-problem").textContent = model.problem ?? "";
    const list = find("diagnose-list");
    const key = JSON.stringify(model.runs);
    if (list.dataset.key !== key) { // keeps an open list of choices
      list.dataset.key = key;
      list.replaceChildren(...model.runs.map((run) => this.#line(run)));
    }
    this.#enable();
    const jobs = model.jobs.filter((job) => job.kind === "diagnose").reverse();
    find("diagnose-jobs").replaceChildren(...await Promise.all(jobs.map((job) => this.#job(job))));
  }

  #line(run) {
    const choice = element("select", { ariaLabel: "Use of " + run.name, disabled: run.too_large, onchange: (event) => { event.target.value ? this.#use.set(run.name, event.target.value) : this.#use.delete(run.name); this.#enable(); } },
      ...[["", "—"], ["train", "train"], ["test", "test"]].map(([value, title]) => element("option", { value, selected: (this.#use.get(run.name) ?? "") === value }, title)));
    return element("li", { dataset: { run: run.name } }, choice, element("b", {}, run.name), element("small", {}, `${date(run.changed_s)}, ${size(run.bytes)}`));
  }

  #enable() { find("diagnose-start").disabled = !this.model.starts || !this.#named("train").length || !this.#named("test").length; }

  async #job(job) {
    const card = element("article", { className: "panel review", dataset: { state: job.state } }, element("h3", {}, job.runs.join(", ")));
    if (job.state === "running" || job.state === "waiting") {
      card.append(element("progress", { value: job.progress ?? 0, max: 1 }), element("p", { className: "hint" }, job.state === "waiting" ? "waits for the job before it" : `${job.doing || "reads the runs"} — ${job.seconds.toFixed(0)} s of at most ${job.longest_seconds} s`),
        element("button", { type: "button", onclick: () => this.model.start("/api/jobs/cancel", { job: job.id }) }, "Cancel"));
    } else if (job.state === "done") {
      const result = await this.model.resultOf(job.id);
      card.append(element("p", { className: "verdict" }, result ? `${result.verdict}: ${result.sentence ?? ""}` : "no result"), report(job.id, "Open the report"), element("p", { className: "hint" }, `${job.seconds.toFixed(0)} s`));
    } else {
      card.append(element("p", { className: "bad" }, job.problem || job.state));
    }
    return card;
  }
}
