// What friction does to the angular momentum of an eccentric sphere that spins about its leaning axis and slides.

// The plane is that of the axis and the vertical, x where the axis leans, z up; friction is across it, along y.

/** Contact arm, friction, its torque in the plane and the angular momentum, SI, at a tilt. */
export function torqueAt({ body, friction, gravity }, spin, tilt) {
  const { radius, eccentricity } = body.shape;
  const [sine, cosine] = [Math.sin(tilt), Math.cos(tilt)];
  const arm = [eccentricity * radius * sine, radius * (eccentricity * cosine - 1)];
  const slip = spin * radius * sine;
  const force = -friction.mu * body.mass * gravity * slip;
  const torque = [-arm[1] * force, arm[0] * force];
  const momentum = [body.I3 * spin * sine, body.I3 * spin * cosine];
  return { arm, slip, force, torque, momentum };
}
