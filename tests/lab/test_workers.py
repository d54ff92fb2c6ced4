import asyncio
import threading
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor

import pytest

import tippetop as tt
from tippetop.export.track import MAGIC, unpack_header
from tippetop.lab import workers
from tippetop.lab.phase_map import ROWS, plan_map, rows_of
from tippetop.lab.setup import Setup, first_setup
from tippetop.lab.workers import Workers


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


def test_a_map_comes_row_by_row_and_agrees_with_single_runs(pool: Workers) -> None:
    setup = first_setup().changed({"duration": 3})
    spins, frictions = [20.0, 155.0], [0.1, 0.5]
    rows = list(pool.map_rows(setup, spins, frictions, threading.Event()))
    assert [row.row for row in rows] == [0, 1]
    for row, mu in zip(rows, frictions, strict=True):
        for tilt, spin in zip(row.tilts, spins, strict=True):
            run = tt.simulate(tt.presets.report_problem(spin=spin, mu=mu), 3.0)
            assert tilt == pytest.approx(float(run["theta"][-1]), abs=1e-9)


def test_a_map_can_be_given_up(pool: Workers) -> None:
    stopped = threading.Event()
    rows = pool.map_rows(first_setup(), [155.0] * 50, [0.3] * 50, stopped)
    next(rows)
    stopped.set()
    assert list(rows) == []
    short = Setup(tt.presets.report_problem(), 0.1)
    assert len(list(pool.map_rows(short, [10.0], [0.3], threading.Event()))) == 1


def test_a_page_that_goes_away_stops_its_map(pool: Workers) -> None:
    async def look() -> list[int]:
        rows = rows_of(plan_map(first_setup(), 250.0), pool)
        seen = [(await anext(rows)).row]
        await rows.aclose()  # type: ignore[attr-defined]
        other = plan_map(Setup(tt.presets.report_problem(), 0.1), 250.0)
        return seen + [row.row async for row in rows_of(other, pool)]

    with ThreadPoolExecutor(1) as thread:  # another test's browser may have a loop in this one
        assert thread.submit(asyncio.run, look()).result() == [0, *range(ROWS)]
