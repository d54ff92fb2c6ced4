// The scene: lights, table, toy, cameras, arrows and trace. It draws a moment of a track; it has no clock.

import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

import { Eye } from "./eye.js";
import {
  layShadow,
  makeRuler,
  makeShadow,
  makeTable,
  paintShadow,
  paintTable,
  SUN,
} from "./table.js";
import {
  cutTrace,
  makeArrow,
  makePatch,
  makeToy,
  makeTrace,
  pointArrow,
  traceMaterial,
} from "./toy.js";
import { blur, welded } from "./weld.js";

export const ARROWS = {
  axis: "#109b60",
  momentum: "#7b4fd0",
  slip: "#1c7ed6",
  friction: "#e03c31",
  torque: "#b7791f",
};

/** All that can be shown beside the top. */
export const SHOWN = [...Object.keys(ARROWS), "trace", "glass"];

// Columns of a track that arrows need which not every track has.
export const COLUMNS = { slip: "slipping", torque: "torque" };

// How the contact is shown by its mode: it slides, rolls (holds), or is of two surfaces.
export const MODES = {
  sliding: "#e8590c",
  sticking: "#2b8a3e",
  double: "#7b4fd0",
  stem: "#7b4fd0",
  other: "#7b4fd0",
};

// How long the longest arrow of a run is, in sizes of the top.
const LONGEST = { momentum: 2.6, slip: 1.6, friction: 1.6, torque: 2.6 };
// Arrows that begin within the body and are seen through it.
const SEEN_THROUGH = ["torque"];
// Slips below it, m/s, are rounding: what only rolls has no arrow.
const ROUNDING = 1e-9;

// How much of a ghost is seen, and where ghosts stand beside the top, in sizes of it.
const GHOST = 0.45;
const BESIDE = [
  [-1.9, -1.2],
  [1.9, 1.2],
  [-2.2, 2.6],
];

