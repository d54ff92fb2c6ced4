"""Who computes the tasks of a sweep: this process, processes beside it, or a Dask cluster."""

import json
import logging
import threading
import time
from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, CancelledError, Future, wait
from contextlib import contextmanager, nullcontext
from functools import lru_cache
from importlib import import_module
from importlib.util import find_spec
from traceback import walk_tb
from typing import Any, NamedTuple, TypeAlias

from numpy.typing import NDArray

from tippetop import __version__
from tippetop.support.errors import RESUME, InvalidInput, Unavailable, is_whole
from tippetop.support.installation import install_command
from tippetop.support.processes import RESTARTS, Job, processors, shared
from tippetop.support.validation import foreign_kinds, receive_kinds
from tippetop.sweeps.definition import Sweep, Task
from tippetop.sweeps.ensemble import follow_cells

Found: TypeAlias = dict[str, NDArray[Any]]
Call: TypeAlias = tuple[str, str, tuple[str, ...], tuple[slice, ...], bytes]
"""What `compute_region` is called with."""

AHEAD = 2
"""Tasks handed out for every worker of a cluster, so that none waits."""

PATIENCE = 10.0
"""How long a scheduler may take to answer, s."""
LONELY = 60.0
"""How long a cluster may be without workers before the sweep is given up, s."""
GLANCE = 1.0
"""How often it is looked whether it has some, if no task is done meanwhile, s."""

KEPT = f"what is done is kept, and {RESUME} goes on"

HERE = "__main__"
"""Where what a script or notebook defines is, which no other process can import."""

_turn = threading.Lock()


class Cluster(NamedTuple):
    """A running cluster that is connected to."""

    address: str
    client: Any


def compute_region(
    description: str,
    version: str,
    modules: tuple[str, ...],
    region: tuple[slice, ...],
    kinds: bytes = b"",
) -> Found:
    """Compute a region of the cells from parameters: this is all that a worker is sent.

    The modules are those in which the user's kinds of parts are defined; `kinds` has those that a
    script or a notebook defines, pickled.

    Raises `Unavailable` if the worker has another version of this package, or lacks a module.
    """
    if version != __version__:
        raise Unavailable(f"a worker has tippetop {__version__}, and the sweep is run by {version}")
    try:
        for name in modules:
            import_module(name)
        if kinds:
            receive_kinds(kinds)
    except ImportError as error:
        raise Unavailable(
            f"a worker cannot import the module of a part of the problem: {error}"
        ) from None
    sweep = _sweep(description, kinds)
    # Compiled functions have one set of buffers; a worker with several threads takes turns.
    with _turn:
        return follow_cells(sweep, sweep.numbers(region).ravel())


@lru_cache(maxsize=4)
def _sweep(description: str, kinds: bytes) -> Sweep:
    """Return a sweep by its description, and by the kinds of its parts that were received."""
    return Sweep(**json.loads(description))


def results(
    sweep: Sweep,
    tasks: Sequence[Task],
    workers: int | None = None,
    scheduler: str | Cluster | None = None,
) -> Iterator[tuple[Task, Found]]:
    """Compute tasks of a sweep and give what they found as it comes, in any order; see
    `need_workers`.
    """
    modules, kinds = _own_parts(sweep, workers, scheduler)
    if kinds is None:
        workers, kinds = 1, b""
    count = min(workers or processors(), max(len(tasks), 1))
    if scheduler is None and count == 1:
        kinds = b""  # This process has them.
    description = json.dumps(sweep.to_fields())
    calls = {task: (description, __version__, modules, sweep.region(task), kinds) for task in tasks}
    if scheduler is not None:
        yield from _share_with_cluster(scheduler, calls)
        return
    jobs = (Job(task, compute_region, call) for task, call in calls.items())
    try:
        yield from shared(lambda: next(jobs, None), count)
    except Unavailable as error:
        raise Unavailable(f"{error}; {KEPT}") from None


@contextmanager
def need_workers(
    sweep: Sweep, workers: int | None, scheduler: str | None
) -> Iterator[Cluster | None]:
    """See that there is someone to compute, before anything is written; for both see `sweep`.

    Gives the cluster, connected to, that takes the place of the scheduler's address meanwhile.

    Raises `InvalidInput` if the number of workers is not positive, or there is no scheduler at the
    address; `Unavailable` if dask.distributed is needed and not installed.
    """
    _own_parts(sweep, workers, scheduler)
    with nullcontext() if scheduler is None else _cluster(scheduler) as cluster:
        yield cluster


