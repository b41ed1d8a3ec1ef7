// The viewpoint of the crane: turned by dragging, brought nearer by the wheel or two fingers.
export const FIELD_OF_VIEW_DEG = 38;

export class Orbit {
  azimuth = 0.9;
  height = 0.42;
  distance = 4.4;
  target = [0.15, 0.95, 0];

  /** @param changed  called when the viewpoint has moved */
  constructor(changed) { this.changed = changed; }

  configure({ reach, height, kind }) {
    this.distance = 3 * reach;
    this.target = [kind === "gantry" ? reach / 2 : 0.12 * reach, height * 0.5, 0];
    this.changed();
  }

  lookFrom(where) {
    Object.assign(this, where === "top" ? { azimuth: -Math.PI / 2, height: 1.55 } : { azimuth: 0.9, height: 0.42 });
    this.changed();
  }

  /** @param aspect  width through height of the picture; a narrow one is seen from farther away */
  eye(aspect) {
    const far = this.distance * Math.max(1, 1.25 / aspect), flat = far * Math.cos(this.height);
    return [this.target[0] + flat * Math.cos(this.azimuth), this.target[1] + far * Math.sin(this.height), this.target[2] + flat * Math.sin(this.azimuth)];
  }

  handle(canvas) {
    const pointers = new Map();
    let pinch = 0;
    canvas.addEventListener("pointerdown", (event) => { pointers.set(event.pointerId, event); canvas.setPointerCapture(event.pointerId); });
    const end = (event) => { pointers.delete(event.pointerId); pinch = 0; };
    canvas.addEventListener("pointerup", end);
    canvas.addEventListener("pointercancel", end);
    canvas.addEventListener("pointermove", (event) => {
      const before = pointers.get(event.pointerId);
      if (!before) return;
      pointers.set(event.pointerId, event);
      if (pointers.size === 2) {
        const [a, b] = [...pointers.values()];
        const spread = Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY);
        if (pinch > 0) this.#zoom(pinch / spread);
        pinch = spread;
      } else {
        this.azimuth -= (event.clientX - before.clientX) * 0.006;
        this.height = Math.min(1.55, Math.max(-0.05, this.height + (event.clientY - before.clientY) * 0.005));
      }
      this.changed();
    });
    canvas.addEventListener("wheel", (event) => { event.preventDefault(); this.#zoom(Math.exp(event.deltaY * 0.001)); }, { passive: false });
  }
  #zoom(factor) {
    this.distance = Math.min(14, Math.max(1.2, this.distance * factor));
    this.changed();
  }
}
