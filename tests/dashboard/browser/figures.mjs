// Measures the dashboard in a headless Chromium beside a recorded stack, and prints one line for each figure (deploy/bench-dashboard).
// It states no limits: the figures depend on the computer and on what else runs on it.
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { loadavg, tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { chromium } from "playwright-core";
import WebSocket from "ws";
import { bus, crane_done, end, start, startDashboard, startStack, until } from "./stack.mjs";

const TICKS_PER_S = 100; // of /proc/PID/stat
const PATIENCE_MS = 60_000;
const directory = mkdtempSync(join(tmpdir(), "crane_figures_"));
const print = (name, text) => console.log(`${name.padEnd(58)} ${text}`);
const sleep = (ms) => new Promise((done) => setTimeout(done, ms));
// Without a graphics processor, Chromium draws a 2D canvas fastest without WebGL.
const launch = (executablePath) => chromium.launch({ executablePath, args: ["--no-sandbox", "--disable-gpu"] });
const open = async (browser, address) => {
  const page = await (await browser.newContext({ viewport: { width: 1440, height: 900 } })).newPage();
  await page.goto(address);
  return page;
};
const accepted = (...request) => until(request[0] + " is accepted", () => crane_done(...request, ...bus).then(() => true, () => false), PATIENCE_MS);
async function arm() {
  await accepted("reset");
  await accepted("arm");
}

/** Processor time of a process [s]. */
function processor_s(pid) {
  const fields = readFileSync(`/proc/${pid}/stat`, "utf8").replace(/^.*\) /, "").split(" ");
  return (Number(fields[11]) + Number(fields[12])) / TICKS_PER_S;
}
/** Process id of a child of `parent` whose command line contains `text`. */
function child_of(parent, text) {
  const pids = readFileSync(`/proc/${parent}/task/${parent}/children`, "utf8").trim().split(/\s+/);
  return Number(pids.find((pid) => readFileSync(`/proc/${pid}/cmdline`, "utf8").replaceAll("\0", " ").includes(text)));
}
/** A viewer that subscribes to every channel. */
function viewer(address) {
  const socket = new WebSocket(address.replace("http", "ws"), ["foxglove.websocket.v1"]);
  socket.on("message", (data, binary) => {
    if (binary) return;
    const message = JSON.parse(data);
    if (message.op === "advertise") socket.send(JSON.stringify({ op: "subscribe", subscriptions: message.channels.map(({ id }) => ({ id, channelId: id })) }));
  });
  return socket;
}

test("page, first picture, pictures per second, processor time", async () => {
  const stack = await startStack("--record", join(directory, "run.mcap"), "--no-black-box");
  const dashboard = await startDashboard();
  const browser = await launch(process.env.CRANE_CHROMIUM);
  const page = await open(browser, dashboard.address);
  await page.waitForFunction(() => window.craneDashboard?.frames > 0, null, { timeout: PATIENCE_MS });
  const first_ms = await page.evaluate(() => performance.now());
  await sleep(2000); // fonts and the second renderer
  const bytes = await page.evaluate(() => [...performance.getEntriesByType("navigation"), ...performance.getEntriesByType("resource")].reduce((sum, entry) => sum + entry.encodedBodySize, 0));
  print("page, transferred", `${(bytes / 1e6).toFixed(2)} MB`);
  print("first picture after the start of loading", `${first_ms.toFixed(0)} ms`);
  await arm();
  const viewers = [1, 2, 3].map(() => viewer(dashboard.address));
  let frames = 0, moving_s = 0;
  const recorder = child_of(stack.pid, " record ");
  const from = { time_ms: performance.now(), recorder_s: processor_s(recorder), dashboard_s: processor_s(dashboard.child.pid) };
  for (const trolley of ["0.9", "0.4", "0.9", "0.4"]) {
    const moved = crane_done("move", "--trolley", trolley, "--slew", `${(Number(trolley) - 0.4) * 120}deg`, "--wait", ...bus);
    await until("the load moves", () => page.evaluate(() => document.getElementById("speed-trolley").textContent !== "0.00 m/s"), PATIENCE_MS);
    const before = await page.evaluate(() => [craneDashboard.frames, performance.now()]);
    await sleep(2000);
    const after = await page.evaluate(() => [craneDashboard.frames, performance.now()]);
    frames += after[0] - before[0];
    moving_s += (after[1] - before[1]) / 1000;
    await moved;
  }
  const span_s = (performance.now() - from.time_ms) / 1000;
  const share = (before_s, pid) => `${(100 * (processor_s(pid) - before_s) / span_s).toFixed(1)} % of a processor over ${span_s.toFixed(0)} s`;
  print("pictures per second during moves", `${(frames / moving_s).toFixed(0)}`);
  print("recorder", share(from.recorder_s, recorder));
  print("dashboard with 4 clients (page, 3 viewers of every channel)", share(from.dashboard_s, dashboard.child.pid));
  for (const socket of viewers) socket.close();
  await browser.close();
  await Promise.all([dashboard.child, stack].map((child) => end(child)));
});

test("from `crane up` to a moving picture in a browser of another host", async (context) => {
  const ip = (...args) => execFileSync("ip", args, { stdio: ["ignore", "pipe", "pipe"] });
  const host = "crane_figures", link = ["cfig0", "cfig1"], address = "10.83.24.1";
  try {
    ip("netns", "add", host);
  } catch {
    return context.skip("network namespaces need root and iproute2");
  }
  let up, dashboard, browser;
  try {
    ip("link", "add", link[0], "type", "veth", "peer", "name", link[1], "netns", host);
    ip("addr", "add", address + "/24", "dev", link[0]);
    ip("link", "set", link[0], "up");
    ip("-n", host, "addr", "add", "10.83.24.2/24", "dev", link[1]);
    ip("-n", host, "link", "set", link[1], "up");
    const wrapper = join(directory, "chromium");
    writeFileSync(wrapper, `#!/bin/sh\nexec ip netns exec ${host} ${process.env.CRANE_CHROMIUM} "$@"\n`, { mode: 0o755 });
    browser = await launch(wrapper); // a browser is open before somebody starts a crane
    const begin_ms = performance.now();
    const seconds = () => `${((performance.now() - begin_ms) / 1000).toFixed(1)} s`;
    const started = startStack("--no-black-box").then((child) => { up = child; });
    dashboard = (await start("crane_dashboard", [...bus, "--rig", "virginia_tech_tower", "--listen", address, "--port", "8765"], /dashboard: (http:\S+)/)).child;
    const page = await open(browser, `http://${address}:8765/`);
    await page.waitForFunction(() => window.craneDashboard?.frames > 0, null, { timeout: PATIENCE_MS });
    print("`crane up` to the picture on another host", seconds());
    await started;
    await arm();
    const moved = crane_done("move", "--trolley", "0.9", ...bus);
    await page.waitForFunction(() => document.getElementById("speed-trolley").textContent !== "0.00 m/s", null, { timeout: PATIENCE_MS });
    print("`crane up`, reset, arm and move to a moving picture there", seconds());
    await moved;
  } finally {
    await browser?.close();
    await Promise.all([dashboard, up].filter(Boolean).map((child) => end(child)));
    ip("netns", "del", host);
    rmSync(directory, { recursive: true, force: true });
    print("load average of this computer", loadavg().map((load) => load.toFixed(1)).join(" "));
  }
});
