// What stands in the scene, made of three.js objects: the toy, its table with a ruler, arrows, the trace.

const SEGMENTS = 48;

// A solid of revolution about z, with equal sectors in its colours; lengths in `unit` metres.
export function lathe(THREE, part, unit) {
  const profile = part.profile.map(([r, z]) => [r / unit, z / unit]);
  const last = profile.length - 1;
  const normals = profile.map((_, k) => {
    const [r0, z0] = profile[Math.max(k - 1, 0)];
    const [r1, z1] = profile[Math.min(k + 1, last)];
    const length = Math.hypot(z1 - z0, r1 - r0) || 1;
    return [(z1 - z0) / length, (r0 - r1) / length];
  });
  const sectors = part.colours.length;
  const steps = Math.max(1, Math.round(SEGMENTS / sectors));
  const points = [];
  const directions = [];
  const colours = [];
  const triangles = [];
  part.colours.forEach((name, sector) => {
    const colour = new THREE.Color(name);
    for (let s = 0; s <= steps; s++) {
      const turn = (2 * Math.PI * (sector + s / steps)) / sectors;
      const x = Math.cos(turn);
      const y = Math.sin(turn);
      for (let k = 0; k <= last; k++) {
        if (s < steps && k < last) {
          const a = points.length / 3;
          const b = a + last + 1;
          triangles.push(a, b, b + 1, a, b + 1, a + 1);
        }
        points.push(profile[k][0] * x, profile[k][0] * y, profile[k][1]);
        directions.push(normals[k][0] * x, normals[k][0] * y, normals[k][1]);
        colours.push(colour.r, colour.g, colour.b);
      }
    }
  });
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(points, 3));
  geometry.setAttribute("normal", new THREE.Float32BufferAttribute(directions, 3));
  geometry.setAttribute("color", new THREE.Float32BufferAttribute(colours, 3));
  geometry.setIndex(triangles);
  return geometry;
}

export function makeToy(THREE, body) {
  const toy = new THREE.Group();
  for (const part of body.parts) {
    const glass = part.opacity < 1;
    const material = new THREE.MeshStandardMaterial({
      vertexColors: true,
      roughness: glass ? 0.08 : 0.42,
      metalness: 0,
      transparent: glass,
      opacity: part.opacity,
      depthWrite: !glass,
    });
    const mesh = new THREE.Mesh(lathe(THREE, part, body.size), material);
    mesh.name = part.name;
    mesh.castShadow = !glass;
    mesh.receiveShadow = !glass;
    mesh.renderOrder = glass ? 2 : 0;
    toy.add(mesh);
  }
  return toy;
}

// The table top: a square of squares, `cell` wide, every fifth line heavier.
export function makeTable(THREE, cell, colours) {
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
export function makeRuler(THREE, cell, label, colours) {
  const canvas = document.createElement("canvas");
  canvas.width = 2048;
  canvas.height = 200;
  const pen = canvas.getContext("2d");
  const margin = 60;
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

// An arrow from the origin along z, to be turned and stretched by `pointArrow`.
export function makeArrow(THREE, colour) {
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

export function pointArrow(THREE, arrow, from, vector) {
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
export function traceMaterial(THREE) {
  return new THREE.MeshBasicMaterial({
    side: THREE.DoubleSide,
    polygonOffset: true,
    polygonOffsetFactor: -2,
    polygonOffsetUnits: -2,
  });
}

// The path of the contact point, a ribbon just above the table; nothing where the top flies.
export function makeTrace(THREE, track, unit, material) {
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
