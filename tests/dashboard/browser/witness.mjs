// A bare timer beside a test: prints by how many ms it was late at most, when it is told to end.
const PERIOD_MS = 10;
let due = performance.now() + PERIOD_MS, latest = 0;
const tick = () => {
  const now = performance.now();
  latest = Math.max(latest, now - due);
  due = now + PERIOD_MS;
  setTimeout(tick, PERIOD_MS);
};
setTimeout(tick, PERIOD_MS);
process.on("SIGTERM", () => { console.log(Math.round(latest)); process.exit(); });
