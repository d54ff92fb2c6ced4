"""Steady rolling without slip: circles of the centre of mass, straight lines, and turning in place.

The axis turns about the vertical at the rate phi' with constant tilt and axial spin omega3, and the
centre of mass goes round a circle of radius rho at the same rate. Let P = h' s^2 + h c and Q = h -
h' c, with c = cos(theta), s = sin(theta) and the support function h(c). Without slip

    rho = s (P - (omega3 / phi') Q),

positive where the centre of mass lies from the middle as the axis leans. The table bears the
weight, its friction m phi'^2 rho turns the velocity, and the moments about the centre of mass are
balanced where

    phi' omega3 (I3 + m h Q) - phi'^2 (I1 c + m h P) = m g h'.

Two of tilt, phi', omega3 and rho determine the others. Where h' = 0 the body rolls straight, phi' =
0, at any spin. A sharp tip (Q = 0, P its distance from the centre of mass) gives the steady
precessions of the heavy top. Friction must be able to stick, with a coefficient of at least phi'^2
rho / g.
"""

import math
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np
from scipy.linalg import null_space

from tippetop.integrators.base import Array
from tippetop.mechanics.contacts.contact_point import ContactPoint
from tippetop.mechanics.contacts.forces import slip_reserve
from tippetop.mechanics.contacts.sticking import sticking_forces
from tippetop.mechanics.contacts.wrench import Wrench
from tippetop.mechanics.invariants import energy, jellett
from tippetop.mechanics.laws.friction import NO_TORQUE
from tippetop.mechanics.motion import axis_rate, on_table
from tippetop.mechanics.roots import crossing
from tippetop.mechanics.surfaces.hull import each_surface, is_edge
from tippetop.mechanics.top import Top, natural, natural_units
from tippetop.mechanics.vectors import Scalar
from tippetop.mechanics.view import Angles, state_from_angles
from tippetop.problem.problem import Problem, top_of
from tippetop.support.errors import MISSING, Described, InvalidInput, is_number, short
from tippetop.support.units import number_in
from tippetop.theory.derivatives import jacobian
from tippetop.theory.requirements import require_no_field, sticks
from tippetop.theory.series_roots import roots_between
from tippetop.theory.stability import TURNED, Complex, Spectrum
from tippetop.theory.steady import FASTEST, VERTICAL_SPINS, SteadyKind, SteadyState

ROUNDING = 1e-12
"""Relative size of a moment of the weight, of a radius and of a difference of heights that counts
as zero: above the rounding of a tilt, and far below what can be set.
"""

CLOSE = 1e-7
"""Distance from a root of a series, rad, within which the balance itself changes its sign: above
the error of the series, and below the distance of two motions.
"""

NEIGHBOURS = "the neighbouring steady states, of another spin and another rate"

UNITS = {"tilt": "rad", "rate": "rad s-1", "radius": "m", "spin": "rad s-1"}
"""The numbers of a steady motion that can be asked for, and their units."""


class SteadyMotion(NamedTuple):
    """Tilt, rad, rate about the vertical and axial spin, rad/s, of steady rolling."""

    tilt: float
    rate: float
    spin: float


class Levers(NamedTuple):
    """What the balance of moments needs of a body at a tilt, in its natural units."""

    sine: Scalar
    along: Scalar
    """P: radius of the circle over the sine, of a body without axial spin."""
    across: Scalar
    """Q: how much less that is for each omega3 / phi'."""
    spinning: Scalar
    """Moment for each phi' omega3."""
    turning: Scalar
    """Moment against it for each phi'^2."""
    weight: Scalar
    """Moment of the weight."""

    @classmethod
    def at(cls, sine: Scalar, cosine: Scalar, top: Top) -> "Levers":
        """Return the levers at a tilt."""
        height, slope = top.surface.height(cosine), top.surface.slope(cosine)
        along, across = slope * sine * sine + height * cosine, height - slope * cosine
        lever = top.mass * height
        return cls(
            sine,
            along,
            across,
            top.axial_inertia + lever * across,
            top.transverse_inertia * cosine + lever * along,
            top.mass * top.gravity * slope,
        )

    def imbalance(self, rate: Scalar, spin: Scalar) -> Scalar:
        """Return the moment that is not balanced at a rate and a spin."""
        return rate * spin * self.spinning - rate * rate * self.turning - self.weight

    def radius(self, motion: SteadyMotion) -> Scalar:
        """Return the radius of the circle, of whichever sign; infinite where the body rolls
        straight.
        """
        if motion.rate == 0.0:
            return math.inf
        return self.sine * (self.along - motion.spin / motion.rate * self.across)


