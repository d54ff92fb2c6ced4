"""Better tops: a bowl with a stem that turns over at less spin, or sooner, or stands longer."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from scipy.optimize import minimize

from tippetop.fit.sensitivities import sensitivities
from tippetop.integrators.base import Array
from tippetop.lathe.design import LONGEST, bowl_with_stem, rim_height
from tippetop.lathe.workpiece import Workpiece
from tippetop.problem.bodies import Body
from tippetop.problem.frictions import ContensouFriction, Friction
from tippetop.problem.launch import Launch
from tippetop.problem.problem import Problem, top_of
from tippetop.run import simulate
from tippetop.support.errors import Described, InvalidInput
from tippetop.support.suggestions import not_one_of
from tippetop.support.units import number_in
from tippetop.theory.advice import standing_spin
from tippetop.theory.prospects import Prospects, prospects
from tippetop.theory.requirements import sticks

GOALS = ("lowest spin", "fastest", "stands longest")

GRID = (4, 6, 2)
"""Walls, tips and stems that are tried before the best of them is improved."""

SHORTEST_TIP = 1.05
"""Least height of the stem's end over the sphere's centre, in radii."""

THICKEST_STEM = 0.35
"""Largest radius of the stem, in radii of the sphere: then its inside still is a bowl."""

FASTER = 1.3
"""Spin of the launches that the time of turning over is asked of, over the least that does, where
nobody says: at the least spin the last part of the rise takes for ever.
"""

LONGEST_RUN = 6.0
"""Seconds after which a top that has not turned over does not count as fast."""

SLOPE_STEP = 1e-5
"""Step, relative to the range of a size, of differences of theory's formulae and of masses."""

ITERATIONS, RUN_ITERATIONS = 12, 4
"""Steps of the search, by theory and by runs: the value hardly falls after them."""


@dataclass(frozen=True)
class ImprovedTop:
    """A top that meets a goal better, as a body and as what a lathe or a printer makes.

    Examples
    --------
    >>> import tippetop as tt
    >>> better = tt.improve(tt.presets.FRIEDL)
    >>> better.goal, sorted(better.sizes)
    ('lowest spin', ['radius', 'stem', 'tip', 'wall'])
    """

    body: Body
    """Mass, moments of inertia and surfaces of the solid."""
    workpiece: Workpiece
    """The solid: `tippetop.write_solid` writes it for a printer."""
    goal: str
    """What was improved."""
    spin: float
    """Least spin of launches from which theory lets it turn over and stand, rad/s."""
    before: float
    """The same of the body that it was made from; inf if that does not turn over."""
    sizes: dict[str, float]
    """Lengths of the solid, m: radius, wall, stem (its radius) and tip (height of its end over the
    sphere's centre).
    """

    def __str__(self) -> str:
        lengths = ", ".join(f"{name} {1e3 * size:.3g} mm" for name, size in self.sizes.items())
        before = f"{self.before:.4g} rad/s" if math.isfinite(self.before) else "no spin"
        return (
            f"{self.goal}: turns over and stands from {self.spin:.4g} rad/s (before: {before})\n"
            f"{lengths}; mass {1e3 * self.body.mass:.3g} g"
        )


def improve(
    body: Body | Workpiece,
    goal: Literal["lowest spin", "fastest", "stands longest"] = "lowest spin",
    *,
    friction: Friction | None = None,
    spin: float | None = None,
    density: float = 700.0,
    mass: float | None = None,
    radius: float | None = None,
    wall: float = 1e-3,
    stem: float = 1.5e-3,
    tilt: float = 0.1,
    gravity: float = 9.8,
) -> ImprovedTop:
    """Return a top like a body that meets a goal better: a bowl with a stem that can be made.

    The thickness of the bowl, and the radius and length of the stem, are found by the gradients of
    theory; for the fastest, by those of runs (see `tippetop.sensitivities`), which go through
    all their events.

    Parameters
    ----------
    body
        The top to begin with. It lies on a sphere, its centre of mass below the centre of that.
    goal
        "lowest spin": it turns over and stands from the least spin; "fastest": it turns over
        soonest from a spin; "stands longest": drilling friction takes longest to stop it on its
        stem, from a spin.
    friction
        Friction of the runs: a law with creep; None for a patch of 0.5 mm with mu = 0.3.
    spin
        Spin of the launches, rad/s; None for 1.3 times the least.
    density
        Density of the material, kg/m^3.
    mass, radius
        The largest mass, kg, and radius of the sphere, m; None for any mass, and the body's radius.
    wall, stem
        The least thickness of the bowl and radius of the stem, m.
    tilt, gravity
        Tilt of the launches, rad, and gravity, m/s^2.

    Raises
    ------
    InvalidInput
        If the body is no such top, the friction has no creep, or no such solid meets the bounds.

    Examples
    --------
    >>> import tippetop as tt
    >>> better = tt.improve(tt.presets.FRIEDL)  # which hangs at some tilt, whatever its spin
    >>> better.before, better.spin < 150.0
    (inf, True)
    """
    if goal not in GOALS:
        raise not_one_of("goal", goal, GOALS)
    law = ContensouFriction(mu=0.3, patch_radius=5e-4) if friction is None else friction
    start = Body.turned(body) if isinstance(body, Workpiece) else body
    _require_top(start, gravity, tilt)
    size = start.shapes[0].surface.size if radius is None else number_in("radius", radius, "m")
    problem = Problem(body=start, friction=law, launch=Launch(tilt=tilt, spin=1.0), gravity=gravity)
    if sticks(top_of(problem)):
        raise InvalidInput(
            "friction",
            Described("dry friction of a point"),
            "viscous, regularized or Contensou friction, by which slip never ends while the top"
            " spins; on this one it sticks, and rolls for ever without turning over",
        )
    family = BowlFamily(float(size), density, wall, stem, mass, gravity, tilt)
    best = family.least_spin()
    least = standing_spin(family.body(best), gravity, tilt)
    launched = FASTER * least if spin is None else float(number_in("spin", spin, "rad s-1"))
    if goal == "stands longest":
        best = family.improved(best, lambda at: -family.standing_time(at, launched))
    if goal == "fastest":
        launch = problem.replace({"launch.spin": launched})
        best = family.improved(best, *timed(family, launch))
    workpiece = family.workpiece(best)
    solid = Body.turned(workpiece)
    return ImprovedTop(
        solid,
        workpiece,
        goal,
        standing_spin(solid, gravity, tilt),
        standing_spin(start, gravity, tilt),
        {"radius": family.radius, **dict(zip(("wall", "tip", "stem"), best.tolist(), strict=True))},
    )


