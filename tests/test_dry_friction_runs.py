"""Runs and sweeps of problems with dry friction: sticking, limits, and one answer wherever it is
asked.
"""

import json

import numpy as np
import pytest
from typer.testing import CliRunner

import tippetop as tt
from tippetop.cli.commands import app
from tippetop.contact.automaton import Automaton
from tippetop.contact.contact_mode import ContactMode
from tippetop.contact.guards import STOPPING
from tippetop.contact.mode import ModeEnd
from tippetop.contact.slip_end_mode import SlipEnd
from tippetop.integrators import make_integrator
from tippetop.mechanics.contacts.contact_point import ContactPoint
from tippetop.mechanics.contacts.forces import (
    forces_and_accelerations,
    slip_reserve,
    velocity_without_slip,
)
from tippetop.mechanics.laws.coulomb import CoulombLaw
from tippetop.mechanics.motion import along_table, on_table, presses, sliding_contact
from tippetop.mechanics.state import SlidingState
from tippetop.mechanics.surfaces.surface import SphereSurface
from tippetop.mechanics.top import Top, natural, natural_state, natural_units
from tippetop.problem.problem import top_of

INTEGRATORS = ["taylor", "dop853"]
LAWS = {
    "coulomb": {"kind": "coulomb", "mu": 0.3},
    "ellipsoidal": {
        "kind": "contensou",
        "mu": 0.3,
        "patch_radius": 1e-3,
        "pressure": "ellipsoidal",
    },
    "hertz": {"kind": "contensou", "mu": 0.3, "patch_radius": 1e-3},
}


def dry(law, spin=100.0, **launch):
    """The report's top with dry friction."""
    fields = json.loads(tt.presets.report_problem(spin=spin).to_json())
    fields["launch"] |= launch
    return tt.Problem.from_json(
        json.dumps(fields | {"friction": LAWS[law] if isinstance(law, str) else law})
    )


def last(run):
    """The direction of the axis at the end, and the axial spin."""
    return np.array([float(run["tilt"][-1]), float(run["spin"][-1]) / 100.0])


@pytest.mark.parametrize("law", LAWS)
def test_problems_are_written_and_read_again(law):
    problem = dry(law)
    assert tt.Problem.from_toml(problem.to_toml()) == problem
    assert tt.Problem.from_json(problem.to_json()) == problem


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_top_that_rolls_sticks_for_ever_and_loses_nothing(integrator):
    """At rest in tilt without slip, the force that keeps it so stays below mu N."""
    run = tt.simulate(dry("coulomb"), 2.0, integrator=integrator)
    assert set(run["mode"].values) == {"sticking"}
    assert abs(float(run["energy_lost"])) < 1e-12 * float(run["energy"][0])
    force = run["contact_force"].values
    assert (np.hypot(force[:, 0], force[:, 1]) < 0.3 * force[:, 2]).all()


@pytest.mark.parametrize("law", LAWS)
def test_two_integrators_agree(law):
    problem = dry(law, slip=[0.3, 0.0])
    runs = [tt.simulate(problem, 0.4, integrator=name) for name in ("taylor", "dop853")]
    assert last(runs[0]) == pytest.approx(last(runs[1]), abs=1e-9)
    assert float(runs[0]["energy_lost"]) == pytest.approx(float(runs[1]["energy_lost"]), rel=1e-9)


def test_friction_is_against_the_slip_that_begins_from_its_first_instant_on():
    """A top set down without slip on a table too slippery to hold it."""
    run = tt.simulate(
        dry({"kind": "coulomb", "mu": 1e-3}, tilt=1.2, tilt_rate=2.0), 1e-4, samples=101
    )
    force = run["contact_force"].values
    assert np.hypot(force[:, 0], force[:, 1]) == pytest.approx(1e-3 * force[:, 2], rel=1e-12)
    ways = np.arctan2(force[:, 1], force[:, 0])
    assert ways[0] == pytest.approx(2.0 * ways[1] - ways[2], abs=0.01)
    assert np.ptp(ways[1:]) < 0.1


def test_smoothed_friction_tends_to_dry_friction():
    """The slip that smoothing leaves where a top sticks is proportional to eps, and so is what it
    changes.
    """
    launch = {"slip": [0.3, 0.0]}
    exact = last(tt.simulate(dry("coulomb", **launch), 0.3))
    off = []
    for eps in (4e-3, 2e-3, 1e-3):
        law = {"kind": "regularized_coulomb", "mu": 0.3, "eps": eps}
        off.append(np.abs(last(tt.simulate(dry(law, **launch), 0.3)) - exact).max())
    assert 1e-6 < off[-1] < 1e-2
    assert off[0] / off[1] == pytest.approx(2.0, rel=0.25)
    assert off[1] / off[2] == pytest.approx(2.0, rel=0.25)


@pytest.mark.parametrize("law", ["ellipsoidal", "hertz"])
def test_a_small_patch_tends_to_a_point(law):
    """Drilling speeds of R w beside the slip matter in proportion to their square while the top
    slides.
    """
    launch = {"slip": [0.5, 0.0], "spin": 20.0}
    exact = last(tt.simulate(dry("coulomb", **launch), 0.02))
    off = []
    for radius in (2e-4, 1e-4):
        friction = LAWS[law] | {"patch_radius": radius}
        off.append(np.abs(last(tt.simulate(dry(friction, **launch), 0.02)) - exact).max())
    assert off[1] < 0.6 * off[0]
    assert off[0] < 1e-2


