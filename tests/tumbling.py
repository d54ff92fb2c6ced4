"""Bodies that turn uniformly about a horizontal axis in flight, and when they land, by their tilt
alone.
"""

import math
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from tippetop.mechanics.laws.friction import ViscousLaw
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.hull import Hull
from tippetop.mechanics.surfaces.surface import RingSurface, SphereSurface, SpheroidSurface
from tippetop.mechanics.top import Top

EDGES = {
    "edge": RingSurface(0.02),
    "edge of a face": RingSurface(0.02, -0.002),
    "tube": RingSurface(0.02, 0.001, 0.004),
}


def reach(shape, tilt):
    """How far below the centre of mass a body reaches at any tilt, beyond pi too: of its lowest
    point.
    """
    sine, cosine = np.abs(np.sin(tilt)), np.cos(tilt)
    match shape:
        case RingSurface(radius, center, tube):
            return tube + radius * sine - center * cosine
        case SphereSurface(radius, center):
            return radius - center * cosine
        case SpheroidSurface(across, along, center):
            return np.hypot(across * sine, along * cosine) - center * cosine
        case Hull(units, sizes):
            pairs = zip(units, sizes, strict=True)
            return np.max([size * reach(unit, tilt) for unit, size in pairs], axis=0)


class Tumbling(NamedTuple):
    """A body that turns uniformly about a horizontal axis while its centre of mass is on a
    parabola.
    """

    shape: object
    tilt: float
    rate: float
    up: float
    rise: float
    azimuth: float

    @property
    def thrown(self):
        """The top, and the state in which it is thrown."""
        top = Top.of(0.02, 3.0e-6, 3.3e-6, self.shape, ViscousLaw(0.3), 9.8)
        east, north = math.cos(self.azimuth), math.sin(self.azimuth)
        axis = (math.sin(self.tilt) * east, math.sin(self.tilt) * north, math.cos(self.tilt))
        swing = top.transverse_inertia * self.rate
        height = float(reach(self.shape, self.tilt)) + self.up
        return top, State(axis, (-swing * north, swing * east, 0.0), (0.1, 0.2, self.rise), height)

    def gap(self, time):
        """The gap at a time, or times."""
        z = reach(self.shape, self.tilt) + self.up + self.rise * time - 4.9 * time**2
        return z - reach(self.shape, self.tilt + self.rate * time)

    @property
    def landing(self):
        """The first zero of the gap after its start, between looks that are too near for two."""
        last = (self.rise + math.sqrt(self.rise**2 + 19.6 * (self.up + 0.1))) / 9.8
        looks = np.linspace(0.0, last, 40_001)[1:]
        first = np.flatnonzero(self.gap(looks) <= 0.0)[0]
        return (
            brentq(self.gap, looks[first - 1], looks[first], xtol=1e-16, rtol=1e-15)
            if first
            else 0.0
        )

    @property
    def highest(self):
        """The highest gap until it lands, among looks, and where it passes the poles."""
        turned = self.rate * self.landing
        first, last = sorted((self.tilt, self.tilt + turned))
        poles = np.arange(math.ceil(first / math.pi), math.floor(last / math.pi) + 1) * math.pi
        looks = np.concatenate(
            [np.linspace(0.0, self.landing, 20_001), (poles - self.tilt) / self.rate]
        )
        return self.gap(looks).max()