def _require_top(body: Body, gravity: float, tilt: float) -> None:
    """Refuse, with `InvalidInput`, a body that cannot turn over as a tippe top does."""
    if prospects(body, list(body.shapes), gravity, tilt) is None:
        kind = body.shapes[0].kind.replace("_", " ")
        shown = f"a body that lies on a {kind}"
        if kind == "sphere":
            shown = "a body that its sphere does not right"
        raise InvalidInput(
            "body",
            Described(shown),
            "a top that lies on a sphere, its centre of mass between its centre and the table",
            "is no tippe top: friction does not raise it",
        )


class BowlFamily:
    """Bowls with a stem of one sphere and material, by wall, tip and stem.

    Attributes
    ----------
    radius
        Radius of the sphere, m.
    low, high
        Bounds of wall, tip and stem, m.
    """

    def __init__(
        self,
        radius: float,
        density: float,
        wall: float,
        stem: float,
        mass: float | None,
        gravity: float,
        tilt: float,
    ) -> None:
        self.radius, self.density, self.mass = radius, density, mass
        self.gravity, self.tilt, self.least_wall = gravity, tilt, wall
        self.low = np.array([wall, SHORTEST_TIP * radius, stem])
        self.high = np.array([0.9 * radius, LONGEST * radius, THICKEST_STEM * radius])
        if not np.all(self.low < self.high):
            raise InvalidInput(
                "wall, stem", (wall, stem), "less, or a larger radius", "are too thick for it"
            )

    def workpiece(self, at: Array) -> Workpiece:
        """Return the solid."""
        wall, tip, stem = at.tolist()
        return bowl_with_stem(
            self.radius, self.density, stem=stem, tip=tip, hollow=self.radius - wall
        )

    def body(self, at: Array) -> Body:
        """Return the body."""
        return Body.turned(self.workpiece(at))

    def margins(self, at: Array) -> Array:
        """Return numbers that are positive where the bowl is open and the mass is within bounds."""
        wall, tip, stem = at.tolist()
        face = rim_height(self.radius, stem, tip)
        opening = (self.radius - wall) - math.hypot(face, stem + self.least_wall)
        rows = [opening / self.radius]
        if self.mass is not None:
            rows.append(1.0 - self._mass(at) / self.mass if opening > 0.0 else -1.0)
        return np.array(rows)

    def _mass(self, at: Array) -> float:
        try:
            return self.workpiece(at).mass_properties.mass
        except (InvalidInput, ValueError):
            return math.inf

    def spin(self, at: Array) -> float:
        """Return the least spin from which it turns over and stands, rad/s; inf for none."""
        if np.any(self.margins(at) <= 0.0):
            return math.inf
        try:
            return standing_spin(self.body(at), self.gravity, self.tilt)
        except InvalidInput:
            return math.inf

    def standing_time(self, at: Array, spin: float) -> float:
        """Return how long drilling takes to stop it on its stem, up to a factor of all such tops.

        A torque that is the same for every top of a weight, over m, takes away the spin that it has
        above the least that holds it; what it has of spin on its stem grows with the launch's.
        """
        ahead = self._prospects(at)
        if ahead is None or ahead.stem is None or not math.isfinite(ahead.stem.launch):
            return -math.inf
        body = self.body(at)
        excess = spin / ahead.stem.launch - 1.0
        return body.I3 / body.mass * ahead.stem.spin * excess

    def _prospects(self, at: Array) -> Prospects | None:
        if np.any(self.margins(at) <= 0.0):
            return None
        try:
            body = self.body(at)
            return prospects(body, list(body.shapes), self.gravity, self.tilt)
        except InvalidInput:
            return None

    def least_spin(self) -> Array:
        """Return the sizes with the least spin.

        Raises
        ------
        InvalidInput
            If no bowl within the bounds turns over.
        """
        axes = [np.linspace(0.02, 0.98, count) for count in GRID]
        grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(GRID))
        points = self.low + grid * (self.high - self.low)
        spins = [self.spin(point) for point in points]
        best = int(np.argmin(spins))
        if not math.isfinite(spins[best]):
            raise InvalidInput(
                "body",
                Described(f"a sphere of {1e3 * self.radius:.3g} mm with these bounds"),
                "a larger radius or mass, or a thinner wall or stem",
                "leaves no bowl with a stem that turns over",
            )
        return self.improved(points[best], self.spin)

    def improved(
        self,
        start: Array,
        value: Callable[[Array], float],
        gradient: Callable[[Array], Array] | None = None,
    ) -> Array:
        """Return the sizes with the least value near others, within all bounds."""
        reach, first = self.high - self.low, value(start)
        scale = abs(first) or 1.0
        tried: list[tuple[float, Array]] = [(first, start)]

        def scaled(at: Array) -> float:
            sizes = self.low + at * reach
            number = value(sizes)
            if not math.isfinite(number):
                return 10.0
            if np.all(self.margins(sizes) > 0.0):
                tried.append((number, sizes))
            return number / scale

        def slopes(at: Array) -> Array:
            if gradient is not None:
                return np.asarray(gradient(self.low + at * reach) * reach / scale)
            ends = [at + sign * SLOPE_STEP * row for row in np.eye(len(at)) for sign in (1.0, -1.0)]
            numbers = np.array([value(self.low + end * reach) for end in ends]).reshape(-1, 2)
            changes = (numbers[:, 0] - numbers[:, 1]) / (2.0 * SLOPE_STEP * scale)
            return np.asarray(np.nan_to_num(changes, posinf=0.0, neginf=0.0))

        search: Any = minimize  # Its annotations know no constraints of an array of numbers.
        search(
            scaled,
            (start - self.low) / reach,
            jac=slopes,
            method="SLSQP",
            bounds=[(0.0, 1.0)] * len(start),
            constraints={
                "type": "ineq",
                "fun": lambda at: self.margins(self.low + at * reach) - 1e-6,
            },
            options={"maxiter": ITERATIONS if gradient is None else RUN_ITERATIONS, "ftol": 1e-5},
        )
        return min(tried, key=lambda pair: pair[0])[1]


