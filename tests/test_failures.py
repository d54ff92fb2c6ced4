"""What a run says that cannot go on: what could not be found, and never arithmetic's own words."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

import tippetop as tt
from campaigns import among
from launches import asked, in_javascript
from test_dry_campaign import LAWS, ordinary
from test_painleve_on_two import drawn
from tippetop.contact import slip_onset
from tippetop.contact.automaton import Automaton
from tippetop.contact.closed_pair import Before, ClosedPair
from tippetop.contact.contact_mode import mode_on_two
from tippetop.contact.impact import impact
from tippetop.contact.mode import BOTH, BROKEN, EventKind, Status
from tippetop.contact.slip_onset import UNSEEN
from tippetop.mechanics.contacts import pair_resolution
from tippetop.mechanics.contacts.slip_direction import Resisted, directions
from tippetop.mechanics.invariants import energy
from tippetop.mechanics.laws.contensou import EllipsoidalLaw
from tippetop.mechanics.laws.coulomb import RollingResistance
from tippetop.mechanics.laws.friction import ViscousLaw
from tippetop.mechanics.motion import along_table, sliding_contact
from tippetop.mechanics.series import PLAIN, Series, unknown
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.surface import SpheroidSurface
from tippetop.mechanics.top import Top
from tippetop.mechanics.unsolved import Unsolved
from tippetop.problem.presets import REPORT, report_problem
from tippetop.problem.problem import top_of

THROWN = report_problem(spin=155.0).replace({"launch.gap": 0.01})
SLIPPERY = tt.Problem(
    body=REPORT, friction=tt.CoulombFriction(mu=0.02), launch=tt.Launch(tilt=0.5, spin=155.0)
)
STICKS_AND_SLIPS = ordinary(LAWS["coulomb"], np.random.default_rng(5019))
TWO = tt.Problem(
    body=tt.presets.COIN,
    friction=tt.CoulombFriction(mu=0.3),
    launch=tt.Launch(tilt=math.pi / 2, spin=0.0),
)

SITES: list[tuple[str, tt.Problem, str]] = [
    ("collision.impact", THROWN, "The impulse of the impact"),
    ("automaton.answers", SLIPPERY, "The force that holds the contact"),
    ("automaton.find_onset", STICKS_AND_SLIPS, "The direction in which slip begins"),
    ("closed_pair.ClosedPair.answers", TWO, "The forces on two surfaces that touch"),
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
    assert run.attrs["status"] == "failed"
    assert run.attrs["message"].endswith(f" {what} cannot be found: {why}.")


@pytest.mark.parametrize("spin", among([1e150, 1e80], check=1))
def test_a_flight_that_turns_too_often_is_followed_on_no_page_either(spin: float) -> None:
    problem = THROWN.replace({"launch.spin": spin})
    run = tt.simulate(problem, 0.5, samples=3)
    (found,) = in_javascript([asked(0, 0.5) | {"problem": problem.model_dump(mode="json")}])
    assert run.attrs["status"] == "failed"
    assert found["status"]["name"] in {"failed", "too_many_steps"}


@pytest.mark.parametrize(
    ("step", "tilt"),
    [
        pytest.param(2e-3, 0.5, marks=pytest.mark.slow),
        pytest.param(2e-3, 1.2, marks=pytest.mark.slow),
        (4e-3, 0.1),
        (1e-2, 0.5),
        (3e-2, 1.2),
    ],
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
        if run.attrs["status"] not in {"inaccurate", "failed"}:
            exact = tt.simulate(problem, 0.6, samples=3)
            assert run.attrs["status"] == exact.attrs["status"]
            downs = [
                float(one["event_time"].values[one["event_kind"].values == "lies down"][0])
                for one in (run, exact)
            ]
            assert downs[0] == pytest.approx(downs[1], rel=1e-10)


EGG = Top.of(1.0, 0.2, 0.4, SpheroidSurface(1.0, 1.5), ViscousLaw(0.1), 1.0)


def test_what_drives_slip_round_leads_nowhere() -> None:
    """No law of friction does: a rate across every direction, which none resists."""

    def turning(ways: Any) -> list[Resisted]:
        return [Resisted((-y, x), 1.0) for x, y in ways]

    with pytest.raises(Unsolved, match="no direction in which the contact can go on"):
        directions(turning, [(1.0, 0.0)])


def test_painleves_paradox_with_rolling_held_takes_slip_away() -> None:
    """Friction presses the contact more than its force opens it, and rolling is at rest."""
    problem = report_problem(0.0, tilt=1.5, mu=10.0).replace(
        {"launch.slip": (10.0, 0.0), "rolling_resistance": 1e-6}
    )
    start, top = problem.start(), top_of(problem)
    assert sliding_contact(*along_table(start), top).delassus < 0.0
    after = Automaton(top, "fly", 0.0).resting(top, 0.0, start)
    assert [event.kind for event in after.events][:1] == [EventKind.IMPACT]
    lost = energy(start, top) - energy(after.state, top)
    assert lost == pytest.approx(after.events[0].energy_lost, rel=1e-12)
    assert lost > 0.0
    assert sliding_contact(*along_table(after.state), top).delassus > 0.0


def test_at_the_singular_point_of_a_jam_it_is_open_what_follows() -> None:
    """Genot and Brogliato's point: A and b are zero at once, and slip in a plane does not turn."""

    def rod(mu: float, rate: float) -> tt.Problem:
        return tt.Problem(
            body=tt.Body(
                mass=0.02,
                shape=tt.EccentricSphere(radius=0.02, eccentricity=0.05),
                I1=4e-8,
                I3=4e-8,
            ),
            friction=tt.CoulombFriction(mu=mu),
            launch=tt.Launch(tilt=math.pi - 1.2, spin=0.0, tilt_rate=rate, slip=(0.5, 0.0)),
            contact=tt.Contact(liftoff="fly", restitution=0.0),
        )

    def delassus(mu: float) -> float:
        problem = rod(mu, 0.0)
        touch = sliding_contact(*along_table(problem.start()), top_of(problem))
        return float(touch.delassus * top_of(problem).mass)

    def opening(rate: float) -> float:
        problem = rod(mu, rate)
        return float(
            sliding_contact(*along_table(problem.start()), top_of(problem)).free_acceleration
        )

    mu = brentq(delassus, 0.01, 10.0, xtol=1e-16)
    singular = rod(mu, brentq(opening, 0.0, 1000.0))
    after = Automaton(top_of(singular), "fly", 0.0).jammed(top_of(singular), 0.0, singular.start())
    assert after is not None
    assert after.detail.startswith("What follows where friction jams the contact cannot be found:")
    assert "whether it does or is struck rigid bodies do not tell" in after.detail


