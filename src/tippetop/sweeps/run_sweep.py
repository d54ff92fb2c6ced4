"""Carry out a sweep, into a store or into memory."""

import math
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import psutil
import xarray as xr
from numpy.typing import ArrayLike

from tippetop.problem.implausible import warn
from tippetop.problem.problem import Problem
from tippetop.results.cf_flags import decoded
from tippetop.support.errors import Described, InvalidInput, require
from tippetop.support.progress_bar import Tell, progress_bar
from tippetop.support.validation import require_callback
from tippetop.sweeps.contents import (
    components_of,
    contents_of,
    coordinate_attributes,
    coordinates_of,
)
from tippetop.sweeps.definition import Sweep, Task
from tippetop.sweeps.draws import columns_of
from tippetop.sweeps.grid import Product
from tippetop.sweeps.implausible_cells import implausible_cells
from tippetop.sweeps.schedulers import Cluster, Found, need_workers, results
from tippetop.sweeps.store import Store
from tippetop.sweeps.store_layout import layout_attributes


@dataclass(frozen=True)
class Progress:
    """How far a sweep is."""

    cells: int
    """How many cells there are."""
    before: int
    """How many of them were done before this run began."""
    done: int
    """How many are done."""
    elapsed: float
    """Time since this run began, s."""

    @property
    def rate(self) -> float:
        """Cells per second in this run."""
        return (self.done - self.before) / self.elapsed if self.elapsed > 0 else 0.0


Callback = Callable[[Progress], None]


def shown_by(tell: Tell) -> Callback:
    """Return a callback that shows the progress of a sweep by a progress bar."""

    def show(now: Progress) -> None:
        rate = f" {now.rate:,.0f} launches/s" if now.rate else ""
        tell(now.done, now.cells, f"{now.done:,} of {now.cells:,}{rate}")

    return show


def _carry_out(
    sweep: Sweep,
    tasks: Sequence[Task],
    keep: Callable[[Task, Found], None],
    workers: int | None,
    scheduler: str | Cluster | None,
    callback: Callback | None,
) -> Progress:
    """Compute tasks of a sweep whose others are done, and keep what they find."""
    before = sweep.cells - sum(sweep.numbers(sweep.region(task)).size for task in tasks)
    began, tell = time.monotonic(), callback or (lambda _: None)
    progress = Progress(sweep.cells, before, before, 0.0)
    tell(progress)
    for task, variables in results(sweep, tasks, workers, scheduler) if tasks else ():
        keep(task, variables)
        done = progress.done + variables["outcome"].size
        progress = Progress(sweep.cells, before, done, time.monotonic() - began)
        tell(progress)
    return progress


def fill(
    store: Store,
    *,
    workers: int | None = None,
    scheduler: str | Cluster | None = None,
    callback: Callback | None = None,
) -> Progress:
    """Compute what is missing in a store; for workers, scheduler and callback see `sweep`.

    Raises `FileTrouble` if the store cannot be written, or another process fills it; it stays good,
    and another call goes on where this one ended. A store that was just created and in which
    nothing could be written is removed.
    """
    with store.held():
        return _carry_out(store.sweep, store.remaining(), store.write, workers, scheduler, callback)


def compute(
    sweep: Sweep,
    *,
    workers: int | None = 1,
    scheduler: str | None = None,
    callback: Callback | None = None,
) -> xr.Dataset:
    """Carry out a sweep in memory; for workers, scheduler and callback see `sweep`.

    The variables of `tippetop.results.catalogue.SWEPT` and `is_done` are over the grid, and those
    that are kept over the grid and the sample times.

    Raises `InvalidInput` if the samples do not fit into the free memory.
    """
    contents = contents_of(sweep)
    _require_memory(sweep)
    arrays = {name: content.missing(sweep.grid.shape) for name, content in contents.items()}

    def keep(task: Task, variables: Found) -> None:
        region = sweep.region(task)
        for name, values in variables.items():
            arrays[name][region] = values.reshape(arrays[name][region].shape)

    _carry_out(sweep, sweep.tasks, keep, workers, scheduler, callback)
    arrays["is_done"][...] = True
    data = {
        name: (
            (*sweep.dimensions, *content.dimensions),
            arrays[name],
            content.variable.attributes,
        )
        for name, content in contents.items()
    }
    coordinates: dict[str, Any] = {
        name: ((along,), values, coordinate_attributes(sweep, name))
        for name, (along, values) in coordinates_of(sweep).items()
    }
    return xr.Dataset(data, coordinates | components_of(sweep), layout_attributes(sweep))


