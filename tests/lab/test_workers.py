import asyncio
import os
import threading
import time
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from types import SimpleNamespace

import pytest

import tippetop as tt
from tippetop.export.track import MAGIC, unpack_header
from tippetop.lab import workers
from tippetop.lab.map_job import Fate, MapPart, map_parts
from tippetop.lab.phase_map import COLUMNS, ROWS, MapPlan, parts_of, plan_map
from tippetop.lab.setup import Setup, first_setup
from tippetop.lab.workers import Worker, Workers


@pytest.fixture(scope="module")
def pool() -> Iterator[Workers]:
    pool = Workers(1)
    yield pool
    pool.close()


def test_a_worker_runs_what_it_is_asked(pool: Workers) -> None:
    block = pool.track(first_setup().changed({"duration": 2}))
    assert block.startswith(MAGIC)
    assert unpack_header(block)["duration"] == 2.0


def test_a_run_that_takes_too_long_is_refused_and_the_next_is_not(
    pool: Workers, monkeypatch: pytest.MonkeyPatch
) -> None:
    frantic = first_setup().changed({"launch.spin": 20_000.0, "friction.mu": 50.0, "duration": 120})
    pool.track(first_setup().changed({"duration": 0.1}))  # the worker is ready
    with monkeypatch.context() as patch:
        patch.setattr(workers, "PATIENCE", 0.2)
        began = time.monotonic()
        with pytest.raises(tt.InvalidInput, match=r"duration = 120\.0 is not possible.*within 0\.2 s"):
            pool.track(frantic)
        assert time.monotonic() - began < 5
    assert pool.track(first_setup().changed({"duration": 0.1})).startswith(MAGIC)


def test_what_a_job_refuses_comes_back_as_it_is(pool: Workers) -> None:
    with pytest.raises(tt.InvalidInput, match=r"kind = 'doc' is not possible; accepted: nc, csv"):
        pool.file(first_setup(), "doc")


def test_a_fault_in_a_job_is_a_sentence_and_the_worker_goes_on(pool: Workers) -> None:
    with pytest.raises(tt.InvalidInput, match="can be computed"):
        pool.track(None)  # type: ignore[arg-type]
    assert pool.track(first_setup().changed({"duration": 0.1})).startswith(MAGIC)


def test_a_worker_that_ends_is_replaced() -> None:
    worker = Worker()
    with pytest.raises(tt.Unavailable, match="try again"):
        list(worker.results(os._exit, 1, patience=60))
    assert list(worker.results(len, "abc", patience=60)) == [3]
    worker.close()


def known_of(parts: Iterable[MapPart]) -> dict[int, tuple[float | None, int, Fate]]:
    """What is known of every cell in the end."""
    found = {}
    for part in parts:
        for cell, tilt, flights, fate in zip(part.cells, part.tilts, part.flights, part.fates, strict=True):
            found[cell] = tilt, flights, Fate(fate)
    return found


EGG = tt.Body(mass=0.02, shape=tt.Spheroid(across=0.015, along=0.025), I1=4e-6, I3=2e-6)
OTHERS = {
    "viscous": first_setup().problem,
    "coulomb": first_setup().problem.replace(
        {"friction": {"kind": "regularized_coulomb", "eps": 0.01, "mu": 0.3}}
    ),
    "egg": first_setup().problem.model_copy(update={"body": EGG}).replace({"launch.tilt": 1.5}),
    "dropped": first_setup().problem.replace({"launch.gap": 1e-3, "contact.restitution": 0.3}),
    "thrown": first_setup().problem.replace({"launch.velocity": (0.1, 0.0, 0.2)}),
    "held": first_setup().problem.replace({"contact.liftoff": "ignore"}),
}


