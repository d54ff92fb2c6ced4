"""The Taylor method is compiled once for all values, and kept between processes where that is
possible.
"""

import itertools
import os
import subprocess
import sys
import threading
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from exact_motions import DEFAULTS, FREQUENCY, KEPLER, OSCILLATOR, follow, whole

from children import posix_only
from tippetop.integrators import Guard, Motion, make_integrator, taylor
from tippetop.integrators.base import NOT_FINITE
from tippetop.integrators.sealed_folders import SEAL, VARIABLE

TAYLOR = DEFAULTS[0]


@pytest.fixture
def compilations(monkeypatch):
    """The orders of all that is compiled from here on."""
    made = []

    class Counted(taylor.SeriesExpansion):
        def __init__(self, recorded, order):
            made.append(order)
            super().__init__(recorded, order)

    monkeypatch.setattr(taylor, "SeriesExpansion", Counted)
    monkeypatch.setenv(VARIABLE, "off")
    return made


def swing(motion, frequency, guards=(), tolerance=None):
    """Follow an oscillator of this frequency for a second; return the arc."""
    integrator = taylor.Taylor(tolerance) if tolerance else taylor.Taylor()
    motion = replace(motion, guards=tuple(guards))
    return whole(integrator.integrate(motion, (frequency,), (0.0, np.array([1.0, 0.0])), 1.0))


def oscillator():
    """A motion that nothing has been compiled for."""
    return Motion(lambda y, p: (y[1], -(p[0] ** 2) * y[0]), size=2, parameters=1)


def test_a_motion_whose_coefficients_are_beyond_all_floats_is_followed_by_a_slower_clock():
    frequency = 1e20
    motion = Motion(lambda y, p: (p[0] * y[1], -p[0] * y[0]), size=2, parameters=1)
    guarded = replace(motion, guards=(Guard("position", lambda y, _: y[0] + 0.5),))
    for each, angle in ((motion, 10.0), (guarded, 2.0 * np.pi / 3.0)):
        start = 0.0, np.array([1.0, 0.0])
        arc = whole(taylor.Taylor().integrate(each, (frequency,), start, 10.0 / frequency))
        assert arc.failure is None
        assert arc.solution.end == pytest.approx(angle / frequency, rel=1e-13)
        assert arc.end_state[0] == pytest.approx(np.cos(angle), abs=1e-13)
        times = np.linspace(0.0, arc.solution.end, 9)
        np.testing.assert_allclose(arc.solution(times)[:, 0], np.cos(frequency * times), atol=1e-13)


def test_one_compilation_serves_all_values_of_the_parameters(compilations):
    motion, guards = oscillator(), (Guard("position", lambda y, _: y[0]),)
    frequencies = np.linspace(0.1, 3.0, 20)
    for frequency in frequencies:
        arc = swing(motion, frequency, guards)
        quarter = np.pi / 2 / frequency
        assert (arc.guard is not None) == (quarter < 1.0)
        assert arc.solution.end == pytest.approx(min(quarter, 1.0), rel=1e-14)
        assert arc.end_state[0] == pytest.approx(np.cos(frequency * arc.solution.end), abs=1e-14)
    assert len(compilations) == 1


def test_equal_guards_and_equal_tolerances_share_a_compilation_and_others_do_not(compilations):
    motion, guard = oscillator(), Guard("position", lambda y, _: y[0])
    swing(motion, 1.0, [guard])
    swing(motion, 1.0, (Guard(guard.name, guard.value),))
    swing(motion, 1.0, [guard], taylor.Taylor().tolerance)
    assert len(compilations) == 1
    swing(motion, 1.0)
    swing(motion, 1.0, [guard], 1e-9)
    assert compilations == [20, 20, taylor.order_for(1e-9)]


def test_an_arc_that_hit_a_guard_leaves_nothing_behind_for_the_next():
    motion, guards = oscillator(), (Guard("position", lambda y, _: y[0]),)
    first = swing(motion, 2.0, guards)
    swing(motion, 2.5, guards)
    again = swing(motion, 2.0, guards)
    assert first.guard == again.guard == "position"
    assert again.solution.end == first.solution.end
    np.testing.assert_array_equal(again.end_state, first.end_state)


@pytest.mark.parametrize("long", [1, 2, 5, 4096])
def test_long_motions_are_followed_in_arcs_that_do_not_show(monkeypatch, long):
    times = np.linspace(0.0, KEPLER.end, 200)
    uncut = follow(TAYLOR, KEPLER)
    monkeypatch.setattr(taylor, "STEPS_PER_ARC", long)
    arc = follow(TAYLOR, KEPLER)
    assert arc.solution.end == KEPLER.end
    assert arc.steps == uncut.steps > 10
    np.testing.assert_allclose(arc.solution.knots, uncut.solution.knots, rtol=1e-9)
    np.testing.assert_allclose(arc.solution(times), KEPLER.states(times), rtol=0, atol=1e-12)
    np.testing.assert_allclose(arc.end_state, uncut.end_state, rtol=0, atol=1e-13)


