"""The coefficients of Dormand and Prince's method of order 8(5,3), which are SciPy's, written out as code."""

import numpy as np
from scipy.integrate import DOP853

from tippetop.integrators.dormand_prince import Array


def written_out() -> str:
    """The functions in which the method's coefficients are, as code."""
    moved, place = "moved[i] = h * ({}) + lost[i]", "place[i] = y[i] + {}"
    given = "p, y: Array, lost: Array, k: Array"
    lines = [f"def stages(rates, h: float, {given}, moved: Array, place: Array):"]
    for number, weights in enumerate([*DOP853.A[1:], DOP853.B], start=1):
        lines += _for_each(moved.format(_sum(weights)), place.format("moved[i]"))
        lines.append(f"    evaluate(rates, place, p, k[{number}])")
    lines.append(f"def more_stages(rates, h: float, {given}, place: Array):")
    for number, weights in enumerate(DOP853.A_EXTRA, start=13):
        lines += _for_each(place.format(f"(h * ({_sum(weights)}) + lost[i])"))
        lines.append(f"    evaluate(rates, place, p, k[{number}])")
    lines.append("def combined(y: Array, k: Array):")
    lines += _for_each(
        *(f"k[{n}, i] = {_sum(row)}" for n, row in enumerate((DOP853.E5, DOP853.E3), start=16))
    )
    # Of the polynomials x, x (1 - x), x^2 (1 - x), ... the ends of the step give the first three.
    lines.append("def polynomials(h: float, y: Array, new: Array, k: Array, terms: Array, first: int):")
    lines.append("    at = first")
    rows = enumerate(_powers()[1:], start=1)
    lines += _for_each(
        "c0 = new[i] - y[i]",
        "c1 = h * k[0, i] - c0",
        "c2 = 2.0 * c0 - h * (k[0, i] + k[12, i])",
        *(f"c{n} = h * ({_sum(row)})" for n, row in enumerate(DOP853.D, start=3)),
        "terms[at] = y[i]",
        *(f"terms[at + {n}] = {_sum(row, 'c{}')}" for n, row in rows),
        "at += POWERS",
    )
    return "\n".join(lines)


def _for_each(*assignments: str) -> list[str]:
    return ["    for i in range(len(y)):", *(f"        {line}" for line in assignments)]


def _sum(weights: Array, name: str = "k[{}, i]") -> str:
    terms = [(weight, name.format(j)) for j, weight in enumerate(weights.tolist()) if weight]
    return " + ".join(term if weight == 1.0 else f"{weight!r} * {term}" for weight, term in terms)


def _powers() -> Array:
    """Powers of x, shape (8, 7), in the polynomials of the dense output."""
    found = np.zeros((8, 7))
    for row in range(7):
        polynomial = np.polynomial.Polynomial([0.0, 1.0]) ** (row // 2 + 1)
        polynomial *= np.polynomial.Polynomial([1.0, -1.0]) ** ((row + 1) // 2)
        found[: len(polynomial.coef), row] = polynomial.coef
    return found
