// The official client of foxglove.websocket.v1, with the official decoder of its CDR and IDL.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { parseIDL } from "@foxglove/omgidl-parser";
import { MessageReader } from "@foxglove/omgidl-serialization";
import protocol from "@foxglove/ws-protocol";
import WebSocket from "ws";
import { end, startDashboard, startStack, until } from "./stack.mjs";

const { FoxgloveClient } = protocol;
let stack, dashboard, client;
const channels = new Map(), samples = new Map(), errors = [], times = [];
let info, parameters;

before(async () => {
  stack = await startStack();
  dashboard = await startDashboard();
  client = new FoxgloveClient({ ws: new WebSocket(dashboard.address.replace("http", "ws"), [FoxgloveClient.SUPPORTED_SUBPROTOCOL]) });
  client.on("error", (error) => errors.push(error));
  client.on("status", (status) => errors.push(status.message));
  client.on("serverInfo", (message) => { info = message; });
  client.on("time", ({ time }) => times.push(time));
  client.on("parameterValues", (message) => { parameters = message.parameters; });
  client.on("advertise", (list) => {
    for (const channel of list) {
      const reader = channel.encoding === "cdr" ? new MessageReader(channel.schemaName, parseIDL(channel.schema)) : null;
      channels.set(client.subscribe(channel.id), { ...channel, reader });
    }
  });
  client.on("message", ({ subscriptionId, data, timestamp }) => {
    const channel = channels.get(subscriptionId);
    const value = channel.reader ? channel.reader.readMessage(data) : JSON.parse(new TextDecoder().decode(data));
    const list = samples.get(channel.topic) ?? [];
    list.push({ value, timestamp });
    samples.set(channel.topic, list);
  });
});
after(async () => {
  client?.close();
  await Promise.all([dashboard?.child, stack].filter(Boolean).map((child) => end(child)));
});

test("the client knows the server and its channels", async () => {
  await until("channels", () => channels.size >= 16);
  assert.match(info.name, /^crane browser_test_/);
  assert.deepEqual(info.capabilities, ["time", "parameters"]);
});

test("every topic of the loop is decoded, in order and whole", async () => {
  const loop = ["/crane/state", "/crane/reference", "/crane/tracking", "/crane/anti_swing", "/crane/demand", "/crane/command", "/crane/supervisor"];
  await until("200 samples of each", () => loop.every((topic) => (samples.get(topic)?.length ?? 0) >= 200));
  for (const topic of loop) {
    const ticks = samples.get(topic).map(({ value }) => value.header.tick);
    assert.ok(ticks.every((tick, i) => i === 0 || tick > ticks[i - 1]), `${topic} in order`);
  }
  // A busy computer may skip ticks; what the dashboard has, it passes on.
  const metrics = await (await fetch(dashboard.address + "metrics")).text();
  assert.match(metrics, /\ncrane_dashboard_dropped_messages_total 0\n/);
  assert.match(metrics, /\ncrane_dashboard_lost_samples_total 0\n/);
  const { value: state, timestamp } = samples.get("/crane/state").at(-1);
  assert.ok(Math.abs(state.trolley_position_m - 0.3) < 0.01, "where the rig file starts the trolley");
  assert.ok(Math.abs(Number(timestamp / 1000000n) - Date.now()) < 5000, "times are ns since 1970");
  assert.equal(samples.get("/crane/supervisor").at(-1).value.state, 2, "LOCKED");
});

test("documents, time and parameters arrive, too", async () => {
  await until("documents", () => samples.get("/dashboard/traffic") && samples.get("/dashboard/situation"));
  assert.equal(samples.get("/dashboard/situation").at(-1).value.state, "LOCKED");
  client.getParameters(["crane"], "mine");
  await until("parameters and time", () => parameters && times.length > 10);
  assert.match(parameters[0].value, /^browser_test_/);
});

test("what a viewer may not do is answered, not obeyed", async () => {
  assert.deepEqual(errors, []);
  client.setParameters([{ name: "crane", value: "other" }]);
  await until("a reason", () => errors.some((error) => /not supported/.test(error)));
});
