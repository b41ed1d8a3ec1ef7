// Figures of the page in a headless Chromium, beside a running stack. Prints one line for each setting. It judges nothing.
//   CRANE_BIN=build/release/bin CRANE_CHROMIUM=$(which chromium) tests/dashboard/browser/run DIRECTORY measure.mjs
import { after, before, test } from "node:test";
import { chromium } from "playwright-core";
import { crane_done, crane_options, end, startDashboard, startStack, until } from "./stack.mjs";

const LOADS = 5; // of the page; the median is printed
const WATCHED_MS = 10_000;
const median = (values) => [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];

let stack, dashboard, browser;
before(async () => {
  stack = await startStack();
  dashboard = await startDashboard();
  browser = await chromium.launch({ executablePath: process.env.CRANE_CHROMIUM, args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"] });
});
after(async () => {
  await browser?.close();
  await Promise.all([dashboard?.child, stack].filter(Boolean).map((child) => end(child)));
});

/** One load of the page, without cache: time to the first picture, to the first live data, bytes of its files. */
async function load(viewport) {
  const context = await browser.newContext({ viewport });
  const page = await context.newPage();
  let bytes = 0, files = 0;
  const sizes = [];
  page.on("requestfinished", (request) => sizes.push(request.sizes().then((size) => { bytes += size.responseBodySize + size.responseHeadersSize; ++files; }).catch(() => {})));
  await page.goto(dashboard.address);
  const picture_ms = await page.evaluate(async () => {
    while (!(window.craneDashboard?.frames > 0)) await new Promise(requestAnimationFrame);
    return performance.now();
  });
  await until("the page is live", () => page.locator("#link-state[data-state=live]").count());
  const paint_ms = await page.evaluate(() => performance.getEntriesByName("first-contentful-paint")[0]?.startTime);
  await Promise.all(sizes);
  return { context, page, picture_ms, paint_ms, bytes, files };
}

/** Pictures drawn and offered by the browser in WATCHED_MS. */
async function frames(page) {
  return page.evaluate(async (watched_ms) => {
    const begin = performance.now(), drawn = craneDashboard.frames;
    let offered = 0;
    while (performance.now() - begin < watched_ms) { await new Promise(requestAnimationFrame); ++offered; }
    const seconds = (performance.now() - begin) / 1000;
    return { drawn_hz: (craneDashboard.frames - drawn) / seconds, offered_hz: offered / seconds };
  }, WATCHED_MS);
}

for (const [name, viewport] of [["desktop 1440 x 900", { width: 1440, height: 900 }], ["phone 390 x 844", { width: 390, height: 844 }]])
  test(name, async () => {
    const loads = [];
    for (let i = 0; i < LOADS; ++i) {
      const one = await load(viewport);
      loads.push(one);
      if (i < LOADS - 1) await one.context.close();
    }
    const { page, context, bytes, files } = loads.at(-1);
    await crane_done("reset", ...crane_options).catch(() => {}); // HOLD already, from the setting before
    await until("the crane is armed", () => crane_done("arm", ...crane_options).then(() => true, () => page.getAttribute("#situation", "data-state").then((state) => state === "HOLD")));
    await crane_done("move", "--trolley", name.startsWith("desktop") ? "1.0" : "0.4", "--slew", name.startsWith("desktop") ? "90deg" : "0", ...crane_options);
    const { drawn_hz, offered_hz } = await frames(page);
    await context.close();
    console.log(`${name}: first paint ${median(loads.map((one) => one.paint_ms)).toFixed(0)} ms, first picture of the crane ${median(loads.map((one) => one.picture_ms)).toFixed(0)} ms, ` +
      `${drawn_hz.toFixed(1)} pictures/s of ${offered_hz.toFixed(1)} frames/s while the crane moves, page ${(bytes / 1000).toFixed(0)} kB in ${files} files`);
  });