@pytest.mark.parametrize("relieved", [False, True])
@pytest.mark.parametrize("begin", [0.0, 1e3])
def test_what_turns_beside_what_blows_up_keeps_its_length_to_the_end(begin, relieved):
    """One number is 1e8 / (1 - t), and two turn at 50 / (1 - t), whose steps must be the shorter
    ones.
    """

    def rates(y, _):
        growth = 1e-8 * y[0]
        return growth * y[0], -50.0 * growth * y[2], 50.0 * growth * y[1]

    motion = Motion(rates, size=3, parameters=0)
    integrator = make_integrator() if relieved else taylor.Taylor()
    start = begin, np.array([1e8, 1.0, 0.0])
    arcs = list(itertools.islice(integrator.integrate(motion, (), start, begin + 2.0), 16))
    arc = whole(arcs)
    assert arc.failure == NOT_FINITE
    assert arc.solution.end == pytest.approx(begin + 1.0, rel=0, abs=1e-8 * (1.0 + begin))
    # Where steps are as short as a million roundings of time, they are what they can be.
    told = begin + 1.0 - 1e-8 * (1.0 + begin)
    states = arc.solution(np.linspace(begin, told, 1000))
    lengths = np.hypot(states[:, 1], states[:, 2])
    np.testing.assert_allclose(lengths, 1.0, rtol=0, atol=10.0 * arc.steps * integrator.tolerance)


@pytest.mark.parametrize("long", [1, 2, 24, 4096])
def test_guard_is_found_in_whichever_arc_it_falls(monkeypatch, long):
    monkeypatch.setattr(taylor, "STEPS_PER_ARC", long)
    arc = follow(TAYLOR, OSCILLATOR, [Guard("position", lambda y, _: y[0])])
    when = np.pi / 2 / FREQUENCY
    assert arc.guard == "position"
    assert arc.solution.end == pytest.approx(when, rel=1e-14)
    times = np.linspace(0.0, arc.solution.end, 50)
    np.testing.assert_allclose(arc.solution(times), OSCILLATOR.states(times), rtol=0, atol=1e-14)


def test_threads_that_share_a_compilation_do_not_mix_their_motions():
    motion, times = oscillator(), np.linspace(0.0, 50.0, 20_001)
    frequencies = np.linspace(0.5, 3.0, 8)
    results = {}

    def run(frequency):
        start = 0.0, np.array([1.0, 0.0])
        for _ in range(5):
            results[frequency] = whole(taylor.Taylor().integrate(motion, (frequency,), start, 50.0))

    threads = [threading.Thread(target=run, args=(frequency,)) for frequency in frequencies]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for frequency in frequencies:
        found = results[frequency].solution(times)[:, 0]
        np.testing.assert_allclose(found, np.cos(frequency * times), atol=1e-11)


# --- between processes
# --------------------------------------------------------------------------------------

SWING = """
import numpy as np
from tippetop.integrators import Motion, make_integrator
motion = Motion(lambda y, p: (y[1], -p[0] ** 2 * y[0]), size=2, parameters=1)
start = 0.0, np.array([1.0, 0.0])
[arc] = make_integrator("taylor").integrate(motion, (np.pi,), start, 1.0)
assert abs(arc.end_state[0] + 1.0) < 1e-14, arc
assert abs(arc.end_state[1]) < 1e-14, arc
"""


def swing_elsewhere(**variables):
    """Follow half a swing in another process, which must be right and silent."""
    environment = {name: value for name, value in os.environ.items() if name != VARIABLE}
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", SWING],
        env={**environment, **{name: str(value) for name, value in variables.items()}},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert (done.stdout, done.stderr, done.returncode) == ("", "", 0)


def kept(folder):
    """The files of compiled code in a cache: their content, and what would change if it were made
    again.
    """
    files = [path for path in folder.rglob("*") if path.is_file()]
    return {
        path: (path.stat().st_ino, path.stat().st_mtime_ns, path.read_bytes()) for path in files
    }


@pytest.fixture(scope="module")
def filled_cache(tmp_path_factory):
    """A folder in which a process has left its compiled code."""
    folder = tmp_path_factory.mktemp("filled")
    swing_elsewhere(**{VARIABLE: folder})
    return folder


def test_a_second_process_compiles_nothing(filled_cache):
    before = kept(filled_cache)
    assert len(before) == 4, "the code of the motion and of its steps, and their seals"
    swing_elsewhere(**{VARIABLE: filled_cache})
    assert kept(filled_cache) == before


