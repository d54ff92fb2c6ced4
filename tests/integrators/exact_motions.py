"""Motions whose solutions are known in closed form, and every integrator with the error it may
make.
"""

import itertools
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from page_method import PageMethod
from scipy.optimize import brentq

from tippetop.integrators import Arc, Integrator, Motion, make_integrator
from tippetop.integrators.dense import DenseSolution
from tippetop.mechanics.vectors import cross


@dataclass(frozen=True)
class Method:
    """An integrator, and what bounds its error in one step: a tolerance, or the step."""

    label: str
    integrator: Integrator
    tolerance: float | None = None
    step: float | None = None

    def allowed(self, arc, exact):
        """Error that may have gathered over an arc: each step's error, carried along and added up.

        Error estimates are estimates, which the factor of ten grants them.
        """
        # A step of the classical method leaves out the terms of the series from (rate h)^5 / 5! on.
        per_step = (exact.rate * self.step) ** 5 / 120 if self.step else self.tolerance
        return 10.0 * (1 + arc.steps) * per_step * exact.sensitivity


def _adaptive(name, tolerance):
    return Method(f"{name}-{tolerance:g}", make_integrator(name, tolerance), tolerance)


STEP = 0.01
CLASSICAL = Method("rk4", make_integrator("rk4", step=STEP), step=STEP)
EPS = float(np.finfo(float).eps)
DEFAULTS = [
    _adaptive("taylor", EPS),
    _adaptive("collocation", 1e-13),
    _adaptive("dop853", 1e-12),
    _adaptive("rk45", 1e-10),
    _adaptive("radau", 1e-9),
    _adaptive("bdf", 1e-9),
    _adaptive("lsoda", 1e-11),
    CLASSICAL,
    Method("page-1e-13", PageMethod(), 1e-13),
]
LOOSE = [
    *[_adaptive(method.integrator.name, 1e-6) for method in DEFAULTS[:-2]],
    Method("page-1e-06", PageMethod(1e-6), 1e-6),
]


def whole(arcs):
    """Arcs that follow one another, put together."""
    arcs = list(arcs)
    for before, after in itertools.pairwise(arcs):
        assert (before.guard, before.failure) == (None, None)
        assert after.solution.knots[0] == before.solution.end
    return Arc(
        DenseSolution.joined([arc.solution for arc in arcs]),
        arcs[-1].end_state,
        arcs[-1].guard,
        arcs[-1].failure,
        sum(arc.steps for arc in arcs),
        sum(arc.evaluations for arc in arcs),
    )


def follow(method, exact, guards=(), **changes):
    """Follow an exact motion, or a variant of it, to its end or a guard; return all of it as one
    arc.
    """
    exact = replace(exact, **changes)
    motion = replace(exact.motion, guards=tuple(guards))
    return whole(method.integrator.integrate(motion, exact.parameters, exact.start, exact.end))


@cache
def followed(method, exact):
    """Return the arc of an exact motion to its end; several tests look at the same arcs."""
    return follow(method, exact)


@dataclass(frozen=True)
class ExactMotion:
    """Equations of motion, a start, and the state at any time.

    `sensitivity` is how many times larger an error can be at the end than where it was made, and
    `rate` how fast the motion changes where it is fastest.
    """

    label: str
    motion: Motion
    parameters: tuple[float, ...]
    end: float
    state: Callable[[float], np.ndarray]
    sensitivity: float
    rate: float = 1.0

    @property
    def start(self):
        return 0.0, self.state(0.0)

    def states(self, times):
        return np.array([self.state(time) for time in times]).reshape(-1, self.motion.size)


FREQUENCY = 1.7
OSCILLATOR = ExactMotion(
    "oscillator",
    Motion(lambda y, p: (y[1], -(p[0] ** 2) * y[0]), size=2, parameters=1),
    (FREQUENCY,),
    end=5.0,
    state=lambda t: np.array([np.cos(FREQUENCY * t), -FREQUENCY * np.sin(FREQUENCY * t)]),
    sensitivity=FREQUENCY,
    rate=FREQUENCY,
)

GRAVITY = 9.8
FALL = ExactMotion(
    "free fall",
    Motion(lambda y, p: (y[1], -p[0] + 0.0 * y[0]), size=2, parameters=1),
    (GRAVITY,),
    end=1.0,
    state=lambda t: np.array([3.0 - GRAVITY * t**2 / 2, -GRAVITY * t]),
    sensitivity=GRAVITY,  # the size of the numbers, to which the tolerance is relative
)

DECAY = ExactMotion(
    "decay",
    Motion(lambda y, p: (-p[0] * y[0],), size=1, parameters=1),
    (0.8,),
    end=3.0,
    state=lambda t: np.array([np.exp(-0.8 * t)]),
    sensitivity=1.0,
)

ECCENTRICITY = 0.5


def _on_ellipse(t):
    """Position and velocity on an ellipse of semi-major axis 1 about a centre of attraction 1."""
    e = ECCENTRICITY
    anomaly = brentq(lambda E: E - e * np.sin(E) - t, t - 1.0, t + 1.0, xtol=1e-15, rtol=1e-15)
    width, rate = np.sqrt(1.0 - e**2), 1.0 / (1.0 - e * np.cos(anomaly))
    return np.array(
        [
            np.cos(anomaly) - e,
            width * np.sin(anomaly),
            -np.sin(anomaly) * rate,
            width * np.cos(anomaly) * rate,
        ]
    )


def _attraction(y, p):
    distance = (y[0] ** 2 + y[1] ** 2) ** 0.5
    return y[2], y[3], -p[0] * y[0] / distance**3, -p[0] * y[1] / distance**3


KEPLER = ExactMotion(
    "Kepler",
    Motion(_attraction, size=4, parameters=1),
    (1.0,),
    end=7.0,
    state=_on_ellipse,
    # An error dE of the energy shifts the phase by 3/2 a dE t. Where the centre is nearest, at 1 -
    # e, a shift of the phase moves the velocity by (1 - e)^-2 and an error of position the energy
    # by as much.
    sensitivity=1.5 * 2.0 * 7.0 / (1.0 - ECCENTRICITY) ** 4,
    rate=(1.0 - ECCENTRICITY) ** -1.5,
)

INERTIA = 0.4
MOMENTUM = np.array([0.3, -0.2, 1.1])
AXIS = np.array([0.6, 0.0, 0.8])


def _about_momentum(t):
    """The axis of a free symmetric top, turned about the constant angular momentum at the rate L /
    I1.
    """
    size = np.linalg.norm(MOMENTUM)
    unit, angle = MOMENTUM / size, size * t / INERTIA
    along = unit * (unit @ AXIS)
    return along + np.cos(angle) * (AXIS - along) + np.sin(angle) * np.cross(unit, AXIS)


FREE_TOP = ExactMotion(
    "free top",
    Motion(
        lambda n, p: tuple(rate / p[3] for rate in cross((p[0], p[1], p[2]), n)),
        size=3,
        parameters=4,
    ),
    (*MOMENTUM, INERTIA),
    end=4.0,
    state=_about_momentum,
    sensitivity=1.0,
    rate=float(np.linalg.norm(MOMENTUM)) / INERTIA,
)

EXACT = [OSCILLATOR, FALL, DECAY, KEPLER, FREE_TOP]
