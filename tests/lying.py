"""Bodies that lie on two unlike spheres."""

import numpy as np

import tippetop as tt

R = 0.02
"""Their size, m."""


def lying(seed: int) -> tt.Problem:
    """A body on two unlike spheres that rolls, slides and turns."""
    random = np.random.default_rng(seed)
    (r1, r2), z1, z2 = R * random.uniform(0.3, 1, 2), *(R * random.uniform(0.9, 1.8, 2))
    I1 = random.uniform(0.3, 1) * R**3
    body = tt.Body(
        mass=0.02,
        shape=[tt.Sphere(radius=r1, center=z1), tt.Sphere(radius=r2, center=-z2)],
        I1=I1,
        I3=I1 * random.uniform(0.1, 1.2),
    )
    friction = tt.CoulombFriction(mu=random.uniform(0.05, 0.6))
    launch = tt.Launch(
        tilt=float(np.arccos((r1 - r2) / (z1 + z2))),
        spin=random.uniform(-60, 60),
        precession=random.uniform(-8, 8),
        velocity=(*random.uniform(-0.3, 0.3, 2).tolist(), 0.0),
    )
    return tt.Problem(body=body, friction=friction, launch=launch)


def resisted(seed: int) -> tt.Problem:
    """One of them, with some resistance to rolling."""
    arm = R * 10.0 ** np.random.default_rng(seed).uniform(-2.5, -0.5)
    return lying(seed).model_copy(update={"rolling_resistance": arm})
