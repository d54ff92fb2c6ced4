"""The coefficients of Dormand and Prince's method of order 8(5,3), which are SciPy's, written out
as code.
"""

from collections.abc import Iterable, Sequence

import numpy as np
from scipy.integrate import DOP853

from tippetop.integrators.dormand_prince import Array

TAKEN = "rates, h, p, y, lost, k, place"
"""What the functions of stages take; those of a step tell what it adds to the state in `moved` too.
"""

SLOPE = "k{}_i"
"""A number's rate at a stage, once it is read."""


def written_out(size: int | None = None) -> str:
    """Return the source of functions that contain the method's coefficients; stages of a size
    without loops.
    """
    lines = list[str]()
    for name, first, rows, arguments in (
        ("stages", 1, [*DOP853.A[1:], DOP853.B], f"{TAKEN}, moved"),
        ("more_stages", 13, DOP853.A_EXTRA, TAKEN),
    ):
        stages = list(enumerate(rows, start=first))
        lines.append(f"def {name}({arguments}):")
        if size is not None:
            lines += [f"    if len(y) == {size}:", f"        return {name}_of_{size}({arguments})"]
        for number, weights in stages:
            lines += [*_for_each(*_stage(number, weights)), _evaluated(number)]
        if size is not None:
            lines += [f"def {name}_of_{size}({arguments}):", *_straight(stages, size)]
    lines.append("def combined(y: Array, k: Array):")
    errors = DOP853.E5, DOP853.E3
    lines += _for_each(
        *_reads(*errors),
        *(f"k[{n}, i] = {_sum(row, SLOPE)}" for n, row in enumerate(errors, start=16)),
    )
    # Of the polynomials x, x (1 - x), x^2 (1 - x), ... the ends of the step give the first three.
    lines.append(
        "def polynomials(h: float, y: Array, new: Array, k: Array, terms: Array, first: int):"
    )
    lines.append("    at = first")
    powers = enumerate(_powers()[1:], start=1)
    lines += _for_each(
        *_reads(*DOP853.D),
        "c0 = new[i] - y[i]",
        "c1 = h * k0_i - c0",
        "c2 = 2.0 * c0 - h * (k0_i + k12_i)",
        *(f"c{n} = h * ({_sum(row, SLOPE)})" for n, row in enumerate(DOP853.D, start=3)),
        "terms[at] = y[i]",
        *(f"terms[at + {n}] = {_sum(row, 'c{}')}" for n, row in powers),
        "at += POWERS",
    )
    return "\n".join(lines)


def _stage(
    number: int,
    weights: Array,
    i: str = "i",
    y: str = "y[i]",
    lost: str = "lost[i]",
    slope: str = "k[{}, i]",
) -> list[str]:
    """Return the row of a stage's rates; stage 12 is at the end of the step."""
    lines = [f"step = h * ({_sum(weights, slope)}) + {lost}", f"place[{i}] = {y} + step"]
    return [*lines, f"moved[{i}] = step"] if number == 12 else lines


def _evaluated(number: int) -> str:
    return f"    evaluate(rates, place, p, k[{number}])"


def _straight(stages: Sequence[tuple[int, Array]], size: int) -> list[str]:
    """Stages of so many numbers, each of which is read once."""
    each, used = range(size), _used(weights for _, weights in stages)
    reads = {j: [f"    {_read(j, str(i))}" for i in each] for j in used}
    lines = [f"    {name}{i} = {name}[{i}]" for name in ("y", "lost") for i in each]
    lines += [line for j, some in reads.items() if j < stages[0][0] for line in some]
    for number, weights in stages:
        for i in each:
            names = f"y{i}", f"lost{i}", f"k{{}}_{i}"
            lines += [f"    {line}" for line in _stage(number, weights, str(i), *names)]
        lines += [_evaluated(number), *reads.get(number, ())]
    return lines


def _used(rows: Iterable[Array]) -> list[int]:
    """Return the stages that have a weight in some of these rows."""
    return sorted({int(j) for weights in rows for j in np.flatnonzero(weights)})


def _reads(*rows: Array) -> list[str]:
    """Return the reads of the stages that rows of weights use, each once: compilers for pages do
    not merge them.
    """
    return [_read(j, "i") for j in _used(rows)]


def _read(stage: int, i: str) -> str:
    """Return a line of source that reads the rate of number i at a stage into a name."""
    return f"k{stage}_{i} = k[{stage}, {i}]"


def _for_each(*assignments: str) -> list[str]:
    return ["    for i in range(len(y)):", *(f"        {line}" for line in assignments)]


def _sum(weights: Array, name: str = "k[{}, i]") -> str:
    terms = [(weight, name.format(j)) for j, weight in enumerate(weights.tolist()) if weight]
    return " + ".join(term if weight == 1.0 else f"{weight!r} * {term}" for weight, term in terms)


def _powers() -> Array:
    """Powers of x, shape (8, 7), in the polynomials of the dense output."""
    matrix = np.zeros((8, 7))
    for row in range(7):
        polynomial = np.polynomial.Polynomial([0.0, 1.0]) ** (row // 2 + 1)
        polynomial *= np.polynomial.Polynomial([1.0, -1.0]) ** ((row + 1) // 2)
        matrix[: len(polynomial.coef), row] = polynomial.coef
    return matrix