def rolling_states(problem: Problem, **numbers: Any) -> list[SteadyState[float]]:
    """Return the steady states in which the contact rolls without slip, by increasing tilt.

    `numbers` are one or two of tilt, rate, radius and spin; beside one alone the centre of mass
    rests. Raises `InvalidInput` for others, and if the table cannot hold the contact.
    """
    asked = _checked(numbers)
    body = top_of(problem).body
    require_no_field(top_of(problem))
    states = []
    for top in body.contacts:
        if not top.torque_free:
            raise InvalidInput(
                "friction",
                Described("this law"),
                "one without torque, and no rolling resistance: both brake what rolls",
            )
        states += [
            _state(motion, top) for motion in _motions(asked, top) if _is_lowest(motion.tilt, top)
        ]
    return _held(sorted(states, key=lambda state: state.tilt), top_of(problem))


def _checked(numbers: dict[str, Any]) -> dict[str, float]:
    """Return the numbers asked for in natural order, SI; raise `InvalidInput` unless they are
    one or two that determine steady states.
    """
    asked: dict[str, float] = {}
    stated = {name: value for name, value in numbers.items() if value is not None}
    for name, value in stated.items():
        number = number_in(name, value, UNITS[name])
        if not is_number(number) and not (name == "radius" and number == math.inf):
            raise InvalidInput(name, value, "a finite number")
        asked[name] = float(number)
    if not 0.0 < asked.get("tilt", 1.0) < math.pi:
        raise InvalidInput("tilt", numbers["tilt"], "more than 0 and less than pi rad")
    if asked.get("radius", 0.0) < 0.0:
        raise InvalidInput("radius", numbers["radius"], "0 or more, in m")
    if asked.get("radius") == math.inf:
        if asked.get("rate", 0.0) != 0.0:
            raise InvalidInput(
                "rate",
                asked["rate"],
                "0, or a finite radius",
                "does not go with an infinite radius: the axis of a body that rolls straight keeps"
                " its direction",
            )
        asked = {**asked, "rate": 0.0}
        del asked["radius"]
    if asked.get("rate") == 0.0 and len(asked) < 3 and "spin" not in asked:
        raise InvalidInput(
            "spin", MISSING, "one: a body that rolls straight, at a rate of 0, does so at any spin"
        )
    if len(asked) == 1 and "radius" not in asked:
        asked["radius"] = 0.0
    if len(asked) != 2:
        raise InvalidInput(
            ", ".join(stated),
            Described(", ".join(map(short, stated.values()))),
            "two of tilt, rate, radius and spin, or one of tilt, rate and spin for a centre of mass"
            " that rests",
            "do not determine steady states" if len(asked) > 2 else "leaves the steady states open",
        )
    return asked


def _motions(asked: dict[str, float], top: Top) -> Iterator[SteadyMotion]:
    """Yield the steady motions on a surface with two of the four numbers, SI."""
    units, scaled = natural_units(top), natural(top)
    time, length = float(units.time), float(units.length)
    scales = {"tilt": 1.0, "rate": time, "radius": 1.0 / length, "spin": time}
    natural_numbers = {name: value * scales[name] for name, value in asked.items()}
    for radius in _signed(natural_numbers.get("radius")):
        for motion in _scaled_motions({**natural_numbers, **radius}, scaled):
            if max(abs(motion.rate), abs(motion.spin)) < FASTEST:
                yield SteadyMotion(motion.tilt, motion.rate / time, motion.spin / time)


