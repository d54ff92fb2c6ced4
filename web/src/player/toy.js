// What stands in the scene, made of three.js objects: the toy, its table with a ruler, arrows, the trace.

import * as THREE from "three";

const SEGMENTS = 48;

// The toy of parts turned on a lathe, in sizes of the toy, each with equal sectors in its colours;
// of a ghost, of which but a share is seen, without what is of glass.
export function makeToy(parts, seen = 1) {
  const toy = new THREE.Group();
  for (const { name, profile, colours, opacity: own } of parts) {
    if (own < 1 && seen < 1) continue;
    const opacity = own * seen;
    const glass = opacity < 1;
    const points = profile.map(([r, z]) => new THREE.Vector2(r, z));
    const angle = (2 * Math.PI) / colours.length;
    const part = new THREE.Group();
    part.name = name;
    colours.forEach((color, k) => {
      const steps = Math.max(1, Math.round(SEGMENTS / colours.length));
      // three.js turns profiles about y, from z towards x.
      const geometry = new THREE.LatheGeometry(points, steps, k * angle + Math.PI / 2, angle).rotateX(Math.PI / 2);
      const material = new THREE.MeshStandardMaterial({
        color, opacity, transparent: glass, depthWrite: !glass, roughness: glass ? 0.08 : 0.42, metalness: 0,
      });
      const mesh = new THREE.Mesh(geometry, material);
      mesh.castShadow = mesh.receiveShadow = !glass;
      mesh.renderOrder = glass ? 2 : 0;
      part.add(mesh);
    });
    toy.add(part);
  }
  return toy;
}

// The table top: a square of squares, `cell` wide, every fifth line heavier.
export function makeTable(cell, colours) {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 512;
  paintGrid(canvas, colours);
  const texture = new THREE.CanvasTexture(canvas);
  texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
  texture.anisotropy = 8;
  texture.colorSpace = THREE.SRGBColorSpace;
  const cells = 16;
  texture.repeat.set(cells, cells);
  const side = 5 * cell * cells;
  const material = new THREE.MeshLambertMaterial({ map: texture });
  const table = new THREE.Mesh(new THREE.PlaneGeometry(side, side), material);
  table.receiveShadow = true;
  table.userData.canvas = canvas;
  return table;
}

export function paintGrid(canvas, { table, line }) {
  const pen = canvas.getContext("2d");
  const side = canvas.width;
  pen.globalAlpha = 1;
  pen.fillStyle = table;
  pen.fillRect(0, 0, side, side);
  pen.strokeStyle = line;
  for (let k = 0; k <= 5; k++) {
    const edge = k % 5 === 0;
    pen.lineWidth = edge ? 9 : 3;
    pen.globalAlpha = edge ? 0.9 : 0.5;
    pen.beginPath();
    pen.moveTo((k * side) / 5, 0);
    pen.lineTo((k * side) / 5, side);
    pen.moveTo(0, (k * side) / 5);
    pen.lineTo(side, (k * side) / 5);
    pen.stroke();
  }
}

// A ruler of ten cells that lies on the table, numbered in centimetres (or whatever the cell is).
export function makeRuler(cell, label, colours) {
  const canvas = document.createElement("canvas");
  canvas.width = 2048;
  canvas.height = 200;
  const pen = canvas.getContext("2d");
  const margin = 110;
  const step = (canvas.width - 2 * margin) / 10;
  pen.fillStyle = colours.ruler;
  pen.fillRect(0, 0, canvas.width, canvas.height);
  pen.fillStyle = pen.strokeStyle = "#2b2418";
  pen.font = "600 62px system-ui, sans-serif";
  pen.textAlign = "center";
  for (let k = 0; k <= 100; k++) {
    const x = margin + (k * step) / 10;
    pen.lineWidth = k % 10 ? 3 : 5;
    pen.beginPath();
    pen.moveTo(x, 0);
    pen.lineTo(x, k % 10 ? (k % 5 ? 34 : 54) : 80);
    pen.stroke();
    if (k % 10 === 0) pen.fillText(label(k / 10), x, 152);
  }
  const texture = new THREE.CanvasTexture(canvas);
  texture.colorSpace = THREE.SRGBColorSpace;
  texture.anisotropy = 8;
  const length = (10 * cell * canvas.width) / (10 * step);
  const width = (length * canvas.height) / canvas.width;
  const geometry = new THREE.BoxGeometry(length, width, 0.04);
  const plain = new THREE.MeshStandardMaterial({ color: colours.ruler, roughness: 0.7 });
  const face = new THREE.MeshStandardMaterial({ map: texture, roughness: 0.7 });
  const ruler = new THREE.Mesh(geometry, [plain, plain, plain, plain, face, plain]);
  ruler.position.z = 0.02;
  ruler.castShadow = ruler.receiveShadow = true;
  return ruler;
}

// Where the top touches the table, as a ring around it.
export function makePatch() {
  const material = new THREE.MeshBasicMaterial({ transparent: true, opacity: 0.85 });
  const patch = new THREE.Mesh(new THREE.RingGeometry(0.07, 0.13, 32), material);
  patch.visible = false;
  return patch;
}

// An arrow from the origin along z, to be turned and stretched by `pointArrow`.
export function makeArrow(colour) {
  const material = new THREE.MeshStandardMaterial({ color: colour, emissive: colour, emissiveIntensity: 0.35 });
  const arrow = new THREE.Group();
  const shaft = new THREE.Mesh(new THREE.CylinderGeometry(0.035, 0.035, 1, 12), material);
  const head = new THREE.Mesh(new THREE.ConeGeometry(0.1, 0.28, 16), material);
  for (const piece of [shaft, head]) {
    piece.rotation.x = Math.PI / 2;
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

// The path of the contact point, a ribbon just above the table; nothing where the top flies.
export function makeTrace(track, unit, material) {
  const stride = Math.max(1, Math.floor(track.count / 12000));
  const { point, touching } = track.columns;
  const half = 0.02;
  const corners = [];
  const triangles = [];
  const ends = [];
  let last = null;
  let joined = false;
  for (let i = 0; i < track.count; i += stride) {
    const x = point[2 * i] / unit;
    const y = point[2 * i + 1] / unit;
    const length = last ? Math.hypot(x - last[0], y - last[1]) : 0;
    if (!touching[i] || !last) {
      last = touching[i] ? [x, y] : null;
      joined = false;
    } else if (length > 0.012) {
      const sx = (-(y - last[1]) / length) * half;
      const sy = ((x - last[0]) / length) * half;
      if (!joined) corners.push(last[0] + sx, last[1] + sy, 0, last[0] - sx, last[1] - sy, 0);
      const a = corners.length / 3 - 2;
      corners.push(x + sx, y + sy, 0, x - sx, y - sy, 0);
      triangles.push(a, a + 1, a + 3, a, a + 3, a + 2);
      last = [x, y];
      joined = true;
    }
    ends.push([track.time[i], triangles.length]);
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(corners, 3));
  geometry.setIndex(triangles);
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
