"""Recording of a run: samples, integrals along it, and the check of conserved quantities."""

from typing import Self

import numpy as np
from numpy.polynomial.legendre import Legendre, leg2poly

from tippetop.contact.block import NODES, WEIGHTS, Block, ModeSteps
from tippetop.contact.contact_mode import SLIPS, ContactMode
from tippetop.contact.flight import Flight
from tippetop.contact.mode import Mode, Status
from tippetop.contact.natural_launch import NaturalLaunch, initial_mode
from tippetop.contact.readings import TOLD, Instants, Rates, conditions, instants, read
from tippetop.contact.trajectory import Trajectory
from tippetop.contact.transient import TransientMode
from tippetop.integrators.base import Array
from tippetop.integrators.dense import at_fractions, parts_of, powers
from tippetop.mechanics.quadratures import nearer_pole, turn_at_launch, turn_in_chart
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.hull import each_surface, is_edge
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Row, Scalar
from tippetop.results.accuracy_monitor import NEGATIVE, Monitor, monitored_quantities
from tippetop.results.samples import Samples
from tippetop.results.sums import INTEGRALS, RunSums

_INTEGRALS = np.array(
    [
        leg2poly(Legendre.fit(NODES, unit, len(NODES) - 1, domain=[0.0, 1.0]).integ(lbnd=0.0).coef)
        for unit in np.eye(len(NODES))
    ]
)
"""Integrals from 0 of Lagrange's polynomials on Gauss's points, in powers of a variable from -1 to
1 over a step.
"""


TURN, WORK, STRUCK = (RunSums._fields.index(name) for name in ("turn", "work", "struck"))
"""Places of sums that change otherwise than by their rates alone."""

READINGS = 3 + len(RunSums._fields)
"""Row from which on a sample has its readings, after time, mode, sums and pole."""


def monitored_in(mode: Mode, y: Row) -> tuple[Scalar, ...]:
    """Return the monitored quantities of the numbers of a mode."""
    return monitored_quantities(mode.state(y), mode.top)