def _signed(radius: float | None) -> tuple[dict[str, float], ...]:
    """Return a radius, and the same on the other side of the middle."""
    if radius is None:
        return ({},)
    return ({"radius": radius}, {"radius": -radius})[: 1 if radius == 0.0 else 2]


def _scaled_motions(asked: dict[str, float], top: Top) -> Iterator[SteadyMotion]:
    """Yield the steady motions with two of the four numbers, natural units."""
    names = set(asked)
    tilt, rate, spin = (asked.get(name, math.nan) for name in ("tilt", "rate", "spin"))
    radius = asked.get("radius", math.nan)
    on_spot = int(radius == 0.0)
    if names == {"tilt", "rate"}:
        yield _at_rate(tilt, rate, top)
    elif names == {"tilt", "spin"}:
        yield from _at_spin(tilt, spin, top)
    elif names == {"tilt", "radius"}:
        yield from _on_circle(tilt, radius, top)
    elif names == {"rate", "spin"}:
        for at in _tilts(lambda levers: levers.imbalance(rate, spin), top):
            yield SteadyMotion(at, rate, spin)
    elif names == {"rate", "radius"}:
        for at in _tilts(lambda levers: _circle_at_rate(levers, rate, radius), top, on_spot):
            yield _at_rate(at, rate, top)
    else:
        for at in _tilts(lambda levers: _circle_at_spin(levers, spin, radius), top, 2 * on_spot):
            levers = _levers(at, top)
            yield SteadyMotion(
                at, spin * levers.across / (levers.along - radius / levers.sine), spin
            )


def _at_rate(tilt: float, rate: float, top: Top) -> SteadyMotion:
    """Return the steady motion at a tilt with a rate other than 0."""
    levers = _levers(tilt, top)
    return SteadyMotion(
        tilt, rate, (levers.weight + rate * rate * levers.turning) / (rate * levers.spinning)
    )


def _at_spin(tilt: float, spin: float, top: Top) -> Iterator[SteadyMotion]:
    """Yield the slow and the fast steady motion at a tilt with a spin."""
    levers = _levers(tilt, top)
    weight = levers.weight if abs(levers.weight) > ROUNDING else 0.0
    driving = spin * levers.spinning
    square = driving * driving - 4.0 * levers.turning * weight
    if square < 0.0:
        return
    larger = 0.5 * (driving + math.copysign(math.sqrt(square), driving))
    if larger == 0.0:
        return
    yield SteadyMotion(tilt, weight / larger, spin)
    if abs(levers.turning) > ROUNDING:
        yield SteadyMotion(tilt, larger / levers.turning, spin)


def _on_circle(tilt: float, radius: float, top: Top) -> Iterator[SteadyMotion]:
    """Yield the steady motion at a tilt with phi' > 0 on a circle; that with phi' < 0 mirrors
    it.
    """
    levers = _levers(tilt, top)
    if levers.across == 0.0:
        raise InvalidInput(
            "radius",
            Described("this one"),
            "rate or spin beside a tilt: a sharp tip does not roll, and its tilt tells the radius",
        )
    ratio = (levers.along - radius / levers.sine) / levers.across
    moment = ratio * levers.spinning - levers.turning
    if levers.weight * moment > 0.0:
        rate = math.sqrt(levers.weight / moment)
        yield SteadyMotion(tilt, rate, ratio * rate)


def _circle_at_rate(levers: Levers, rate: float, radius: float) -> float:
    """Return what is zero where a motion at a rate is steady on a circle."""
    circling = (levers.along * levers.sine - radius) * levers.spinning
    braking = levers.sine * levers.across * (levers.turning + levers.weight / rate**2)
    return float(circling - braking)


