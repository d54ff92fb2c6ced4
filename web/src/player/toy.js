// What stands in the scene, made of three.js objects: the toy, its table with a ruler, arrows, the trace.

import * as THREE from "three";

const SEGMENTS = 48;

// The toy of parts turned on a lathe, in sizes of the toy, each with equal sectors in its colours;
// of a ghost, of which but a share is seen, without what is of glass.
export function makeToy(parts, seen = 1) {
  const toy = new THREE.Group();
  for (const part of parts) {
    const isGlass = part.opacity < 1;
    if (isGlass && seen < 1) continue;
    toy.add(makePart(part, part.opacity * seen));
  }
  return toy;
}

function makePart({ name, profile, colours }, opacity) {
  const part = new THREE.Group();
  part.name = name;
  const points = profile.map(([r, z]) => new THREE.Vector2(r, z));
  const angle = (2 * Math.PI) / colours.length;
  const steps = Math.max(1, Math.round(SEGMENTS / colours.length));
  colours.forEach((colour, k) => {
    // three.js turns profiles about y, from z towards x.
    const start = k * angle + Math.PI / 2;
    const geometry = new THREE.LatheGeometry(points, steps, start, angle).rotateX(Math.PI / 2);
    const sector = makeSector(geometry, colour, opacity);
    sector.sector = { colours, number: k };
    part.add(sector);
  });
  return part;
}

function makeSector(geometry, color, opacity) {
  const isClear = opacity < 1;
  const material = new THREE.MeshStandardMaterial({
    color,
    opacity,
    transparent: isClear,
    depthWrite: !isClear,
    roughness: isClear ? 0.08 : 0.42,
    metalness: 0,
  });
  const mesh = new THREE.Mesh(geometry, material);
  mesh.castShadow = !isClear;
  mesh.receiveShadow = !isClear;
  mesh.renderOrder = isClear ? 2 : 0;
  return mesh;
}

// Where the top touches the table, as a ring around it.
export function makePatch() {
  const material = new THREE.MeshBasicMaterial({ transparent: true, opacity: 0.85 });
  const patch = new THREE.Mesh(new THREE.RingGeometry(0.07, 0.13, 32), material);
  patch.visible = false;
  return patch;
}

// An arrow from the origin along z, to be turned and stretched by `pointArrow`.
// Later than anything that is drawn without it.
const ABOVE_ALL = 10;

export function makeArrow(colour, isSeenThrough = false) {
  const material = new THREE.MeshStandardMaterial({
    depthTest: !isSeenThrough,
    transparent: isSeenThrough,
    color: colour,
    emissive: colour,
    emissiveIntensity: 0.35,
  });
  const arrow = new THREE.Group();
  const shaft = new THREE.Mesh(new THREE.CylinderGeometry(0.035, 0.035, 1, 12), material);
  const head = new THREE.Mesh(new THREE.ConeGeometry(0.1, 0.28, 16), material);
  for (const piece of [shaft, head]) {
    piece.rotation.x = Math.PI / 2;
    piece.renderOrder = isSeenThrough ? ABOVE_ALL : 0;
    arrow.add(piece);
  }
  arrow.userData = { shaft, head };
  return arrow;
}

export function pointArrow(arrow, from, vector) {
  const length = Math.hypot(...vector);
  arrow.visible = length > 0.05;
  if (!arrow.visible) return;
  const { shaft, head } = arrow.userData;
  const stem = Math.max(length - 0.28, 0.01);
  shaft.scale.y = stem;
  shaft.position.z = stem / 2;
  head.position.z = stem + 0.14;
  arrow.position.set(...from);
  const direction = new THREE.Vector3(...vector).divideScalar(length);
  arrow.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), direction);
}

// What traces are made of; one for all, as making it anew takes longer than a frame.
export function traceMaterial() {
  return new THREE.MeshBasicMaterial({
    side: THREE.DoubleSide,
    polygonOffset: true,
    polygonOffsetFactor: -2,
    polygonOffsetUnits: -2,
  });
}

// Half the width of a trace, and how far a path goes on at least before it does, in sizes of the top.
const HALF = 0.02;
const SHORTEST = 0.012;

// A ribbon along a path: two corners at either end of every straight stretch, two triangles between them.
class Ribbon {
  corners = [];
  triangles = [];
  last = null;
  joined = false;

  // Let the path end here, and go on elsewhere.
  lift() {
    this.last = null;
    this.joined = false;
  }

  goTo(x, y) {
    if (!this.last) {
      this.last = [x, y];
      return;
    }
    const [lastX, lastY] = this.last;
    const length = Math.hypot(x - lastX, y - lastY);
    if (!(length > SHORTEST)) return;
    const acrossX = (-(y - lastY) / length) * HALF;
    const acrossY = ((x - lastX) / length) * HALF;
    if (!this.joined) this.addCorners(lastX, lastY, acrossX, acrossY);
    const first = this.corners.length / 3 - 2;
    this.addCorners(x, y, acrossX, acrossY);
    this.triangles.push(first, first + 1, first + 3, first, first + 3, first + 2);
    this.last = [x, y];
    this.joined = true;
  }

  addCorners(x, y, acrossX, acrossY) {
    this.corners.push(x + acrossX, y + acrossY, 0, x - acrossX, y - acrossY, 0);
  }
}

// The path of the contact point, a ribbon just above the table; nothing where the top flies.
export function makeTrace(track, unit, material) {
  const stride = Math.max(1, Math.floor(track.count / 12000));
  const { point, touching } = track.columns;
  const ribbon = new Ribbon();
  const ends = [];
  for (let i = 0; i < track.count; i += stride) {
    if (touching[i]) ribbon.goTo(point[2 * i] / unit, point[2 * i + 1] / unit);
    else ribbon.lift();
    ends.push([track.time[i], ribbon.triangles.length]);
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(ribbon.corners, 3));
  geometry.setIndex(ribbon.triangles);
  const trace = new THREE.Mesh(geometry, material);
  trace.frustumCulled = false;
  trace.position.z = 0.004;
  trace.userData.ends = ends;
  return trace;
}

export function cutTrace(trace, time) {
  const { ends } = trace.userData;
  let low = 0;
  let high = ends.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (ends[middle][0] <= time) low = middle;
    else high = middle - 1;
  }
  trace.geometry.setDrawRange(0, ends.length && ends[low][0] <= time ? ends[low][1] : 0);
}
