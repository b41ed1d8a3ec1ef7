// The connection to the dashboard: subscribes, decodes, connects anew. Messages are those of
// foxglove.websocket.v1, many in one frame (crane.batch.v1, docs/dashboard.md).
import { Decoder, parseIdl } from "./cdr.js";

const RETRY_MS = [200, 500, 1000, 2000];
// The server sends a frame every 16 ms. A server that hangs or a cut link closes no socket.
const OLD_MS = 1000, LOOK_MS = 200, REPLACE_MS = 5000;
// Largest error of the clocks of page and server against each other, per frame: 120 ppm.
const DRIFT_MS = 0.002;

export class Link extends EventTarget {
  #socket = null;
  #attempt = 0;
  #listeners = new Map(); // topic -> Set of functions (sample)
  #channels = new Map(); // topic -> channel
  #idl = null;
  #heard_ms = 0; // time of the newest frame
  #least_offset_ms = Infinity; // of the page's clock from that of the server, with the least delay so far
  #delay_ms = 0; // of the newest frame beyond the least delay: it has waited in the network or in this page
  #connected_ms = 0; // time at which the present connection was requested
  decoders = new Map(); // topic -> Decoder
  state = "connecting"; // "live", "lost"
  ready = new Promise((known) => { this.known = known; }); // the channels are known
  bytes = 0;

  constructor(url) {
    super();
    this.url = url;
    this.#connect();
    setInterval(() => this.#look(), LOOK_MS);
  }

  get topics() { return [...this.#channels.values()].filter((c) => c.encoding === "cdr").map((c) => c.topic.slice(1)); }
  get idl() { return this.#idl; }

  /** Calls `listener` with every sample of "crane/state" or document of "dashboard/faults" from now on. */
  listen(topic, listener) {
    if (!this.#listeners.has(topic)) {
      this.#listeners.set(topic, new Set());
      this.#subscribe(topic);
    }
    this.#listeners.get(topic).add(listener);
    return () => {
      const set = this.#listeners.get(topic);
      set?.delete(listener);
      if (set?.size !== 0) return;
      this.#listeners.delete(topic);
      this.#send({ op: "unsubscribe", subscriptionIds: [this.#channels.get("/" + topic)?.id].filter(Boolean) });
    };
  }

  #connect() {
    this.#connected_ms = performance.now();
    this.#least_offset_ms = Infinity;
    this.#delay_ms = 0;
    this.#socket = new WebSocket(this.url, "crane.batch.v1");
    this.#socket.binaryType = "arraybuffer";
    this.#socket.onopen = () => { this.#attempt = 0; };
    this.#socket.onmessage = ({ data }) => this.#take(data);
    this.#socket.onclose = () => {
      this.#channels = new Map();
      this.#change("lost");
      setTimeout(() => this.#connect(), RETRY_MS[Math.min(this.#attempt++, RETRY_MS.length - 1)]);
    };
  }

  #look() {
    const silence_ms = performance.now() - Math.max(this.#heard_ms, this.#connected_ms);
    if (this.state === "live" && Math.max(silence_ms, this.#delay_ms) > OLD_MS) this.#change("lost");
    if (this.state === "lost" && this.#channels.size > 0 && Math.max(silence_ms, this.#delay_ms) <= OLD_MS) this.#change("live");
    const pending = [WebSocket.CONNECTING, WebSocket.OPEN].includes(this.#socket.readyState);
    if (silence_ms < REPLACE_MS || this.state !== "lost" || !pending) return;
    // After a cut of the network, the server has given up this connection, and no message says so.
    this.#socket.onmessage = this.#socket.onclose = null;
    this.#socket.close();
    this.#channels = new Map();
    this.#connect();
  }

  #change(state) {
    if (state === this.state) return;
    this.state = state;
    this.dispatchEvent(new Event("change"));
  }

  #send(message) {
    if (this.#socket.readyState === WebSocket.OPEN) this.#socket.send(JSON.stringify(message));
  }

  #subscribe(topic) {
    const channel = this.#channels.get("/" + topic);
    if (channel) this.#send({ op: "subscribe", subscriptions: [{ id: channel.id, channelId: channel.id }] });
  }

  #take(frame) {
    this.bytes += frame.byteLength;
    this.#heard_ms = performance.now();
    const view = new DataView(frame);
    for (let at = 0; at + 5 <= frame.byteLength;) {
      const kind = view.getUint8(at), length = view.getUint32(at + 1, true);
      if (kind === 1) this.#text(JSON.parse(new TextDecoder().decode(new Uint8Array(frame, at + 5, length))));
      else this.#message(new DataView(frame, at + 5, length));
      at += 5 + length;
    }
  }

  #text(message) {
    if (message.op === "advertise") {
      this.#channels = new Map(message.channels.map((channel) => [channel.topic, channel]));
      this.byId = new Map(message.channels.map((channel) => [channel.id, channel]));
      const described = message.channels.find((channel) => channel.schemaEncoding === "omgidl");
      this.#idl = parseIdl(described.schema);
      for (const channel of message.channels)
        if (channel.encoding === "cdr") this.decoders.set(channel.topic.slice(1), new Decoder(this.#idl, channel.schemaName));
      for (const topic of this.#listeners.keys()) this.#subscribe(topic);
      this.known();
      this.#change("live");
    } else if (message.op === "status") {
      console.warn("dashboard:", message.message);
    }
  }

  #message(view) {
    if (view.getUint8(0) !== 1) return this.#takeTime(Number(view.getBigUint64(1, true)) * 1e-6);
    const channel = this.byId.get(view.getUint32(1, true));
    const topic = channel?.topic.slice(1);
    const listeners = this.#listeners.get(topic);
    if (!listeners) return;
    const payload = new DataView(view.buffer, view.byteOffset + 13, view.byteLength - 13);
    const sample = channel.encoding === "json"
      ? JSON.parse(new TextDecoder().decode(payload))
      : this.sampleOf(topic, Number(view.getBigUint64(5, true)) * 1e-9, payload);
    for (const listener of listeners) {
      try {
        listener(sample);
      } catch (error) { // one view that fails must not take the frame from the others
        console.error(topic, error);
      }
    }
  }

  #takeTime(server_ms) {
    const offset_ms = performance.now() - server_ms;
    this.#least_offset_ms = Math.min(this.#least_offset_ms + DRIFT_MS, offset_ms);
    this.#delay_ms = offset_ms - this.#least_offset_ms;
  }

  /** {time_s (arrival, s since 1970), values (in the order of the decoder's columns), get(path)} */
  sampleOf(topic, time_s, payload) {
    const decoder = this.decoders.get(topic);
    const values = decoder.decode(payload);
    return { time_s, values, get: (path) => values[decoder.index.get(path)] };
  }

  /** Samples that the dashboard still has. @param more  "&from=..&to=.." [ns since 1970] or "&fault=3" */
  async history(topic, more = "") {
    await this.ready;
    const answer = await fetch(`/api/history?topic=${topic}${more}`).catch(() => null); // the banner says that it is lost
    if (!answer?.ok) return [];
    const data = await answer.arrayBuffer();
    const view = new DataView(data), samples = [];
    for (let at = 0; at + 12 <= data.byteLength;) {
      const length = view.getUint32(at + 8, true);
      samples.push(this.sampleOf(topic, Number(view.getBigInt64(at, true)) * 1e-9, new DataView(data, at + 12, length)));
      at += 12 + length;
    }
    return samples;
  }
}
