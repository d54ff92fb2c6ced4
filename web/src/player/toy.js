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
      const geometry = new THREE.LatheGeometry(
        points,
        steps,
        k * angle + Math.PI / 2,
        angle,
      ).rotateX(Math.PI / 2);
      const material = new THREE.MeshStandardMaterial({
        color,
        opacity,
        transparent: glass,
        depthWrite: !glass,
        roughness: glass ? 0.08 : 0.42,
        metalness: 0,
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

// Where the top touches the table, as a ring around it.
export function makePatch() {
  const material = new THREE.MeshBasicMaterial({ transparent: true, opacity: 0.85 });
  const patch = new THREE.Mesh(new THREE.RingGeometry(0.07, 0.13, 32), material);
  patch.visible = false;
  return patch;
}

// An arrow from the origin along z, to be turned and stretched by `pointArrow`.
export function makeArrow(colour) {
  const material = new THREE.MeshStandardMaterial({
    color: colour,
    emissive: colour,
    emissiveIntensity: 0.35,
  });
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
