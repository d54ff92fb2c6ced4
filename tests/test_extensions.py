"""Friction laws, a surface and a contact mode of a user's own, in runs and in sweeps."""

import math
import subprocess
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
import pytest

import tippetop as tt
from campaigns import among
from extension_example import Counting, drying_problem
from own_parts import DRAWN, OVER, PROBLEMS, REPORT, PinAutomaton, Pinned, RampLaw, pinned_motion
from tippetop.contact.automaton import Automaton
from tippetop.contact.mode import Mode, ModeEnd, Transition
from tippetop.extend import (
    NO_TORQUE,
    FrictionLaw,
    Horizontal,
    Positive,
    Quantity,
    Scalar,
    Traction,
    Units,
    Vector,
)
from tippetop.graph.hoisting import evaluated
from tippetop.graph.recording import record
from tippetop.integrators.base import Motion
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Top
from tippetop.results.catalogue import SWEPT
from tippetop.support.errors import InvalidInput

DURATION = 0.6


EACH = pytest.mark.parametrize("what", PROBLEMS)


@pytest.mark.parametrize("what", among(list(PROBLEMS), check=3))
def test_integrators_agree_and_energy_balances(what: str) -> None:
    runs = [
        tt.simulate(PROBLEMS[what], DURATION, integrator=name, tolerance=tolerance, samples=101)
        for name, tolerance in ((None, None), ("dop853", 1e-13))
    ]
    for name in ("tilt", "spin", "x", "normal_force", "work"):
        one, other = (run[name].values for run in runs)
        np.testing.assert_allclose(one, other, rtol=0, atol=1e-8 * np.abs(one).max(), err_msg=name)
    for run in runs:
        assert run.attrs["status"] == "completed"
        assert float(run["energy_error"]) < 1e-10
    assert float(runs[0]["energy_lost"]) > 0.01 * float(runs[0]["initial_energy"])


def test_the_law_is_the_one_defined() -> None:
    run = tt.simulate(PROBLEMS["law"], 0.2, samples=51)
    slip = np.hypot(run["slip_x"], run["slip_y"]).values
    force = np.hypot(*run["contact_force"].values[:, :2].T) / run["normal_force"].values
    expected = 0.2 * (1 + 0.5 / (1 + (slip / 0.05) ** 2)) * slip / np.hypot(slip, 0.05)
    # At launch slip is zero: what is left of it is rounding of 3 m/s, which the law multiplies by
    # 0.3 / 0.05.
    np.testing.assert_allclose(force, expected, rtol=1e-9, atol=6.0 * np.spacing(3.0))


class ForgottenAutomaton(PinAutomaton):
    """Of which nobody said what follows the release."""

    def follow(self, mode: Mode, end: ModeEnd, time: float) -> Transition:
        return Automaton.follow(self, mode, end, time)


class ForgottenPin(tt.Contact):
    kind: Literal["forgotten_pin"] = "forgotten_pin"
    until: Annotated[Positive, Quantity("s", "when the pin is drawn")]

    def rules(self, top: Top, units: Units) -> ForgottenAutomaton:
        return ForgottenAutomaton(top, self.liftoff, self.restitution, left=self.until / units.time)


def test_a_mode_that_nothing_follows_is_named_in_one_sentence() -> None:
    problem = REPORT.model_copy(update={"contact": ForgottenPin(until=0.1)})
    with pytest.raises(InvalidInput) as caught:
        tt.simulate(problem, 0.2)
    assert str(caught.value) == (
        "contact: the mode pinned, ended by 'released', has no rule for what follows (return a"
        " Transition for this guard from the automaton's method follow)"
    )
    swept = tt.sweep(problem, {"launch.spin": [155.0]}, duration=0.2, workers=1)
    assert swept["outcome"].values.tolist() == ["failed"]