def drawn_contacts(seed: int, law: Any = None, resistance: float | None = None) -> ClosedPair:
    """A slender body on two spheres, of which the first sticks and the second slips if it can."""
    case = drawn(np.random.default_rng(seed))
    assert case is not None
    (first, _), state = case
    rolling = None if resistance is None else RollingResistance(resistance)
    top = first.altered(rolling_resistance=rolling, friction=law or first.friction)
    return ClosedPair.of(
        state, (top.body.contacts[0], top.body.contacts[1]), 0.0, (True, law is not None)
    )


def test_each_of_two_contacts_may_carry_the_body_alone_without_a_jam() -> None:
    contacts = drawn_contacts(349)
    assert not contacts.jammed
    automaton = Automaton(contacts.tops[0], "fly", 0.0)
    after = automaton.resolve_two(0.0, contacts.state, contacts.tops, Before(), 0.0)
    assert after.next is Status.FAILED
    assert after.detail == "each of two surfaces that touch can carry the body alone"


def test_slip_on_two_begins_in_no_direction_where_friction_holds_them() -> None:
    contacts = drawn_contacts(1, EllipsoidalLaw(0.05, 0.01))
    assert pair_resolution.patches_begin_to_slip(contacts.pair, 0.0) is None
    mode = mode_on_two(contacts.tops, 0.0, (True, True))
    automaton = Automaton(contacts.tops[0], "fly", 0.0)
    after = automaton.slip_on_two(0.0, contacts.state, mode, BOTH)
    assert after.next is Status.FAILED
    assert after.detail.startswith(
        "The direction in which slip, or rolling, begins on two surfaces cannot be found: no dir"
    )


def test_rolling_on_two_contacts_may_be_held_by_nothing_and_begin_neither_way() -> None:
    """One contact slips on very rough ground, which presses it (Painleve's paradox)."""
    contacts = drawn_contacts(2346, resistance=0.25)
    with pytest.raises(Unsolved, match="nothing can hold the rolling of two contacts"):
        pair_resolution.resolution(contacts.pair, contacts.xi, contacts.ended, contacts.rolls)


def test_patches_whose_direction_of_slip_is_not_found_are_not_held(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Where moments cannot hold them either, the search is what has failed."""
    contacts = drawn_contacts(4, EllipsoidalLaw(0.05, 0.01))
    assert pair_resolution.patches_begin_to_slip(contacts.pair, 0.0) is not None

    def fail(*_: Any) -> None:
        raise Unsolved("none")

    monkeypatch.setattr(pair_resolution, "directions", fail)
    with pytest.raises(Unsolved, match="nothing holds two patches"):
        pair_resolution.patches_begin_to_slip(contacts.pair, 0.0)


def test_velocities_that_rounding_hides_are_not_followed(monkeypatch: pytest.MonkeyPatch) -> None:
    follow = slip_onset.follow_slip

    def hidden(*arguments: Any, **keywords: Any) -> Any:
        return follow(*arguments, **keywords)._replace(knots=[], rows=[])

    monkeypatch.setattr(slip_onset, "follow_slip", hidden)
    run = tt.simulate(SLIPPERY, 0.5, samples=3)
    assert run.attrs["status"] == "failed"
    assert UNSEEN in run.attrs["message"]


def test_mistakes_in_the_use_of_the_mechanics_are_said() -> None:
    with pytest.raises(AssertionError, match="coefficient 0 before"):
        Series(unknown, PLAIN)[0]
    falling = State((1.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, -1.0), 1.0)
    with pytest.raises(ValueError, match="must lie between 0 and 1, but is"):
        impact(falling, 1.5, EGG)
