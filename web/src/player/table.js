// What lies still: the table with its squares, and a ruler on it. Where pictures are computed without graphics
// hardware the table, most of every picture, is drawn in colours that are lit once, and the shadow is a flat one.

import * as THREE from "three";

// The table top: a square of squares, `cell` wide, every fifth line heavier.
export function makeTable(cell, colours, frugal) {
  const canvas = document.createElement("canvas");
  canvas.width = frugal ? 256 : 512;
  canvas.height = canvas.width;
  const texture = new THREE.CanvasTexture(canvas);
  texture.wrapS = THREE.RepeatWrapping;
  texture.wrapT = THREE.RepeatWrapping;
  const cells = 16;
  texture.repeat.set(cells, cells);
  const side = 5 * cell * cells;
  const table = new THREE.Mesh(
    new THREE.PlaneGeometry(side, side),
    frugal ? finished(texture) : lit(texture),
  );
  table.renderOrder = -3;
  table.receiveShadow = !frugal;
  table.userData = { canvas, frugal };
  paintTable(table, colours);
  return table;
}

function lit(texture) {
  texture.anisotropy = 8;
  texture.colorSpace = THREE.SRGBColorSpace;
  return new THREE.MeshLambertMaterial({ map: texture });
}

// A material whose texture has the colours of the screen.
function finished(texture) {
  const material = new THREE.MeshBasicMaterial({ map: texture });
  material.onBeforeCompile = (shader) => {
    shader.fragmentShader = shader.fragmentShader.replace("#include <colorspace_fragment>", "");
  };
  return material;
}

export function paintTable({ material, userData: { canvas, frugal } }, theme) {
  const { table, line } = theme;
  const seen = (colour) =>
    frugal ? new THREE.Color(colour).multiply(lightOf(theme)).getStyle() : colour;
  const pen = canvas.getContext("2d");
  const side = canvas.width;
  pen.globalAlpha = 1;
  pen.fillStyle = seen(table);
  pen.fillRect(0, 0, side, side);
  pen.strokeStyle = seen(line);
  for (let k = 0; k <= 5; k++) {
    const edge = k % 5 === 0;
    pen.lineWidth = (edge ? 9 : 3) * (side / 512);
    pen.globalAlpha = edge ? 0.9 : 0.5;
    pen.beginPath();
    pen.moveTo((k * side) / 5, 0);
    pen.lineTo((k * side) / 5, side);
    pen.moveTo(0, (k * side) / 5);
    pen.lineTo(side, (k * side) / 5);
    pen.stroke();
  }
  material.map.needsUpdate = true;
}

// Where the sun stands seen from the top, and its colour.
export const SUN = { place: new THREE.Vector3(-2.2, -4.2, 7), colour: "#fff4e0" };

// The share of its own colour that a level face sends back, in the sun or in the shadow.
function lightOf({ sky, ground, ambient, sun }, sunny = true) {
  const light = new THREE.Color(sky)
    .lerp(new THREE.Color(ground), 0.5)
    .multiplyScalar(ambient / Math.PI);
  const high = SUN.place.z / SUN.place.length();
  if (!sunny) return light;
  return light.add(new THREE.Color(SUN.colour).multiplyScalar((sun * high) / Math.PI));
}

// The flat shadow of a toy on the table: all of it pressed along the sun's rays, darker than the table only once.
export function makeShadow(toy) {
  const material = new THREE.MeshBasicMaterial({
    fog: false,
    side: THREE.DoubleSide,
    depthTest: false,
    depthWrite: false,
    blending: THREE.MultiplyBlending,
    premultipliedAlpha: true,
    stencilWrite: true,
    stencilRef: 1,
    stencilFunc: THREE.NotEqualStencilFunc,
    stencilZPass: THREE.ReplaceStencilOp,
  });
  const shadow = new THREE.Group();
  toy.traverse((object) => {
    if (!object.isMesh || !object.castShadow) return;
    const mesh = new THREE.Mesh(object.geometry, material);
    mesh.renderOrder = -1;
    mesh.frustumCulled = false;
    shadow.add(mesh);
  });
  shadow.matrixAutoUpdate = false;
  shadow.userData = { material };
  return shadow;
}

export function paintShadow({ userData: { material } }, theme) {
  const [dim, full] = [false, true].map((sunny) =>
    new THREE.Color(theme.table).multiply(lightOf(theme, sunny)).convertLinearToSRGB(),
  );
  // What is multiplied are colours of the screen; this one is converted to them once more.
  material.color.setRGB(dim.r / full.r, dim.g / full.g, dim.b / full.b).convertSRGBToLinear();
}

// Where a point is pressed to by the sun, as a matrix.
const PRESS = new THREE.Matrix4().set(
  1,
  0,
  -SUN.place.x / SUN.place.z,
  0,
  0,
  1,
  -SUN.place.y / SUN.place.z,
  0,
  0,
  0,
  0,
  0.002,
  0,
  0,
  0,
  1,
);

export function layShadow(shadow, toy) {
  toy.updateMatrix();
  shadow.matrix.multiplyMatrices(PRESS, toy.matrix);
  shadow.matrixWorldNeedsUpdate = true;
}

// A ruler of ten cells that lies on the table, numbered in centimetres (or whatever the cell is).
export function makeRuler(cell, label, colours) {
  const { canvas, step } = drawRuler(label, colours.ruler);
  const texture = new THREE.CanvasTexture(canvas);
  texture.colorSpace = THREE.SRGBColorSpace;
  texture.anisotropy = 8;
  const length = (cell * canvas.width) / step;
  const width = (length * canvas.height) / canvas.width;
  const geometry = new THREE.BoxGeometry(length, width, 0.04);
  const plain = new THREE.MeshLambertMaterial({ color: colours.ruler });
  const face = new THREE.MeshLambertMaterial({ map: texture });
  const ruler = new THREE.Mesh(geometry, [plain, plain, plain, plain, face, plain]);
  ruler.position.z = 0.02;
  ruler.renderOrder = -2;
  ruler.castShadow = true;
  ruler.receiveShadow = true;
  return ruler;
}

// The face of a ruler, and the pixels between two of its numbers.
function drawRuler(label, colour) {
  const ink = "#2b2418";
  const margin = 110;
  const canvas = document.createElement("canvas");
  canvas.width = 2048;
  canvas.height = 200;
  const step = (canvas.width - 2 * margin) / 10;
  const pen = canvas.getContext("2d");
  pen.fillStyle = colour;
  pen.fillRect(0, 0, canvas.width, canvas.height);
  pen.fillStyle = ink;
  pen.strokeStyle = ink;
  pen.font = "600 62px system-ui, sans-serif";
  pen.textAlign = "center";
  for (let k = 0; k <= 100; k++) {
    const x = margin + (k * step) / 10;
    pen.lineWidth = k % 10 ? 3 : 5;
    pen.beginPath();
    pen.moveTo(x, 0);
    pen.lineTo(x, heightOfLine(k));
    pen.stroke();
    if (k % 10 === 0) pen.fillText(label(k / 10), x, 152);
  }
  return { canvas, step };
}

// How long a ruler's line is, pixels: longest at whole cells, longer at halves.
function heightOfLine(tenths) {
  if (tenths % 10 === 0) return 80;
  return tenths % 5 === 0 ? 54 : 34;
}