def _circle_at_spin(levers: Levers, spin: float, radius: float) -> float:
    """Return what is zero where a motion at a spin is steady on a circle."""
    circling, across = levers.along * levers.sine - radius, levers.across * levers.sine
    moment = (circling * levers.spinning - across * levers.turning) * across
    return float(spin**2 * moment - levers.weight * circling**2)


def _levers(tilt: float, top: Top) -> Levers:
    return Levers.at(math.sin(tilt), math.cos(tilt), top)


def _tilts(balance: Callable[[Levers], float], top: Top, zeros: int = 0) -> list[float]:
    """Return the tilts, rad, at which a balance of moments vanishes.

    Of an edge it is infinite where the axis is vertical, as 1 / s; of a smooth surface it has some
    zeros there if the centre of mass rests, which are no motions.
    """
    edge = is_edge(top.surface)

    def regular(tilt: float) -> float:
        levers = _levers(tilt, top)
        return balance(levers) * float(levers.sine if edge else levers.sine**-zeros)

    tilts = []
    for at in roots_between(regular, 0.0, math.pi, ROUNDING**2):
        low, high = max(at - CLOSE, 0.5 * at), min(at + CLOSE, 0.5 * (at + math.pi))
        if (regular(low) < 0.0) != (regular(high) < 0.0):
            tilts.append(crossing(regular, low, high))
    return tilts


def _is_lowest(tilt: float, top: Top) -> bool:
    """Return whether the surface touches at a tilt, and no other does."""
    c = math.cos(tilt)
    least = top.surface.height(c) - ROUNDING * top.surface.size
    touching = [one for one in each_surface(top.body.surface) if one.height(c) >= least]
    return len(touching) == 1


def _state(motion: SteadyMotion, top: Top) -> SteadyState[float]:
    """Return a steady motion with its numbers, SI."""
    angles = Angles(motion.tilt, 0.0, 0.0, motion.rate, motion.spin, (0.0, 0.0))
    state = on_table(state_from_angles(angles, top, math), top)
    radius = abs(_levers(motion.tilt, top).radius(motion))
    spin = motion.spin if abs(motion.spin) > ROUNDING * abs(motion.rate) else 0.0
    kind = SteadyKind.STRAIGHT if motion.rate == 0.0 else SteadyKind.CIRCLE
    if radius <= ROUNDING * top.surface.size:
        kind, radius = SteadyKind.PRECESSION, 0.0
    friction = 0.0 if motion.rate == 0.0 else motion.rate**2 * radius / top.gravity
    numbers = (jellett(state, top), energy(state, top), radius, friction)
    return SteadyState(kind, motion.tilt, motion.rate, spin, *map(float, numbers))


def _held(states: list[SteadyState[float]], top: Top) -> list[SteadyState[float]]:
    """Return the states in which friction holds the contact; raise `InvalidInput` if it holds none.

    Where the centre of mass rests, or moves straight, friction is zero, under any law.
    """
    held = [state for state in states if state.friction == 0.0 or _holds(state.friction, top)]
    if states and not held:
        least = min(state.friction for state in states)
        if not sticks(top):
            raise InvalidInput(
                "friction",
                Described("this law"),
                "dry friction of a point",
                f"lets the contact slip, and a circle needs a force of {least:.4g} of the weight"
                " without slip",
            )
        raise InvalidInput(
            "friction", Described("this law"), f"one that holds {least:.4g} of the weight"
        )
    return held


def _holds(friction: float, top: Top) -> bool:
    """Return whether the contact can stick under this horizontal force over the weight."""
    if not sticks(top):
        return False
    weight = top.mass * top.gravity
    force = Wrench((friction * weight, 0.0, weight), NO_TORQUE)
    return bool(slip_reserve(top, force) >= 0.0)


