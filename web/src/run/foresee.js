// What the theory says of a launch without a run, for the page.

import { InvalidInput, criticalSpins, predict } from "engine";

// The stable states it may head for, and critical spins of its tilt, rad/s; null where the theory is silent.
export function foresee(problem) {
  const ahead = told(() => predict(problem));
  const critical = told(() => criticalSpins(problem));
  if (!ahead && !critical) return null;
  return { ends: ahead?.reachable ?? [], certain: Boolean(ahead?.certain), critical };
}

function told(ask) {
  try {
    return ask();
  } catch (error) {
    if (error instanceof InvalidInput) return null;
    throw error;
  }
}