@dataclass(frozen=True)
class OddlyPinned(Pinned):
    """The same with equations that ask what only numbers have: they cannot be recorded."""

    @property
    def motion(self) -> Motion:
        rates = pinned_motion(self.top.kind).rates

        def of_floats(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> Sequence[Scalar]:
            return [float(rate) for rate in rates(y, numbers)]

        return replace(pinned_motion(self.top.kind), rates=of_floats)


@dataclass(frozen=True)
class OddAutomaton(PinAutomaton):
    """Entered by that mode."""

    def launch(self, state: State) -> Transition:
        return Transition((), OddlyPinned(self.top, self.left), state)


class OddlyPinnedAtFirst(tt.Contact):
    kind: Literal["oddly_pinned_at_first"] = "oddly_pinned_at_first"
    until: Annotated[Positive, Quantity("s", "when the pin is drawn")]

    def rules(self, top: Top, units: Units) -> OddAutomaton:
        return OddAutomaton(top, self.liftoff, self.restitution, left=self.until / units.time)


@pytest.mark.parametrize(
    ("duration", "settings", "names", "tolerance"),
    [
        (0.05, {}, "dop853", 1e-12),
        (0.05, {"integrator": "taylor", "tolerance": 1e-8}, "dop853", 1e-8),
        (0.2, {}, "dop853, taylor", 1e-12),
    ],
)
def test_a_run_says_who_followed_what_cannot_be_recorded(
    duration: float, settings: dict[str, Any], names: str, tolerance: float
) -> None:
    """Taylor's method leaves it to Dormand and Prince's, whose numbers are as inexact as that."""
    problem = REPORT.model_copy(update={"contact": OddlyPinnedAtFirst(until=0.1)})
    run = tt.simulate(problem, duration, samples=5, **settings)
    assert run.attrs["status"] == "completed"
    assert (run.attrs["integrator"], run.attrs["tolerance"]) == (names, tolerance)


def test_a_law_of_a_function_is_that_of_a_class() -> None:
    """The numbers are the same but for the order of roundings in the natural units."""
    of_class, of_function = (
        tt.simulate(PROBLEMS[what], DURATION, samples=11) for what in ("law", "law of a function")
    )
    for name in ("tilt", "spin", "work"):
        np.testing.assert_allclose(of_class[name], of_function[name], rtol=1e-12)


@pytest.mark.parametrize(
    ("units", "field"), [({"mu": "furlong"}, "mu"), ({"kind": "1"}, "kind"), ({"nu": "1"}, "law")]
)
def test_a_law_of_a_function_names_what_cannot_be(units: dict[str, str], field: str) -> None:
    def law(slip: Horizontal, omega: Vector, mu: Scalar) -> tuple[Scalar, Scalar]:
        return -mu * slip[0], -mu * slip[1]

    with pytest.raises(InvalidInput) as caught:
        tt.extend.friction_law(**units)(law)
    assert caught.value.field == field
    assert "law" not in tt.Friction.kinds


def test_the_law_with_a_choice_is_the_one_defined() -> None:
    run = tt.simulate(PROBLEMS["law with a choice"], DURATION, samples=201)
    slip, normal = np.hypot(run["slip_x"], run["slip_y"]).values, run["normal_force"].values
    force = np.hypot(*run["contact_force"].values[:, :2].T)
    expected = 0.2 * np.minimum(slip / 0.05, 1.0) * normal
    np.testing.assert_allclose(force, expected, rtol=1e-9, atol=1e-14)
    assert slip.min() < 0.05 < slip.max()
    assert float(run["energy_error"]) < 1e-13, "steps end where another branch of the law begins"


class Choosing(RampLaw):
    """The same with Python's `max`, which looks at numbers."""

    def traction(self, slip: Horizontal, angular_velocity: Vector) -> Traction:
        factor = -self.mu / max((slip[0] ** 2 + slip[1] ** 2) ** 0.5, self.full)
        return Traction((factor * slip[0], factor * slip[1]), NO_TORQUE)


class Rooted(RampLaw):
    """The same with a function of `math`, which takes numbers alone."""

    def traction(self, slip: Horizontal, angular_velocity: Vector) -> Traction:
        factor = -self.mu / tt.extend.max(math.hypot(slip[0], slip[1]), self.full)
        return Traction((factor * slip[0], factor * slip[1]), NO_TORQUE)


class NotPlainFriction(tt.Friction):
    kind: Literal["not_plain"] = "not_plain"
    rooted: bool

    @property
    def law(self) -> FrictionLaw:
        return (Rooted if self.rooted else Choosing)(0.2, 0.05)


@pytest.mark.parametrize(
    ("rooted", "sentence"),
    [
        (False, r"Choosing\.traction: a choice by if, and, or, min or max "),
        (True, r"Rooted\.traction: TypeError\('must be real number, not Node'\) "),
    ],
)
@pytest.mark.parametrize(
    "run",
    [
        lambda problem: tt.simulate(problem, 0.01),
        lambda problem: tt.simulate(problem, 0.01, integrator="dop853"),
        lambda problem: tt.sweep(problem, {"launch.spin": [100.0]}, duration=0.01),
    ],
)
def test_a_law_that_cannot_be_recorded_is_refused(
    rooted: bool, sentence: str, run: Callable[[tt.Problem], Any]
) -> None:
    problem = REPORT.model_copy(update={"friction": NotPlainFriction(rooted=rooted)})
    with pytest.raises(InvalidInput, match=sentence + ".*tippetop.extend.where, abs, min, max"):
        run(problem)


@pytest.mark.parametrize("number", [-0.5, 0.0, 2.0])
def test_functions_take_numbers_arrays_and_recorded_numbers(number: float) -> None:
    def values(y: Sequence[Scalar], p: Sequence[Scalar]) -> list[Scalar]:
        low, high = (getattr(tt.extend, name)(y[0], 1.0) for name in ("min", "max"))
        size = tt.extend.abs(y[0])
        return [low, high, size, tt.extend.sqrt(size), tt.extend.where(y[0] < 1.0, y[0], 3.0)]

    expected = [
        min(number, 1.0),
        max(number, 1.0),
        abs(number),
        math.sqrt(abs(number)),
        number if number < 1.0 else 3.0,
    ]
    assert values([number], []) == expected
    assert np.array(values([np.array([number, number])], [])).T.tolist() == [expected, expected]
    assert evaluated(record(values, 1, 0), [number], []) == expected


def test_rolling_resistance_is_a_torque_beside_the_law_defined() -> None:
    """Against the horizontal angular velocity w_t, of N times its arm; it takes what the law does
    not.
    """
    run = tt.simulate(PROBLEMS["law with rolling resistance"], 0.2, samples=51)
    body, axis, momentum = REPORT.body, run["axis"].values, run["angular_momentum"].values
    along = (1.0 / body.I3 - 1.0 / body.I1) * np.sum(axis * momentum, axis=1)
    turning = (momentum / body.I1 + along[:, None] * axis)[:, :2]
    torque = run["contact_torque"].values
    expected = -1e-4 * run["normal_force"].values / np.hypot(*turning.T)
    np.testing.assert_allclose(torque[:, :2], expected[:, None] * turning, rtol=1e-9)
    assert 0.0 < float(run["rolling_loss"][-1]) < float(run["energy_lost"])
    total = float(run["sliding_loss"][-1] + run["rolling_loss"][-1])
    assert total == pytest.approx(float(run["energy_lost"]), rel=1e-9)


def test_the_surface_is_the_one_defined() -> None:
    run = tt.simulate(PROBLEMS["surface"], DURATION, samples=51)
    c = np.cos(run["tilt"].values)
    np.testing.assert_allclose(run["height"], 0.02 - 0.005 * c - 0.002 * c * c, rtol=1e-12)


def test_the_mode_is_the_one_defined() -> None:
    run = tt.simulate(PROBLEMS["mode"], DURATION, samples=501)
    pinned = run["time"].values < DRAWN
    names = run["mode"].values
    assert set(names[pinned]) == {"pinned"}
    assert "pinned" not in names[run["time"].values > DRAWN]
    energy, slip = run["energy"].values, np.hypot(run["slip_x"], run["slip_y"]).values
    assert np.ptp(energy[pinned]) < 1e-12 * energy[0], "a force on a point at rest does no work"
    assert slip[pinned].max() < 1e-12 < 1e-3 < slip[~pinned].max()
    assert energy[-1] < 0.99 * energy[0]


def test_an_example_with_public_names_alone_runs() -> None:
    """On the smooth table energy, L_z, L3 and the horizontal velocity are constant."""
    problem = drying_problem(until=DRAWN)
    counter = Counting.of("dop853")
    runs = [
        tt.simulate(problem, DURATION, samples=501),
        tt.simulate(problem, DURATION, samples=501, integrator=counter),
    ]
    assert counter.calls >= 2
    for run in runs:
        smooth = run["time"].values < DRAWN
        names = run["mode"].values
        assert set(names[smooth]) == {"smooth_table"} != set(names[~smooth])
        momentum, axis = run["angular_momentum"].values, run["axis"].values
        axial = np.sum(momentum * axis, axis=1)
        for constant in (run["energy"].values, momentum[:, 2], axial):
            assert np.ptp(constant[smooth]) < 1e-11 * abs(constant[0])
        assert np.ptp(run["velocity"].values[smooth, :2], axis=0).max() < 1e-14
        assert np.all(run["contact_force"].values[smooth, :2] == 0.0)
        assert float(run["energy_error"]) < 1e-10
        assert run["energy"].values[-1] < 0.999 * run["energy"].values[0]
    for name in ("tilt", "spin", "normal_force"):
        one, two = (run[name].values for run in runs)
        np.testing.assert_allclose(one, two, rtol=0, atol=1e-8 * np.abs(one).max(), err_msg=name)
    swept = tt.sweep(problem, {"contact.until": [0.1, DRAWN]}, duration=DURATION, workers=1)
    assert swept["final_tilt"].values[1] == pytest.approx(float(runs[0]["final_tilt"]), rel=1e-7)


@pytest.mark.slow
@pytest.mark.parametrize("what", ["law of a function", "surface", "mode"])
def test_worker_processes_find_the_same(what: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tippetop.sweeps.definition.LEAST_CELLS_A_TASK", 1)
    alone, shared = (
        tt.sweep(PROBLEMS[what], OVER[what], duration=DURATION, workers=count) for count in (1, 2)
    )
    for name in SWEPT:
        if np.issubdtype(alone[name].dtype, np.number):
            np.testing.assert_allclose(alone[name], shared[name], rtol=1e-12)
        else:
            assert alone[name].equals(shared[name])


@EACH
def test_added_parts_survive_toml_and_json(what: str) -> None:
    problem = PROBLEMS[what]
    assert tt.Problem.from_toml(problem.to_toml()) == problem
    assert tt.Problem.from_json(problem.to_json()) == problem
    assert tt.Problem(**problem.model_dump()) == problem


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"friction.mu": -1.0}, "friction.mu"),
        ({"body.shape.squash": 0.1}, "body.shape.squash"),
        ({"contact.until": 0.0}, "contact.until"),
        ({"contact.kind": "glued"}, "contact.kind"),
    ],
)
def test_what_cannot_be_is_refused_by_its_field(changes: dict[str, Any], field: str) -> None:
    everything = REPORT.model_copy(
        update={what.split(".")[0]: getattr(PROBLEMS[kind], what) for kind, what in PARTS.items()}
    )
    with pytest.raises(InvalidInput) as caught:
        everything.replace(changes)
    assert caught.value.field == field


