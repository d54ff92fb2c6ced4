"""Steps of Dormand and Prince's method of order 8(5,3), in plain numbers.

Hairer, Norsett and Wanner 1993, Solving Ordinary Differential Equations I, section II.10.
"""

# translate module: numbers

import math
from collections.abc import Callable, Sequence
from operator import mul
from typing import NamedTuple, TypeAlias

Point: TypeAlias = tuple[float, ...]
"""Numbers that change along the way, or their rates."""

# fmt: off
STAGES: tuple[tuple[float, ...], ...] = (
    (0.05260015195876773,),
    (0.0197250569845379, 0.0591751709536137),
    (0.02958758547680685, 0.0, 0.08876275643042054),
    (0.2413651341592667, 0.0, -0.8845494793282861, 0.924834003261792),
    (0.037037037037037035, 0.0, 0.0, 0.17082860872947386, 0.12546768756682242),
    (0.037109375, 0.0, 0.0, 0.17025221101954405, 0.06021653898045596, -0.017578125),
    (0.03709200011850479, 0.0, 0.0, 0.17038392571223998, 0.10726203044637328, -0.015319437748624402,
     0.008273789163814023),
    (0.6241109587160757, 0.0, 0.0, -3.3608926294469414, -0.868219346841726, 27.59209969944671,
     20.154067550477894, -43.48988418106996),
    (0.47766253643826434, 0.0, 0.0, -2.4881146199716677, -0.590290826836843, 21.230051448181193,
     15.279233632882423, -33.28821096898486, -0.020331201708508627),
    (-0.9371424300859873, 0.0, 0.0, 5.186372428844064, 1.0914373489967295, -8.149787010746927,
     -18.52006565999696, 22.739487099350505, 2.4936055526796523, -3.0467644718982196),
    (2.273310147516538, 0.0, 0.0, -10.53449546673725, -2.0008720582248625, -17.9589318631188,
     27.94888452941996, -2.8589982771350235, -8.87285693353063, 12.360567175794303,
     0.6433927460157636),
    (0.054293734116568765, 0.0, 0.0, 0.0, 0.0, 4.450312892752409, 1.8915178993145003,
     -5.801203960010585, 0.3111643669578199, -0.1521609496625161, 0.20136540080403034,
     0.04471061572777259),
)
# fmt: on
"""Weights of the slopes found so far, at each stage; those of the step itself are last."""

# fmt: off
FINE: tuple[float, ...] = (
    0.01312004499419488, 0.0, 0.0, 0.0, 0.0, -1.2251564463762044, -0.4957589496572502,
    1.6643771824549864, -0.35032884874997366, 0.3341791187130175, 0.08192320648511571,
    -0.022355307863886294,
)
# fmt: on
"""Weights in the difference to a step of order 5."""

THIRD: tuple[float, ...] = (
    0.244094488188976377952755905512,
    *(0.0,) * 7,
    0.733846688281611857341361741547,
    0.0,
    0.0,
    0.0220588235294117647058823529412,
)
ROUGH: tuple[float, ...] = tuple(b - third for b, third in zip(STAGES[-1], THIRD, strict=True))
"""Weights of a step of order 3, and in the difference to it."""

POWER = -0.125
"""How a step that is to have another error changes with that error."""


class RungeKuttaStep(NamedTuple):
    """A step: the numbers at its ends, and the rates at its stages."""

    start: Point
    end: Point
    """Where it begins and ends."""
    slopes: Sequence[Point]
    """The rates at its stages, those at its start first and those at its end last."""
    size: float
    """Its size."""

    @property
    def new_slope(self) -> Point:
        """The rates at its end."""
        return self.slopes[-1]

    def error_estimate(self, measure: Callable[[Point], float]) -> float:
        """Return the error estimate of the step, by a norm of errors."""
        zero = (0.0,) * len(self.start)
        fine = measure(combined(zero, self.size, FINE, self.slopes))
        rough = measure(combined(zero, self.size, ROUGH, self.slopes))
        return fine * fine / math.hypot(fine, 0.1 * rough) if fine > 0.0 else 0.0

    def between(self, part: float) -> Point:
        """Return the cubic through the ends of the step, at a part of the step."""
        remainder = 1.0 - part
        at, pull = part * part * (3.0 - 2.0 * part), part * remainder * self.size
        return tuple(
            x + at * (y - x) + pull * (remainder * a - part * b)
            for x, y, a, b in zip(
                self.start, self.end, self.slopes[0], self.slopes[-1], strict=True
            )
        )


def step_from(
    point: Point, slope: Point, size: float, rates: Callable[[Point], Point]
) -> RungeKuttaStep:
    """Return a step from a point with known rates."""
    slopes = stages(point, slope, size, rates)
    end = combined(point, size, STAGES[-1], slopes)
    return RungeKuttaStep(point, end, [*slopes, rates(end)], size)


def step_to(point: Point, slope: Point, size: float, rates: Callable[[Point], Point]) -> Point:
    """Return the end of a step of order 8."""
    return combined(point, size, STAGES[-1], stages(point, slope, size, rates))


def stages(point: Point, slope: Point, size: float, rates: Callable[[Point], Point]) -> list[Point]:
    """Return the rates at the start of a step and at its stages."""
    slopes = [slope]
    for weights in STAGES[:-1]:
        slopes.append(rates(combined(point, size, weights, slopes)))
    return slopes


def short_step(point: Point, slope: Point, size: float, rates: Callable[[Point], Point]) -> Point:
    """Return the end of a short step by Kutta's method of order 4, at a third of the cost."""
    half = 0.5 * size
    second = rates(advanced(point, half, slope))
    third = rates(advanced(point, half, second))
    last = rates(advanced(point, size, third))
    return combined(point, size / 6.0, (1.0, 2.0, 2.0, 1.0), (slope, second, third, last))


def advanced(point: Point, size: float, slope: Point) -> Point:
    """Return a point moved along a slope."""
    return tuple(x + size * rate for x, rate in zip(point, slope, strict=True))


def combined(point: Point, size: float, weights: Sequence[float], slopes: Sequence[Point]) -> Point:
    """Return a point plus a step along a mean of slopes."""
    columns = zip(*slopes, strict=True)
    return tuple(
        [
            x + size * sum(map(mul, weights, column))
            for x, column in zip(point, columns, strict=True)
        ]
    )
