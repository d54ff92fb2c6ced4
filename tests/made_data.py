"""Tops that rise, and the noise with which they are measured, for data made of runs."""

import numpy as np

import tippetop as tt

NOISES = {"tilt": np.radians(1.0), "turns a minute": 10.0, "time of turning over": 0.1}
"""Standard deviations of what is measured: rad, rpm, s."""


def rising_law(number, mu):
    """Return one of three laws that let the top rise."""
    return (
        tt.ViscousFriction(mu=mu),
        tt.RegularizedCoulombFriction(mu=mu, eps=0.1),
        tt.ContensouFriction(mu=mu, patch_radius=1e-3),
    )[number % 3]