PARTS = {"law": "friction", "surface": "body", "mode": "contact"}


def test_cells_that_a_part_refuses_are_refused() -> None:
    found = tt.sweep(
        PROBLEMS["surface"], {"body.shape.squash": [1e-3, 8e-3]}, duration=0.01, workers=1
    )
    assert found["fault"].values.tolist() == ["none", "value_out_of_range"]


def test_a_kind_needs_a_word_of_its_own() -> None:
    with pytest.raises(TypeError, match="Wordless needs a word"):

        class Wordless(tt.Friction):
            mu: float

    with pytest.raises(TypeError, match="Taken needs another word: 'viscous' is ViscousFriction"):

        class Taken(tt.Friction):
            kind: Literal["viscous"] = "viscous"

    assert tt.Friction.kinds["viscous"] is tt.ViscousFriction


SCRIPT = """
print("once")
import sys
import tippetop as tt
from typing import Literal, NamedTuple
from tippetop.extend import NO_TORQUE, Traction
import dask.base  # xarray imports it where it is installed, and it needs cloudpickle
import tippetop.sweeps.definition
tippetop.sweeps.definition.LEAST_CELLS_A_TASK = 1
workers, missing = map(int, sys.argv[1].split(",")), sys.argv[2:]
sys.modules.update(dict.fromkeys(missing))
class Law(NamedTuple):
    mu: float
    torque_free = True
    def traction(self, slip, angular_velocity):
        return Traction((-self.mu * slip[0], -self.mu * slip[1]), NO_TORQUE)
    def coefficients(self, units):
        return (self.mu * units.speed,)
class Mine(tt.Friction):
    kind: Literal["mine"] = "mine"
    mu: float
    @property
    def law(self):
        return Law(self.mu)
problem = tt.presets.report_problem().model_copy(update={"friction": Mine(mu=0.3)})
spins = {"launch.spin": [100.0, 155.0]}
for count in workers:
    try:
        found = tt.sweep(problem, spins, duration=0.1, workers=count or None)
        print(*found["final_spin"].values)
    except tt.InvalidInput as error:
        print(error)
print(__file__.endswith("script.py"), __spec__)
"""
"""It has no `if __name__ == "__main__"`, which the standard library asks for where processes are
started.
"""


def outputs(folder: Path, workers: str, *missing: str) -> list[str]:
    """Return what the script prints for numbers of workers (0 lets the sweep choose) where modules
    are missing.
    """
    script = folder / "script.py"
    script.write_text(SCRIPT, encoding="utf-8")
    command = [sys.executable, script, workers, *missing]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return done.stdout.splitlines()


def test_what_a_script_defines_is_computed_by_workers_that_do_not_run_it(tmp_path: Path) -> None:
    problem = tt.presets.report_problem()
    found = tt.sweep(problem, {"launch.spin": [100.0, 155.0]}, duration=0.1, workers=1)
    first, line, last = outputs(tmp_path, "2")
    assert (first, last) == ("once", "True None")
    numbers = list(map(float, line.split()))
    np.testing.assert_allclose(numbers, found["final_spin"].values, rtol=1e-12)


def test_without_cloudpickle_it_is_computed_in_its_own_process(tmp_path: Path) -> None:
    _, first, second, _ = outputs(tmp_path, "0,2", "cloudpickle")
    assert len(first.split()) == 2
    assert second.startswith("workers: 2 asks for other processes")
    assert "cloudpickle" in second
