// Swing of the load, seen from above: radial outwards along the jib, tangential ahead in the direction of +slew.
import { begin, polyline } from "./drawing.js";

const DEGREES = 180 / Math.PI;

export class SwingPlot {
  trail = []; // {radial, tangential} in rad, oldest first

  constructor(canvas) { this.canvas = canvas; }

  draw(limit_rad) {
    const frame = begin(this.canvas);
    if (!frame) return;
    const { context, width, height, colour } = frame;
    const cx = width / 2, cy = height / 2, radius = Math.min(width / 2 - 84, height / 2 - 22);
    const largest = this.trail.reduce((most, s) => Math.max(most, Math.hypot(s.radial, s.tangential)), 0) * DEGREES;
    const full = [2, 5, 10, 20, 40, 90].find((degrees) => degrees >= largest * 1.1) ?? 90;
    const px = radius / full;
    context.textBaseline = "middle";
    context.fillStyle = colour("muted");
    for (const share of [0.5, 1]) {
      context.beginPath();
      context.arc(cx, cy, radius * share, 0, 2 * Math.PI);
      context.strokeStyle = colour("line");
      context.lineWidth = 1;
      context.stroke();
      context.textAlign = "left";
      context.fillText(full * share + "°", cx + radius * share * 0.71 + 4, cy + radius * share * 0.71 + 4);
    }
    polyline(context, [[cx - radius, cy], [cx + radius, cy]], colour("line"), 1);
    polyline(context, [[cx, cy - radius], [cx, cy + radius]], colour("line"), 1);
    context.textAlign = "center";
    context.fillText("ahead", cx, cy - radius - 11);
    context.fillText("behind", cx, cy + radius + 12);
    context.textAlign = "left";
    context.fillText("outwards", cx + radius + 6, cy);
    context.textAlign = "right";
    context.fillText("to the tower", cx - radius - 6, cy);
    if (limit_rad * DEGREES < full) {
      context.beginPath();
      context.arc(cx, cy, limit_rad * DEGREES * px, 0, 2 * Math.PI);
      context.strokeStyle = colour("stop");
      context.setLineDash([4, 4]);
      context.stroke();
      context.setLineDash([]);
    }
    const at = (s) => [cx - s.radial * DEGREES * px, cy - s.tangential * DEGREES * px];
    polyline(context, this.trail.map(at), colour("measured"), 1.5);
    const now = this.trail.at(-1);
    if (!now) return;
    context.fillStyle = colour("measured");
    context.beginPath();
    context.arc(...at(now), 6, 0, 2 * Math.PI);
    context.fill();
    context.textAlign = "left";
    context.textBaseline = "top";
    context.fillStyle = colour("ink");
    context.font = "600 15px Plex, sans-serif";
    context.fillText((Math.hypot(now.radial, now.tangential) * DEGREES).toFixed(1) + "°", 2, 2);
  }
}
