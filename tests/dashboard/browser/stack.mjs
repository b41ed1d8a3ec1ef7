// A stack and a dashboard of its own for each test file.
import { spawn } from "node:child_process";
import { once } from "node:events";
import { createInterface } from "node:readline";

const BIN = process.env.CRANE_BIN;

/** Starts a program and waits for a line of its output. @returns {child, match} */
export async function start(program, args, pattern, patience_ms = 30_000) {
  const child = spawn(`${BIN}/${program}`, args, { stdio: ["ignore", "pipe", "pipe"] });
  let said = "";
  child.stderr.on("data", (data) => { said += data; });
  const lines = createInterface({ input: child.stdout });
  const match = await new Promise((found, failed) => {
    const timer = setTimeout(() => failed(new Error(`${program} did not say ${pattern} within ${patience_ms} ms: ${said}`)), patience_ms);
    child.once("exit", (code) => failed(new Error(`${program} ended with ${code}: ${said}`)));
    lines.on("line", (line) => { said += line + "\n"; const hit = line.match(pattern); if (hit) { clearTimeout(timer); found(hit); } });
  });
  return { child, match };
}

export async function end(child, signal = "SIGTERM") {
  if (child.exitCode !== null || child.signalCode !== null) return;
  const ended = once(child, "exit");
  child.kill(signal);
  await ended;
}

const crane = "browser_test_" + process.pid;
export const bus = ["--domain", process.env.CRANE_TEST_DOMAIN ?? "54", "--crane", crane];
export const startStack = async (...more) => (await start("crane", ["up", "--dds", "cyclone", ...bus, ...more], /is up with/)).child;
/** @returns {child, address: "http://127.0.0.1:PORT/"} */
export async function startDashboard(port = 0, ...more) {
  const { child, match } = await start("crane_dashboard", [...bus, "--rig", "virginia_tech_tower", "--port", String(port), ...more], /dashboard: (http:\S+)/);
  return { child, address: match[1] };
}

/** Runs a command of `crane` to its end. */
export async function crane_done(...args) {
  const child = spawn(`${BIN}/crane`, args, { stdio: ["ignore", "ignore", "pipe"] });
  let said = "";
  child.stderr.on("data", (data) => { said += data; });
  const [code] = await once(child, "exit");
  if (code !== 0) throw new Error(`crane ${args.join(" ")}: ${code}: ${said}`);
}

/** Waits until `holds` returns something true. */
export async function until(what, holds, patience_ms = 10_000) {
  const give_up = Date.now() + patience_ms;
  for (;;) {
    const result = await holds();
    if (result) return result;
    if (Date.now() > give_up) throw new Error("did not happen: " + what);
    await new Promise((done) => setTimeout(done, 50));
  }
}