def test_cache_folder_is_made_when_there_is_none(tmp_path):
    swing_elsewhere(**{VARIABLE: tmp_path / "deep" / "down"})
    assert kept(tmp_path / "deep" / "down")


def test_cache_is_kept_in_the_users_cache_folder(tmp_path):
    swing_elsewhere(XDG_CACHE_HOME=tmp_path, HOME=tmp_path)
    seals = list(tmp_path.rglob(SEAL))
    assert {seal.parent.parent.name for seal in seals} == {"tippetop"}
    assert all(kept(seal.parent) for seal in seals)


def test_cache_can_be_turned_off(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    swing_elsewhere(XDG_CACHE_HOME=tmp_path, HOME=tmp_path, **{VARIABLE: "off"})
    assert list(tmp_path.rglob("*")) == []


def a_file_in_its_place(folder: Path) -> Path:
    place = folder / "file"
    place.write_text("mine")
    return place


def below_a_file(folder: Path) -> Path:
    return a_file_in_its_place(folder) / "cache"


def a_folder_that_cannot_be_made(_: Path) -> Path:
    return Path("/proc/no/such/folder")


def a_folder_that_cannot_be_written(_: Path) -> Path:
    return Path("/proc/self")


@posix_only
@pytest.mark.parametrize(
    "place",
    [
        a_file_in_its_place,
        pytest.param(below_a_file, marks=pytest.mark.slow),
        pytest.param(a_folder_that_cannot_be_made, marks=pytest.mark.slow),
        a_folder_that_cannot_be_written,
    ],
    ids=lambda place: place.__name__,
)
def test_where_no_cache_can_be_kept_every_process_compiles_for_itself(tmp_path, place):
    folder = place(tmp_path)
    before = sorted(tmp_path.rglob("*"))
    swing_elsewhere(**{VARIABLE: folder})
    assert sorted(tmp_path.rglob("*")) == before
    if folder.is_file():
        assert folder.read_text() == "mine"


def test_a_guard_that_turns_where_its_polynomial_goes_on_does_not_fall():
    """It is |t - 0.5| + 0.1 but for a rounding, which no polynomial made at t = 0 tells."""
    clock = Motion(
        lambda y, _: (1.0,),
        size=1,
        parameters=0,
        guards=(Guard("turns", lambda y, _: ((y[0] - 0.5) ** 2 + 1e-24) ** 0.5 + 0.1),),
    )
    arcs = list(taylor.Taylor().integrate(clock, (), (0.0, np.array([0.0])), 2.0))
    assert [arc.guard for arc in arcs] == [None]
    assert whole(arcs).solution.end == 2.0


def bending(y, _):
    """0.2 until t = 0.5, and from there on 0.2 - 2 (t - 0.5): it falls at 0.6."""
    late = y[0] - 0.5
    return 0.2 - late - (late * late + 1e-24) ** 0.5


def test_a_guard_that_falls_in_a_step_whose_polynomial_does_not_tell_falls_at_its_end():
    """An oscillation beside the guard takes steps; in one of them the guard bends."""
    clock = Motion(
        lambda y, _: (1.0, y[2], -y[1]),
        size=3,
        parameters=0,
        guards=(Guard("bends", bending),),
    )
    arcs = list(taylor.Taylor().integrate(clock, (), (0.0, np.array([0.0, 1.0, 0.0])), 5.0))
    assert [arc.guard for arc in arcs] == ["bends"]
    before, end = arcs[-1].solution.knots[-2:]
    assert before < 0.5
    assert 0.6 <= end < 4.0
    assert arcs[-1].end_state[0] == end


@pytest.mark.parametrize("end", [0.55, 2.0])
def test_so_it_does_at_the_end_of_the_motion(end):
    clock = Motion(lambda y, _: (1.0,), size=1, parameters=0, guards=(Guard("bends", bending),))
    arcs = list(taylor.Taylor().integrate(clock, (), (0.0, np.array([0.0])), end))
    assert [arc.guard for arc in arcs] == ["bends" if end > 0.6 else None]
    assert whole(arcs).solution.end == end


def test_a_guard_that_starts_below_zero_has_not_fallen():
    """By rounding, or because what it guards has just ended: it is to rise first."""
    guards = (Guard("below", lambda y, _: y[0] - 1e-9), Guard("stays", lambda y, _: -1.0 - y[0]))
    clock = Motion(lambda y, _: (1.0,), size=1, parameters=0, guards=guards)
    arcs = list(taylor.Taylor().integrate(clock, (), (0.0, np.array([0.0])), 2.0))
    assert [arc.guard for arc in arcs] == [None]