def _own_parts(
    sweep: Sweep, workers: int | None, scheduler: str | Cluster | None
) -> tuple[tuple[str, ...], bytes | None]:
    """Return what workers need for kinds of parts that are not of this package.

    Returns
    -------
    tuple
        The modules to import, and the kinds that a script or a notebook defines, pickled; None
        where these cannot be sent, and this process has to compute alone.
    """
    is_count = is_whole(workers) and workers >= 1
    if not (workers is None or is_count):
        raise InvalidInput("workers", workers, "a whole number, at least 1")
    foreign = sorted(foreign_kinds(sweep.problem), key=lambda kind: kind.__qualname__)
    modules = tuple(sorted({kind.__module__ for kind in foreign} - {HERE}))
    unimportable = [kind for kind in foreign if kind.__module__ == HERE]
    kinds, why = _pickled(unimportable) if unimportable else (b"", "")
    if kinds is None and (scheduler is not None or workers not in (None, 1)):
        raise InvalidInput(
            "workers" if scheduler is None else "scheduler",
            workers if scheduler is None else scheduler,
            "1",
            f"asks for other processes, and the script itself defines parts, which {why}",
            "write workers=1, or define them in a module",
        )
    return modules, kinds


def _pickled(kinds: Sequence[type]) -> tuple[bytes | None, str]:
    """Return kinds of parts as they are sent to other processes; None, and why, where that cannot
    be.
    """
    if find_spec("cloudpickle") is None:
        return None, f"only cloudpickle sends to other processes ({install_command('sweep')})"
    import cloudpickle  # noqa: PLC0415 - optional

    try:
        return cloudpickle.dumps(kinds), ""
    except Exception as error:  # noqa: BLE001 - whatever it is of a user's that cannot be pickled
        return None, f"cannot be sent to other processes ({error})"


def _share_with_cluster(
    scheduler: str | Cluster, calls: Mapping[Task, Call]
) -> Iterator[tuple[Task, Found]]:
    """Hand tasks to a cluster, a few ahead of every worker; it does those of workers that died
    again.
    """
    waiting = deque(calls)
    running: dict[Future[Found], Task] = {}
    with (
        nullcontext(scheduler) if isinstance(scheduler, Cluster) else _cluster(scheduler)
    ) as cluster:
        address, client = cluster
        executor = client.get_executor(retries=RESTARTS)
        most = AHEAD * _workers(client)
        try:
            while waiting or running:
                while waiting and len(running) < most:
                    task = waiting.popleft()
                    running[executor.submit(compute_region, *calls[task])] = task
                for future in _first_done(client, address, running):
                    task = running.pop(future)
                    yield task, future.result()
        except Exception as error:
            if _is_of_cluster(error):
                raise Unavailable(
                    f"the cluster at {address} was lost ({type(error).__name__}); {KEPT}"
                ) from None
            raise
        finally:
            for future in running:
                future.cancel()


def _is_of_cluster(error: Exception) -> bool:
    """Return whether the cluster failed, not a task: the library raises errors over results of lost
    workers.
    """
    *_, (innermost, _) = walk_tb(error.__traceback__)
    where = (type(error).__module__, innermost.f_globals.get("__name__", ""))
    return isinstance(error, CancelledError) or any(
        name.startswith("distributed") for name in where
    )


def _first_done(
    client: Any, address: str, running: Mapping[Future[Found], Task]
) -> set[Future[Found]]:
    """Wait until one is done, as long as there is somebody to do it."""
    lonely_since = 0.0
    while True:
        done, _ = wait(running, timeout=GLANCE, return_when=FIRST_COMPLETED)
        if done:
            return done
        if client.status != "running":
            # Tasks handed out since then are cancelled only when the client gives up reconnecting.
            raise CancelledError
        if _workers(client):
            lonely_since = 0.0
            continue
        if not lonely_since:
            lonely_since = time.monotonic()
            logging.getLogger(__name__).warning(
                "the cluster at %s has no workers; the sweep waits for some, %g s", address, LONELY
            )
        if time.monotonic() - lonely_since >= LONELY:
            raise Unavailable(
                f"the cluster at {address} has had no workers for {LONELY:g} s; {KEPT}"
            )


def _workers(client: Any) -> int:
    return len(client.scheduler_info(n_workers=-1).get("workers", ()))


@contextmanager
def _cluster(address: str) -> Iterator[Cluster]:
    """Return a running cluster that has workers."""
    if find_spec("distributed") is None:
        raise Unavailable(f"a scheduler needs dask.distributed: {install_command('sweep')}")
    from distributed import Client  # noqa: PLC0415 - optional, and slow to import
    from distributed.comm.addressing import get_address_host_port  # noqa: PLC0415
    from distributed.utils import silence_logging_cmgr  # noqa: PLC0415

    # What goes wrong is said here, in a sentence.
    with silence_logging_cmgr(logging.CRITICAL):
        try:
            # A client that is asked for no address tries for long, and complains at its end.
            get_address_host_port(address)
            client: Any = Client(address, timeout=PATIENCE, set_as_default=False)  # type: ignore[no-untyped-call]
        except (OSError, TypeError, ValueError) as error:
            raise InvalidInput(
                "scheduler",
                address,
                "the address of a running scheduler",
                f"does not answer ({error})",
            ) from None
        with client:
            if not _workers(client):
                raise InvalidInput("scheduler", address, "", "has no workers", "start some")
            yield Cluster(address, client)
