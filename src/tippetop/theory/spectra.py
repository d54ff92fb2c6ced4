"""Stability of single steady states, on a contact that slides and on one that rolls."""

import math

from tippetop.mechanics.surfaces.hull import Hull, lies_flat_at
from tippetop.problem.problem import Problem, require_problem, top_of
from tippetop.support.errors import Described, InvalidInput
from tippetop.theory.prediction import on_surface
from tippetop.theory.requirements import require_no_field, sticks
from tippetop.theory.rolling import rolling_spectrum, straight_spin
from tippetop.theory.stability import Spectrum
from tippetop.theory.stability import spectrum as sliding_spectrum
from tippetop.theory.steady import VERTICAL_SPINS, SteadyKind, SteadyState, end_of


def spectrum(problem: Problem, state: SteadyState[float]) -> Spectrum:
    """Return the eigenvalues of the linear motion about a steady state.

    Parameters
    ----------
    problem
        The body, its friction, and gravity.
    state
        A steady state of this body, as `steady_states` returns it.

    Returns
    -------
    Spectrum
        Its eigenvalues, 1/s, in the frame that turns with the precession. Under dry friction of a
        point the contact rolls without slip, and loses nothing: no disturbance decays, and the
        state keeps to itself where none grows. Under a law that is linear in small slip the contact
        slides.

    Raises
    ------
    InvalidInput
        If there is no linear motion: of a body that lies flat, with rolling resistance, under
        friction with a torque unless the state is a vertical spin, on a slope, in air, and of
        circles under a law by which slip never ends.

    Examples
    --------
    >>> import math, tippetop as tt
    >>> coin = tt.presets.report_problem().replace(
    ...     {"body": tt.presets.COIN, "friction": {"kind": "coulomb", "mu": 0.5}}
    ... )
    >>> (state,) = tt.steady_states(coin, tilt="80 deg", radius="20 cm")
    >>> tt.spectrum(coin, state).unstable
    False
    """
    require_problem(problem)
    if not isinstance(state, SteadyState):
        raise InvalidInput("state", state, "a steady state, as tt.steady_states returns it")
    body = top_of(problem).body
    top = body.lowest_at(math.cos(state.tilt))
    require_no_field(top)
    if state.kind in VERTICAL_SPINS and lies_flat_at(top.surface, end_of(state.kind)):
        raise InvalidInput(
            "state", Described("this one"), "one in which the body touches in one point"
        )
    if sticks(top):
        if top.resists_rolling:
            arm = problem.rolling_resistance
            raise InvalidInput("rolling_resistance", arm, "0: it brakes what rolls")
        return rolling_spectrum(state, top)
    if state.friction > 0.0 or state.kind is SteadyKind.STRAIGHT:
        raise InvalidInput(
            "friction",
            Described("this law"),
            "dry friction of a point, on which the contact rolls without slip",
        )
    if isinstance(body.surface, Hull):
        top = top_of(on_surface(problem, top.number))
    return sliding_spectrum(state, top)


def least_straight_spin(problem: Problem) -> float:
    """Return the axial spin above which a body that rolls straight on its edge does not fall over.

    A thin disk of radius a rolls straight stably above sqrt(g / (3 a)), and any disk above
    sqrt(I1 m g a / (I3 (I3 + m a^2))).

    Returns
    -------
    float
        rad/s; 0 if it does so at any spin, and inf if at none. Of several tilts at which the body
        can roll straight, that nearest to the launch counts.

    Raises
    ------
    InvalidInput
        If the centre of mass is above the contact point at no tilt between 0 and pi, on a slope, or
        in air.

    Examples
    --------
    >>> import tippetop as tt
    >>> coin = tt.presets.report_problem(tilt=1.5).replace({"body": tt.presets.COIN})
    >>> round(tt.least_straight_spin(coin), 2)  # rad/s
    16.97
    """
    require_problem(problem)
    top = top_of(problem)
    require_no_field(top)
    spin = straight_spin(top, problem.launch.tilt)
    if spin is None:
        raise InvalidInput(
            "body.shape",
            Described("this one"),
            "a shape that rolls straight, such as that of a coin: its centre of mass is above the"
            " contact point at some tilt",
        )
    return spin
