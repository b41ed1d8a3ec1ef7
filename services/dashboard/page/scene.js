// The crane in three dimensions. Draws only when something has changed.
import * as THREE from "/vendor/three/three.module.min.js";
import { loadInJibFrame, plannedPath } from "./geometry.js";

const TRAIL_POINTS = 400;

function colours() {
  const style = getComputedStyle(document.documentElement);
  return (name) => new THREE.Color(style.getPropertyValue("--" + name).trim());
}

export class Scene {
  #dirty = true;
  #orbit = { azimuth: 0.9, height: 0.42, distance: 4.4, target: new THREE.Vector3(0.15, 0.95, 0) };
  #view = { reach: 1.45, height: 2, kind: "tower" };
  #trail = [];
  frames = 0;

  constructor(canvas) {
    this.canvas = canvas;
    // Without a graphics processor every pixel costs the processor that may also run the crane.
    this.software = drawsInSoftware();
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: !this.software, powerPreference: "low-power" });
    this.camera = new THREE.PerspectiveCamera(38, 1, 0.05, 60);
    this.scene = new THREE.Scene();
    this.#paint();
    this.#handle();
    new ResizeObserver(() => this.#resize()).observe(canvas);
    this.#resize();
    let due_ms = 0;
    const loop = (now_ms) => {
      if (this.#dirty && canvas.offsetParent !== null && now_ms >= due_ms) {
        this.#draw();
        if (this.software) due_ms = now_ms + 2 * this.#cost_ms();
      }
      requestAnimationFrame(loop);
    };
    requestAnimationFrame(loop);
  }

  /** Builds everything in the colours of the theme. */
  #paint() {
    const colour = colours();
    this.scene.clear();
    this.scene.background = colour("ground");
    this.scene.fog = new THREE.Fog(colour("ground"), 4.2 * this.#view.reach, 11 * this.#view.reach);
    this.scene.add(new THREE.HemisphereLight(0xffffff, colour("line"), 2.1));
    const sun = new THREE.DirectionalLight(0xffffff, 1.6);
    sun.position.set(3, 6, 2);
    this.scene.add(sun);
    const { reach, height } = this.#view;
    const grid = new THREE.PolarGridHelper(reach, 12, 5, 96, colour("line"), colour("line"));
    const floor = new THREE.Mesh(new THREE.CircleGeometry(reach * 14, 64), new THREE.MeshBasicMaterial({ color: colour("panel") }));
    floor.rotation.x = -Math.PI / 2;
    floor.position.y = -0.004;
    this.scene.add(floor);
    if (this.#view.kind === "gantry") {
      const squares = new THREE.GridHelper(reach * 4, 16, colour("line"), colour("line"));
      this.scene.add(squares);
    } else this.scene.add(grid);

    const steel = new THREE.MeshLambertMaterial({ color: colour("crane") });
    const dark = new THREE.MeshLambertMaterial({ color: colour("muted") });
    this.jib = new THREE.Group();
    this.scene.add(this.jib);
    if (this.#view.kind === "gantry") this.#buildGantry(steel, reach, height);
    else this.#buildTower(steel, dark, reach, height);
    this.trolley = box(0.11, 0.05, 0.12, dark);
    this.jib.add(this.trolley);
    this.cable = line(2, colour("ink"));
    this.load = box(0.13, 0.13, 0.13, new THREE.MeshLambertMaterial({ color: colour("measured") }));
    this.shadow = disc(0.1, new THREE.MeshBasicMaterial({ color: 0x000000, transparent: true, opacity: 0.45 }));
    this.plumb = line(2, colour("muted"), true, 0.5);
    const ghost = new THREE.MeshBasicMaterial({ color: colour("target"), transparent: true, opacity: 0.35, depthWrite: false });
    this.ghost = box(0.135, 0.135, 0.135, ghost);
    this.ghost.add(new THREE.LineSegments(new THREE.EdgesGeometry(this.ghost.geometry), new THREE.LineBasicMaterial({ color: colour("target") })));
    this.ghostShadow = ring(0.1, new THREE.MeshBasicMaterial({ color: colour("target") }));
    this.path = line(64, colour("target"), true);
    this.trailLine = line(TRAIL_POINTS, colour("measured"), false, 0.7);
    this.scene.add(this.cable, this.load, this.shadow, this.plumb, this.ghost, this.ghostShadow, this.path, this.trailLine);
    this.#dirty = true;
  }

  #buildTower(steel, dark, reach, height) {
    const mast = truss(height + 0.28, 0.16, steel);
    mast.rotation.z = Math.PI / 2;
    this.scene.add(mast);
    const foot = box(0.62, 0.07, 0.62, dark);
    foot.position.y = 0.035;
    this.scene.add(foot);
    const arm = truss(reach + 0.12, 0.1, steel);
    arm.position.y = height + 0.06;
    const counter = truss(0.62, 0.1, steel);
    counter.rotation.y = Math.PI;
    counter.position.y = height + 0.06;
    const weight = box(0.2, 0.2, 0.18, dark);
    weight.position.set(-0.55, height - 0.02, 0);
    const cab = box(0.16, 0.17, 0.16, dark);
    cab.position.set(0.12, height - 0.1, 0.13);
    const stay = line(3, steel.color);
    place(stay, [[-0.55, height + 0.1, 0], [0, height + 0.34, 0], [reach * 0.75, height + 0.1, 0]]);
    this.jib.add(arm, counter, weight, cab, stay);
  }

  #buildGantry(steel, reach, height) {
    const beam = truss(reach + 0.2, 0.1, steel);
    beam.position.set(-0.1, height + 0.06, 0);
    this.jib.add(beam);
    for (const x of [-0.1, reach + 0.1])
      for (const z of [-0.4, 0.4]) {
        const leg = box(0.05, height + 0.1, 0.05, steel);
        leg.position.set(x, height / 2, z * 0.6);
        leg.rotation.x = z * 0.35;
        this.jib.add(leg);
      }
  }

  /** @param view {reach (m), height (m), kind} */
  configure(view) {
    if (JSON.stringify(view) === JSON.stringify(this.#view)) return;
    this.#view = view;
    this.#orbit.distance = 3 * view.reach;
    this.#orbit.target.set(view.kind === "gantry" ? view.reach / 2 : 0.12 * view.reach, view.height * 0.5, 0);
    this.#paint();
  }
  repaint() { this.#paint(); }

  /** @param pose {x, slew, cable, radial, tangential} @param target likewise or null @param rig or null */
  show(pose, target, rig) {
    const at = this.#world(pose), { height } = this.#view;
    this.jib.rotation.y = pose.slew;
    this.trolley.position.set(pose.x, height - 0.02, 0);
    const hook = this.#world({ ...pose, cable: 0 });
    place(this.cable, [hook, at]);
    this.load.position.set(at[0], Math.max(0.065, at[1]), at[2]);
    this.load.rotation.y = pose.slew;
    this.shadow.position.set(at[0], 0.004, at[2]);
    this.shadow.scale.setScalar(1 + Math.max(0, at[1]) * 0.25);
    place(this.plumb, [at, [at[0], 0.004, at[2]]]);
    this.#trail.push(at);
    if (this.#trail.length > TRAIL_POINTS) this.#trail.shift();
    place(this.trailLine, this.#trail);
    for (const part of [this.ghost, this.ghostShadow, this.path]) part.visible = target !== null;
    if (target) {
      const there = this.#world(target);
      this.ghost.position.set(...there);
      this.ghost.rotation.y = target.slew;
      this.ghostShadow.position.set(there[0], 0.006, there[2]);
      const key = JSON.stringify(target);
      if (key !== this.pathKey) {
        place(this.path, plannedPath({ ...pose, radial: 0, tangential: 0 }, target, rig).map((step) => this.#world(step)));
        this.path.computeLineDistances();
      }
      this.pathKey = key;
    } else this.pathKey = null;
    this.#dirty = true;
  }

  #world(pose) {
    const { along, ahead, up } = loadInJibFrame(pose);
    const cos = Math.cos(pose.slew), sin = Math.sin(pose.slew);
    return [along * cos - ahead * sin, this.#view.height + up, -(along * sin + ahead * cos)];
  }

  /** Time that the last picture took. Drawn in software, pictures take at most a third of the time: the rest is the page's. */
  #cost_ms() {
    const begin_ms = performance.now(), gl = this.renderer.getContext();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4)); // waits until the picture is done
    return performance.now() - begin_ms;
  }

  lookFrom(where) {
    Object.assign(this.#orbit, where === "top" ? { azimuth: -Math.PI / 2, height: 1.55 } : { azimuth: 0.9, height: 0.42 });
    this.#dirty = true;
  }

  #handle() {
    const pointers = new Map();
    let pinch = 0;
    this.canvas.addEventListener("pointerdown", (event) => { pointers.set(event.pointerId, event); this.canvas.setPointerCapture(event.pointerId); });
    const end = (event) => { pointers.delete(event.pointerId); pinch = 0; };
    this.canvas.addEventListener("pointerup", end);
    this.canvas.addEventListener("pointercancel", end);
    this.canvas.addEventListener("pointermove", (event) => {
      const before = pointers.get(event.pointerId);
      if (!before) return;
      pointers.set(event.pointerId, event);
      if (pointers.size === 2) {
        const [a, b] = [...pointers.values()];
        const spread = Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY);
        if (pinch > 0) this.#zoom(pinch / spread);
        pinch = spread;
      } else {
        this.#orbit.azimuth -= (event.clientX - before.clientX) * 0.006;
        this.#orbit.height = Math.min(1.55, Math.max(-0.05, this.#orbit.height + (event.clientY - before.clientY) * 0.005));
      }
      this.#dirty = true;
    });
    this.canvas.addEventListener("wheel", (event) => { event.preventDefault(); this.#zoom(Math.exp(event.deltaY * 0.001)); }, { passive: false });
  }
  #zoom(factor) {
    this.#orbit.distance = Math.min(14, Math.max(1.2, this.#orbit.distance * factor));
    this.#dirty = true;
  }

  #resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!width || !height) return;
    this.renderer.setPixelRatio(this.software ? 0.75 : Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.#dirty = true;
  }

  #draw() {
    this.#dirty = false;
    ++this.frames;
    const { azimuth, height, distance, target } = this.#orbit;
    const far = distance * Math.max(1, 1.25 / this.camera.aspect);
    this.camera.position.set(target.x + far * Math.cos(height) * Math.cos(azimuth), target.y + far * Math.sin(height), target.z + far * Math.cos(height) * Math.sin(azimuth));
    this.camera.lookAt(target);
    this.renderer.render(this.scene, this.camera);
  }
}

function drawsInSoftware() {
  const context = document.createElement("canvas").getContext("webgl");
  const named = context?.getExtension("WEBGL_debug_renderer_info");
  const renderer = named ? context.getParameter(named.UNMASKED_RENDERER_WEBGL) : "";
  context?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software/i.test(renderer);
}

function box(width, height, depth, material) { return new THREE.Mesh(new THREE.BoxGeometry(width, height, depth), material); }
function disc(radius, material) {
  const mesh = new THREE.Mesh(new THREE.CircleGeometry(radius, 32), material);
  mesh.rotation.x = -Math.PI / 2;
  return mesh;
}
function ring(radius, material) {
  const mesh = new THREE.Mesh(new THREE.RingGeometry(radius * 0.82, radius, 40), material);
  mesh.rotation.x = -Math.PI / 2;
  return mesh;
}
function line(points, color, dashed = false, opacity = 1) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(points * 3), 3));
  const settings = { color, transparent: opacity < 1, opacity };
  const drawn = new THREE.Line(geometry, dashed ? new THREE.LineDashedMaterial({ ...settings, dashSize: 0.05, gapSize: 0.035 }) : new THREE.LineBasicMaterial(settings));
  drawn.frustumCulled = false;
  return drawn;
}
function place(drawn, points) {
  const attribute = drawn.geometry.getAttribute("position");
  const shown = Math.min(points.length, attribute.count);
  for (let i = 0; i < shown; ++i) attribute.setXYZ(i, ...points[i]);
  attribute.needsUpdate = true;
  drawn.geometry.setDrawRange(0, shown);
  if (drawn.material.isLineDashedMaterial) drawn.computeLineDistances();
}
/** Lattice girder along +x: chords and diagonals as one mesh. */
function truss(length, width, material) {
  const group = new THREE.Group(), half = width / 2, bays = Math.max(2, Math.round(length / (width * 1.4)));
  const bars = [];
  for (const [y, z] of [[half, half], [half, -half], [-half, half], [-half, -half]]) bars.push([[0, y, z], [length, y, z]]);
  for (let i = 0; i < bays; ++i) {
    const a = length * i / bays, b = length * (i + 1) / bays, up = i % 2 ? half : -half;
    for (const z of [half, -half]) bars.push([[a, -up, z], [b, up, z]]);
    bars.push([[a, half, up], [b, half, -up]], [[b, -half, half], [b, -half, -half]]);
  }
  const mesh = new THREE.InstancedMesh(new THREE.BoxGeometry(1, 1, 1), material, bars.length);
  const matrix = new THREE.Matrix4(), along = new THREE.Vector3(1, 0, 0), turn = new THREE.Quaternion();
  bars.forEach(([from, to], i) => {
    const a = new THREE.Vector3(...from), b = new THREE.Vector3(...to), way = b.clone().sub(a), thick = i < 4 ? 0.016 : 0.009;
    turn.setFromUnitVectors(along, way.clone().normalize());
    mesh.setMatrixAt(i, matrix.compose(a.add(b).multiplyScalar(0.5), turn, new THREE.Vector3(way.length(), thick, thick)));
  });
  mesh.frustumCulled = false;
  group.add(mesh);
  return group;
}
