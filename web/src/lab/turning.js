// A top from its shape: a ball cut by a face, hollowed around its stem, of one material; lengths in m.

const SLICES = 1200;

export const MATERIALS = { beech: 720, plastic: 1050, cork: 240, aluminium: 2700 };

export const FIRST = { radius: 0.02, face: 0.55, hollow: 0.6, stem: 0.032, knob: 0.0035, material: "beech" };

// Radius of the hollow, in radii of the ball: as wide as leaves a wall.
const WALL = 0.12;

function shaft({ knob }) {
  return 0.75 * knob;
}

// The widest the hollow may be at a height, from the ball's middle: nothing where there is none.
function bore({ radius, face, hollow, knob }, z) {
  const bottom = (face - hollow * (1 + face)) * radius;
  if (hollow <= 0 || z < bottom + WALL * radius || z > face * radius) return 0;
  const inner = (1 - WALL) * radius;
  return Math.max(Math.sqrt(Math.max(inner ** 2 - z ** 2, 0)), shaft({ knob }));
}

export function widthAt(top, z) {
  const { radius, face, stem, knob } = top;
  if (z < -radius || z > stem + knob) return 0;
  if (z <= face * radius) return Math.sqrt(Math.max(radius ** 2 - z ** 2, 0));
  const ball = Math.sqrt(Math.max(knob ** 2 - (z - stem) ** 2, 0));
  return z < stem ? Math.max(ball, shaft(top)) : ball;
}

// Mass, height of its centre above the ball's middle, moments of inertia about it.
export function weigh(top) {
  const density = MATERIALS[top.material];
  const [low, high] = [-top.radius, top.stem + top.knob];
  const step = (high - low) / SLICES;
  let [mass, moment, along, across] = [0, 0, 0, 0];
  for (let k = 0; k < SLICES; k++) {
    const z = low + (k + 0.5) * step;
    const [outer, hole, inner] = [widthAt(top, z), bore(top, z), shaft(top)];
    const empty = hole > inner ? [hole ** 2 - inner ** 2, hole ** 4 - inner ** 4] : [0, 0];
    const area = Math.PI * (outer ** 2 - empty[0]) * density * step;
    const polar = (Math.PI / 2) * (outer ** 4 - empty[1]) * density * step;
    mass += area;
    moment += area * z;
    along += polar;
    across += polar / 2 + area * z ** 2;
  }
  const centre = moment / mass;
  return { mass, centre, I3: along, I1: across - mass * centre ** 2 };
}

// The nearest top to one that can be made: its stem reaches out of the ball, and the table before the rim does.
export function possible(top) {
  const stem = Math.max(top.stem, top.radius + top.knob);
  return { ...top, stem, face: Math.max(top.face, (top.radius - top.knob) / stem) };
}

// The body as the engine takes it: ball and stem.
export function bodyOf(top) {
  const { mass, centre, I1, I3 } = weigh(top);
  const shape = [
    { kind: "sphere", radius: top.radius, center: -centre },
    { kind: "sphere", radius: top.knob, center: top.stem - centre },
  ];
  return { mass, shape, I1, I3 };
}

// What it can do at all, whatever its spin: 1 - alpha < I1/I3 < 1 + alpha turns over completely.
export function verdictOf(top) {
  const { centre, I1, I3, mass } = weigh(top);
  const alpha = -centre / top.radius;
  const ratio = I1 / I3;
  const word = alpha <= 0 ? "high" : ratio <= 1 - alpha ? "never" : ratio >= 1 + alpha ? "half" : "can";
  return { word, alpha, ratio: 1 / ratio, mass };
}

// Half of its section: points from below, and those of its hollow.
export function sectionOf(top) {
  const [low, high] = [-top.radius, top.stem + top.knob];
  const heights = Array.from({ length: 161 }, (_, k) => low + ((high - low) * k) / 160);
  const holes = heights.filter((z) => bore(top, z) > shaft(top));
  return {
    outer: heights.map((z) => [widthAt(top, z), z]),
    hollow: [...holes.map((z) => [bore(top, z), z]), ...holes.reverse().map((z) => [shaft(top), z])],
  };
}
