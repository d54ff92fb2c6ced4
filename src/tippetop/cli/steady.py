"""`tippetop steady`: steady motions with a tilt, a rate, a radius or a spin."""

import math
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tippetop.cli.options import Choice, Json, number_or_text, of_a_problem
from tippetop.cli.terminal import facts, listing, show, show_json, spelled
from tippetop.support.errors import InvalidInput, renamed

if TYPE_CHECKING:
    from tippetop.problem.problem import Problem
    from tippetop.theory.stability import Spectrum
    from tippetop.theory.steady import SteadyState

At = Annotated[
    list[str] | None,
    typer.Option(
        "--at",
        metavar="NAME=VALUE",
        help=(
            "Number of the steady motions: tilt, rate, radius or spin, as in tilt=45deg or"
            " radius=20cm. Two of them, or one for a centre of mass that rests; without, those"
            " that the launch may end in."
        ),
    ),
]
NAMES = ("tilt", "rate", "radius", "spin")
NONE_OF_THE_LAUNCH = (
    "No steady motion is known that this launch ends in. Numbers state others, as in"
    " --at tilt=45deg."
)


@of_a_problem
def steady(choice: Choice, at: At = None, as_json: Json = False) -> None:
    """Show steady motions of a body, such as a coin's that rolls round a circle, and which last."""
    from tippetop.theory.outlook import steady_states  # noqa: PLC0415 - slow to import

    problem = choice.problem()
    try:
        states = steady_states(problem, **_numbers(at or []))
    except InvalidInput as error:
        if set(error.field.split(", ")) <= set(NAMES):
            raise renamed(error, f"--at {error.field}") from None
        raise
    judged = [(state, _spectrum(problem, state)) for state in states]
    straight = _straight(problem)
    if as_json:
        entries = [{**vars(state), **_plain(linear)} for state, linear in judged]
        show_json(
            {
                "steady_states": entries,
                "least_straight_spin": straight,
                "problem": problem.model_dump(),
            }
        )
        return
    if judged:
        headings = ("kind", "tilt", "rate", "spin", "radius", "friction", "", "time")
        rows = (_row(state, linear) for state, linear in judged)
        show(listing("Steady motions", headings, rows, words=("kind", "")))
        show(
            "[dim]rad, rad/s, m; friction: least coefficient that holds the contact; time: s in"
            " which a small disturbance grows e times or, where none grows, of its slowest"
            " oscillation.[/]"
        )
    else:
        show("No motion with these numbers is steady." if at else NONE_OF_THE_LAUNCH)
    if straight is not None:
        show(facts([_straight_row(straight)]))


def _numbers(at: list[str]) -> dict[str, Any]:
    """Return the numbers of `--at NAME=VALUE`."""
    numbers: dict[str, Any] = {}
    for word in at:
        name, _, value = word.partition("=")
        if name not in NAMES or not value or name in numbers:
            raise InvalidInput("--at", word, "NAME=VALUE, once each, of tilt, rate, radius, spin")
        numbers[name] = math.inf if value == "inf" else number_or_text(value)
    return numbers


def _spectrum(problem: "Problem", state: "SteadyState[float]") -> "Spectrum | None":
    """Return the spectrum of a state; None where it has no linear motion."""
    from tippetop.theory.spectra import spectrum  # noqa: PLC0415 - slow to import

    try:
        return spectrum(problem, state)
    except InvalidInput:
        return None


def _straight(problem: "Problem") -> float | None:
    """Return the least spin of stable straight rolling, rad/s; None for a body that cannot roll
    straight.
    """
    from tippetop.theory.spectra import least_straight_spin  # noqa: PLC0415 - slow to import

    try:
        return least_straight_spin(problem)
    except InvalidInput:
        return None


def _straight_row(spin: float) -> tuple[str, str, str]:
    """Return the row of the least spin of stable straight rolling."""
    if spin == 0.0:
        return "rolls straight stably", "at any spin", ""
    if math.isinf(spin):
        return "rolls straight stably", "at no spin", ""
    return "rolls straight stably", f"above {spelled(spin)}", "rad/s"


def _plain(spectrum: "Spectrum | None") -> dict[str, Any]:
    """Return a spectrum as plain data; null where there is none."""
    if spectrum is None:
        return dict.fromkeys(("growth_rate", "stable", "unstable", "eigenvalues"))
    return {
        "growth_rate": spectrum.growth_rate,
        "stable": spectrum.stable,
        "unstable": spectrum.unstable,
        "eigenvalues": [[value.real, value.imag] for value in spectrum.eigenvalues.tolist()],
    }


def _row(state: "SteadyState[float]", spectrum: "Spectrum | None") -> tuple[str, ...]:
    """Return a state's row of the table."""
    numbers = [spelled(value) for value in (state.tilt, state.precession, state.spin)]
    radius = spelled(state.radius) if math.isfinite(state.radius) else "straight"
    verdict, time = "", ""
    if spectrum is not None:
        verdict = "stable" if spectrum.stable else "unstable" if spectrum.unstable else "lasts"
        slowest = min(abs(value.imag) for value in spectrum.eigenvalues.tolist())
        if spectrum.unstable:
            time = spelled(1.0 / spectrum.growth_rate, 4)
        elif slowest > 0.0:
            time = spelled(2.0 * math.pi / slowest, 4)
    return (state.kind.value, *numbers, radius, spelled(state.friction, 4), verdict, time)
