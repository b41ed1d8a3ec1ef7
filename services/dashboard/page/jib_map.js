// The crane from above: where the load may go, where it is, where it goes. A click aims.
import { begin, polyline } from "./drawing.js";
import { onGround, plannedPath } from "./geometry.js";

export class JibMap {
  #scale = 1;
  #centre = [0, 0];
  trail = [];

  /** @param aimed called with {x, slew} of a click inside the permitted area */
  constructor(canvas, aimed) {
    this.canvas = canvas;
    canvas.addEventListener("click", (event) => {
      const at = canvas.getBoundingClientRect();
      const aim = this.#aimOf((event.clientX - at.left - this.#centre[0]) / this.#scale, -(event.clientY - at.top - this.#centre[1]) / this.#scale);
      if (aim) aimed(aim);
    });
  }

  /** @param limits {x: [low, high], slew: [low, high], hard: {...}} @param kind "tower" or "gantry" */
  configure(limits, kind) {
    this.limits = limits;
    this.kind = kind;
  }

  #aimOf(east, north) {
    if (!this.limits) return null;
    const [low, high] = this.limits.x;
    if (this.kind === "gantry") return { x: Math.min(high, Math.max(low, east + (low + high) / 2)) };
    const { slew } = this.limits, radius = Math.hypot(east, north);
    let angle = Math.atan2(north, east);
    // Of the two ways round, the one that is nearer to where the jib points now.
    const turns = [angle, angle + 2 * Math.PI, angle - 2 * Math.PI].filter((a) => a >= slew[0] && a <= slew[1]);
    if (turns.length === 0) return { x: clamp(radius, low, high), slew: clamp(angle, ...slew) };
    turns.sort((a, b) => Math.abs(a - (this.slew ?? 0)) - Math.abs(b - (this.slew ?? 0)));
    return { x: clamp(radius, low, high), slew: turns[0] };
  }

  draw(pose, target, aim, rig) {
    const frame = begin(this.canvas);
    if (!frame || !this.limits) return;
    const { context, width, height, colour } = frame;
    this.slew = pose.slew;
    const reach = this.limits.hard.x[1] * 1.12, gantry = this.kind === "gantry";
    const middle = gantry ? (this.limits.x[0] + this.limits.x[1]) / 2 : 0;
    this.#scale = gantry ? width / (reach * 1.25) : Math.min(width, height) / 2 / reach;
    this.#centre = [width / 2, height / 2];
    const px = ({ east, north }) => [this.#centre[0] + (east - middle) * this.#scale, this.#centre[1] - north * this.#scale];
    if (gantry) this.#gantryArea(context, colour, px);
    else this.#towerArea(context, colour);

    const here = px(onGround(pose)), hook = px(onGround({ ...pose, cable: 0 }));
    polyline(context, gantry ? [px({ east: this.limits.hard.x[0], north: 0 }), px({ east: this.limits.hard.x[1], north: 0 })]
      : [[this.#centre[0] - 0.35 * this.#scale * Math.cos(pose.slew), this.#centre[1] + 0.35 * this.#scale * Math.sin(pose.slew)], px({ east: reach * Math.cos(pose.slew) * 0.97, north: reach * Math.sin(pose.slew) * 0.97 })], colour("crane"), 4);
    polyline(context, this.trail.map((step) => px(onGround(step))), colour("measured"), 1.5);
    for (const [goal, dash, name] of [[target, [6, 5], "target"], [aim, [2, 4], "reference"]]) {
      if (!goal) continue;
      polyline(context, plannedPath({ ...pose, radial: 0, tangential: 0 }, goal, rig).map((step) => px(onGround(step))), colour(name), 2, dash);
      const [x, y] = px(onGround({ ...goal, radial: 0, tangential: 0 }));
      context.strokeStyle = colour(name);
      context.lineWidth = 2;
      context.strokeRect(x - 7, y - 7, 14, 14);
    }
    context.fillStyle = colour("muted");
    context.fillRect(hook[0] - 4, hook[1] - 4, 8, 8);
    polyline(context, [hook, here], colour("ink"), 1);
    context.fillStyle = colour("measured");
    context.beginPath();
    context.arc(...here, 7, 0, 2 * Math.PI);
    context.fill();
  }

  #towerArea(context, colour) {
    const [cx, cy] = this.#centre, { x, slew, hard } = this.limits;
    const sector = (radii, angles, fill) => {
      const whole = angles[1] - angles[0] >= 2 * Math.PI;
      const [from, to] = whole ? [0, 2 * Math.PI] : angles;
      context.beginPath();
      context.arc(cx, cy, radii[1] * this.#scale, -from, -to, true);
      context.arc(cx, cy, radii[0] * this.#scale, -to, -from, false);
      context.closePath();
      context.fillStyle = fill;
      context.fill();
    };
    sector(hard.x, hard.slew, colour("line"));
    sector(x, slew, colour("raised"));
    context.fillStyle = colour("muted");
    context.textAlign = "center";
    context.textBaseline = "middle";
    for (let degrees = -150; degrees <= 180; degrees += 30) {
      const angle = degrees * Math.PI / 180, radius = hard.x[1] * this.#scale;
      polyline(context, [[cx + radius * 0.98 * Math.cos(angle), cy - radius * 0.98 * Math.sin(angle)], [cx + radius * 1.02 * Math.cos(angle), cy - radius * 1.02 * Math.sin(angle)]], colour("muted"), 1);
      if (degrees % 90 === 0) context.fillText(degrees + "°", cx + radius * 0.88 * Math.cos(angle), cy - radius * 0.88 * Math.sin(angle) - 9);
    }
    for (let r = 0.5; r < hard.x[1]; r += 0.5) {
      context.beginPath();
      context.arc(cx, cy, r * this.#scale, 0, 2 * Math.PI);
      context.strokeStyle = colour("line");
      context.lineWidth = 1;
      context.stroke();
      context.fillText(r.toFixed(1) + " m", cx + 14, cy + r * this.#scale - 8);
    }
  }

  #gantryArea(context, colour, px) {
    const { x, hard } = this.limits;
    for (const [range, fill] of [[hard.x, "line"], [x, "raised"]]) {
      const [left] = px({ east: range[0], north: 0 }), [right] = px({ east: range[1], north: 0 });
      context.fillStyle = colour(fill);
      context.fillRect(left, this.#centre[1] - 40, right - left, 80);
    }
  }
}

function clamp(value, low, high) { return Math.min(high, Math.max(low, value)); }
