// The operator's desk: takes and keeps the controls, sends requests, says what was answered and why.
import { REQUESTS, element } from "./words.js";

const RENEW_MS = 3000;
const LONGEST_ANSWER_MS = 5000; // the server waits for the supervisor's answer for less than 3 s

export class Desk extends EventTarget {
  about = { may_operate: false, may_stop: false, why_not: "" };
  situation = null;
  lost = false; // no frame arrives: `situation` is old
  holder = null;
  waiting = new Set(); // requests without an answer yet
  seen = ""; // the newest crane/supervisor that this page has received
  #key = sessionStorage.getItem("crane-seat") ?? "";
  #token = sessionStorage.getItem("crane-token") ?? "";
  #pages = new BroadcastChannel("crane-seat"); // the other pages of this browser

  constructor() {
    super();
    // A duplicated tab also copies the key. The page that had it keeps the controls.
    this.#pages.onmessage = ({ data: { asked, held } }) => {
      if (!this.#key) return;
      if (asked === this.#key) this.#pages.postMessage({ held: this.#key });
      else if (held === this.#key) this.#keep(""), this.#changed();
    };
    if (this.#key) this.#pages.postMessage({ asked: this.#key });
    setInterval(() => { if (this.#key) this.#renew(); }, RENEW_MS);
  }

  get mine() { return this.#key !== ""; }

  #post(path, body = {}) { return this.#send(path, "application/json", JSON.stringify(body), AbortSignal.timeout(LONGEST_ANSWER_MS)); }
  /** With the operator's token, without the controls. @returns the answer, with `ok`, `status` and perhaps `error` */
  post(path, body) { return this.#post(path, body); }
  upload(path, file) { return this.#send(path, "application/octet-stream", file); }

  async #send(path, type, body, signal) {
    const headers = { "Content-Type": type, "X-Crane-Seat": this.#key };
    if (this.#token) headers.Authorization = "Bearer " + this.#token;
    if (this.seen) headers["X-Crane-Seen"] = this.seen; // a request that arrives late is refused
    try {
      const answer = await fetch(path, { method: "POST", headers, body, signal });
      return { ok: answer.ok, status: answer.status, ...(await answer.json()) };
    } catch {
      return { ok: false, status: 0, error: "the dashboard does not answer; the request may have been executed" };
    }
  }

  #askAbout() { return fetch("/api/about", { headers: this.#token ? { Authorization: "Bearer " + this.#token } : {} }); }

  async load() {
    try {
      let answer = await this.#askAbout();
      if (answer.status === 403 && this.#token) { // discard a wrong token: with it, the server refuses even a stop
        this.say((await answer.json()).error, "bad");
        this.#keepToken("");
        answer = await this.#askAbout();
      }
      this.about = await answer.json();
      if (this.#key) await this.#renew();
    } catch { /* the banner says that the dashboard does not answer */ }
    this.#changed();
  }

  async useToken(token) {
    this.#keepToken(token);
    await this.load();
  }

  #keepToken(token) {
    this.#token = token;
    token ? sessionStorage.setItem("crane-token", token) : sessionStorage.removeItem("crane-token");
  }

  async take(name) {
    const answer = await this.#post("/api/operator/take", { name });
    if (answer.ok) this.#keep(answer.seat);
    else this.say(answer.error, "bad");
    this.#changed();
  }

  async release() {
    await this.#post("/api/operator/release");
    this.#keep("");
    this.#changed();
  }

  async #renew() {
    const answer = await this.#post("/api/operator/renew");
    if (answer.status !== 409 && answer.status !== 403) return; // a lost connection keeps the key
    this.#keep("");
    this.say("the controls were lost: take them again", "bad");
    this.#changed();
  }

  #keep(key) {
    this.#key = key;
    key ? sessionStorage.setItem("crane-seat", key) : sessionStorage.removeItem("crane-seat");
  }

  /** @param body {kind, ...}; see docs/dashboard.md. @returns true when the supervisor accepted */
  async ask(body) {
    const name = REQUESTS[body.kind];
    this.say(name + " …", "");
    this.waiting.add(body.kind);
    this.#changed();
    const answer = await this.#post("/api/request", body);
    this.waiting.delete(body.kind);
    this.#changed();
    const refused = answer.error ?? (answer.accepted ? "" : answer.reason);
    const outcome = answer.status === 0 ? " without an answer" : " refused";
    this.say(refused ? `${name}${outcome}: ${refused}` : `${name} accepted`, refused ? "bad" : "good");
    return !refused;
  }

  say(text, kind) {
    this.message = { text, kind };
    this.dispatchEvent(new Event("message"));
  }

  /** What the supervisor would answer now. While the connection is lost, only requests that stop are possible. */
  answerTo(request) {
    if (this.lost && !URGENT.has(request)) return { accepted: false, reason: "the dashboard does not answer" };
    if (!this.situation?.heard) return { accepted: false, reason: "no sample of the supervisor arrives" };
    return this.situation.answers.find((answer) => answer.request === request) ?? { accepted: false, reason: "" };
  }

  update(change) {
    Object.assign(this, change);
    this.#changed();
  }
  #changed() { this.dispatchEvent(new Event("change")); }
}

/** The lines about who operates. */
export function drawSeat(desk, into) {
  const key = JSON.stringify([desk.mine, desk.holder, desk.about]);
  if (into.dataset.key === key) return; // keeps what is being typed
  into.dataset.key = key;
  into.replaceChildren();
  if (!desk.about.may_operate) {
    into.append(element("p", {}, desk.about.why_not ? "You watch: " + desk.about.why_not + "." : "You watch."));
    if (!desk.about.token_helps) return;
    const form = element("form", { className: "seat" }, element("input", { type: "password", placeholder: "operator token", autocomplete: "off", ariaLabel: "Operator token" }), element("button", { type: "submit" }, "Use token"));
    form.onsubmit = (event) => { event.preventDefault(); desk.useToken(form.querySelector("input").value); };
    into.append(form);
  } else if (desk.mine) {
    into.append(element("p", {}, element("b", {}, "You operate."), " The others watch."), element("button", { type: "button", id: "release", onclick: () => desk.release() }, "Release controls"));
  } else if (desk.holder) {
    into.append(element("p", {}, element("b", {}, desk.holder), " operates. You watch."));
  } else {
    into.append(element("p", {}, "Nobody operates."), element("button", { type: "button", id: "take", className: "primary", onclick: () => desk.take(localStorage.getItem("crane-operator") ?? "operator") }, "Take controls"));
  }
}

/** The stop that every view shows. A stop needs neither the controls nor, on this computer, the token. */
export function drawSoftwareStop(desk, button) {
  button.disabled = !desk.about.may_stop;
  button.title = desk.about.may_stop ? "Removes power through the network. It does not replace the wired emergency stop." : desk.about.why_not;
}

const KINDS = { reset: "Reset", arm: "Arm", home: "Home", hold: "Hold here", stop: "Stop", disarm: "Disarm" };
const URGENT = new Set(["stop", "disarm"]); // may be asked for again while the answer is awaited

/** The buttons, and under them why some are refused. A button stays the same element: a click ends on the element on which it began. */
export function drawRequests(desk, into) {
  if (!into.childElementCount)
    for (const [kind, title] of Object.entries(KINDS))
      into.append(element("li", {}, element("button", { type: "button", id: "ask-" + kind, onclick: () => desk.dispatchEvent(new CustomEvent("ask", { detail: kind })) }, title)));
  const allowed = desk.about.may_operate && desk.mine;
  const next = { LOCKED: "reset", READY: "arm", HOLD: "", RUN: "" }[desk.situation?.state] ?? "reset";
  const reasons = new Map();
  for (const kind of Object.keys(KINDS)) {
    const answer = desk.answerTo(kind === "hold" ? "move" : kind);
    const button = into.querySelector("#ask-" + kind);
    const free = URGENT.has(kind) || !desk.waiting.has(kind);
    button.disabled = !(answer.accepted && free && (kind === "stop" ? desk.about.may_stop : allowed));
    button.title = answer.accepted ? "" : answer.reason;
    button.className = !button.disabled && kind === next ? "primary" : "";
    if (!answer.accepted && answer.reason) reasons.set(answer.reason, [...(reasons.get(answer.reason) ?? []), kind === "hold" ? "Move" : REQUESTS[kind]]);
  }
  const why = [...reasons].map(([reason, names]) => element("li", { className: "why" }, element("b", {}, names.join(", ")), element("span", {}, reason)));
  for (const line of into.querySelectorAll(".why")) line.remove();
  into.append(...why);
}
