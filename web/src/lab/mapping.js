// A map that is being computed: the launches around one, from coarse to fine, and what became of them.

import { fineness, HIGHEST } from "./chart.js";
import { Crew } from "./engine.js";
import { changed } from "./setup.js";

export const COLUMNS = 48;
export const ROWS = 24;
export const CELLS = COLUMNS * ROWS;

// After how many answers the page is told how far a map is.
const TOLD = 8;

// The launches of a map around one: spins to the highest of the slider, friction over a factor of 100.
export function planOf(setup) {
  const mu = Math.max(setup.problem.friction.mu, 1e-3);
  const round = (value, count) => Number(value.toPrecision(count));
  return {
    setup,
    spins: Array.from({ length: COLUMNS }, (_, k) => round(((k + 0.5) / COLUMNS) * HIGHEST, 4)),
    frictions: Array.from({ length: ROWS }, (_, k) =>
      round(round(mu, 1) * 10 ** (-1 + (2 * k) / (ROWS - 1)), 3),
    ),
  };
}

export function cellOf(plan, { row, column }) {
  return changed(plan.setup, {
    "launch.spin": plan.spins[column],
    "friction.mu": plan.frictions[row],
  });
}

// The cells from coarse to fine.
function* jobsOf(plan) {
  const order = [];
  for (let row = 0; row < ROWS; row++) {
    for (let column = 0; column < COLUMNS; column++) order.push({ row, column });
  }
  order.sort((a, b) => fineness(a) - fineness(b));
  for (const cell of order)
    yield { key: cell.row * COLUMNS + cell.column, setup: cellOf(plan, cell) };
}

/** One map: its launches, the answers to them, and whether it is still being computed. */
export class Mapping extends EventTarget {
  constructor(setup) {
    super();
    this.plan = planOf(setup);
    this.cells = new Array(CELLS).fill(null);
    this.count = 0;
    this.crew = new Crew();
    this.follow();
  }

  get isUnderWay() {
    return this.crew !== null;
  }

  async follow() {
    const { crew, cells } = this;
    await crew.follow(jobsOf(this.plan), (key, answer) => {
      cells[key] = answer;
      this.count += 1;
      this.dispatchEvent(new Event("cell"));
      if (this.count % TOLD === 0) this.dispatchEvent(new Event("state"));
    });
    this.stop();
  }

  stop() {
    if (!this.crew) return;
    this.crew.stop();
    this.crew = null;
    this.dispatchEvent(new Event("state"));
  }
}
