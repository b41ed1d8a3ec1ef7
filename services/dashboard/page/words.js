// What the names of the interface mean to a person.
import { COORDINATES } from "./coordinates.js";

export const STATES = {
  BOOT: ["Starting", "attention"], SELFTEST: ["Self-test", "attention"], LOCKED: ["Locked", "attention"], READY: ["Ready", "calm"],
  ARMING: ["Arming", "calm"], HOLD: ["Holding", "good"], RUN: ["Moving", "good"], STOP_C1: ["Stopping", "stop"],
  STOP_C0: ["Power off", "stop"], ESTOP: ["Emergency stop", "stop"], FAULT: ["Fault", "stop"],
};

/** "SWING_LIMIT" -> "Swing limit", "LATCH_encoder_jump" -> "Latch encoder jump" */
export function plain(name) {
  const words = name.replace(/_/g, " ").toLowerCase().replace("estop", "emergency stop");
  return words.charAt(0).toUpperCase() + words.slice(1);
}

/** Comment of an enumerator in the IDL: "brakes closed; ends with a reset" -> sentence. */
export function meaningOf(idl, enumeration, name) {
  const text = idl?.enums.get(enumeration)?.find((entry) => entry.name === name)?.meaning ?? "";
  return text && text.charAt(0).toUpperCase() + text.slice(1) + (/[.)]$/.test(text) ? "" : ".");
}

export const REQUESTS = { reset: "Reset", arm: "Arm", disarm: "Disarm", home: "Home", mode: "Mode", move: "Move", hold: "Hold", stop: "Stop", estop: "Software stop" };

const ON_PAGE = [ // of the driven coordinates, in their order
  { label: "Trolley", digits: 3, speed: "trolley_speed_mps" },
  { label: "Slew", digits: 1, speed: "slew_speed_radps" },
  { label: "Cable", digits: 3, speed: "cable_speed_mps" },
];
export const AXES = COORDINATES.filter((coordinate) => coordinate.driven).map(({ name, unit, column }, i) => {
  const angle = unit === "rad", shown = angle ? "°" : unit;
  return { ...ON_PAGE[i], key: name, unit: shown, factor: angle ? 180 / Math.PI : 1, field: `${name}_${unit}`, state: column, speedUnit: `${shown}/s` };
});

/** As Number.toFixed(), without negative zero. */
export const fixed = (value, digits) => value.toFixed(digits).replace(/^-(0(\.0+)?)$/, "$1");

export function element(name, properties = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(properties)) {
    if (key === "dataset") Object.assign(made.dataset, value);
    else if (key.startsWith("--")) made.style.setProperty(key, value);
    else if (key in made) made[key] = value;
    else made.setAttribute(key, value);
  }
  made.append(...children.filter((child) => child !== null && child !== undefined));
  return made;
}
