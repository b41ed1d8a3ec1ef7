// The panel of the adaptation, with a crane that learns its friction: real processes, a real browser.
import assert from "node:assert/strict";
import { appendFileSync, copyFileSync, mkdirSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { chromium } from "playwright-core";
import { bus, crane_done, end, startDashboard, startStack, until } from "./stack.mjs";

let stack, dashboard, browser, page;
const directory = mkdtempSync(join(tmpdir(), "crane_adaptation_"));
const complaints = [];
mkdirSync("screenshots", { recursive: true });
const activity = (axis) => page.textContent(`#adaptation-${axis} .activity`);
const confidence = (axis) => page.evaluate((name) => document.querySelector(`#adaptation-${name} meter`).value, axis);

before(async () => {
  const rig = join(directory, "adaptive.toml");
  copyFileSync(process.env.CRANE_RIGS + "/virginia_tech_tower.toml", rig);
  appendFileSync(rig, "\n[adaptation]\nenabled = true\n");
  stack = await startStack("--rig", rig, "--no-black-box");
  dashboard = await startDashboard();
  browser = await chromium.launch({ executablePath: process.env.CRANE_CHROMIUM, args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"] });
  page = await (await browser.newContext({ viewport: { width: 1440, height: 1000 } })).newPage();
  page.on("console", (message) => { if (["error", "warning"].includes(message.type())) complaints.push(message.text()); });
  page.on("pageerror", (error) => complaints.push(error.message));
  await page.goto(dashboard.address);
});
after(async () => {
  await browser?.close();
  rmSync(directory, { recursive: true, force: true });
  await Promise.all([dashboard?.child, stack].filter(Boolean).map((child) => end(child)));
});

test("before the first move, the panel shows the levels of the rig file, and why no axis learns", async () => {
  await until("the panel appears", () => page.isVisible("#adaptation"), 30_000);
  assert.equal(await confidence("slew"), 0);
  assert.equal(await activity("slew"), "Frozen: the brake of the axis is not open.");
  assert.match(await page.textContent("#adaptation-trolley tbody"), /forward0\.900 ± 0\.\d{3}/);
});

test("a move teaches the axis: estimate, confidence and state change", async () => {
  const before_move = await page.textContent("#adaptation-slew tbody");
  for (const request of ["reset", "arm"]) await until(request + " is accepted", () => crane_done(request, ...bus).then(() => true, () => false), 30_000);
  const moved = crane_done("move", "--slew", "90deg", "--wait", ...bus);
  await until("the slew axis learns", async () => (await activity("slew")) === "Learning");
  await moved;
  await until("the confidence has grown", async () => (await confidence("slew")) > 0);
  assert.ok((await confidence("slew")) <= 1);
  assert.notEqual(await page.textContent("#adaptation-slew tbody"), before_move);
  await until("an axis at rest does not learn", async () => (await activity("slew")).startsWith("Frozen: the axis is within its zero band"));
  assert.match(await page.textContent("#adaptation-load"), /Payload\d+\.\d\d ± \d+\.\d\d kg/);
  await page.locator("#adaptation").scrollIntoViewIfNeeded();
  await page.screenshot({ path: "screenshots/operate_adaptation.png" });
});

test("an axis that was rolled back is shown as such", async () => {
  const shown = await page.evaluate(async () => {
    const { activityOf } = await import("/adaptation.js");
    const { idl } = craneDashboard.link;
    const numberOf = (enumeration, name) => idl.enums.get(enumeration).findIndex((entry) => entry.name === name);
    const values = { "axis[1].phase": numberOf("AdaptationPhase", "ADAPTATION_FROZEN"), "axis[1].freeze": numberOf("AdaptationFreeze", "FREEZE_ROLLED_BACK") };
    return activityOf({ get: (path) => values[path] }, idl, 1);
  });
  assert.equal(shown.tone, "stop");
  assert.match(shown.text, /^Frozen: an installed set explained a move worse than the set before; ends after two moves/);
});

test("the panel disappears with its crane", async () => {
  await end(stack);
  await until("the panel is hidden", async () => !(await page.isVisible("#adaptation")), 20_000);
  assert.deepEqual(complaints, []);
});