@pytest.mark.parametrize("problem", OTHERS.values(), ids=OTHERS.keys())
def test_a_cell_is_the_launch_it_stands_for(problem: tt.Problem) -> None:
    spins, frictions = [20.0, 155.0, 240.0], [0.1, 1.0]
    known = known_of(map_parts(Setup(problem, 3.0), spins, frictions))
    assert sorted(known) == list(range(6))
    for cell, (tilt, flights, fate) in known.items():
        changes = {"launch.spin": spins[cell % 3], "friction.mu": frictions[cell // 3]}
        run = tt.simulate(problem.replace(changes), 3.0, times=[3.0], tolerance=1e-12)
        assert fate is Fate.FOLLOWED
        assert tilt == pytest.approx(float(run["theta"][-1]), abs=1e-5)
        assert flights == run.sizes["flight"]
    if problem.contact.liftoff == "fly":
        assert any(flights for _, flights, _ in known.values()), "some of these leave the table"


def test_a_cell_without_a_final_tilt_says_why() -> None:
    stopping = first_setup().changed({"contact.liftoff": "stop", "duration": 10.0})
    known = known_of(map_parts(stopping, [20.0, 175.0], [0.3]))
    assert known[0][2] is Fate.FOLLOWED
    assert known[1] == (None, 0, Fate.STOPPED)
    # Painleve's paradox, at the larger friction only.
    slipping = first_setup().changed({"contact.liftoff": "ignore", "launch.tilt": 1.0, "duration": 1.0})
    slipping = slipping.changed({"launch.slip": (1.0, 0.0)})
    known = known_of(map_parts(slipping, [20.0], [0.3, 10.0]))
    assert [fate for _, _, fate in known.values()] == [Fate.FOLLOWED, Fate.IMPOSSIBLE]
    assert len({fate.sentence for fate in Fate}) == len(Fate)


def test_a_map_is_told_from_coarse_to_fine_and_flights_last() -> None:
    plan = plan_map(first_setup().changed({"duration": 8.0}), 250.0)
    parts = list(map_parts(plan.setup, plan.spins, plan.frictions))
    cells = [cell for part in parts[:4] for cell in part.cells]
    assert {cell % COLUMNS % 4 for cell in cells} == {cell // COLUMNS % 4 for cell in cells} == {0}
    assert len(cells) == COLUMNS * ROWS // 16
    in_the_air = {
        c for p in parts for c, fate in zip(p.cells, p.fates, strict=True) if fate == Fate.IN_THE_AIR
    }
    assert set(parts[-1].cells) == in_the_air
    assert min(parts[-1].flights) > 0
    shares = [part.share for part in parts]
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    assert sorted(known_of(parts)) == list(range(COLUMNS * ROWS))


def test_a_map_that_would_take_long_stays_coarse() -> None:
    plan = plan_map(first_setup().changed({"duration": 0.5}), 250.0)
    parts = list(map_parts(plan.setup, plan.spins, plan.frictions, haste=0.0))
    assert len(known_of(parts)) == COLUMNS * ROWS // 16


def test_a_law_without_a_coefficient_has_no_map() -> None:
    without = SimpleNamespace(problem=SimpleNamespace(friction=SimpleNamespace(kind="none")))
    with pytest.raises(tt.InvalidInput, match=r"friction\.kind = 'none' is not possible.*coefficient mu"):
        plan_map(without, 250.0)  # type: ignore[arg-type]


def test_a_map_can_be_given_up(pool: Workers) -> None:
    stopped = threading.Event()
    plan = plan_map(first_setup(), 250.0)
    parts = pool.map_parts(plan.setup, plan.spins, plan.frictions, stopped)
    next(parts)
    stopped.set()
    assert list(parts) == []
    short = Setup(tt.presets.report_problem(), 0.1)
    assert len(list(pool.map_parts(short, [10.0], [0.3], threading.Event()))) == 1


def test_a_map_that_takes_too_long_is_refused(pool: Workers, monkeypatch: pytest.MonkeyPatch) -> None:
    with monkeypatch.context() as patch:
        patch.setattr(workers, "MAP_PATIENCE", 0.0)
        with pytest.raises(tt.InvalidInput, match="accepted: a map that is computed within 0 s"):
            list(pool.map_parts(first_setup(), [155.0], [0.3], threading.Event()))


def test_a_page_that_goes_away_stops_its_map(pool: Workers) -> None:
    async def look() -> tuple[int, int]:
        parts = parts_of(plan_map(first_setup(), 250.0), pool)
        seen = await anext(parts)
        await parts.aclose()  # type: ignore[attr-defined]
        other = MapPlan(Setup(tt.presets.report_problem(), 0.1), [10.0, 20.0], [0.3])
        return len(seen.cells), len(known_of([part async for part in parts_of(other, pool)]))

    with ThreadPoolExecutor(1) as thread:  # another test's browser may have a loop in this one
        assert thread.submit(asyncio.run, look()).result() == (COLUMNS * ROWS // 64, 2)
