// The stop buttons of the page without a browser: stand-ins for the elements, the storage and the server.
import assert from "node:assert/strict";
import { copyFileSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { pathToFileURL } from "node:url";

class StandIn {
  dataset = {};
  style = {};
  className = "";
  children = [];
  append(...children) { this.children.push(...children); }
  replaceChildren(...children) { this.children = children; }
  remove() {}
  setAttribute(name, value) { this[name] = value; }
  get childElementCount() { return this.children.length; }
  get inside() { return this.children.filter((child) => child instanceof StandIn).flatMap((child) => [child, ...child.inside]); }
  querySelector(id) { return this.inside.find((child) => "#" + child.id === id) ?? null; }
  querySelectorAll(style) { return this.inside.filter((child) => "." + child.className === style); }
}
const stored = new Map();
globalThis.document = { createElement: () => new StandIn() };
globalThis.sessionStorage = { getItem: (key) => stored.get(key) ?? null, setItem: (key, value) => stored.set(key, value), removeItem: (key) => stored.delete(key) };
/** Delivers at once to the other pages of the browser. */
class Pages {
  static all = new Set();
  constructor() { Pages.all.add(this); }
  postMessage(data) { for (const page of Pages.all) if (page !== this) page.onmessage?.({ data }); }
}
globalThis.BroadcastChannel = Pages;
globalThis.setInterval = () => 0; // the desk renews its controls for as long as the page is open

// The server generates coordinates.js (tests/dashboard/page_test.cpp); the desk does not use it.
const page = mkdtempSync(join(tmpdir(), "crane_page_"));
after(() => rmSync(page, { recursive: true, force: true }));
for (const script of ["desk.js", "words.js"]) copyFileSync(join(process.env.CRANE_DASHBOARD_PAGE, script), join(page, script));
writeFileSync(join(page, "coordinates.js"), "export const COORDINATES = [];");
writeFileSync(join(page, "package.json"), '{"type": "module"}');
const { Desk, drawRequests, drawSoftwareStop } = await import(pathToFileURL(join(page, "desk.js")));

const KINDS = ["reset", "arm", "home", "move", "stop", "disarm"];
/** A desk whose supervisor accepts every request. */
function deskWith(about) {
  const desk = new Desk();
  desk.update({ about, situation: { heard: true, state: "HOLD", answers: KINDS.map((request) => ({ request, accepted: true, reason: "" })) } });
  return desk;
}
function buttonsOf(desk) {
  const requests = new StandIn(), estop = new StandIn();
  drawRequests(desk, requests);
  drawSoftwareStop(desk, estop);
  return { estop, enabled: requests.inside.filter((child) => child.id && !child.disabled).map((child) => child.id) };
}

test("a page that may stop but not operate enables both stop buttons and nothing else", () => {
  const { estop, enabled } = buttonsOf(deskWith({ may_operate: false, may_stop: true, why_not: "the operator token is needed" }));
  assert.equal(estop.disabled, false);
  assert.match(estop.title, /does not replace the wired emergency stop/);
  assert.deepEqual(enabled, ["ask-stop"]);
});

test("a page that may operate needs the controls for all requests but the stops", () => {
  const { estop, enabled } = buttonsOf(deskWith({ may_operate: true, may_stop: true, why_not: "" }));
  assert.equal(estop.disabled, false);
  assert.deepEqual(enabled, ["ask-stop"]);
});

test("a page without a connection offers only the requests that stop", () => {
  const desk = deskWith({ may_operate: true, may_stop: true, why_not: "" });
  stored.set("crane-seat", "key");
  const operator = new Desk();
  stored.delete("crane-seat");
  operator.update({ about: desk.about, situation: desk.situation });
  assert.ok(buttonsOf(operator).enabled.includes("ask-arm"));
  operator.update({ lost: true });
  assert.deepEqual(buttonsOf(operator).enabled, ["ask-stop", "ask-disarm"]);
  assert.equal(buttonsOf(operator).estop.disabled, false);
  assert.equal(operator.answerTo("move").reason, "the dashboard does not answer");
});

test("a duplicated tab does not take the controls of the first one", () => {
  stored.set("crane-seat", "seat");
  const first = new Desk(), duplicate = new Desk();
  stored.delete("crane-seat");
  assert.ok(first.mine);
  assert.ok(!duplicate.mine);
});

test("a page that may not stop disables every button and says why", () => {
  const { estop, enabled } = buttonsOf(deskWith({ may_operate: false, may_stop: false, why_not: "read-only" }));
  assert.equal(estop.disabled, true);
  assert.equal(estop.title, "read-only");
  assert.deepEqual(enabled, []);
});

test("a wrong token is forgotten: the server would refuse a stop that contains it", async () => {
  const answer = (status, body) => ({ ok: status === 200, status, json: async () => body });
  globalThis.fetch = async (path, { headers }) =>
    headers.Authorization ? answer(403, { error: "the operator token is wrong" }) : answer(200, { may_operate: false, may_stop: true, token_helps: true, why_not: "the operator token is needed" });
  const desk = new Desk();
  await desk.useToken("guess");
  assert.equal(desk.message.text, "the operator token is wrong");
  assert.equal(desk.about.may_stop, true);
  assert.equal(desk.about.token_helps, true, "the page asks for the token again");
  assert.equal(stored.has("crane-token"), false);
});
