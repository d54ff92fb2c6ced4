// What the theory says of a launch without a run, for the page.

import { criticalSpins, InvalidInput, predict } from "engine";

// The stable states it may head for, and critical spins of its tilt, rad/s; null where the theory is silent.
export function foresee(problem) {
  const ahead = unlessRefused(() => predict(problem));
  const critical = unlessRefused(() => criticalSpins(problem));
  if (!ahead && !critical) return null;
  return { ends: ahead?.reachable ?? [], certain: Boolean(ahead?.certain), critical };
}

// What a function returns; null for a problem that the theory refuses.
function unlessRefused(compute) {
  try {
    return compute();
  } catch (error) {
    if (error instanceof InvalidInput) return null;
    throw error;
  }
}
