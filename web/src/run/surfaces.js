// The height h of the centre of mass above the table on each surface of a body, and its slope dh/dc, over the
// cosine c of the tilt; lengths in m.

const KINDS = {
  eccentric_sphere: ({ radius, eccentricity }) => sphere(radius, eccentricity * radius),
  sphere: ({ radius, center = 0 }) => sphere(radius, center),
  ring: ({ radius, tube = 0, center = 0 }) => ({
    height: (c) => tube + radius * sine(c) - center * c,
    slope: (c) => (-radius * c) / Math.max(sine(c), 1e-9) - center,
  }),
  spheroid: ({ across, along, center = 0 }) => {
    const reach = (c) => Math.hypot(across * sine(c), along * c);
    return {
      height: (c) => reach(c) - center * c,
      slope: (c) => ((along ** 2 - across ** 2) * c) / reach(c) - center,
    };
  },
};

function sine(c) {
  return Math.sqrt(Math.max(1 - c * c, 0));
}

function sphere(radius, center) {
  return { height: (c) => radius - center * c, slope: () => -center };
}

export function surfacesOf(shape) {
  return [shape].flat().map((one) => KINDS[one.kind](one));
}

// The number of the surface that reaches lowest at a tilt.
export function lowest(surfaces, c) {
  let best = 0;
  for (let i = 1; i < surfaces.length; i++) {
    if (surfaces[i].height(c) > surfaces[best].height(c)) best = i;
  }
  return best;
}
