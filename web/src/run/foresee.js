// Where an eccentric sphere on a table that drags ends, without a run: the least energy that goes with Jellett's
// integral lambda, as in tippetop.theory (steady.py, thresholds.py), in SI units.

const CREEP = ["viscous", "regularized_coulomb"];
const TILTS = 720;

// Critical spins of a launch's tilt, rad/s, and the stable states it may head for; null where this theory is silent.
export function foresee({ body, friction, launch, gravity, rolling_resistance: resistance }) {
  const { shape, mass, I1, I3 } = body;
  if (shape.kind !== "eccentric_sphere" || !CREEP.includes(friction.kind) || !friction.mu || resistance) return null;
  const { radius: R, eccentricity: alpha } = shape;
  const weight = mass * gravity * R * alpha;
  const spread = (c) => I3 * (c - alpha) ** 2 + I1 * (1 - c * c);
  const slope = (c) => 2 * (I3 - I1) * c - 2 * alpha * I3;
  // lambda^2 of the steady precession at a tilt; at a pole, where the vertical spin changes stability.
  const square = (c) => (-2 * weight * R ** 2 * spread(c) ** 2) / slope(c);
  const [up, down] = [square(1), square(-1)].map((one) => (one > 0 ? Math.sqrt(one) : Infinity));
  const c = Math.cos(launch.tilt);
  const [fixed, share] = [R * I1 * (launch.precession ?? 0) * (1 - c * c), R * I3 * (c - alpha)];
  const spinAt = (lambda) => (share ? Math.max(...[lambda, -lambda].map((one) => (one - fixed) / share)) : Infinity);
  const critical = { upright: spinAt(up), inverted: spinAt(down) };
  const lambda = fixed + share * launch.spin;
  const energy = (at) => lambda ** 2 / (2 * R ** 2 * spread(at)) - weight * at;
  const states = minima(energy).map((at) => stateAt(at, lambda, body, energy(at), spread(at)));
  states.sort((a, b) => a.energy - b.energy);
  return { ends: states, certain: states.length === 1, critical };
}

// Cosines of the tilts at which an energy is least among its neighbours.
function minima(energy) {
  const grid = Array.from({ length: TILTS + 1 }, (_, k) => Math.cos((Math.PI * k) / TILTS));
  const values = grid.map(energy);
  const found = [];
  values.forEach((value, k) => {
    if (!(value < (values[k - 1] ?? Infinity) && value <= (values[k + 1] ?? Infinity))) return;
    found.push(k === 0 || k === TILTS ? grid[k] : least(energy, grid[k + 1], grid[k - 1]));
  });
  return found;
}

// The place of the least value between two others, by the golden section.
function least(energy, low, high) {
  const share = (Math.sqrt(5) - 1) / 2;
  for (let turn = 0; turn < 40; turn++) {
    const [a, b] = [high - share * (high - low), low + share * (high - low)];
    if (energy(a) < energy(b)) high = b;
    else low = a;
  }
  return (low + high) / 2;
}

function stateAt(c, lambda, { shape: { radius: R, eccentricity: alpha }, I3 }, energy, spread) {
  if (c === 1) return { kind: "upright", tilt: 0, spin: lambda / (R * I3 * (1 - alpha)), precession: 0, energy };
  if (c === -1) return { kind: "inverted", tilt: Math.PI, spin: -lambda / (R * I3 * (1 + alpha)), precession: 0, energy };
  const precession = lambda / (R * spread);
  return { kind: "precession", tilt: Math.acos(c), precession, spin: precession * (c - alpha), energy };
}
