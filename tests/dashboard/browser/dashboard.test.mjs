// The dashboard as a person uses it: real processes, a real browser. Screenshots stay in the directory of the build.
import assert from "node:assert/strict";
import { mkdirSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { chromium } from "playwright-core";
import WebSocket from "ws";
import { crane_done, end, startDashboard, startStack, until } from "./stack.mjs";

let stack, dashboard, browser, page, second;
const recorded = mkdtempSync(join(tmpdir(), "crane_runs_"));
const complaints = [];
mkdirSync("screenshots", { recursive: true });
const shot = (from, name) => from.screenshot({ path: `screenshots/${name}.png` });

function watch(opened, name) {
  opened.on("console", (message) => { if (["error", "warning"].includes(message.type())) complaints.push(`${name}: ${message.text()}`); });
  opened.on("pageerror", (error) => complaints.push(`${name}: ${error.message}`));
}
async function open(name, options = {}) {
  const opened = await (await browser.newContext({ viewport: { width: 1440, height: 900 }, ...options })).newPage();
  watch(opened, name);
  await opened.goto(dashboard.address);
  await until(name + " is live", () => opened.locator("#link-state[data-state=live]").count());
  return opened;
}
const show = (view) => page.click(`.tabs a[href="#${view}"]`);
const state = (from = page) => from.getAttribute("#situation", "data-state");
async function ask(kind) {
  await until(kind + " is possible", () => page.isEnabled("#ask-" + kind));
  await page.click("#ask-" + kind);
}
async function arm() {
  await ask("reset");
  await until("READY", async () => (await state()) === "READY");
  await until("armed", async () => {
    // Refused until state and demand have been fresh for a second. The button waits for the answer; a click does not wait for the button.
    await page.evaluate(() => document.querySelector("#ask-arm").click());
    return (await state()) === "HOLD";
  });
}
const number = async (id) => parseFloat(await page.textContent("#" + id));

before(async () => {
  for (const controller of ["gain_scheduling_partial", "delayed_1"]) await crane_done("run", "maneuver_1", "--controller", controller, "--out", join(recorded, controller));
  stack = await startStack("--twin");
  dashboard = await startDashboard(0, "--runs", recorded);
  browser = await chromium.launch({ executablePath: process.env.CRANE_CHROMIUM, args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"] });
});
after(async () => {
  await browser?.close();
  rmSync(recorded, { recursive: true, force: true });
  await Promise.all([dashboard?.child, stack].filter(Boolean).map((child) => end(child)));
});

test("the first picture comes soon, and the state says what to do", async () => {
  page = await open("first browser");
  const first_ms = await page.evaluate(async () => {
    while (craneDashboard.frames < 1) await new Promise(requestAnimationFrame);
    return performance.now();
  });
  console.log(`first picture after ${first_ms.toFixed(0)} ms`);
  await until("the state is shown", async () => (await state()) === "LOCKED");
  assert.match(await page.textContent("#remedy"), /Reset, then arm/);
  assert.ok(await page.isDisabled("#ask-reset"), "without the controls nothing can be asked for");
  assert.ok(await page.isEnabled("#estop"));
  await shot(page, "operate_locked");
});

test("the operator takes the controls, arms and moves; the load moves and the numbers follow", async () => {
  await page.click("#take");
  assert.match(await page.textContent("#requests"), /Move/);
  await arm();
  await page.fill("#target-trolley", "0.9");
  await page.fill("#target-slew", "60");
  await page.click("#ask-move");
  await until("the move is accepted", async () => /Move accepted/.test(await page.textContent("#answer")));
  await until("the trolley is under way", async () => (await number("hud-trolley")) > 0.4);
  await shot(page, "operate_moving");
  await until("the load swings", async () => (await number("hud-swing")) > 0.3);
  await until("the target is reached", async () => Math.abs((await number("hud-trolley")) - 0.9) < 0.02 && Math.abs((await number("hud-slew")) - 60) < 2, 15_000);
});

test("a click on the map aims, and Hold here holds", async () => {
  const box = await page.locator("#map").boundingBox();
  await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2 - box.height * 0.25); // slew 90 degrees
  assert.ok(Math.abs(parseFloat(await page.inputValue("#target-slew")) - 90) < 3, await page.inputValue("#target-slew"));
  await page.click("#clear");
  await ask("hold");
  await until("hold is accepted", async () => /Hold accepted/.test(await page.textContent("#answer")));
});

test("a move beyond the limits is refused with its reason", async () => {
  await page.fill("#target-trolley", "9");
  await page.click("#ask-move");
  await until("refused", async () => /Move refused: trolley target .* must lie in/.test(await page.textContent("#answer")));
  await page.click("#clear");
});

test("another operating mode is refused while the crane is armed", async () => {
  await page.selectOption("#mode", "manual");
  await until("refused", async () => /Mode refused: the mode does not change while the crane is arming, armed or stopping/.test(await page.textContent("#answer")));
  await until("the present mode is shown", async () => (await page.inputValue("#mode")) === "semi_automatic");
});

test("without the operator token, a page of this computer stops the crane and does nothing else", async () => {
  const secret = mkdtempSync(join(tmpdir(), "crane_token_"));
  const guarded = await startDashboard(0, "--operator-token", join(secret, "token"));
  const other = await (await browser.newContext()).newPage();
  watch(other, "without token");
  await other.goto(guarded.address);
  await until("the page asks for the token", () => other.locator("#seat input[type=password]").count());
  await until("the stop is possible", () => other.isEnabled("#ask-stop"));
  assert.ok(await other.isEnabled("#estop"));
  assert.ok(await other.isDisabled("#ask-disarm"));
  await other.click("#ask-stop");
  await until("stopped", async () => (await state()) === "LOCKED");
  await other.close();
  await end(guarded.child);
  rmSync(secret, { recursive: true });
  await arm();
});

test("plots fill, can be added, paused and exported", async () => {
  await show("plots");
  await until("the plot has two lines of data", async () => page.evaluate(() => document.querySelectorAll(".plot canvas").length >= 3));
  const value = () => page.textContent(".plot .chip .value");
  await until("the measured trolley is plotted", async () => Math.abs(parseFloat(await value()) - 0.9) < 0.05);
  await page.fill("#signal-search", "measured swing radial");
  await page.click("#signal-list button >> nth=0");
  await until("the page has been open for 12 s", () => page.evaluate(() => performance.now() > 12_000));
  const [download] = await Promise.all([page.waitForEvent("download"), page.click("#plot-csv")]);
  await download.saveAs("screenshots/crane.csv");
  const csv = readFileSync("screenshots/crane.csv", "utf8").split("\n");
  assert.match(csv[0], /^time_s,state\.trolley_position_m,reference\.axis\[0\]\.position/);
  assert.ok(csv.length > 1000, `${csv.length} lines; more than 1000 expected after 12 s at 100 Hz`);
  await page.click("#plot-pause");
  await shot(page, "plots");
  await page.click("#plot-pause");
});

test("the network view shows what runs", async () => {
  await show("network");
  await until("processes", async () => (await page.locator("#process-table tbody tr").count()) >= 7);
  await until("rates", async () => /\d\d\d?\.\d Hz/.test(await page.textContent("#topic-table")));
  assert.match(await page.textContent("#graph"), /planner/);
  await shot(page, "network");
});

test("a second browser watches and does not operate", async () => {
  second = await open("second browser");
  assert.match(await second.textContent("#seat"), /operates\. You watch/);
  assert.ok(await second.isDisabled("#ask-disarm"));
  const refused = await second.evaluate(async () => (await fetch("/api/request", { method: "POST", headers: { "Content-Type": "application/json" }, body: '{"kind":"disarm"}' })).status);
  assert.equal(refused, 409);
  complaints.splice(0, complaints.length, ...complaints.filter((line) => !/409/.test(line)));
  await until("it sees the crane", async () => (await second.textContent("#hud-trolley")).includes("0."));
});

test("the software stop stops the crane, with cause and remedy, in both browsers", async () => {
  await show("operate");
  await page.fill("#target-trolley", "0.4");
  await page.click("#ask-move");
  await until("under way", async () => (await state()) === "RUN");
  await page.click("#estop");
  for (const shown of [page, second]) await until("stopped", async () => (await state(shown)) === "ESTOP");
  assert.equal(await page.textContent("#cause-name"), "Operator emergency stop");
  assert.match(await page.textContent("#remedy"), /Find the reason for the stop, then reset/);
  await shot(page, "operate_software_stop");
  await second.close(); // two cranes drawn in software leave little of two processors
});

test("the timeline names the stop, and shows the data around it", async () => {
  await show("faults");
  assert.match(await page.textContent("#fault-list li >> nth=0"), /Operator emergency stop/);
  await until("the data are complete", async () => page.isEnabled("#fault-list li button >> nth=0"), 12_000);
  await shot(page, "faults");
  await page.click("#fault-list li button >> nth=0");
  await until("the moment is shown", async () => /Data around OPERATOR_ESTOP/.test(await page.textContent("#plot-hint")));
  await page.waitForTimeout(300);
  await shot(page, "moment");
  await page.click("#plot-pause");
});

test("a reload keeps the controls", async () => {
  await show("operate");
  await page.reload();
  await until("still the operator", async () => /You operate/.test(await page.textContent("#seat")));
});

test("while the dashboard hangs, the page says that its values are old and offers no motion", async () => {
  dashboard.child.kill("SIGSTOP");
  await until("the loss is shown", () => page.isVisible("#lost"));
  assert.match(await page.textContent("#link-state"), /lost/);
  assert.equal(await page.textContent("#state-name"), "Unknown");
  await show("operate");
  assert.ok(await page.isDisabled("#ask-arm") && await page.isDisabled("#ask-home") && await page.isDisabled("#mode"));
  dashboard.child.kill("SIGCONT");
  await until("live again", async () => !(await page.isVisible("#lost")) && (await page.locator("#link-state[data-state=live]").count()) === 1);
});

test("after a lost dashboard the page says so, and connects again by itself", async () => {
  const port = Number(new URL(dashboard.address).port);
  await end(dashboard.child, "SIGKILL");
  await until("the loss is shown", () => page.isVisible("#lost"));
  await shot(page, "lost");
  dashboard = await startDashboard(port, "--runs", recorded);
  await until("live again", () => page.locator("#link-state[data-state=live]").count());
  await until("the state is shown again", async () => (await state()) === "ESTOP");
  assert.ok(!(await page.isVisible("#lost")));
  complaints.splice(0, complaints.length, ...complaints.filter((line) => !/ERR_CONNECTION|WebSocket|ERR_EMPTY|ERR_SOCKET|409/.test(line)));
});

test("a client that does not read delays nobody", async () => {
  const hanging = new WebSocket(dashboard.address.replace("http", "ws"), ["foxglove.websocket.v1"]);
  await new Promise((opened) => hanging.once("open", opened));
  hanging.send(JSON.stringify({ op: "subscribe", subscriptions: Array.from({ length: 12 }, (_, i) => ({ id: i + 1, channelId: i + 1 })) }));
  hanging.pause();
  const before_frames = await page.evaluate(() => craneDashboard.frames);
  await page.waitForTimeout(3000);
  const drawn = (await page.evaluate(() => craneDashboard.frames)) - before_frames;
  console.log(`${(drawn / 3).toFixed(0)} pictures per second beside a client that does not read`);
  assert.ok(drawn >= 5, `${drawn} pictures in 3 s`); // drawn in software beside a whole stack
  hanging.terminate();
});

test("it works on a phone and in light colours", async () => {
  const phone = await open("phone", { viewport: { width: 390, height: 844 }, colorScheme: "light", deviceScaleFactor: 2, hasTouch: true });
  await phone.waitForTimeout(500);
  const wide = await phone.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
  assert.equal(wide, 0, "the page is as wide as the phone");
  const stop = await phone.locator("#estop").boundingBox();
  assert.ok(stop.height >= 44 && stop.y + stop.height <= 844, "the stop is in reach of a thumb");
  await shot(phone, "phone");
  await phone.close();
  await page.click("#theme");
  await page.waitForTimeout(300);
  await shot(page, "operate_other_theme");
});

test("two recordings are reviewed side by side", async () => {
  await show("runs");
  for (const controller of ["gain_scheduling_partial", "delayed_1"]) {
    await page.check(`#runs-list li[data-run="${controller}/recording.mcap"] input`);
    await until(controller + " is reviewed", () => page.locator(`.review[data-run="${controller}/recording.mcap"] .report-link`).count(), 90_000);
  }
  assert.ok((await page.locator("#runs-plots canvas").count()) >= 6, "a plot of each signal");
  assert.match(await page.textContent("#runs-reviews"), /largest swing/);
  await shot(page, "runs");
  const [opened] = await Promise.all([page.context().waitForEvent("page"), page.click(".report-link >> nth=0")]);
  await opened.waitForLoadState();
  assert.match(await opened.textContent("body"), /What happened/);
  await opened.locator(".plot >> nth=0").scrollIntoViewIfNeeded(); // a plot is drawn when it comes into view
  await until("the scripts of the report draw a plot", () => opened.locator("canvas").count());
  assert.equal(await opened.evaluate(() => fetch("/api/about").then(() => "reached", () => "kept out")), "kept out", "a report reaches nothing of the dashboard");
  await opened.close();
});

test("an uploaded run is diagnosed, with its verdict and report", async () => {
  await show("diagnose");
  await page.setInputFiles("#diagnose-upload", join(recorded, "delayed_1", "run.csv"));
  const line = (run) => page.locator(`#diagnose-list li[data-run="${run}"] select`);
  await until("the upload is listed", () => line("upload:run.csv").count());
  assert.ok(await page.isDisabled("#diagnose-start"));
  await line("gain_scheduling_partial/run.csv").selectOption("train");
  await line("upload:run.csv").selectOption("test");
  await page.click("#diagnose-start");
  await until("it computes", () => page.locator("#diagnose-jobs progress").count());
  await until("progress is told", async () => (await page.locator("#diagnose-jobs progress").getAttribute("value")) > 0, 120_000);
  await shot(page, "diagnose_running");
  await until("a verdict", () => page.locator("#diagnose-jobs .verdict").count(), 240_000);
  assert.match(await page.textContent("#diagnose-jobs .verdict"), /^(none|named|ambiguous|parameter|unknown): /);
  await shot(page, "diagnose");
});

test("no browser complained", () => assert.deepEqual(complaints, []));

test("without a crane the page shows no values of the past", async () => {
  await show("operate");
  await end(stack);
  await until("the brake is unknown", async () => /brake unknown/.test(await page.textContent("#brake-trolley")));
  assert.equal(await page.textContent("#speed-trolley"), "—");
  assert.match(await page.textContent("#hud-trolley"), /—/);
  assert.ok(await page.isDisabled("#ask-arm"));
});
