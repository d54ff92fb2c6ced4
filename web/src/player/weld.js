// A toy of few pieces: what is of one material but for its colour becomes one mesh, which is drawn at once.

import * as THREE from "three";
import { mergeGeometries } from "three/addons/utils/BufferGeometryUtils.js";

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
