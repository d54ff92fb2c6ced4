// The scene: lights, table, toy, cameras, arrows and trace. It draws a moment of a track; it has no clock.

import { cutTrace, makeArrow, makeRuler, makeTable, makeToy, makeTrace, paintGrid, pointArrow, traceMaterial } from "./toy.js";

export const ARROWS = { axis: "#109b60", momentum: "#7b4fd0", friction: "#e03c31" };

const VIEWS = { orbit: [3.6, -5.6, 3.1], side: [0, -6.6, 0.7], above: [0, -0.05, 7.5] };

export class Scene {
  constructor({ THREE, OrbitControls }, canvas) {
    this.THREE = THREE;
    const frugal = drawnInSoftware();
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: !frugal });
    this.renderer.debug.checkShaderErrors = false;
    this.renderer.shadowMap.enabled = true;
    this.quality = frugal ? 0.7 : Math.min(globalThis.devicePixelRatio || 1, 2);
    this.best = Math.max(this.quality, 1);
    this.least = frugal ? 0.35 : 0.5;
    this.renderer.shadowMap.type = this.quality < 0.8 ? THREE.BasicShadowMap : THREE.PCFSoftShadowMap;
    this.world = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(38, 1, 0.05, 200);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = true;
    this.controls.maxPolarAngle = 1.53;
    this.controls.minDistance = 2;
    this.controls.maxDistance = 30;
    this.light();
    this.ink = traceMaterial(THREE);
    this.arrows = {};
    for (const [name, colour] of Object.entries(ARROWS)) {
      this.arrows[name] = makeArrow(THREE, colour);
      this.arrows[name].visible = false;
      this.world.add(this.arrows[name]);
    }
    this.shown = { axis: false, momentum: false, friction: false, trace: true, glass: true };
    this.following = true;
    this.look("orbit");
  }

  light() {
    const { THREE } = this;
    this.sky = new THREE.HemisphereLight("#ffffff", "#c9b799", 1);
    this.sun = new THREE.DirectionalLight("#fff4e0", 2);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.setScalar(this.quality < 0.8 ? 512 : 1024);
    this.sun.shadow.radius = 5;
    this.sun.shadow.bias = -0.0006;
    this.sun.shadow.normalBias = 0.02;
    const box = this.sun.shadow.camera;
    [box.left, box.right, box.bottom, box.top, box.near, box.far] = [-3, 3, -3, 3, 1, 14];
    this.world.add(this.sky, this.sun, this.sun.target);
  }

  setTheme(name) {
    const { THREE } = this;
    this.themed = name;
    const theme = (this.theme = this.track?.header.scenes[name]);
    if (!theme) return;
    this.world.background = new THREE.Color(theme.background);
    this.world.fog = new THREE.Fog(theme.background, 14, 34);
    this.sky.color.set(theme.sky);
    this.sky.groundColor.set(theme.ground);
    this.sky.intensity = theme.ambient;
    this.sun.intensity = theme.sun;
    if (this.table) {
      paintGrid(this.table.userData.canvas, theme);
      this.table.material.map.needsUpdate = true;
    }
    this.ink.color.set(theme.trace);
  }

  // Show another run.
  load(track) {
    this.track = track;
    const { THREE, world } = this;
    const { body } = track.header;
    this.setTheme(this.themed);
    const shape = JSON.stringify(body);
    if (shape !== this.shape) {
      this.shape = shape;
      this.remove(this.toy, this.table, this.ruler);
      this.toy = makeToy(THREE, body.parts);
      const { metres, label } = roundLength(body.size / 2);
      const cell = metres / body.size;
      this.cell = 5 * cell;
      this.table = makeTable(THREE, cell, this.theme);
      this.ruler = makeRuler(THREE, cell, label, this.theme);
      this.ruler.position.x = 3 * cell;
      this.ruler.position.y = 1.9;
      this.scaleText = `squares of ${label(1)} ${label(10).split(" ")[1]}`;
      world.add(this.toy, this.table, this.ruler);
    }
    this.clearTrace();
    this.trace = makeTrace(THREE, track, body.size, this.ink);
    world.add(this.trace);
    const pull = track.columns.friction;
    let strongest = 0;
    for (let i = 0; i < pull.length; i += 2) strongest = Math.max(strongest, Math.hypot(pull[i], pull[i + 1]));
    const L = track.columns.momentum;
    let largest = 0;
    for (let i = 0; i < L.length; i += 3) largest = Math.max(largest, Math.hypot(L[i], L[i + 1], L[i + 2]));
    this.scales = { momentum: 2.6 / (largest || 1), friction: 1.6 / (strongest || 1) };
    this.show(this.shown);
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

  // Put the camera at one of the `VIEWS`.
  look(name) {
    const centre = this.controls.target;
    const [x, y, z] = VIEWS[name];
    if (name === "orbit" || centre.lengthSq() === 0) centre.z = 1.05;
    this.camera.position.set(centre.x + x, centre.y + y, centre.z + z);
    this.controls.update();
  }

  turn(across, up) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const ball = new this.THREE.Spherical().setFromVector3(new this.THREE.Vector3(offset.x, offset.z, -offset.y));
    ball.theta += across;
    ball.phi = Math.min(Math.max(ball.phi - up, 0.02), 1.53);
    const moved = new this.THREE.Vector3().setFromSpherical(ball);
    this.camera.position.set(moved.x, -moved.z, moved.y).add(this.controls.target);
    this.controls.update();
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

  // Trade sharpness for speed: below one pixel per pixel the shadows' edges go, too.
  setQuality(quality, now = true) {
    this.quality = quality;
    this.renderer.shadowMap.type = quality < 0.8 ? this.THREE.BasicShadowMap : this.THREE.PCFSoftShadowMap;
    this.resized = !now;
    if (now && this.extent) this.resize(...this.extent);
  }

  // Draw the track at a time.
  draw(time) {
    if (!this.track) return;
    if (this.resized && this.extent) this.resize(...this.extent);
    this.resized = false;
    const unit = this.track.header.body.size;
    const pose = this.track.at(time);
    const [x, y, z] = pose.position.map((v) => v / unit);
    const [w, i, j, k] = pose.orientation;
    this.toy.position.set(x, y, z);
    this.toy.quaternion.set(i, j, k, w);
    this.sun.position.set(x - 2.2, y - 4.2, 7);
    this.sun.target.position.set(x, y, 0);
    if (this.following) this.follow(x, y);
    // The table reaches as far as one looks: it moves with the camera by whole squares.
    const { target } = this.controls;
    this.table.position.x = this.cell * Math.round(target.x / this.cell);
    this.table.position.y = this.cell * Math.round(target.y / this.cell);
    if (this.trace.visible) cutTrace(this.trace, time);
    this.point(pose, [x, y, z], time, unit);
    this.controls.update();
    this.renderer.render(this.world, this.camera);
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
    const { arrows, shown, track, scales, THREE } = this;
    const place = (name, from, vector) => {
      if (shown[name]) pointArrow(THREE, arrows[name], from, vector);
      else arrows[name].visible = false;
    };
    place("axis", centre, pose.axis.map((v) => 2.2 * v));
    place("momentum", centre, pose.momentum.map((v) => v * scales.momentum));
    const [fx, fy] = [0, 1].map((k) => track.value("friction", time, k, 2) * scales.friction);
    const foot = [0, 1].map((k) => track.value("point", time, k, 2) / unit);
    place("friction", [foot[0], foot[1], 0.05], [fx, fy, 0]);
  }

  dispose() {
    this.remove(this.toy, this.table, this.ruler);
    this.clearTrace();
    this.ink.dispose();
    this.controls.dispose();
    this.renderer.dispose();
    // A browser holds but some sixteen contexts, and frees one of a canvas that is gone when it likes.
    this.renderer.forceContextLoss();
  }
}

// Whether this browser computes its pictures without graphics hardware, so that every pixel counts.
function drawnInSoftware() {
  const gl = document.createElement("canvas").getContext("webgl2");
  const info = gl?.getExtension("WEBGL_debug_renderer_info");
  const name = info ? String(gl.getParameter(info.UNMASKED_RENDERER_WEBGL)) : "";
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software/i.test(name);
}

// The round length (1, 2 or 5 times a power of ten) nearest to one, m, and how to number its multiples.
function roundLength(length) {
  const power = 10 ** Math.floor(Math.log10(length));
  const metres = [1, 2, 5, 10].map((k) => k * power).reduce((a, b) =>
    Math.abs(Math.log(b / length)) < Math.abs(Math.log(a / length)) ? b : a,
  );
  const [factor, name] = metres < 0.001 ? [1e6, "µm"] : metres < 0.5 ? [100, "cm"] : [1, "m"];
  return {
    metres,
    label: (count) => `${+(count * metres * factor).toPrecision(3)}${count === 10 ? " " + name : ""}`,
  };
}
