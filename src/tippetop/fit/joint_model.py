"""Models of several launches in one: some numbers are the same in all, others each launch's own."""

from collections.abc import Sequence
from typing import Self

import numpy as np

from tippetop.fit.measurement import Measurement
from tippetop.fit.model import Model, PredictedData
from tippetop.integrators.base import Array
from tippetop.problem.problem import Problem


class JointModel:
    """Values of the measurements of several launches, as a function of numbers.

    It has the attributes and methods of `Model`. Numbers are named as their fields where they are
    shared, and else begin with the number of the launch, from 0: "2.launch.spin".
    """

    def __init__(self, launches: Sequence[Model], shared: Sequence[str]) -> None:
        self.launches = tuple(launches)
        fields = list[str](dict.fromkeys(shared))
        instruments = list[str]()
        columns = list[list[str]]()
        for number, launch in enumerate(self.launches):
            names = [name if name in shared else f"{number}.{name}" for name in launch.names]
            columns.append(names)
            count = len(launch.fields)
            fields += [name for name in names[:count] if name not in shared]
            instruments += names[count:]
        self.fields, self.names = tuple(fields), (*fields, *instruments)
        self.places = [np.array([self.names.index(name) for name in names]) for names in columns]
        self._collect()

    def _collect(self) -> None:
        launches = self.launches
        self.measurements: tuple[Measurement, ...] = tuple(
            one for launch in launches for one in launch.measurements
        )
        ends = [float(launch.times[-1]) for launch in launches]
        self.times = launches[int(np.argmax(ends))].times
        self.data = np.concatenate([launch.data for launch in launches])
        self.is_event = np.concatenate([launch.is_event for launch in launches])
        self._rows = np.cumsum([0, *(len(launch.data) for launch in launches)])

    @property
    def problem(self) -> Problem:
        """The problem of the first launch."""
        return self.launches[0].problem

    @property
    def runs(self) -> int:
        """How many runs were followed."""
        return sum(launch.runs for launch in self.launches)

    @property
    def reasons(self) -> dict[str, str]:
        """Why a derivative does not exist, by the names of the numbers."""
        return {
            self.names[self.places[number][launch.names.index(name)]]: reason
            for number, launch in enumerate(self.launches)
            for name, reason in launch.reasons.items()
        }

    @property
    def steps(self) -> Array:
        """Heights of the steps in which the values move, shape (values,)."""
        return np.concatenate([launch.steps for launch in self.launches])

    @property
    def own_fields(self) -> Array:
        """The problems' own values of the fields; of shared ones the first problem's."""
        values = np.zeros(len(self.fields))
        for launch, places in reversed(list(zip(self.launches, self.places, strict=True))):
            values[places[: len(launch.fields)]] = launch.own_fields
        return values

    @property
    def start(self) -> Array:
        """The problems' own numbers, and the instruments' that fit best to their runs."""
        return self.with_instruments(self.own_fields)

    def with_instruments(self, fields: Array) -> Array:
        """Return numbers with those of the instruments that fit best to the runs of some fields."""
        numbers = np.append(fields, np.zeros(len(self.names) - len(fields)))
        for launch, places in zip(self.launches, self.places, strict=True):
            count = len(launch.fields)
            numbers[places] = launch.with_instruments(numbers[places[:count]])
        return numbers

    def problem_of(self, numbers: Array) -> Problem:
        """Return the first problem with its varied fields replaced."""
        return self.launches[0].problem_of(numbers[self.places[0]])

    def problems_of(self, numbers: Array) -> list[Problem]:
        """Return the problem of every launch with its varied fields replaced."""
        return [
            launch.problem_of(numbers[places])
            for launch, places in zip(self.launches, self.places, strict=True)
        ]

    def turning_over(self, fields: Array) -> float:
        """Return when the first of the runs of some fields turns over, s; infinity if none does."""
        return min(
            launch.turning_over(fields[places[: len(launch.fields)]])
            for launch, places in zip(self.launches, self.places, strict=True)
        )

    def predict(self, numbers: Array) -> PredictedData:
        """Return what the runs of these numbers show."""
        rows = [
            launch.predict(numbers[places]).values
            for launch, places in zip(self.launches, self.places, strict=True)
        ]
        return PredictedData(np.concatenate(rows), ())

    def differences(self, numbers: Array, steps: Array | None = None) -> tuple[Array, Array]:
        """Return the values, and their derivatives by differences of runs, with stated steps."""
        values, blocks = list[Array](), list[Array]()
        for launch, places in zip(self.launches, self.places, strict=True):
            stated = None if steps is None else steps[places]
            seen, slopes = launch.differences(numbers[places], stated)
            values.append(seen)
            blocks.append(slopes)
        return np.concatenate(values), self._placed(blocks)

    def jacobian(self, numbers: Array) -> Array:
        """Return the derivatives of the values, shape (values, numbers)."""
        return self._placed(
            [
                launch.jacobian(numbers[places])
                for launch, places in zip(self.launches, self.places, strict=True)
            ]
        )

    def _placed(self, blocks: Sequence[Array]) -> Array:
        matrix = np.zeros((len(self.data), len(self.names)))
        for start, block, places in zip(self._rows, blocks, self.places, strict=False):
            matrix[start : start + len(block), places] = block
        return matrix

    def scales(self, numbers: Array) -> Array:
        """Return the size of each number, above which a change of it is large."""
        sizes = np.ones(len(numbers))
        for launch, places in zip(self.launches, self.places, strict=True):
            inside = places[places < len(numbers)]
            sizes[inside] = launch.scales(numbers[inside])
        return sizes

    def until(self, time: float) -> Self:
        """Return the model of the data up to a time, without times of events."""
        return self._of({k: one.until(time) for k, one in enumerate(self.launches) if _films(one)})

    def on_fine_grid(self, time: float) -> Self:
        """Return the model of the same instruments at instants that follow the fastest motion."""
        return self._of(
            {k: one.on_fine_grid(time) for k, one in enumerate(self.launches) if _films(one)}
        )

    def _of(self, launches: dict[int, Model]) -> Self:
        """Return the model of some of the launches, by number, with the same numbers."""
        part = type(self).__new__(type(self))
        part.fields, part.names = self.fields, self.names
        part.launches = tuple(launches.values())
        part.places = [self.places[number] for number in launches]
        part._collect()
        return part


def _films(launch: Model) -> bool:
    """Return whether data of a launch have times of their own."""
    return not launch.is_event.all()
