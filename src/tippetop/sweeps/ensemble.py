"""The engine: cells in, observables out."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tippetop.contact.mode import Status
from tippetop.integrators.base import Array
from tippetop.mechanics.invariants import energy
from tippetop.mechanics.natural_units import Units
from tippetop.mechanics.surfaces.hull import lowest_gap
from tippetop.mechanics.vectors import length
from tippetop.results.accuracy_monitor import STATUSES_OF_MOTION, Monitor, monitored_quantities
from tippetop.results.catalogue import Fault, Outcome
from tippetop.results.metrics import STATUSES, Ends, metrics, outcomes_of, settled_band
from tippetop.results.settling import settled_tilt_of_one, settled_tilts
from tippetop.support.errors import Unavailable
from tippetop.sweeps.cells import cells_of, spread
from tippetop.sweeps.contents import OF_EVENTS, contents_of
from tippetop.sweeps.definition import Sweep
from tippetop.sweeps.grid import Flat
from tippetop.sweeps.lane_executor import Lanes, arrivals
from tippetop.sweeps.lane_sums import LaneSums, swept_motion
from tippetop.sweeps.launch_arrays import Launches, single
from tippetop.sweeps.listed_events import ListedEvents
from tippetop.sweeps.single_launches import follow_each, needs_single_launches, note_failure
from tippetop.sweeps.taylor_stepper import stepper
from tippetop.sweeps.trajectory_samples import TrajectorySamples

LANES_AT_ONCE = 2048
"""Launches that are followed together: enough to make little of Python's part, few enough for the
cache.
"""


def follow_cells(sweep: Sweep, numbers: Flat) -> dict[str, NDArray[np.generic]]:
    """Return each variable of `contents_of` a sweep but `is_done`, for cells counted row by row, of
    shape (n, ...).

    A cell in which something raises has failed. Where cells are followed together, they are halved
    until those that raise are by themselves: a cell's numbers do not depend on the others.
    """
    try:
        return _followed(sweep, numbers)
    except (MemoryError, Unavailable):
        raise
    except Exception as error:  # noqa: BLE001 - whatever was raised, the others go on
        if len(numbers) > 1:
            halves = [follow_cells(sweep, half) for half in np.array_split(numbers, 2)]
            return {name: np.concatenate([half[name] for half in halves]) for name in halves[0]}
        note_failure(error)
        return _unknown(sweep, 1, Outcome.FAILED)


def _unknown(sweep: Sweep, count: int, outcome: Outcome) -> dict[str, NDArray[np.generic]]:
    """Return each variable for cells of which nothing but the outcome is known."""
    variables: dict[str, NDArray[np.generic]] = {
        name: content.missing((count,))
        for name, content in contents_of(sweep).items()
        if name != "is_done"
    }
    variables["outcome"][:] = outcome
    variables["fault"][:] = Fault.NONE
    return variables


@np.errstate(all="ignore")  # numbers that are not finite show in outcomes
def _followed(sweep: Sweep, numbers: Flat) -> dict[str, NDArray[np.generic]]:
    cells = cells_of(sweep.problem, sweep.grid.values(numbers))
    count = len(numbers)
    variables = _unknown(sweep, count, Outcome.INVALID)
    variables["fault"][:] = cells.fault
    good = np.flatnonzero(cells.fault == Fault.NONE)
    if not len(good):
        return variables
    launches = cells.launches(good, sweep.duration)
    method, sums = None, LaneSums.of(launches.kind, sweep.keep)
    if not needs_single_launches(launches):
        motion = swept_motion(launches.kind, sums)
        method = stepper(motion, sweep.tolerance, sums, sampled=bool(sweep.sampled))
    alike = np.argsort(expected_cost(launches), kind="stable")
    for first in range(0, len(alike), LANES_AT_ONCE):
        block = alike[first : first + LANES_AT_ONCE]
        some, which = launches.some(block), good[block]
        units = Units(*(spread(unit, count)[which] for unit in cells.units))
        samples = None
        if sweep.keep:
            arrays: dict[str, Any] = {name: variables[name] for name in sweep.sampled}
            azimuths = spread(cells.problem.launch.azimuth, count)[which]
            samples = TrajectorySamples(
                some, units, sweep.sample_times, arrays, which, azimuths, sums
            )
            if sweep.event_places:
                listed: dict[str, Any] = {
                    name: variables[name] for name in ("event_count", *OF_EVENTS)
                }
                samples.events = ListedEvents(listed, which, units)
        if method is None:
            ends = follow_each(some, sweep.tolerance, sweep.settled, samples)
        else:
            lanes = Lanes(some, method, sweep.tolerance, settled=sweep.settled, samples=samples)
            ends = lanes.run()
            judge(ends, some, sweep.tolerance)
            done = ends.status == STATUSES.index(Status.COMPLETED)
            settled = settled_in_lanes(ends, some)
            ends.settled = np.where(done, settled, ends.settled)
            again = arrivals(lanes, settled_band(ends.settled))
            ends.arrived = np.where(np.isnan(again), ends.arrived, again)
        values = metrics(ends, some.state, some.top, units)
        values["outcome"] = outcomes_of(ends, some.state)
        if samples is not None:
            samples.finish()
            if sweep.sampled:
                values["is_sampled"] = samples.is_sampled
        for name, numbers_found in values.items():
            variables[name][which] = numbers_found.astype(variables[name].dtype)
    return variables


def settled_in_lanes(ends: Ends, launches: Launches) -> Array:
    """Return the tilts near which launches stay for ever, rad, shape (n,), or nan.

    Of a field, some launches may have parts that are zero: each is asked for its own.
    """
    if launches.kind.field is None:
        return settled_tilts(ends.state, launches.state, launches.top)
    tilts = [
        settled_tilt_of_one(
            STATUSES[status],
            single(ends.state, i),
            single(launches.state, i),
            launches.automaton(i).top,
        )
        for i, status in enumerate(np.asarray(ends.status).tolist())
    ]
    return np.array(tilts)


def judge(ends: Ends, launches: Launches, tolerance: float) -> None:
    """Mark launches as inaccurate that did not keep what a motion keeps.

    Conserved quantities are checked at the end only, since an error of theirs stays, gaps there,
    too, and normal forces by the least of each launch. The energy that is lost counts as the work
    of friction, so that its balance shows no error; the length of the axis shows errors first.
    """
    top, end = launches.top, ends.state
    monitor = Monitor(top, launches.state, launches.liftoff == "ignore")
    gone = energy(end, top) - energy(launches.state, top)
    monitor.check(*(number[None] for number in (*monitored_quantities(end, top), gone)))
    monitor.check_gap(lowest_gap(end.axis, end.height, top.surface)[None])
    monitor.check_force(np.nan_to_num(ends.least_force)[None])
    is_reported = np.isin(ends.status, [STATUSES.index(status) for status in STATUSES_OF_MOTION])
    is_broken = np.where(
        is_reported, ~monitor.is_trusted(tolerance), monitor.is_breached(tolerance)
    )
    ends.status[is_broken] = STATUSES.index(Status.INACCURATE)


def expected_cost(launches: Launches) -> Array:
    """Angle through which the axis nutates, rad: the steps that a launch takes grow with it."""
    cost: Array = length(launches.state.momentum) / launches.top.transverse_inertia * launches.end
    return cost
