// A toy of few pieces: what is of one material but for its colour becomes one mesh, which is drawn at once.

import * as THREE from "three";
import { mergeGeometries } from "three/addons/utils/BufferGeometryUtils.js";

export function welded(toy) {
  const alike = new Map();
  for (const part of toy.children) {
    for (const mesh of [part, ...part.children].filter(({ isMesh }) => isMesh)) {
      const { opacity, roughness } = mesh.material;
      const key = opacity < 1 ? `${part.name} ${opacity}` : String(roughness);
      if (!alike.has(key)) alike.set(key, { name: opacity < 1 ? part.name : "solid", meshes: [] });
      alike.get(key).meshes.push(mesh);
    }
  }
  const whole = new THREE.Group();
  for (const { name, meshes } of alike.values()) {
    const mesh = new THREE.Mesh(mergeGeometries(meshes.map(coloured)), meshes[0].material);
    mesh.material.color.set("#ffffff");
    mesh.material.vertexColors = true;
    mesh.name = name;
    mesh.castShadow = meshes[0].castShadow;
    mesh.receiveShadow = meshes[0].receiveShadow;
    mesh.renderOrder = meshes[0].renderOrder;
    whole.add(mesh);
    for (const one of meshes) one.geometry.dispose();
  }
  return whole;
}

// A mesh's geometry with its colour at every corner.
function coloured({ geometry, material: { color } }) {
  const count = geometry.attributes.position.count;
  const colours = new Float32Array(3 * count);
  for (let i = 0; i < count; i++) colours.set([color.r, color.g, color.b], 3 * i);
  return geometry.setAttribute("color", new THREE.BufferAttribute(colours, 3));
}