export class Scene {
  constructor(canvas) {
    const frugal = drawnInSoftware();
    this.frugal = frugal;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: !frugal, stencil: frugal });
    this.renderer.debug.checkShaderErrors = false;
    this.renderer.shadowMap.enabled = !frugal;
    this.renderer.shadowMap.type = THREE.PCFShadowMap;
    // Pixels drawn for each of the screen's: at first, in a moment that is looked at, at least, and now.
    this.usual = frugal ? 0.7 : Math.min(globalThis.devicePixelRatio || 1, 2);
    this.best = frugal ? 2 : this.usual;
    this.least = 0.5;
    this.quality = this.usual;
    this.world = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(38, 1, 0.05, 200);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = true;
    this.eye = new Eye(this.camera, this.controls);
    this.light();
    this.ink = traceMaterial();
    this.addArrows();
    const arrows = Object.keys(ARROWS).map((name) => [name, false]);
    this.shown = { ...Object.fromEntries(arrows), trace: true, glass: true };
    this.following = true;
    this.ghosts = [];
    this.patch = makePatch();
    this.world.add(this.patch);
    this.listen(canvas);
    this.eye.look("orbit");
  }

  addArrows() {
    this.arrows = {};
    for (const [name, colour] of Object.entries(ARROWS)) {
      const arrow = makeArrow(colour, SEEN_THROUGH.includes(name));
      arrow.visible = false;
      this.arrows[name] = arrow;
      this.world.add(arrow);
    }
  }

  // A swipe up or down and a wheel scroll the page; drags turn, and so do wheels once the scene was clicked.
  listen(canvas) {
    canvas.style.touchAction = "pan-y";
    const wheel = ({ ctrlKey }) => {
      this.controls.enableZoom = ctrlKey || document.activeElement === canvas;
    };
    const press = () => {
      this.controls.enableZoom = true;
    };
    canvas.addEventListener("wheel", wheel, { capture: true });
    canvas.addEventListener("pointerdown", press, { capture: true });
  }

  light() {
    this.sky = new THREE.HemisphereLight("#ffffff", "#c9b799", 1);
    this.sun = new THREE.DirectionalLight(SUN.colour, 2);
    this.sun.castShadow = !this.frugal;
    this.sun.shadow.mapSize.setScalar(1024);
    this.sun.shadow.radius = 5;
    this.sun.shadow.bias = -0.0006;
    this.sun.shadow.normalBias = 0.02;
    const box = { left: -3, right: 3, bottom: -3, top: 3, near: 1, far: 14 };
    Object.assign(this.sun.shadow.camera, box);
    this.world.add(this.sky, this.sun, this.sun.target);
  }

  setTheme(name) {
    this.themed = name;
    const theme = this.track?.header.scenes[name];
    this.theme = theme;
    if (!theme) return;
    this.world.background = new THREE.Color(theme.background);
    this.world.fog = new THREE.Fog(theme.background, 14, 34);
    this.sky.color.set(theme.sky);
    this.sky.groundColor.set(theme.ground);
    this.sky.intensity = theme.ambient;
    this.sun.intensity = theme.sun;
    if (this.table) paintTable(this.table, theme);
    if (this.shadow) paintShadow(this.shadow, theme);
    this.ink.color.set(theme.trace);
  }

  // Show another run.
  load(track) {
    this.track = track;
    const { body } = track.header;
    this.setTheme(this.themed);
    const shape = JSON.stringify(body);
    if (shape !== this.shape) {
      this.shape = shape;
      this.loadBody(body);
    }
    this.clearTrace();
    this.trace = makeTrace(track, body.size, this.ink);
    this.world.add(this.trace);
    const { momentum, slipping = [], friction, torque = [] } = track.columns;
    const slip = longestOf(slipping, 2);
    this.scales = {
      momentum: LONGEST.momentum / (longestOf(momentum, 3) || 1),
      slip: slip > ROUNDING ? LONGEST.slip / slip : 0,
      friction: LONGEST.friction / (longestOf(friction, 2) || 1),
      torque: LONGEST.torque / (longestOf(torque, 3) || 1),
    };
    this.show(this.shown);
  }

  // Show the toy of a body, on a table and beside a ruler of its size.
  loadBody(body) {
    this.remove(this.toy, this.table, this.ruler, this.shadow);
    this.toy = welded(makeToy(body.parts));
    const { metres, number, unit } = roundLength(body.size / 2);
    const cell = metres / body.size;
    this.cell = 5 * cell;
    this.table = makeTable(cell, this.theme, this.frugal);
    const label = (count) => (count === 10 ? `${number(count)} ${unit}` : number(count));
    this.ruler = makeRuler(cell, label, this.theme);
    this.ruler.position.x = 3 * cell;
    this.ruler.position.y = 1.9;
    this.square = `${number(1)} ${unit}`;
    this.world.add(this.toy, this.table, this.ruler);
    if (this.frugal) {
      this.shadow = makeShadow(this.toy);
      paintShadow(this.shadow, this.theme);
      this.world.add(this.shadow);
    }
  }

  scaleText(words) {
    return this.square ? `${words} ${this.square}` : "";
  }

  // Show other runs as ghosts of theirs, at the same time.
  compare(tracks) {
    this.remove(...this.ghosts.map(({ toy }) => toy));
    this.ghosts = tracks.map((track) => {
      const toy = welded(makeToy(track.header.body.parts, GHOST));
      this.world.add(toy);
      return { track, toy };
    });
  }

  remove(...things) {
    for (const thing of things) {
      if (!thing) continue;
      this.world.remove(thing);
      thing.traverse((object) => {
        object.geometry?.dispose();
        for (const material of [object.material ?? []].flat()) {
          material.map?.dispose();
          material.dispose();
        }
      });
    }
  }

  clearTrace() {
    if (!this.trace) return;
    this.world.remove(this.trace);
    this.trace.geometry.dispose();
  }

  show(shown) {
    Object.assign(this.shown, shown);
    if (this.trace) this.trace.visible = this.shown.trace;
    const glass = this.toy?.getObjectByName("glass");
    if (glass) glass.visible = this.shown.glass;
  }

  resize(width, height) {
    if (!width || !height) return;
    this.renderer.setPixelRatio(this.quality);
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.fov = width < height ? 50 : 38;
    this.camera.updateProjectionMatrix();
    this.extent = [width, height];
  }

  // Trade sharpness for speed.
  setQuality(quality, now = true) {
    this.quality = quality;
    this.resized = !now;
    if (now && this.extent) this.resize(...this.extent);
  }

  // Draw the track at a time, with its turns blurred that are looked at for so long, s.
  draw(time, sunk = 0, exposure = 0) {
    if (!this.track) return;
    if (this.resized && this.extent) this.resize(...this.extent);
    this.resized = false;
    const unit = this.track.header.body.size;
    blur(this.toy, exposure && this.track.turning(time).spin * exposure);
    const pose = this.track.at(time);
    const [x, y, z] = place(this.toy, pose, unit);
    this.ghosts.forEach(({ track, toy }, k) => {
      const then = Math.min(time, track.duration);
      blur(toy, exposure && track.turning(then).spin * exposure);
      const [, , up] = place(toy, track.at(then), unit, track);
      const away = BESIDE[k % BESIDE.length];
      toy.position.set(x + away[0], y + away[1], up);
    });
    if (this.shadow) layShadow(this.shadow, this.toy);
    this.sun.position.set(x, y, 0).add(SUN.place);
    this.sun.target.position.set(x, y, 0);
    if (this.following) this.follow(x, y);
    this.eye.sink(sunk);
    // The table reaches as far as one looks: it moves with the camera by whole squares.
    const { target } = this.controls;
    this.table.position.x = this.cell * Math.round(target.x / this.cell);
    this.table.position.y = this.cell * Math.round(target.y / this.cell);
    if (this.trace.visible) cutTrace(this.trace, time);
    this.point(pose, [x, y, z], time, unit);
    this.controls.update();
    this.eye.standBeside(this.track.table(time));
    this.eye.drawFrom(() => this.renderer.render(this.world, this.camera));
  }

  follow(x, y) {
    const { target } = this.controls;
    const dx = x - target.x;
    const dy = y - target.y;
    target.x += dx;
    target.y += dy;
    this.camera.position.x += dx;
    this.camera.position.y += dy;
  }

  point(pose, centre, time, unit) {
    const { track, scales } = this;
    this.placeArrow("axis", centre, pose.axis, 2.2);
    this.placeArrow("momentum", centre, pose.momentum, scales.momentum);
    const along = (name) => [0, 1].map((k) => track.value(name, time, k, 2));
    const foot = along("point").map((value) => value / unit);
    this.placeArrow("friction", [...foot, 0.05], [...along("friction"), 0], scales.friction);
    if (track.columns.slipping)
      this.placeArrow("slip", [...foot, 0.05], [...along("slipping"), 0], scales.slip);
    if (track.columns.torque) {
      const torque = [0, 1, 2].map((k) => track.value("torque", time, k, 3));
      this.placeArrow("torque", centre, torque, scales.torque);
    }
    const mode = track.mode(time);
    this.patch.visible = Boolean(mode) && mode !== "flight";
    this.patch.position.set(foot[0], foot[1], 0.006);
    this.patch.material.color.set(MODES[mode] ?? MODES.sliding);
  }

  placeArrow(name, from, vector, scale) {
    const arrow = this.arrows[name];
    const scaled = vector.map((component) => component * scale);
    if (this.shown[name]) pointArrow(arrow, from, scaled);
    else arrow.visible = false;
  }

  dispose() {
    this.remove(
      this.toy,
      this.table,
      this.ruler,
      this.shadow,
      this.patch,
      ...this.ghosts.map(({ toy }) => toy),
    );
    this.clearTrace();
    this.ink.dispose();
    this.controls.dispose();
    this.renderer.dispose();
    // A browser holds but some sixteen contexts, and frees one of a canvas that is gone when it likes.
    this.renderer.forceContextLoss();
  }
}