class Recorder:
    """Recorder of a launch's samples and of the integrals along it, in natural units.

    Parameters
    ----------
    top, start
        The top, and the state at launch.
    azimuth
        Direction into which the axis leans at launch, rad; the marker lies in the plane of axis and
        vertical.
    times
        Increasing sample times, shape (k,).
    lost
        Energy lost in an impact at launch.
    pulls
        Whether the table may pull.
    """

    def __init__(
        self,
        top: Top,
        start: State,
        azimuth: float,
        times: Array,
        lost: float = 0.0,
        pulls: bool = False,
    ) -> None:
        self.top, self.times = top, times
        self._parts: list[Array] = []
        self.modes = [SLIPS, Flight.name]
        self._sampled = 0
        self._last: tuple[Block, tuple[Array, Array, Array]] | None = None
        self._pole = float(nearer_pole(start.axis[2]))
        self._integrals = integrals_of(top)
        self._sums = np.array(RunSums.at_launch(turn_at_launch(azimuth, self._pole), lost))
        self.monitor = Monitor(top, start, pulls)

    @classmethod
    def of(cls, launch: NaturalLaunch, times: Array) -> Self:
        """Return the recorder of a launch; times increase, in natural units, shape (k,)."""
        lost, pulls = launch.first.energy_lost, launch.automaton.pulls
        return cls(launch.top, launch.state, launch.azimuth, times, lost, pulls)

    def go_on_from(self, turn: float, pole: float) -> None:
        """Go on with the angle about the axis, and its chart, with which another recorder ended."""
        self._sums[TURN], self._pole = turn, pole

    @property
    def pole(self) -> float:
        """Pole of the chart of the angle at the end of the last block."""
        return self._pole

    def take(self, block: Block) -> None:
        """Take the samples in a block."""
        if not len(block.starts):
            return
        integrals = self._integrate(block)
        until = int(np.searchsorted(self.times, block.ends[-1], side="right"))
        times = self.times[self._sampled : until]
        self._sampled = until
        self._last = block, integrals
        if len(times):
            self._sample(block, times, *integrals)

    @property
    def sums(self) -> RunSums:
        """What is summed up from launch to the end of the last block."""
        return RunSums(*self._sums.tolist())

    def status_of(self, trajectory: Trajectory) -> Status:
        """Return the status of a trajectory whose blocks were all taken, checked by the
        monitor.
        """
        assert trajectory.status is not None, "a trajectory that has no more segments has ended"
        return self.monitor.final_status(
            trajectory.status,
            trajectory.state,
            self.sums.total_work(self.top),
            tolerance_of(trajectory),
        )

    def breach_of(self, trajectory: Trajectory) -> str:
        """Return a sentence that names what a trajectory that has ended did not keep."""
        return self.monitor.breach(tolerance_of(trajectory))

    def finish(self, end: float, state: State, early: bool) -> Samples:
        """Return all samples of a launch that has ended; the last is its end if it ended early."""
        if early and not (self._parts and self._parts[-1][0, -1] >= end):
            if self._last is None:
                self._parts.append(self._single(state))
            else:
                block, integrals = self._last
                self._sample(block, np.array([end]), *integrals)
        if not self._parts:
            self._parts.append(self._single(state))
        rows = np.concatenate(self._parts, axis=1) if len(self._parts) > 1 else self._parts[0]
        times, mode, *sums, pole = rows[:READINGS]
        readings = Instants.unpack(rows[READINGS:])
        return Samples(times, readings, RunSums(*sums), pole, mode.astype(np.int8))

    def _sample(
        self, block: Block, times: Array, rates: Array, values: Array, poles: Array
    ) -> None:
        """Take the samples of a block at some times."""
        step = block.step_at(times)
        part = parts_of(times, block.starts[step], block.ends[step])
        integrals = _INTEGRALS @ powers(2.0 * part - 1.0, len(NODES) + 1).T * block.spans[step]
        sums = values.take(step, axis=1)
        sums[: len(rates)] += np.einsum("ik,qik->qk", integrals, rates.take(step, axis=2))
        rows = np.empty((READINGS + TOLD, len(times)))
        rows[0], rows[2 : READINGS - 1], rows[READINGS - 1] = times, sums, poles[step]
        for mode, chosen, numbers in block.sampled(step, part):
            rows[READINGS:, chosen] = numbers
            if mode.label not in self.modes:
                self.modes.append(mode.label)
            rows[1, chosen] = self.modes.index(mode.label)
        self._parts.append(rows)

    def _single(self, state: State) -> Array:
        """Return the sample of a launch that ended as it began."""
        mode, numbers = initial_mode(state, self.top)
        readings = read(instants, mode, np.array([numbers]).T)[:, 0]
        return np.array([[0.0, 0.0, *self._sums, self._pole, *readings]]).T

    def _integrate(self, block: Block) -> tuple[Array, Array, Array]:
        """Integrate along the steps of a block.

        Returns
        -------
        tuple
            Rates of the integrals at Gauss's points, shape (q, 8, k), the sums at the starts of the
            steps, shape (8, k), and the charts of the angle, shape (k,). The integrals are the
            first q of `RunSums` (see `integrals_of`).
        """
        count, last = len(block.starts), self._integrals
        rates, axis = np.empty((last, len(NODES), count)), np.empty((2, count))
        poles = np.empty(count)
        for group in block.groups:
            at_nodes = group.nodes[:last]
            if len(group.which) == count:
                rates = at_nodes
            else:
                rates[:, :, group.which] = at_nodes
            axis[:, group.which], poles[group.which] = group.terms[:, :2, 0].T, group.poles
        gains = np.zeros((len(self._sums), count))
        gains[:last] = np.einsum("i,qik->qk", WEIGHTS, rates) * block.spans
        before = np.concatenate([[self._pole], poles[:-1]])
        # Derivatives compare runs 1e-8 apart: what thousands of sums round away would show in them.
        summed = np.concatenate([self._sums[:, None], gains], axis=1)
        values = np.cumsum(summed, axis=1, dtype=np.longdouble).astype(float)
        values[TURN] = self._sums[TURN] + evenly_summed(gains[TURN])
        for step in np.flatnonzero(poles - before):
            azimuth = np.arctan2(axis[1, step], axis[0, step])
            turn = values[TURN, step:]
            values[TURN, step:] = turn_in_chart(turn, azimuth, before[step], poles[step])
        lost = np.zeros(count + 1)
        for place, segment in zip(np.cumsum(block.lengths), block.segments, strict=True):
            if segment.transition is not None:
                lost[place] += segment.transition.energy_lost
        values[WORK] -= np.cumsum(lost)
        values[STRUCK] += np.cumsum(lost)
        self._sums, self._pole = values[:, -1], float(poles[-1])
        work = RunSums(*values).total_work(self.top)
        for group in block.groups:
            size, energy, jellett = read(
                monitored_in, group.mode, group.start_numbers, total=group.total(len(group.which))
            )
            with np.errstate(invalid="ignore"):  # edges have nan where the axis is vertical
                self.monitor.check(size, energy, jellett, work[group.which])
            self._check_conditions(group)
        return rates, values[:, :-1], poles

    def _check_conditions(self, group: ModeSteps) -> None:
        """Have the monitor check what is nowhere negative at Gauss's points of the steps.

        What the table does in a mode of a user is that mode's affair.
        """
        at_nodes = Rates(*group.nodes)
        if isinstance(group.mode, (ContactMode, TransientMode)):
            self.monitor.check_force(at_nodes.force.ravel())
        if not at_nodes.margin.min() >= NEGATIVE:
            y = at_fractions(group.terms, NODES)
            gap, pressing, reserve = read(conditions, group.mode, y).reshape(3, -1)
            self.monitor.check_gap(gap)
            self.monitor.check_force(pressing)
            self.monitor.check_reserve(reserve)


def integrals_of(top: Top) -> int:
    """Return how many of the integrals of `RunSums` may not be zero: those of air only in air, and
    those of drilling and rolling not under a law without torque, but on a face.
    """
    if top.field is not None and top.field.has_air:
        return INTEGRALS
    has_face = any(is_edge(one) for one in each_surface(top.surface))
    return INTEGRALS - 1 if has_face or not top.torque_free else 1 + WORK


def tolerance_of(trajectory: Trajectory) -> float:
    """Return the relative tolerance of a trajectory's steps; 0 of a method that has none."""
    return float(getattr(trajectory.integrator, "tolerance", 0.0))


def evenly_summed(gains: Array) -> Array:
    """Return the cumulative sums of the gains, from 0, with less rounding for nearly equal
    gains.
    """
    mean = np.mean(gains)
    sums: Array = mean * np.arange(len(gains) + 1.0)
    sums[1:] += np.cumsum(gains - mean)
    return sums
