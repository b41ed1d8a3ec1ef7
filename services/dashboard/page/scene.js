// The crane in three dimensions: first as lines, then with light and surfaces if the computer has a graphics processor. Without one,
// drawing surfaces would load the processor that may also run the crane.
import { Orbit } from "./orbit.js";
import { WireScene } from "./wire_scene.js";

const WAIT_FOR_PROCESSOR_MS = 1500; // the page is complete by then

export class Scene {
  #drawn;
  #dirty = true;
  #last = null; // [pose, target, rig]
  #view = { reach: 1.45, height: 2, kind: "tower" };
  #orbit = new Orbit(() => { this.#dirty = true; });
  frames = 0;

  constructor(canvas) {
    this.canvas = canvas;
    this.#drawn = new WireScene(canvas, this.#orbit, this.#view);
    this.#orbit.handle(canvas);
    new ResizeObserver(() => { this.#dirty = true; }).observe(canvas.parentElement);
    const loop = () => {
      if (this.#dirty && this.canvas.offsetParent !== null) {
        this.#dirty = false;
        ++this.frames;
        this.#drawn.draw();
      }
      requestAnimationFrame(loop);
    };
    requestAnimationFrame(loop);
    setTimeout(() => { if (hasGraphicsProcessor()) this.#drawSolid(); }, WAIT_FOR_PROCESSOR_MS);
  }

  /** A canvas has one kind of context for ever: the solid picture gets one of its own. */
  async #drawSolid() {
    const { SolidScene } = await import("./solid_scene.js");
    const canvas = this.canvas.cloneNode();
    const solid = new SolidScene(canvas, this.#orbit, this.#view);
    this.canvas.replaceWith(canvas);
    this.canvas = canvas;
    this.#orbit.handle(canvas);
    this.#drawn = solid;
    if (this.#last) solid.show(...this.#last);
    this.#dirty = true;
  }

  /** @param view {reach (m), height (m), kind} */
  configure(view) {
    if (JSON.stringify(view) === JSON.stringify(this.#view)) return;
    this.#view = view;
    this.#orbit.configure(view);
    this.#drawn.build(view);
  }

  repaint() {
    this.#drawn.build(this.#view);
    this.#dirty = true;
  }

  /** @param pose {x, slew, cable, radial, tangential} @param target likewise or null @param rig or null */
  show(pose, target, rig) {
    this.#last = [pose, target, rig];
    this.#drawn.show(pose, target, rig);
    this.#dirty = true;
  }

  lookFrom(where) { this.#orbit.lookFrom(where); }
}

function hasGraphicsProcessor() {
  const context = document.createElement("canvas").getContext("webgl", { failIfMajorPerformanceCaveat: true });
  if (!context) return false;
  const named = context.getExtension("WEBGL_debug_renderer_info");
  const renderer = named ? context.getParameter(named.UNMASKED_RENDERER_WEBGL) : "";
  context.getExtension("WEBGL_lose_context")?.loseContext();
  return !/swiftshader|llvmpipe|software/i.test(renderer);
}