// Put a toy where a pose says, in units of the size of the one that is followed.
function place(toy, { position, orientation }, unit, ghost) {
  const centre = position.map((v) => v / unit);
  const [w, i, j, k] = orientation;
  toy.position.set(...centre);
  toy.quaternion.set(i, j, k, w);
  if (ghost) toy.scale.setScalar(ghost.header.body.size / unit);
  return centre;
}

// Whether this browser computes its pictures without graphics hardware, so that every pixel counts.
function drawnInSoftware() {
  const gl = document.createElement("canvas").getContext("webgl2");
  const info = gl?.getExtension("WEBGL_debug_renderer_info");
  const name = info ? String(gl.getParameter(info.UNMASKED_RENDERER_WEBGL)) : "";
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software/i.test(name);
}

// Length of the longest of the vectors in a column, of so many components.
function longestOf(column, width) {
  let longest = 0;
  for (let i = 0; i < column.length; i += width) {
    let square = 0;
    for (let k = i; k < i + width; k++) square += column[k] ** 2;
    longest = Math.max(longest, square);
  }
  return Math.sqrt(longest);
}

// The round length (1, 2 or 5 times a power of ten) nearest to one, m, with the unit and the numbers of its multiples.
function roundLength(length) {
  const power = 10 ** Math.floor(Math.log10(length));
  const distance = (one) => Math.abs(Math.log(one / length));
  const lengths = [1, 2, 5, 10].map((k) => k * power);
  const metres = lengths.reduce((a, b) => (distance(b) < distance(a) ? b : a));
  const { unit, size } = unitFor(metres);
  return { metres, unit, number: (count) => `${+((count * metres) / size).toPrecision(3)}` };
}

function unitFor(metres) {
  if (metres < 0.001) return { unit: "µm", size: 1e-6 };
  return metres < 0.5 ? { unit: "cm", size: 1e-2 } : { unit: "m", size: 1 };
}
