// The crane as lines and shaded boxes on a flat canvas, for computers without a graphics processor.
import { begin, polyline } from "./drawing.js";
import { loadInJibFrame, plannedPath } from "./geometry.js";
import { FIELD_OF_VIEW_DEG } from "./orbit.js";

const TRAIL_POINTS = 400, NEAR_M = 0.05;
const LIGHT = [0.4, 0.85, 0.3]; // direction to the sun, about of length 1

export class WireScene {
  #view;
  #standing = []; // parts that stand: {points} in m, world frame; y is up
  #turning = []; // parts of the jib, at slew 0
  #trail = [];
  #path = [];
  #pathKey = null;
  #shown = null;

  constructor(canvas, orbit, view) {
    this.canvas = canvas;
    this.orbit = orbit;
    this.build(view);
  }

  build(view) {
    this.#view = view;
    const { reach, height, kind } = view;
    if (kind === "gantry") {
      this.#standing = [];
      this.#turning = [...truss([-0.1, height + 0.06, 0], [reach + 0.1, height + 0.06, 0], 0.1)];
      for (const x of [-0.1, reach + 0.1])
        for (const z of [-0.24, 0.24]) this.#turning.push({ points: [[x, height, z * 0.3], [x, 0, z * 1.6]], thick: 0.03 });
    } else {
      this.#standing = [...truss([0, 0, 0], [0, height + 0.28, 0], 0.16), ...box([0, 0.035, 0], [0.62, 0.07, 0.62], "muted")];
      this.#turning = [...truss([0, height + 0.06, 0], [reach + 0.12, height + 0.06, 0], 0.1), ...truss([0, height + 0.06, 0], [-0.62, height + 0.06, 0], 0.1),
        ...box([-0.55, height - 0.02, 0], [0.2, 0.2, 0.18], "muted"), ...box([0.12, height - 0.1, 0.13], [0.16, 0.17, 0.16], "muted"),
        { points: [[-0.55, height + 0.1, 0], [0, height + 0.34, 0], [reach * 0.75, height + 0.1, 0]], thick: 0.008 }];
    }
  }

  show(pose, target, rig) {
    const at = this.#world(pose);
    this.#trail.push(at);
    if (this.#trail.length > TRAIL_POINTS) this.#trail.shift();
    const key = target && JSON.stringify(target);
    if (key !== this.#pathKey) this.#path = target ? plannedPath({ ...pose, radial: 0, tangential: 0 }, target, rig).map((step) => this.#world(step)) : [];
    this.#pathKey = key;
    this.#shown = { pose, at, target };
  }

  #world(pose) {
    const { along, ahead, up } = loadInJibFrame(pose);
    return turned([along, this.#view.height + up, -ahead], pose.slew);
  }

  draw() {
    const frame = begin(this.canvas);
    if (!frame) return;
    const { context, width, height, colour } = frame;
    context.fillStyle = colour("ground");
    context.fillRect(0, 0, width, height);
    const project = projection(this.orbit, width, height);
    const lines = (points, style, metres, dash, least = 1) => {
      const seen = points.map(project).filter(Boolean);
      if (seen.length < 2) return;
      polyline(context, seen, style, Math.max(least, metres * project.focal_px / seen[0][2]), dash);
    };
    this.#drawFloor(lines, colour("line"));
    if (!this.#shown) return;
    const { pose, at, target } = this.#shown;
    const face = (points, name, normal) => {
      const seen = points.map(project);
      if (seen.some((point) => point === null)) return;
      context.beginPath();
      seen.forEach(([x, y], i) => (i ? context.lineTo(x, y) : context.moveTo(x, y)));
      context.closePath();
      context.fillStyle = colour(name);
      context.fill();
      context.fillStyle = `rgba(0, 0, 0, ${(0.55 * (1 - Math.max(0, dot(normal, LIGHT)))).toFixed(2)})`; // in its own shade
      context.fill();
    };
    const draw = (part, slew) => {
      const points = slew === 0 ? part.points : part.points.map((point) => turned(point, slew));
      if (!part.normal) return lines(points, colour("crane"), part.thick);
      const normal = slew === 0 ? part.normal : turned(part.normal, slew);
      if (dot(normal, minus(project.eye, points[0])) > 0) face(points, part.colour, normal);
    };
    const disc = (centre, radius) => Array.from({ length: 25 }, (_, i) => [centre[0] + radius * Math.cos(i * Math.PI / 12), 0.004, centre[2] + radius * Math.sin(i * Math.PI / 12)]);
    const shadow = disc(at, 0.1 * (1 + Math.max(0, at[1]) * 0.25)).map(project);
    if (shadow.every(Boolean)) {
      context.beginPath();
      shadow.forEach(([x, y], i) => (i ? context.lineTo(x, y) : context.moveTo(x, y)));
      context.fillStyle = "rgba(0, 0, 0, 0.45)";
      context.fill();
    }
    for (const part of this.#standing) draw(part, 0);
    for (const part of this.#turning) draw(part, pose.slew);
    for (const part of box([pose.x, this.#view.height - 0.02, 0], [0.11, 0.05, 0.12], "muted")) draw(part, pose.slew);
    lines([at, [at[0], 0.004, at[2]]], colour("muted"), 0, [5, 4]);
    lines(this.#trail, colour("measured"), 0.004);
    if (target) {
      const there = this.#world(target);
      lines(this.#path, colour("target"), 0.006, [7, 5], 1.5);
      lines(disc(there, 0.1), colour("target"), 0.012, [], 1.5);
      for (const part of box([0, 0, 0], [0.135, 0.135, 0.135], "target")) lines([...part.points, part.points[0]].map((point) => plus(turned(point, target.slew), there)), colour("target"), 0.004);
    }
    lines([this.#world({ ...pose, cable: 0 }), at], colour("ink"), 0.006, [], 1.5);
    const middle = [at[0], Math.max(0.065, at[1]), at[2]];
    for (const part of box([0, 0, 0], [0.13, 0.13, 0.13], "measured")) {
      const points = part.points.map((point) => plus(turned(point, pose.slew), middle)), normal = turned(part.normal, pose.slew);
      if (dot(normal, minus(project.eye, points[0])) > 0) face(points, part.colour, normal);
    }
  }

  #drawFloor(lines, style) {
    const { reach, kind } = this.#view;
    if (kind === "gantry") {
      for (let i = -4; i <= 4; ++i) {
        lines([[i * reach / 2, 0, -2 * reach], [i * reach / 2, 0, 2 * reach]], style, 0);
        lines([[-2 * reach, 0, i * reach / 2], [2 * reach, 0, i * reach / 2]], style, 0);
      }
      return;
    }
    const around = (i, n) => [Math.cos(2 * Math.PI * i / n), Math.sin(2 * Math.PI * i / n)];
    for (let ring = 1; ring <= 5; ++ring)
      lines(Array.from({ length: 49 }, (_, i) => [around(i, 48)[0] * reach * ring / 5, 0, around(i, 48)[1] * reach * ring / 5]), style, 0);
    for (let i = 0; i < 12; ++i) lines([[0, 0, 0], [around(i, 12)[0] * reach, 0, around(i, 12)[1] * reach]], style, 0);
  }
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const plus = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => a.map((value) => value / Math.hypot(...a));
/** About the vertical axis; a positive angle is anticlockwise from above. */
const turned = ([x, y, z], angle) => [x * Math.cos(angle) + z * Math.sin(angle), y, -x * Math.sin(angle) + z * Math.cos(angle)];

/** Point in m -> [x px, y px, depth m]; null behind the eye. */
function projection(orbit, width, height) {
  const eye = orbit.eye(width / height), forward = unit(minus(orbit.target, eye));
  const right = unit(cross(forward, [0, 1, 0])), up = cross(right, forward);
  const focal_px = height / 2 / Math.tan(FIELD_OF_VIEW_DEG / 2 * Math.PI / 180);
  const project = (point) => {
    const from = minus(point, eye), depth = dot(from, forward);
    if (depth < NEAR_M) return null;
    return [width / 2 + focal_px * dot(from, right) / depth, height / 2 - focal_px * dot(from, up) / depth, depth];
  };
  return Object.assign(project, { eye, focal_px });
}

/** Six faces with their normals, outwards. */
function box([cx, cy, cz], [dx, dy, dz], colour) {
  const faces = [];
  for (let axis = 0; axis < 3; ++axis)
    for (const side of [1, -1]) {
      const corner = (u, v) => {
        const at = [0, 0, 0];
        at[axis] = side;
        at[(axis + 1) % 3] = u;
        at[(axis + 2) % 3] = v;
        return [cx + at[0] * dx / 2, cy + at[1] * dy / 2, cz + at[2] * dz / 2];
      };
      const normal = [0, 0, 0];
      normal[axis] = side;
      faces.push({ points: [corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)], normal, colour });
    }
  return faces;
}

/** Lattice girder between two points: four chords, and one diagonal on each side of each bay. */
function truss(from, to, width) {
  const way = minus(to, from), length = Math.hypot(...way), along = unit(way), half = width / 2;
  const side = Math.abs(along[1]) > 0.9 ? [1, 0, 0] : [0, 1, 0], other = cross(along, side);
  const at = (s, a, b) => [0, 1, 2].map((i) => from[i] + along[i] * s + side[i] * a * half + other[i] * b * half);
  const bars = [[1, 1], [1, -1], [-1, 1], [-1, -1]].map(([a, b]) => ({ points: [at(0, a, b), at(length, a, b)], thick: 0.016 }));
  const bays = Math.max(2, Math.round(length / (width * 1.4)));
  for (const b of [1, -1]) { // one zigzag on each side: few strokes
    bars.push({ points: Array.from({ length: bays + 1 }, (_, i) => at(length * i / bays, i % 2 ? 1 : -1, b)), thick: 0.009 });
    bars.push({ points: Array.from({ length: bays + 1 }, (_, i) => at(length * i / bays, b, i % 2 ? 1 : -1)), thick: 0.009 });
  }
  return bars;
}