def timed(
    family: BowlFamily, problem: Problem
) -> tuple[Callable[[Array], float], Callable[[Array], Array]]:
    """Return the time of turning over as a function of the sizes, and its gradient."""

    def launched(at: Array) -> Problem | None:
        if np.any(family.margins(at) <= 0.0):
            return None
        try:
            return problem.model_copy(update={"body": family.body(at)})
        except InvalidInput:
            return None

    def time(at: Array) -> float:
        launch = launched(at)
        if launch is None or family.spin(at) > launch.launch.spin:
            return math.inf
        run = simulate(launch, LONGEST_RUN, until=lambda state: state.axis[2], samples=2)
        return float(run["end_time"]) if run.attrs["status"] == "stopped" else math.inf

    def gradient(at: Array) -> Array:
        launch, end = launched(at), time(at)
        if launch is None or not math.isfinite(end):
            return np.zeros(len(at))
        fields = fields_of(launch)
        slopes = sensitivities(launch, 1.05 * end, fields, samples=2)["turnover_time"].values
        reach = family.high - family.low
        rows = np.zeros(len(at))
        for place in range(len(at)):
            step = np.zeros(len(at))
            step[place] = SLOPE_STEP * reach[place]
            up, down = (launched(at + sign * step) for sign in (1.0, -1.0))
            if up is not None and down is not None:
                moved = [float(up.get(name)) - float(down.get(name)) for name in fields]
                rows[place] = np.nan_to_num(slopes) @ np.array(moved) / (2.0 * step[place])
        return rows

    return time, gradient


def fields_of(problem: Problem) -> list[str]:
    """Return the fields of a turned body that move with its sizes."""
    names = ["body.mass", "body.I1", "body.I3"]
    several = len(problem.body.shapes) > 1
    for place, shape in enumerate(problem.body.shapes):
        prefix = f"body.shape.{place}" if several else "body.shape"
        names += [f"{prefix}.{name}" for name in ("radius", "center") if hasattr(shape, name)]
    return names
