"""What a run says that cannot go on: what could not be found, and never arithmetic's own words."""

import math
from collections.abc import Callable
from typing import Any

import pytest

import tippetop as tt
from launches import TOLERANCE, asked, in_javascript
from tippetop.contact.mode import BROKEN
from tippetop.mechanics.roots import first_root
from tippetop.mechanics.unsolved import Unsolved
from tippetop.problem.presets import REPORT, report_problem

THROWN = report_problem(spin=155.0).replace({"launch.gap": 0.01})
SLIPPERY = tt.Problem(
    body=REPORT, friction=tt.CoulombFriction(mu=0.02), launch=tt.Launch(tilt=0.5, spin=155.0)
)
BRAKED = SLIPPERY.replace({"rolling_resistance": 1e-6, "launch.spin": 0.0})
TWO = tt.Problem(
    body=tt.presets.COIN,
    friction=tt.CoulombFriction(mu=0.3),
    launch=tt.Launch(tilt=math.pi / 2, spin=0.0),
)

SITES: list[tuple[str, tt.Problem, str]] = [
    ("flight.touchdown", THROWN, "The end of the flight"),
    ("collision.impact", THROWN, "The impulse of the impact"),
    ("automaton.resolve_onset", SLIPPERY, "The force that holds the contact"),
    ("slip_onset.find_onset", SLIPPERY, "The direction in which slip begins"),
    ("slip_onset.find_onset", BRAKED, "The direction in which slip and rolling begin"),
    ("two_closed.TwoClosed.resolved", TWO, "The forces on two surfaces that touch"),
]


@pytest.mark.parametrize(
    ("error", "why"),
    [
        (ZeroDivisionError("0.0 cannot be raised to a negative power"), BROKEN),
        (OverflowError(34, "Numerical result out of range"), BROKEN),
        (Unsolved("it is nowhere"), "it is nowhere"),
    ],
    ids=["division", "overflow", "unsolved"],
)
@pytest.mark.parametrize(("site", "problem", "what"), SITES, ids=[what for _, _, what in SITES])
def test_what_cannot_be_found_is_said_in_words_of_the_motion(
    monkeypatch: pytest.MonkeyPatch,
    site: str,
    problem: tt.Problem,
    what: str,
    error: Exception,
    why: str,
) -> None:
    def fail(*_: Any, **__: Any) -> Callable[..., Any]:
        raise error

    monkeypatch.setattr(f"tippetop.contact.{site}", fail)
    run = tt.simulate(problem, 0.5, samples=3)
    assert run.attrs["outcome"] == "failed"
    assert run.attrs["outcome_advice"].endswith(f" {what} cannot be found: {why}.")


@pytest.mark.parametrize("spin", [1e80, 1e150])
def test_the_page_says_the_same(spin: float) -> None:
    problem = THROWN.replace({"launch.spin": spin})
    run = tt.simulate(problem, 0.5, samples=3, integrator="dop853", tolerance=TOLERANCE)
    (found,) = in_javascript([asked(0, 0.5) | {"problem": problem.model_dump(mode="json")}])
    assert found["outcome"] == {"name": "failed", "advice": run.attrs["outcome_advice"]}
    assert "The end of the flight cannot be found" in run.attrs["outcome_advice"]


@pytest.mark.parametrize(
    ("step", "tilt"), [(2e-3, 0.5), (2e-3, 1.2), (4e-3, 0.1), (1e-2, 0.5), (3e-2, 1.2)]
)
def test_steps_too_long_for_an_edge_are_told_whatever_they_lead_to(
    step: float, tilt: float
) -> None:
    """They turn the axis beyond flat, where no body can be.

    A coin that falls flat while it is followed without the integrator lies flat when it does in
    short steps, however long these are.
    """
    for friction in (tt.ViscousFriction(mu=0.3), tt.CoulombFriction(mu=0.3)):
        problem = tt.Problem(
            body=tt.presets.COIN, friction=friction, launch=tt.Launch(tilt=tilt, spin=0.0)
        )
        run = tt.simulate(problem, 0.6, integrator="rk4", step=step)
        if run.attrs["outcome"] not in {"inaccurate", "failed"}:
            exact = tt.simulate(problem, 0.6, samples=3)
            assert run.attrs["outcome"] == exact.attrs["outcome"] == "lying_flat"
            assert float(run["end_time"]) == pytest.approx(float(exact["end_time"]), rel=1e-10)


def test_steps_that_are_lost_in_rounding_are_not_taken_for_ever() -> None:
    """The bound lets steps be positive that are shorter than the distance of two numbers at that
    time.
    """
    with pytest.raises(Unsolved, match="rounding"):
        first_root(lambda _: (1.0, 0.0, 0.0), 1.8, 1.8 + 1e-14, 6.0 / 1e-17**3)
