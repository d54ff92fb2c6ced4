// A top from its shape: a ball cut by a face, hollowed around its stem, of one material; lengths in m.

import { edge } from "../run/arc.js";

export const MATERIALS = { beech: 720, plastic: 1050, cork: 240, aluminium: 2700 };

export const FIRST = {
  radius: 0.02,
  face: 0.7,
  hollow: 0.8,
  stem: 0.025,
  knob: 0.005,
  material: "beech",
};

// Bounds and step of each size.
export const SIZES = {
  radius: [0.008, 0.04, 0.0005],
  face: [0.2, 0.9, 0.01],
  hollow: [0, 0.95, 0.01],
  stem: [0.02, 0.07, 0.0005],
  knob: [0.0015, 0.012, 0.0005],
};

// Thickness of the wall around the hollow, in radii of the ball.
const WALL = 0.12;

// Places and weights of Gauss's rule of three points on (0, 1): exact for what an edge adds.
const GAUSS = [
  [0.5 - Math.sqrt(0.15), 5 / 18],
  [0.5, 8 / 18],
  [0.5 + Math.sqrt(0.15), 5 / 18],
];

// The line that is turned, in three parts from below: points (distance from the axis, height above the ball's
// middle) with their radius where arcs end. All arcs have their centre on the axis.
function partsOf({ radius, face, hollow, stem, knob }) {
  const cut = face * radius;
  const slim = 0.75 * knob;
  const inner = (1 - WALL) * radius;
  const bottom = cut - hollow * (1 + face) * radius + WALL * radius;
  const across = (ball, z) => Math.sqrt(Math.max(ball ** 2 - z ** 2, 0));
  // Cut too high there is no way in.
  const bored = bottom < cut && across(inner, cut) > slim && across(inner, bottom) > slim;
  return {
    ball: [
      [0, -radius],
      [across(radius, cut), cut, radius],
    ],
    bore: bored
      ? [
          [across(inner, cut), cut],
          [across(inner, bottom), bottom, -inner],
          [slim, bottom],
        ]
      : [],
    stem: [
      [slim, bored ? bottom : cut],
      [slim, stem - across(knob, slim)],
      [0, stem + knob, knob],
    ].slice(bored ? 1 : 0),
  };
}

function profileOf(top) {
  const { ball, bore, stem } = partsOf(top);
  return [...ball, ...bore, ...stem];
}

// Mass, height of its centre above the ball's middle, moments of inertia about it.
export function weigh(top) {
  const density = MATERIALS[top.material];
  const points = profileOf(top);
  let mass = 0;
  let moment = 0;
  let along = 0;
  let across = 0;
  points.slice(1).forEach(([r, z, arc], k) => {
    const [before, from] = points[k];
    if (z === from) return;
    const middle = (r ** 2 + z ** 2 - before ** 2 - from ** 2) / (2 * (z - from));
    for (const [place, weight] of GAUSS) {
      const at = from + place * (z - from);
      const square = arc ? arc ** 2 - (at - middle) ** 2 : r ** 2;
      const area = Math.PI * square * density * weight * (z - from);
      const polar = (area * square) / 2;
      mass += area;
      moment += area * at;
      along += polar;
      across += polar / 2 + area * at ** 2;
    }
  });
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
  const above = ([r, z, ...arc]) =>
    [r, z - centre, ...arc].map((value) => Number(value.toFixed(9)));
  return { mass, shape, I1, I3, profile: profileOf(top).map(above) };
}

// Its mass, how far its centre is below the ball's middle, in radii, and its inertia along over that across.
export function massesOf(top) {
  const { mass, centre, I1, I3 } = weigh(top);
  return { mass, alpha: -centre / top.radius, ratio: I3 / I1 };
}

// Half of its section: points from below, and those of its hollow.
export function sectionOf(top) {
  const { ball, bore, stem } = partsOf(top);
  const drawn = (points) => points.slice(1).flatMap((point, k) => edge(points[k], point));
  const [slim] = stem[0];
  return {
    outer: drawn([...ball, [slim, ball[1][1]], ...stem]),
    hollow: bore.length ? drawn([...bore, [slim, ball[1][1]]]) : [],
  };
}
