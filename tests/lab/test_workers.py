import asyncio
import math
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Awaitable, Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from types import SimpleNamespace
from typing import TypeVar

import pytest

import tippetop as tt
from tippetop.export.track import MAGIC, unpack_header
from tippetop.lab import jobs, workers
from tippetop.lab.map_job import Fate, MapPart, map_parts
from tippetop.lab.phase_map import COLUMNS, ROWS, MapPlan, parts_of, plan_map
from tippetop.lab.setup import Setup, first_setup
from tippetop.lab.turns import Turns
from tippetop.lab.workers import Workers
from tippetop.processes import Worker

Result = TypeVar("Result")


def in_a_loop(work: Callable[[], Awaitable[Result]]) -> Result:
    async def run() -> Result:
        return await work()

    with ThreadPoolExecutor(1) as thread:  # another test's browser may have a loop in this one
        return thread.submit(asyncio.run, run()).result()


def is_alive(process: int) -> bool:
    """Whether a process runs: one that ended and that nobody minds is none."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except FileNotFoundError:
        return False


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


def test_a_map_is_told_from_coarse_to_fine_and_flights_last() -> None:
    plan = plan_map(first_setup().changed({"duration": 8.0}), 250.0)
    parts = list(map_parts(plan.setup, plan.spins, plan.frictions, haste=math.inf))
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

    assert in_a_loop(look) == (COLUMNS * ROWS // 64, 2)


def test_a_stopped_map_that_waits_is_not_begun() -> None:
    worker, stopped = Worker(jobs.warm_up), threading.Event()
    process = worker._process.pid
    stopped.set()
    assert list(worker.results(time.sleep, 60, patience=1, stopped=stopped)) == []
    assert worker._process.pid == process, "and its process still warms up"
    worker.close()


def test_a_map_that_waits_for_another_can_be_given_up(pool: Workers) -> None:
    first, second = threading.Event(), threading.Event()
    plan = plan_map(first_setup(), 250.0)
    parts = pool.map_parts(plan.setup, plan.spins, plan.frictions, first)
    next(parts)
    threading.Timer(0.1, second.set).start()
    began = time.monotonic()
    assert list(pool.map_parts(plan.setup, plan.spins, plan.frictions, second)) == []
    assert time.monotonic() - began < 2
    first.set()
    assert list(parts) == []


def test_files_do_not_wait_for_pictures_nor_leave_anything_behind(
    pool: Workers, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    short = first_setup().changed({"duration": 0.1})
    long = first_setup().changed({"launch.spin": 20_000.0, "friction.mu": 50.0, "duration": 120})
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    pool.track(short)  # the worker is ready
    monkeypatch.setattr(workers, "PATIENCE", 2.0)
    with ThreadPoolExecutor(1) as thread:
        refused = thread.submit(pool.track, long)
        assert pool.file(short, "csv").startswith(b"time")
        with pytest.raises(tt.InvalidInput, match="within 2 s"):
            refused.result()
    with monkeypatch.context() as patch:
        patch.setattr(workers, "FILE_PATIENCE", 0.3)
        with pytest.raises(tt.InvalidInput, match=r"within 0\.3 s"):
            pool.file(long, "nc")
    assert list(tmp_path.iterdir()) == []


def test_those_who_wait_hear_when_the_laboratory_is_closed() -> None:
    closing = Workers(1)
    closing.track(first_setup().changed({"duration": 0.1}))
    long = first_setup().changed({"launch.spin": 20_000.0, "friction.mu": 50.0, "duration": 120})
    with ThreadPoolExecutor(2) as threads:
        waiting = [threads.submit(closing.track, long) for _ in range(2)]
        time.sleep(0.5)
        closing.close()
        for each in waiting:
            with pytest.raises(tt.Unavailable, match="is being closed"):
                each.result(timeout=3)
    assert not any(worker._process.is_alive() for worker in closing._all), "none is started again"


def test_a_worker_ends_with_its_server_even_if_that_is_killed() -> None:
    pytest.importorskip("resource", reason="this reads /proc")
    program = """
import threading, time
from tippetop.processes import Worker
worker = Worker(int)
list(worker.results(int, patience=60))
threading.Thread(target=lambda: list(worker.results(time.sleep, 60, patience=90)), daemon=True).start()
print(worker._process.pid, flush=True)
time.sleep(60)
"""
    command = [sys.executable, "-c", program]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
        assert server.stdout is not None
        process = int(server.stdout.readline())
        time.sleep(0.5)
        assert is_alive(process)
        server.kill()
    deadline = time.monotonic() + 10
    while is_alive(process) and time.monotonic() < deadline:
        time.sleep(0.1)
    assert not is_alive(process)


async def is_wanted() -> None:
    """Somebody waits."""


def test_a_visitor_who_asks_for_much_delays_others_by_one_run() -> None:
    done = []

    async def ask() -> None:
        turns = Turns(1)

        def work(name: str) -> None:
            time.sleep(0.1)
            done.append(name)

        async def come(name: str, after: float = 0.0) -> None:
            await asyncio.sleep(after)
            await turns.take(name, lambda: work(name), is_wanted)

        await asyncio.gather(*(come("greedy") for _ in range(4)), come("neighbour", 0.05))

    in_a_loop(ask)
    assert done == ["greedy", "neighbour", "greedy", "greedy", "greedy"]


def test_one_visitor_does_not_have_all_places() -> None:
    async def ask() -> bool:
        turns, open_again = Turns(2), threading.Event()
        greedy = [asyncio.create_task(turns.take("greedy", open_again.wait, is_wanted)) for _ in range(3)]
        await asyncio.sleep(0.05)
        try:
            answered = await asyncio.wait_for(turns.take("neighbour", lambda: True, is_wanted), 5)
        finally:
            open_again.set()
            await asyncio.gather(*greedy)
        return answered

    assert in_a_loop(ask)


def test_too_much_is_refused_with_a_sentence() -> None:
    async def ask() -> None:
        turns, open_again = Turns(1, most=3, of_one=2), threading.Event()

        def come(name: str) -> "asyncio.Task[bool]":
            return asyncio.create_task(turns.take(name, open_again.wait, is_wanted))

        waiting = [come("a"), come("a"), come("b")]
        await asyncio.sleep(0.05)
        refused = [come("a"), come("c")]
        await asyncio.sleep(0.05)
        open_again.set()
        with pytest.raises(tt.Unavailable, match=r"2 runs of yours .* try again"):
            await refused[0]
        with pytest.raises(tt.Unavailable, match=r"many others .* try again"):
            await refused[1]
        assert await asyncio.gather(*waiting, return_exceptions=True) == [True] * 3
        assert await come("a"), "and then there is room again"

    in_a_loop(ask)


def test_work_whose_visitor_has_left_is_not_begun() -> None:
    async def ask() -> list[str]:
        turns, done, open_again = Turns(1), [], threading.Event()

        async def has_left() -> None:
            raise tt.Unavailable("nobody waits")

        first = asyncio.create_task(turns.take("a", open_again.wait, is_wanted))
        await asyncio.sleep(0.05)
        left = asyncio.create_task(turns.take("b", lambda: done.append("b"), has_left))
        await asyncio.sleep(0.5)
        open_again.set()
        with pytest.raises(tt.Unavailable, match="nobody waits"):
            await left
        await first
        await turns.take("c", lambda: done.append("c"), is_wanted)
        return done

    assert in_a_loop(ask) == ["c"]
