// Pushes of a top while it spins: a sideways impulse on its stem, another friction or slope of the table from then on, or
// several of them.

/** The most pushes of one run. */
export const MOST_PUSHES = 8;
// The largest impulse, N s, and the largest friction coefficient of a link.
const MOST_IMPULSE = 100;
const MOST_FRICTION = 1e6;
// The strongest push of the slider gives a top this speed, m/s.
const SPEED = 0.5;
// Times of pushes are rounded down to it, s; it is the earliest time too.
const MOMENT = 1e-4;

/** Directions of a push, rad, from that into which the axis leans. */
export const DIRECTIONS = {
  down: 0,
  left: Math.PI / 2,
  up: Math.PI,
  right: -Math.PI / 2,
};

export function isPush({ time, impulse, direction, mu, slope }) {
  const isImpulse = impulse >= 0 && impulse <= MOST_IMPULSE && Number.isFinite(direction);
  const isFriction = mu === null || (mu >= 0 && mu <= MOST_FRICTION);
  const isSlope = slope === null || (slope >= 0 && slope < Math.PI / 2);
  return time > 0 && isImpulse && isFriction && isSlope;
}

/** Pushes in order of time; of two at one time the later one in the list. */
export function sortedPushes(pushes) {
  const byTime = new Map(pushes.map((push) => [push.time, push]));
  return [...byTime.values()].sort((one, other) => one.time - other.time);
}

/** The moment of a push at a time of a run, s. */
export const momentOf = (time) =>
  Math.max(MOMENT, Number((MOMENT * Math.floor(time / MOMENT)).toFixed(4)));

/** The strongest push of the slider, N s: a power of ten times 1, 2 or 5. */
export function strongest(mass) {
  const most = mass * SPEED;
  const power = 10 ** Math.floor(Math.log10(most));
  return Number((power * [5, 2, 1].find((one) => one * power <= most * (1 + 1e-9))).toPrecision(3));
}
