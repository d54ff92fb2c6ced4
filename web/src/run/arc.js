// The edges of profiles as points.

import looks from "../generated/looks.json";

// Points from one of a profile to the next, on the arc of the radius that this has, so far apart, rad, at most.
export function edge([r, z], [toR, toZ, radius = 0], apart = looks.meridian.arc_step) {
  const across = toR - r;
  const up = toZ - z;
  if (!radius)
    return [
      [r, z],
      [toR, toZ],
    ];
  const half = Math.asin(Math.max(-1, Math.min(1, Math.hypot(across, up) / (2 * radius))));
  const steps = Math.max(1, Math.ceil((2 * Math.abs(half)) / apart - 1e-9));
  return Array.from({ length: steps + 1 }, (_, k) => {
    const along = Math.sin((k / steps) * half) / Math.sin(half);
    const x = Math.cos((k / steps - 1) * half);
    const y = Math.sin((k / steps - 1) * half);
    return [r + along * (across * x - up * y), z + along * (across * y + up * x)];
  });
}