def straight_spin(top: Top, tilt: float) -> float | None:
    """Return the spin, rad/s, above which a body that rolls straight stays upright on its edge.

    The result is that at the tilt nearest to `tilt`, rad, of those at which the body can roll
    straight, with the centre of mass above the contact point; None if there is none. It is 0 where
    the body does so stably at any spin, and inf where at none.

    Notes
    -----
    The square of the eigenvalue is linear in that of the spin: without rate, the only moment that
    restores the tilt is gyroscopic, of the spin and of the rate that it causes.
    """
    tilts = [
        (at, contact)
        for contact in top.body.contacts
        for at in _tilts(lambda levers: levers.weight, natural(contact))
        if _is_lowest(at, contact)
    ]
    if not tilts:
        return None
    at, contact = min(tilts, key=lambda pair: abs(pair[0] - tilt))
    unit = 1.0 / float(natural_units(contact).time)
    first, second = (
        float((_straight_eigenvalue(at, spin, contact) ** 2).real) for spin in (unit, 2.0 * unit)
    )
    steadying = (first - second) / 3.0
    toppling = first + steadying
    if toppling <= 0.0:
        return 0.0
    return unit * math.sqrt(toppling / steadying) if steadying > 0.0 else math.inf


def _straight_eigenvalue(tilt: float, spin: float, top: Top) -> complex:
    """Return an eigenvalue of straight rolling, 1/s."""
    state = _state(SteadyMotion(tilt, 0.0, spin), top)
    return complex(rolling_spectrum(state, top).eigenvalues[0])


def rolling_spectrum(state: SteadyState[float], top: Top) -> Spectrum:
    """Return the eigenvalues of the linear motion about a steady state whose contact rolls.

    The frame turns with the precession. What symmetry implies is divided out: of the six numbers n
    and L, the length of the axis, the turn about the vertical, and the neighbouring steady states,
    which are as many as two numbers. A pair of eigenvalues remains, imaginary or real, as nothing
    is lost. About a vertical spin the neighbour is one, and four remain.
    """
    time, scaled = float(natural_units(top).time), natural(top)
    angles = (state.tilt, state.precession * time, state.spin * time)

    def six(numbers: Any) -> Any:
        tilt, rate, spin = numbers
        angles = Angles(tilt, 0.0, 0.0, rate, spin, (0.0, 0.0))
        return state_from_angles(angles, scaled, np).pack()[:6]

    def imbalance(numbers: Any) -> Any:
        tilt, rate, spin = numbers
        return [Levers.at(np.sin(tilt), np.cos(tilt), scaled).imbalance(rate, spin)]

    def rates(y: Any) -> Any:
        axis, momentum = tuple(y[:3]), tuple(y[3:])
        point = ContactPoint.of(axis, momentum, scaled)
        wrench, _ = sticking_forces(point, drills=True)
        moving = (*axis_rate(axis, momentum, scaled), *point.moment(wrench))
        turned = (-y[1], y[0], 0.0, -y[4], y[3], 0.0)
        return [each - angles[1] * turning for each, turning in zip(moving, turned, strict=True)]

    point = np.array([float(number) for number in six(angles)])
    matrix = jacobian(rates, list(point))
    off_sphere: Array = np.array([*point[:3], 0.0, 0.0, 0.0])
    neutral: tuple[str, ...] = (TURNED, NEIGHBOURS)
    if state.kind in VERTICAL_SPINS:
        neighbours: Array = np.array([[*[0.0] * 3, *point[:3]]])
        neutral = ("the neighbouring steady state, of another spin",)
    else:
        gradient = jacobian(imbalance, list(angles))
        tangents = null_space(gradient).T
        turned = np.array([-point[1], point[0], 0.0, -point[4], point[3], 0.0])
        neighbours = np.vstack([turned, tangents @ jacobian(six, list(angles)).T])
    excluded = np.vstack([off_sphere, neighbours]).T
    basis: Array = np.linalg.qr(excluded, mode="complete").Q[:, excluded.shape[1] :]
    reduced: Array = basis.T @ matrix @ basis / time
    values: Complex = np.linalg.eigvals(reduced).astype(np.complex128)
    order = np.lexsort((values.imag, -values.real))
    return Spectrum(values[order], state.precession, neutral)