def _require_memory(sweep: Sweep) -> None:
    """Refuse to keep samples in memory that are more than fit into it."""
    sizes = [
        math.prod(content.shape) * content.variable.bytes
        for content in contents_of(sweep).values()
        if content.shape
    ]
    total, free = sweep.cells * sum(sizes), psutil.virtual_memory().available
    if total > free:
        amount = f"{total / 1e9:.3g} GB of samples"
        fault = f"are more than the {free / 1e9:.3g} GB of free memory"
        hint = "keep them in a store, with out, or keep fewer variables or times"
        raise InvalidInput("keep", Described(amount), "", fault, hint)


def sweep(
    problem: Problem,
    over: Mapping[str, Any] | Product | None = None,
    *,
    draw: Any = None,
    count: int | None = None,
    seed: int | None = None,
    duration: float = 20.0,
    tolerance: float | None = None,
    settled: float | None = None,
    keep: str | Sequence[str] | None = None,
    samples: int | None = None,
    times: ArrayLike | None = None,
    most_events: int | None = None,
    events: object = None,
    until: object = None,
    out: Path | str | None = None,
    overwrite: bool = False,
    resume: bool = False,
    workers: int | None = None,
    scheduler: str | None = None,
    callback: Callback | None = None,
    progress: bool = True,
    decode: bool = True,
) -> xr.Dataset:
    """See what becomes of many launches: ``sweep(problem, {"launch.spin": np.linspace(0, 250,
    200)})``.

    Parameters
    ----------
    problem
        The problem whose fields are changed.
    over
        Fields, named with dots, and their values in SI units, of which all combinations are
        launched: lists, arrays, Series, DataArrays, or tables such as ``{"from": 0.05, "to": 1,
        "count": 40, "spacing": "log"}``.
    draw
        Fields and how each is drawn, instead of `over`: a distribution (any object with a method
        `ppf`, such as ``scipy.stats.norm(150, 5)``, or a table ``{"distribution": "norm", "loc":
        150, "scale": 5}``), a range ``{"from": 0.05, "to": 1, "spacing": "log"}``, or one number a
        draw (a list, an array, a Series, a DataArray). Or a DataFrame with a column a field and a
        row a draw, in which fields may be correlated.
    count
        Number of draws; omitted where values are listed.
    seed
        Seed of random draws, 0 if omitted: a draw does not depend on how many there are.
    duration
        Length of every run, s.
    tolerance
        Relative error per step: 1e-9 by default, and 1e-11 where samples are kept.
    settled
        A run ends once its energy holds the tilt within this for good, rad; None to follow every
        run for its whole duration.
    keep
        Variables over time, such as ``["tilt", "axis"]``, of which samples of every launch are
        kept, by their names in a run. They are not numbers after the end of a run that ends before
        `duration`, and `is_sampled` says so.
    samples
        Number of equally spaced samples from launch to `duration`, of what is kept; 201 by default.
    times
        Sample times instead, s: increasing, from 0 to `duration`.
    most_events
        Number of events of a run, the first ones, that are kept where "events" is in `keep`; 20 by
        default. They are `event_time`, `event_kind`, `event_impulse`, `event_energy_lost` and
        `event_surface`, not numbers where there are fewer, and `event_count` is how many there
        were.
    events, until
        Not in a sweep: they are refused with a sentence. `simulate` finds the instants at which
        functions of one's own pass through zero.
    out
        Folder of a Zarr store to keep the sweep in, whose name ends in .zarr or has no ending; in
        memory if left out.
    overwrite
        Replace a sweep that is there.
    resume
        Finish a sweep that is there.
    workers
        How many processes; None for as many as there are processors, 1 for this process alone.
    scheduler
        Address of a running dask.distributed scheduler, instead of processes.
    callback
        Told of the progress, at the beginning and after every task.
    progress
        Show progress and the time left in a terminal and below the cell of a notebook, unless a
        `callback` is told of it.
    decode
        Give outcomes, and all else that is flags, as words; False for their numbers, which take a
        byte a launch (see `Outcome`).

    Returns
    -------
    xarray.Dataset
        What became of every launch, over the grid: its outcome, final tilt, spin and precession,
        when it turned over, its flights, forces and losses, each with its SI unit. That of a store
        is read when used. A coordinate is named by the last word of its field, spin for
        launch.spin, where that names one field alone and nothing that is kept, else by the whole;
        its attribute `path` is the whole. The dimensions are the fields of `over`, or `draw`, and
        `time` of what is kept.

    Raises
    ------
    InvalidInput
        If there is no such field, or it cannot have such values; if `overwrite` or `resume` is
        asked for without `out`, or both are; if `n` or `seed` is given without `samples`; if `out`
        ends as the name of another kind of file.
    FileTrouble
        If there is something at `out` already, or it cannot be written.

    Examples
    --------
    >>> import tippetop as tt
    >>> spins = {"launch.spin": [10.0, 50.0, 155.0]}
    >>> found = tt.sweep(tt.presets.report_problem(), spins, duration=20.0)
    >>> [round(float(tilt), 2) for tilt in found["final_tilt"]]
    [0.0, 1.5, 3.14]
    >>> bool(found["outcome"].sel(spin=155.0) == "inverted")
    True

    Sampled trajectories of all launches:

    >>> found = tt.sweep(tt.presets.report_problem(), spins, duration=2.0, keep="tilt", samples=5)
    >>> found["tilt"].dims, found["tilt"].shape
    (('spin', 'time'), (3, 5))
    """
    chosen = Sweep(
        problem=problem,
        over=None if over is None else Product.of(over),
        draw=None if draw is None else columns_of(draw),
        count=count,
        seed=seed,
        duration=duration,
        **({} if tolerance is None else {"tolerance": tolerance}),
        settled=settled,
        keep=keep,
        samples=samples,
        times=times,
        most_events=most_events,
    )
    require_callback("callback", callback)
    for name, flag in {"progress": progress, "decode": decode}.items():
        require(name, flag, bool, "True or False")
    for field, functions in {"events": events, "until": until}.items():
        if functions is not None:
            fault = "is not followed in sweeps"
            hint = 'keep=["events"] keeps impacts and the like; simulate follows one launch'
            raise InvalidInput(field, functions, "", fault, hint)
    for field, asked in {"overwrite": overwrite, "resume": resume}.items():
        require(field, asked, bool, "True or False")
        if asked and out is None:
            raise InvalidInput(
                field, asked, "False", "needs out, which says where the sweep is kept"
            )
    if overwrite and resume:
        raise InvalidInput(
            "overwrite", overwrite, "False", "stands beside resume=True, which keeps what is there"
        )
    if doubt := implausible_cells(chosen):
        warn(doubt)
    with progress_bar() if progress and callback is None else nullcontext() as tell:
        callback = callback if tell is None else shown_by(tell)
        if out is None:
            swept = compute(chosen, workers=workers, scheduler=scheduler, callback=callback)
            return decoded(swept) if decode else swept
        with need_workers(chosen, workers, scheduler) as cluster:
            store = Store.resume(out, chosen) if resume else Store.create(out, chosen, overwrite)
            fill(store, workers=workers, scheduler=cluster, callback=callback)
    return decoded(store.dataset()) if decode else store.dataset()
