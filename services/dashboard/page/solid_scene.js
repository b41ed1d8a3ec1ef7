// The crane with light and surfaces, for computers with a graphics processor.
import * as THREE from "/vendor/three/three.module.min.js";
import { loadInJibFrame, plannedPath } from "./geometry.js";
import { FIELD_OF_VIEW_DEG } from "./orbit.js";

const TRAIL_POINTS = 400;

function colours() {
  const style = getComputedStyle(document.documentElement);
  return (name) => new THREE.Color(style.getPropertyValue("--" + name).trim());
}

export class SolidScene {
  #trail = [];

  constructor(canvas, orbit, view) {
    this.canvas = canvas;
    this.orbit = orbit;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, powerPreference: "low-power" });
    this.camera = new THREE.PerspectiveCamera(FIELD_OF_VIEW_DEG, 1, 0.05, 60);
    this.scene = new THREE.Scene();
    this.build(view);
  }

  /** Builds everything in the colours of the theme. */
  build(view) {
    this.view = view;
    const colour = colours();
    this.scene.clear();
    this.scene.background = colour("ground");
    this.scene.fog = new THREE.Fog(colour("ground"), 4.2 * this.view.reach, 11 * this.view.reach);
    this.scene.add(new THREE.HemisphereLight(0xffffff, colour("line"), 2.1));
    const sun = new THREE.DirectionalLight(0xffffff, 1.6);
    sun.position.set(3, 6, 2);
    this.scene.add(sun);
    const { reach, height } = this.view;
    const grid = new THREE.PolarGridHelper(reach, 12, 5, 96, colour("line"), colour("line"));
    const floor = new THREE.Mesh(new THREE.CircleGeometry(reach * 14, 64), new THREE.MeshBasicMaterial({ color: colour("panel") }));
    floor.rotation.x = -Math.PI / 2;
    floor.position.y = -0.004;
    this.scene.add(floor);
    if (this.view.kind === "gantry") {
      const squares = new THREE.GridHelper(reach * 4, 16, colour("line"), colour("line"));
      this.scene.add(squares);
    } else this.scene.add(grid);

    const steel = new THREE.MeshLambertMaterial({ color: colour("crane") });
    const dark = new THREE.MeshLambertMaterial({ color: colour("muted") });
    this.jib = new THREE.Group();
    this.scene.add(this.jib);
    if (this.view.kind === "gantry") this.#buildGantry(steel, reach, height);
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

  /** @param pose {x, slew, cable, radial, tangential} @param target likewise or null @param rig or null */
  show(pose, target, rig) {
    const at = this.#world(pose), { height } = this.view;
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
  }

  #world(pose) {
    const { along, ahead, up } = loadInJibFrame(pose);
    const cos = Math.cos(pose.slew), sin = Math.sin(pose.slew);
    return [along * cos - ahead * sin, this.view.height + up, -(along * sin + ahead * cos)];
  }

  draw() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!width || !height) return;
    const ratio = Math.min(window.devicePixelRatio, 2);
    if (this.canvas.width !== Math.floor(width * ratio) || this.canvas.height !== Math.floor(height * ratio)) {
      this.renderer.setPixelRatio(ratio);
      this.renderer.setSize(width, height, false);
      this.camera.aspect = width / height;
      this.camera.updateProjectionMatrix();
    }
    this.camera.position.set(...this.orbit.eye(width / height));
    this.camera.lookAt(...this.orbit.target);
    this.renderer.render(this.scene, this.camera);
  }
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
