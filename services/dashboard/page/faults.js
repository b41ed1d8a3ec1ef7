// The view Faults: what went wrong, first cause first.
import { element, plain } from "./words.js";

const find = (id) => document.getElementById(id);
const clock = (ns) => new Date(Number(BigInt(ns) / 1000000n)).toLocaleTimeString([], { hour12: false });

export class FaultsView {
  #faults = [];
  #seen = Number(sessionStorage.getItem("crane-faults-seen") ?? 0);
  #visible = false;

  /** @param jump called with a fault whose data are to be shown */
  constructor(link, jump) {
    this.jump = jump;
    link.listen("dashboard/faults", ({ faults }) => { this.#faults = faults; this.#draw(); });
  }

  shown(view) {
    this.#visible = view === "faults";
    this.#draw();
  }

  #draw() {
    const newest = Math.max(0, ...this.#faults.map((fault) => fault.number));
    if (this.#visible || newest < this.#seen) sessionStorage.setItem("crane-faults-seen", this.#seen = newest);
    const unseen = this.#faults.filter((fault) => fault.number > this.#seen && fault.first.kind !== "order").length;
    find("fault-count").hidden = unseen === 0;
    find("fault-count").textContent = unseen;
    if (!this.#visible) return;
    const open = new Set([...document.querySelectorAll("#fault-list details[open]")].map((details) => details.dataset.number));
    find("fault-list").replaceChildren(...(this.#faults.length ? this.#faults.map((fault) => this.#entry(fault, open)) : [element("li", { className: "empty" }, "No fault since the dashboard was started.")]));
  }

  #entry(fault, open) {
    const { first } = fault;
    const body = element("div", {}, element("p", { className: "fault-name" }, plain(first.what)),
      element("p", {}, `${first.explanation.charAt(0).toUpperCase()}${first.explanation.slice(1)}. `, element("span", { className: "hint" }, `${first.from.replace(/_/g, " ")}, tick ${first.tick}`)));
    if (first.remedy) body.append(element("p", {}, element("span", { className: "hint" }, "What to do: "), element("b", {}, first.remedy)));
    const more = fault.consequences.length;
    if (more) {
      const details = element("details", { open: open.has(String(fault.number)), dataset: { number: fault.number } }, element("summary", {}, more === 1 ? "1 consequence" : more + " consequences"),
        element("ul", {}, ...fault.consequences.map((note) => element("li", {}, element("span", { className: "hint" }, `+${((Number(BigInt(note.at_ns) - BigInt(first.at_ns))) / 1e6).toFixed(0)} ms  `), element("b", {}, plain(note.what)), ` ${note.explanation} (${note.from.replace(/_/g, " ")})`))));
      body.append(details);
    }
    const cleared = fault.cleared_ns ? `cleared ${clock(fault.cleared_ns)}` : first.kind === "warning" ? "" : "not cleared";
    const jump = element("button", { type: "button", disabled: !fault.has_data, title: fault.has_data ? "10 s before to 5 s after" : "the data are complete 5 s after the event; the last eight are kept", onclick: () => this.jump(fault) }, "Show data");
    return element("li", { dataset: { kind: first.kind } }, element("div", {}, element("time", {}, clock(first.at_ns)), element("p", { className: "hint" }, cleared)), body, element("div", {}, jump));
  }
}
