"""A cell in which something raises is a cell that has failed, and the others are as they were."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import tippetop as tt
from tippetop.contact.automaton import Automaton
from tippetop.mechanics.top import natural_state, natural_units
from tippetop.problem.problem import top_of
from tippetop.sweeps import Store

SPINS = [10.0, 20.0, 30.0, 40.0]
BAD = 2
STEM = [tt.Sphere(radius=0.02, center=0.006), tt.Ring(radius=0.004, center=0.0334)]


def problem_of(several: bool) -> tt.Problem:
    """A top that is dropped: the report's, or one with a stem."""
    fields = {"launch.gap": 0.001, "contact.liftoff": "fly"}
    problem = tt.presets.report_problem(spin=SPINS[BAD]).replace(fields)
    if not several:
        return problem
    return problem.replace({"body": tt.Body(mass=0.02, shape=STEM, I1=3e-6, I3=3.2e-6)})


def swept(problem: tt.Problem, **options: Any) -> Any:
    return tt.sweep(problem, {"launch.spin": SPINS}, duration=0.01, workers=1, **options)


@pytest.mark.parametrize(
    ("several", "error"),
    [(False, ZeroDivisionError("by nothing")), (True, RuntimeError("whatever"))],
)
def test_a_launch_that_raises_fails_alone(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, several: bool, error: Exception
) -> None:
    """One by one, in lanes, and in a store."""
    problem, launch = problem_of(several), Automaton.launch
    bad = natural_state(problem.start(), natural_units(top_of(problem))).momentum[2]

    def raising(self: Automaton, state: Any) -> Any:
        if np.isclose(state.momentum[2], bad):
            raise error
        return launch(self, state)

    before = swept(problem)
    monkeypatch.setattr(Automaton, "launch", raising)
    for after in (swept(problem), swept(problem, out=tmp_path / "a.zarr")):
        assert after["is_done"].all()
        assert str(after["outcome"][BAD].values) == "failed"
        assert np.isnan(after["final_tilt"][BAD])
        others = [0, 1, 3]
        assert after[{"spin": others}].drop_attrs().equals(before[{"spin": others}].drop_attrs())


def test_what_ends_the_program_ends_the_sweep(monkeypatch: pytest.MonkeyPatch) -> None:
    def raising(self: Automaton, state: Any) -> Any:
        raise MemoryError

    monkeypatch.setattr(Automaton, "launch", raising)
    with pytest.raises(MemoryError):
        swept(problem_of(True))


def test_a_lost_chunk_of_the_status_is_damage_and_is_mended(tmp_path: Path) -> None:
    path, problem = tmp_path / "a.zarr", problem_of(False)
    done = swept(problem, out=path).load()
    (chunk,) = (path / "is_done" / "c").iterdir()
    chunk.unlink()
    with pytest.raises(tt.FileTrouble, match=r"damaged.*is_done is missing"):
        tt.read_sweep(path)
    assert swept(problem, out=path, resume=True).load().equals(done)


def test_a_store_that_could_never_be_written_leaves_nothing(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def full(self: Store, task: Any, variables: Any) -> None:
        raise tt.FileTrouble("no space left on device")

    monkeypatch.setattr(Store, "write", full)
    with pytest.raises(tt.FileTrouble, match="no space"):
        swept(problem_of(False), out=tmp_path / "a.zarr")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", ["a.nc", "a.h5", "a.csv"])
def test_a_store_does_not_have_the_name_of_another_kind_of_file(tmp_path: Path, name: str) -> None:
    with pytest.raises(tt.InvalidInput, match=r"out: .*zarr"):
        swept(problem_of(False), out=tmp_path / name)
    assert list(tmp_path.iterdir()) == []
