"""Better tops: a bowl with a stem that turns over at less spin, or sooner, or stands longer."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import product
from typing import Literal

import numpy as np
from scipy.optimize import brentq

from tippetop.fit.standing import (
    DRILLING,
    FALLEN,
    LONGEST_RISE,
    above_upside_down,
    least_standing_spin,
    stands,
)
from tippetop.integrators.base import Array
from tippetop.lathe.design import LONGEST, bowl_with_stem, rim_height
from tippetop.lathe.materials import material_density
from tippetop.lathe.workpiece import Workpiece
from tippetop.problem.bodies import Body
from tippetop.problem.frictions import Friction
from tippetop.problem.launch import Launch
from tippetop.problem.problem import Problem, top_of
from tippetop.problem.shapes import Sphere
from tippetop.run import simulate
from tippetop.support.errors import Described, InvalidInput, is_number
from tippetop.support.suggestions import not_one_of
from tippetop.support.units import positive_in
from tippetop.theory.advice import standing_spin
from tippetop.theory.prospects import Prospects, prospects
from tippetop.theory.requirements import sticks

GOALS = ("lowest spin", "fastest", "stands longest")

GRID = (5, 8, 3)
"""Walls, tips and stems that are tried by theory before the best of them are improved."""

STARTS = 3
"""Places of the grid that are improved by theory: its least spin has several minima, and edges at
which the kind of motion changes."""

ENTRANTS = 14
"""Places of the grid whose runs are followed beside those."""

DEFAULT_DENSITY = 700.0
"""Density of the material where nobody states one, kg/m^3."""

SHORTEST_TIP = 1.05
"""Least height of the stem's end over the sphere's centre, in radii."""

THICKEST_STEM = 0.35
"""Largest radius of the stem, in radii of the sphere: then its inside still is a bowl."""

FASTER = 1.3
"""Spin of the launches that the time of turning over is asked of, over the least that does, where
nobody says: at the least spin the last part of the rise takes for ever.
"""

MICROMETRE = 1e-6
"""Digits of the sizes, m: finer than any lathe or printer. A body made of rounded sizes is
recognized when it is improved again."""

GAIN = 0.02
"""Least relative gain for which runs are followed: less is not worth their time."""

STEPS_BY_THEORY, STEPS_BY_RUNS = (0.08, 0.03, 0.01, 0.003), (0.04, 0.012)
"""Steps of the two searches, in ranges of the sizes."""

TRIALS_BY_THEORY = 100
"""Most bodies that the search by theory tries from a start."""

HARDER = 1.08
"""Ratio of the spins, one after the other, at which runs of the entrants are followed until one of
them stands."""

SURELY = (1.0, 1.05, 1.15, 1.3)
"""Ratios to a spin at which runs must stand before a body counts as better."""

LONGEST_STAND = 60.0
"""Seconds up to which it is measured how long a top stands."""


@dataclass(frozen=True)
class ImprovedTop:
    """A top that meets a goal better, as a body and as what a lathe or a printer makes.

    Examples
    --------
    >>> import tippetop as tt
    >>> piece = tt.design_bowl(radius=0.015, density=700.0, eccentricity=0.15, inertia_ratio=1.2)
    >>> sizes = {"radius": 0.015, "wall": 1e-3, "stem": 1.5e-3, "tip": 0.02}
    >>> body, none = tt.Body.turned(piece), float("inf")
    >>> top = tt.ImprovedTop(body, piece, "lowest spin", spin=150.0, before=none, sizes=sizes)
    >>> print(str(top).splitlines()[0])
    lowest spin: turns over and stands from 150 rad/s (before: no spin that was tried)
    >>> top = tt.ImprovedTop(body, piece, "fastest", 150.0, none, sizes, 195.0, 1.84, none)
    >>> print(str(top).splitlines()[0])
    fastest: turns over in 1.84 s from 195 rad/s (before: does not stand from it)
    """

    body: Body
    """Mass, moments of inertia and surfaces of the solid."""
    workpiece: Workpiece
    """The solid: `tippetop.write_solid` writes it for a printer."""
    goal: str
    """What was improved."""
    spin: float
    """Least spin of launches from which runs turn over and stand, rad/s: they come within 0.1 rad
    of upside down within 20 s, and so do runs from more spin, up to half as much again.
    """
    before: float
    """The same of the body that it was made from; inf if that does not turn over."""
    sizes: dict[str, float]
    """Lengths of the solid, m: radius, wall, stem (its radius) and tip (height of its end over the
    sphere's centre).
    """
    launch_spin: float = math.nan
    """Spin of the launches of which the time was asked, rad/s; NaN where the goal is the lowest."""
    seconds: float = math.nan
    """Time after which a run from that spin has turned over, s, or for which it stands, by the
    goal; NaN where the goal is the lowest spin."""
    seconds_before: float = math.nan
    """The same of the body that it was made from; inf for "fastest" and 0 for "stands longest" if
    that does not stand from this spin."""

    def __str__(self) -> str:
        lengths = ", ".join(f"{name} {1e3 * size:.3g} mm" for name, size in self.sizes.items())
        spin, before = (
            f"{number:.4g} rad/s" if math.isfinite(number) else "no spin that was tried"
            for number in (self.spin, self.before)
        )
        stands = f"turns over and stands from {spin} (before: {before})"
        lines = [f"{self.goal}: {stands}", f"{lengths}; mass {1e3 * self.body.mass:.3g} g"]
        if self.goal != "lowest spin":
            verb = "turns over in" if self.goal == "fastest" else "stands for"
            stood = 0.0 < self.seconds_before < math.inf
            shown = f"{self.seconds_before:.3g} s" if stood else "does not stand from it"
            lines[0] = f"{verb} {self.seconds:.3g} s from {self.launch_spin:.4g} rad/s"
            lines[0] = f"{self.goal}: {lines[0]} (before: {shown})"
            lines.insert(1, stands)
        return "\n".join(lines)


def improve(
    body: Body | Workpiece,
    goal: Literal["lowest spin", "fastest", "stands longest"] = "lowest spin",
    *,
    friction: Friction | None = None,
    spin: float | None = None,
    density: float | str | None = None,
    mass: float | None = None,
    radius: float | None = None,
    wall: float = 1e-3,
    stem: float = 1.5e-3,
    tilt: float = 0.1,
    gravity: float = 9.8,
    whole: bool = False,
    trials: int = 20,
) -> ImprovedTop:
    """Return a top like a body that meets a goal better: a bowl with a stem that can be made.

    Theory proposes the thickness of the bowl, and the radius and length of the stem. Runs improve
    them further and decide: what the result claims was seen in runs with this friction. A result
    that is improved again is not worse afterwards.

    Parameters
    ----------
    body
        The top to begin with. It lies on a sphere, its centre of mass below the centre of that.
    goal
        "lowest spin": it turns over and stands from the least spin; "fastest": it turns over
        soonest from a spin; "stands longest": it stands on its stem for the longest time, from a
        spin.
    friction
        Friction of the runs: a law with creep; None for a patch of 0.5 mm with mu = 0.3.
    spin
        Spin of the launches of the other two goals, rad/s; None for 1.3 times the least.
    density
        Density of the material, kg/m^3, or its name, such as "beech" or "PLA 20 %"; None for that
        of the workpiece, or for 700 kg/m^3 where a `Body` is stated.
    mass, radius
        The largest mass, kg, and radius of the sphere, m; None for any mass, and the body's radius.
    wall, stem
        The least thickness of the bowl and radius of the stem, m.
    tilt, gravity
        Tilt of the launches, rad, and gravity, m/s^2.
    whole
        Accept incomplete surfaces of a workpiece as `Body.turned` does.
    trials
        Most bodies that are tried by runs around the best of the first; with 0, the best by theory
        is taken, and only its spin is measured by runs.

    Raises
    ------
    InvalidInput
        If the body is no such top, the friction has no creep, no such solid meets the bounds, or a
        spin is stated for the lowest spin.

    Examples
    --------
    A minute or two of runs:

    .. code-block:: python

        better = tt.improve(tt.presets.FRIEDL)  # which stands from no spin
        print(better)
        tt.write_solid(better.workpiece, "better.stl")

    Only tops of the kind are improved:

    >>> import tippetop as tt
    >>> tt.improve(tt.presets.COIN)
    Traceback (most recent call last):
        ...
    tippetop.support.errors.InvalidInput: body: a body that lies on a ring is no tippe top: friction
    does not raise it (write a top that lies on a sphere, its centre of mass between its centre and
    the table)
    """
    if goal not in GOALS:
        raise not_one_of("goal", goal, GOALS)
    if not is_number(trials) or trials < 0 or trials != int(trials):
        raise InvalidInput("trials", trials, "a whole number, 0 or more")
    if not isinstance(body, (Body, Workpiece)):
        raise InvalidInput("body", body, "a Body or a Workpiece, such as presets.REPORT")
    if spin is not None and goal == "lowest spin":
        fault = "has no effect where the goal is the lowest spin"
        raise InvalidInput("spin", spin, "", fault, "leave it out, or choose another goal")
    if density is None:
        density = body.density if isinstance(body, Workpiece) else DEFAULT_DENSITY
    by_name = material_density("density", density)
    density, wall = positive_in("density", by_name, "kg m-3"), positive_in("wall", wall, "m")
    stem, gravity = positive_in("stem", stem, "m"), positive_in("gravity", gravity, "m s-2")
    mass = None if mass is None else positive_in("mass", mass, "kg")
    radius = None if radius is None else positive_in("radius", radius, "m")
    spin = None if spin is None else positive_in("spin", spin, "rad s-1")
    tilt = positive_in("tilt", tilt, "rad")
    law = DRILLING if friction is None else friction
    start = Body.turned(body, whole=whole) if isinstance(body, Workpiece) else body
    _require_top(start, gravity, tilt)
    size = start.shapes[0].surface.size if radius is None else radius
    problem = Problem(body=start, friction=law, launch=Launch(tilt=tilt, spin=1.0), gravity=gravity)
    if sticks(top_of(problem)):
        raise InvalidInput(
            "friction",
            Described("dry friction of a point"),
            "viscous, regularized or Contensou friction, by which slip never ends while the top"
            " spins; on this one it sticks, and rolls for ever without turning over",
        )
    family = BowlFamily(round_to_picometre(size), density, wall, stem, mass, gravity, tilt)
    proposed = family.proposals(ENTRANTS if trials else 0)
    present = family.sizes_of(start)
    trial = Trial(family, problem, goal)
    before = least_standing_spin(problem)
    if goal != "lowest spin":
        least = trial.least_spin(proposed[0]) if spin is None else math.nan
        trial.spin = FASTER * least if spin is None else spin
    if goal == "stands longest":
        by_theory = family.improved(proposed[0], lambda at: -family.standing_time(at, trial.spin))
        proposed.insert(0, by_theory)
    best = trial.best_of(proposed, trials)
    if present is not None and trial.value(present) <= trial.value(best):
        best = present
    workpiece = family.workpiece(best)
    values = (math.nan, math.nan)
    if goal != "lowest spin":
        values = (trial.value(best), trial.measured(problem))
    if goal == "stands longest":
        values = (-values[0], max(-values[1], 0.0))
    return ImprovedTop(
        Body.turned(workpiece),
        workpiece,
        goal,
        trial.least_spin(best),
        before,
        {"radius": family.radius, **dict(zip(("wall", "tip", "stem"), best.tolist(), strict=True))},
        trial.spin,
        *values,
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

    def sizes_of(self, body: Body) -> Array | None:
        """Return wall, tip and stem of a body of this family; None for other bodies."""
        first, last = body.shapes[0], body.shapes[-1]
        if len(body.shapes) != 2 or not isinstance(first, Sphere) or not isinstance(last, Sphere):
            return None
        stem, tip = last.radius, last.center - first.center + last.radius

        def excess(wall: float) -> float:
            return self._mass(np.array([wall, tip, stem])) - body.mass

        rim = math.hypot(rim_height(self.radius, stem, tip), stem + self.least_wall)
        ends = (self.low[0] - MICROMETRE, self.radius - rim)
        if not tip > self.radius > stem or not excess(ends[0]) < 0.0 < excess(ends[1]) < math.inf:
            return None
        at = rounded(np.array([brentq(excess, *ends), tip, stem]))
        if np.any(self.margins(at) <= 0.0) or np.any(at < self.low - 0.5 * MICROMETRE):
            return None
        same = self.body(at)
        pairs = ((same.mass, body.mass), (same.I1, body.I1), (same.I3, body.I3))
        return at if all(math.isclose(*pair, rel_tol=1e-9) for pair in pairs) else None

    def spin(self, at: Array) -> float:
        """Return the least spin from which theory lets it turn over and stand, rad/s; inf for
        none.

        Theory leaves out what the top loses while sphere and stem both touch.
        """
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

    def proposals(self, entrants: int) -> list[Array]:
        """Return sizes with little spin by theory, the least first, and some of the grid.

        Raises
        ------
        InvalidInput
            If no bowl within the bounds turns over.
        """
        axes = [np.linspace(0.02, 0.98, count) for count in GRID]
        grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(GRID))
        points = self.low + grid * (self.high - self.low)
        spins = np.array([self.spin(point) for point in points])
        if not np.any(np.isfinite(spins)):
            raise InvalidInput(
                "body",
                Described(f"a sphere of {1e3 * self.radius:.3g} mm with these bounds"),
                "a larger radius or mass, or a thinner wall or stem",
                "leaves no bowl with a stem that turns over",
            )
        order = [place for place in np.argsort(spins) if math.isfinite(spins[place])]
        improved = [self.improved(points[place], self.spin) for place in order[:STARTS]]
        others = [rounded(points[place]) for place in order[:entrants]]
        return [*sorted(improved, key=self.spin), *others]

    def improved(self, start: Array, value: Callable[[Array], float]) -> Array:
        """Return sizes near others at which a function of theory is least."""
        return pattern_search(
            lambda at, bound: value(at), rounded(start), self, STEPS_BY_THEORY, TRIALS_BY_THEORY
        )


def rounded(sizes: Array) -> Array:
    """Return sizes to the micrometre, m."""
    return np.round(sizes / MICROMETRE) * MICROMETRE


def round_to_picometre(size: float) -> float:
    """Return a length, m, without the rounding of the surfaces that were made from it."""
    return round(float(size), 12)


DIRECTIONS = [np.array(signs) / 2.0 for signs in product((-1.0, 0.0, 1.0), repeat=3) if any(signs)]
"""Directions of the search: along the sizes, and along those that change two or three of them."""


def pattern_search(
    value: Callable[[Array, float], float],
    start: Array,
    family: BowlFamily,
    steps: tuple[float, ...],
    trials: int,
) -> Array:
    """Return the sizes with the least value near others.

    It compares values only, for theory's least spin has edges at which it jumps, and runs decide
    whether a top stands.

    Parameters
    ----------
    value
        Function of the sizes, and of the least value so far, of which it need only be decided
        whether it is undercut.
    start
        The sizes to begin with.
    family
        Bodies and their bounds.
    steps
        Lengths of steps in ranges of the sizes, one after the other.
    trials
        Most sizes that are tried.
    """
    reach, best, least = family.high - family.low, start, value(start, math.inf)
    for step in steps:
        directions, failed = list(DIRECTIONS), 0
        while failed < len(directions) and trials > 0:
            direction = directions[failed]
            sizes = rounded(np.clip(best + step * direction * reach, family.low, family.high))
            if np.array_equal(sizes, best) or np.any(family.margins(sizes) <= 0.0):
                failed += 1
                continue
            trials -= 1
            number = value(sizes, least)
            if number < least:
                best, least = sizes, number
                directions.insert(0, directions.pop(failed))
                failed = 0
            else:
                failed += 1
    return best


class Trial:
    """Runs of bowls, by which one of them is chosen.

    Attributes
    ----------
    spin
        Spin of the launches, rad/s, of all goals but the lowest spin.
    """

    def __init__(self, family: BowlFamily, problem: Problem, goal: str) -> None:
        self.family, self.problem, self.goal, self.spin = family, problem, goal, math.nan
        self._values: dict[tuple[float, ...], float] = {}

    def launch(self, at: Array) -> Problem:
        """Return a launch of a bowl, with some spin."""
        return self.problem.model_copy(update={"body": self.family.body(at)})

    def least_spin(self, at: Array) -> float:
        """Return the least spin from which runs turn over and stand, rad/s; inf for none."""
        place = ("spin", *at.tolist())
        if place not in self._values:
            self._values[place] = least_standing_spin(self.launch(at))
        return self._values[place]

    def value(self, at: Array) -> float:
        """Return the number that is least for the best bowl; inf if the bowl does not stand."""
        if self.goal == "lowest spin":
            return self.least_spin(at)
        place = (self.goal, *at.tolist())
        if place not in self._values:
            self._values[place] = self.measured(self.launch(at))
        return self._values[place]

    def best_of(self, starts: list[Array], trials: int) -> Array:
        """Return the best of some bowls, or of those around it that are tried by runs."""
        if trials == 0:
            return starts[0]
        first, least = self._first_of(starts)
        return pattern_search(
            lambda at, bound: least if math.isinf(bound) else self._better_than(at, bound),
            first,
            self.family,
            STEPS_BY_RUNS,
            trials,
        )

    def _first_of(self, starts: list[Array]) -> tuple[Array, float]:
        """Return the best of some bowls, and a bound of its value."""
        if self.goal != "lowest spin":
            best = min(starts, key=self.value)
            return best, self.value(best)
        least = min(self.family.spin(at) for at in starts)
        spin = HARDER * least
        while spin < FASTER**4 * least:
            for at in starts:
                if stands_from(self.launch(at), spin):
                    return at, spin
            spin *= HARDER
        return starts[0], self.least_spin(starts[0])

    def _better_than(self, at: Array, bound: float) -> float:
        """Return a bound of a value that is less than another bound, or inf."""
        try:
            if self.goal != "lowest spin":
                return self.value(at)
            spin = (1.0 - GAIN) * bound
            return spin if stands_from(self.launch(at), spin) else math.inf
        except InvalidInput:  # There is no such solid.
            return math.inf

    def measured(self, problem: Problem) -> float:
        """Return the time of turning over of a launch, s, or minus that for which the top stands.

        The launch has the spin of all; the result is inf if the top does not stand from it.
        """
        if not stands_from(problem, self.spin):
            return math.inf
        launch = problem.replace({"launch.spin": self.spin})
        if self.goal == "fastest":
            run = simulate(launch, LONGEST_RISE, until=above_upside_down, samples=2)
            return float(run["turnover_time"])
        return -standing_duration(launch)


def stands_from(problem: Problem, spin: float) -> bool:
    """Return whether runs of a launch stand from some spins, rad/s, from the least on."""
    return all(stands(problem.replace({"launch.spin": spin * ratio})) for ratio in SURELY)


def standing_duration(problem: Problem) -> float:
    """Return for how long a run stands, s: how long its axis is within `FALLEN` of upside down."""
    crossing = "stands"
    run = simulate(
        problem,
        LONGEST_STAND,
        events={crossing: lambda state: state.axis[2] + math.cos(FALLEN)},
        samples=2,
    )
    times = run["event_time"].values[run["event_kind"].values == crossing].tolist()
    times += [float(run["end_time"])] * (len(times) % 2)
    return float(np.sum(np.diff(times)[::2]))
