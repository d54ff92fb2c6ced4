// The climax: how near a moment is to the top's turning over, and what that does to the clock and the camera.

// How long before and after it turns over is shown with care, s.
export const SPAN = 0.6;
// How far before it a jump to it goes, s.
export const LEAD = 0.8;
// How much slower time goes when it turns over.
const SLOWEST = 0.15;

// 0 far from the climax, 1 at it.
export function nearness(time, turnsOver, span = SPAN) {
  if (!Number.isFinite(turnsOver)) return 0;
  const u = Math.min(Math.abs(time - turnsOver) / span, 1);
  return (1 - u) ** 2 * (1 + 2 * u);
}

// The share of its speed at which a clock goes that slows down for the climax.
export function pace(time, turnsOver) {
  return 1 - (1 - SLOWEST) * nearness(time, turnsOver);
}