@pytest.mark.parametrize("law", LAWS)
def test_what_friction_takes_is_what_the_energy_loses(law):
    run = tt.simulate(dry(law, slip=[0.3, 0.1]), 0.4)
    energy = run["energy"].values
    assert energy[0] - energy[-1] > 1e-3 * energy[0]
    assert float(run["energy_lost"]) == pytest.approx(energy[0] - energy[-1], rel=1e-10)


def test_the_command_line_finds_the_same():
    changes = [
        "--set",
        "friction.kind=coulomb",
        "--mu",
        "0.3",
        "--spin",
        "100",
        "--set",
        "launch.slip=[0.3,0]",
    ]
    told = CliRunner().invoke(app, ["simulate", *changes, "--duration", "0.4", "--json"])
    assert told.exit_code == 0, told.output
    run = tt.simulate(dry("coulomb", slip=[0.3, 0.0]), 0.4)
    assert json.loads(told.stdout)["energy_lost"] == float(run["energy_lost"])


def test_theory_that_knows_no_sticking_says_so():
    for ask in (tt.predict, tt.critical_spins, tt.standing_time):
        with pytest.raises(tt.InvalidInput, match=r"friction: .* sticks"):
            ask(dry("coulomb"))


def test_steady_states_are_the_same_whatever_friction():
    states = tt.steady_states(dry("coulomb"))
    assert states == tt.steady_states(tt.presets.report_problem(spin=100.0))


def test_another_law_keeps_what_it_has_in_common_and_takes_the_rest():
    viscous = tt.presets.report_problem(mu=0.2)
    changes = {"friction.patch_radius": 1e-4, "friction.kind": "contensou"}
    changed = viscous.replace(changes)
    assert changed.friction == tt.ContensouFriction(mu=0.2, patch_radius=1e-4)
    assert changed.replace({"friction.kind": "viscous"}) == viscous
    for wrong in (
        {"friction.kind": "contensou"},
        changes | {"friction.eps": 1.0},
        {"friction.kind": "wet"},
    ):
        with pytest.raises(tt.InvalidInput, match="friction"):
            viscous.replace(wrong)
    told = CliRunner().invoke(
        app, ["problem", "--mu", "0.2", *(f"--set={k}={v}" for k, v in changes.items())]
    )
    assert tt.Problem.from_toml(told.stdout) == changed


def test_a_patch_needs_a_radius():
    with pytest.raises(tt.InvalidInput, match="patch_radius is missing"):
        tt.ContensouFriction(mu=0.3)


def test_hertz_gives_the_radius():
    """A glass marble of 15 mm on steel under its weight: (3 P r / 4 E*)^(1/3), reckoned by hand."""
    stiffness = 1.0 / ((1 - 0.23**2) / 69e9 + (1 - 0.30**2) / 207e9)
    radius = tt.hertz_patch_radius(0.06, 0.015, tt.MATERIALS["glass"], tt.MATERIALS["steel"])
    assert radius**3 * 4.0 * stiffness == pytest.approx(3.0 * 0.06 * 0.015)


@pytest.mark.parametrize(("slip", "mode"), [(1e-3, ContactMode), (-1e-3, SlipEnd)])
def test_slip_that_grows_is_not_followed_to_an_end(slip: float, mode: type) -> None:
    """What falls over rolls the way it falls: slip against that ends, slip along it goes on."""
    launch = tt.Launch(tilt=1.0, spin=0.0, slip=(slip, 0.0))
    problem = tt.Problem(
        body=tt.presets.REPORT, friction=tt.CoulombFriction(mu=0.01), launch=launch
    )
    top = natural(top_of(problem))
    automaton, slides = Automaton(top, "ignore", 0.0), ContactMode(top, pulls=True)
    start = natural_state(problem.start(), natural_units(top_of(problem)))
    end = ModeEnd(STOPPING, start)
    assert type(automaton.follow(slides, end, 0.0).next) is mode


def test_what_could_be_held_by_a_pull_only_slips():
    """Sticking would need a pull, though the gap would close: neither that nor flight is
    consistent.
    """
    rng, count = np.random.default_rng(3), 0
    while count < 40:
        surface = SphereSurface(1.0, rng.uniform(-0.9, 0.9))
        across = rng.uniform(0.05, 0.6)
        along, law = rng.uniform(0.05, 2.0 * across), CoulombLaw(rng.uniform(0.5, 4.0))
        top = Top.of(1.0, across, along, surface, law, 1.0)
        way, momentum = rng.normal(size=3), tuple(rng.normal(size=3))
        axis = tuple(way / np.linalg.norm(way))
        held = forces_and_accelerations(ContactPoint.of(axis, momentum, top), None)[0]
        if (
            held.force[2] > 0.0
            or slip_reserve(top, held) < 0.0
            or not presses(axis, momentum, top, None)
        ):
            continue
        state = on_table(
            SlidingState(axis, momentum, velocity_without_slip(axis, momentum, top)), top
        )
        mode = Automaton(top, "fly", 0.0).resting(top, 0.0, state).next
        segment = next(mode.segments(0.0, state, 1e-3, make_integrator("dop853")))
        touch = sliding_contact(*along_table(segment.end_state), top)
        assert touch.normal_force > 0.0
        assert np.hypot(*touch.slip) > 0.0
        count += 1
