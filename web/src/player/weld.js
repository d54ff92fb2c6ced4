// A toy of few pieces: what is of one material but for its colour becomes one mesh, which is drawn at once, and whose
// colours can be blurred by its spin.

import * as THREE from "three";
import { mergeGeometries } from "three/addons/utils/BufferGeometryUtils.js";

// Angles of blur are multiples of it, rad: 6 degrees.
const BLUR_STEP = Math.PI / 30;
const FULL = 2 * Math.PI;

export function welded(toy) {
  const whole = new THREE.Group();
  for (const { name, meshes } of alikeIn(toy)) whole.add(weld(name, meshes));
  return whole;
}

// The meshes of a toy by their material; what is of glass keeps its name, by which it is hidden.
function alikeIn(toy) {
  const groups = new Map();
  for (const part of toy.children) {
    for (const mesh of [part, ...part.children].filter(({ isMesh }) => isMesh)) {
      const { opacity, roughness } = mesh.material;
      const isClear = opacity < 1;
      const key = isClear ? `${part.name} ${opacity}` : String(roughness);
      if (!groups.has(key)) groups.set(key, { name: isClear ? part.name : "solid", meshes: [] });
      groups.get(key).meshes.push(mesh);
    }
  }
  return groups.values();
}

function weld(name, meshes) {
  const [first] = meshes;
  const mesh = new THREE.Mesh(mergeGeometries(meshes.map(coloured)), first.material);
  mesh.material.color.set("#ffffff");
  mesh.material.vertexColors = true;
  mesh.name = name;
  mesh.castShadow = first.castShadow;
  mesh.receiveShadow = first.receiveShadow;
  mesh.renderOrder = first.renderOrder;
  mesh.userData.sectors = meshes.map(sectorOf);
  for (const { geometry } of meshes) geometry.dispose();
  return mesh;
}

// A mesh's geometry with its colour at every corner.
function coloured({ geometry, material: { color } }) {
  const count = geometry.attributes.position.count;
  const colours = new Float32Array(3 * count);
  for (let i = 0; i < count; i++) colours.set([color.r, color.g, color.b], 3 * i);
  return geometry.setAttribute("color", new THREE.BufferAttribute(colours, 3));
}

// What blurring needs of a sector: the colours of its part, its number among them, the shares of it at which corners
// are, and which of these each corner has.
function sectorOf({ geometry, sector: { colours, number } }) {
  const { uv } = geometry.attributes;
  const along = Array.from({ length: uv.count }, (_, i) => uv.getX(i));
  const shares = [...new Set(along)];
  const places = new Map(shares.map((share, place) => [share, place]));
  const corners = Uint32Array.from(along, (share) => places.get(share));
  return { palette: colours.map((colour) => new THREE.Color(colour)), number, shares, corners };
}

/** Blur the colours of a toy as if it had turned by an angle about its axis, rad, while it was looked at. */
export function blur(toy, angle) {
  const steps = Math.sign(angle) * Math.min(Math.round(Math.abs(angle) / BLUR_STEP), 60);
  if ((toy.userData.blurred ?? 0) === steps) return;
  toy.userData.blurred = steps;
  for (const mesh of toy.children) {
    const colours = mesh.geometry.attributes.color;
    let place = 0;
    for (const { palette, number, shares, corners } of mesh.userData.sectors) {
      const width = FULL / palette.length;
      const seen = shares.map((share) =>
        steps ? mean(palette, (number + share) * width, steps * BLUR_STEP) : palette[number],
      );
      for (const corner of corners) {
        const colour = seen[corner];
        colours.setXYZ(place, colour.r, colour.g, colour.b);
        place += 1;
      }
    }
    colours.needsUpdate = true;
  }
}

// The mean of the colours of equal sectors from an angle on.
function mean(palette, from, length) {
  const width = FULL / palette.length;
  const low = Math.min(from, from + length);
  const high = Math.max(from, from + length);
  const mixed = new THREE.Color(0, 0, 0);
  for (let k = Math.floor(low / width); k * width < high; k++) {
    const share = (Math.min((k + 1) * width, high) - Math.max(k * width, low)) / (high - low);
    const { r, g, b } = palette.at(((k % palette.length) + palette.length) % palette.length);
    mixed.r += share * r;
    mixed.g += share * g;
    mixed.b += share * b;
  }
  return mixed;
}
