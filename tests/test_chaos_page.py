"""The page of regular and chaotic motion: two methods agree, and a ball is not chaotic."""

import re
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest

PAGE = Path(__file__).parents[1] / "docs" / "howto" / "chaos.md"
CELL = re.compile(r"^```\{code-cell\} python\n(.*?)^```$", re.MULTILINE | re.DOTALL)
OPTIONS = re.compile(r"^(:[\w-]+:[^\n]*\n)+")
COMPUTES = re.compile(r"^(?:pieces, length =|print\(|run, solution|nods)", re.MULTILINE)
LENGTH = 0.25


@pytest.fixture(scope="module")
def page():
    """Names that the page defines, before it computes."""
    pytest.importorskip("matplotlib.pyplot")
    mpl.use("agg")
    names = {"__name__": "__main__"}
    for cell in CELL.findall(PAGE.read_text("utf-8")):
        code = COMPUTES.split(OPTIONS.sub("", cell))[0]
        exec(compile(code, str(PAGE), "exec"), names)
    return names


def test_the_exponent_of_an_egg_is_positive_by_both_methods(page):
    by_runs = page["growth"](page["egg"], 3, LENGTH)
    by_derivatives = page["growth_of_derivatives"](page["egg"], 3, LENGTH)
    np.testing.assert_allclose(by_runs, by_derivatives, rtol=1e-4)
    assert by_runs[-1] / (3 * LENGTH) > 5.0


def test_the_exponent_of_a_ball_is_zero(page):
    """The axis of a homogeneous ball moves with the same angular velocity whatever it strikes.

    So a change of its tilt moves the axis by as much at all times. Tilting rate and precession of
    the axis follow from it, within bounds that do not depend on time.
    """
    growths = page["growth"](page["ball"], 8, LENGTH)
    assert np.abs(growths).max() < 2.0
    assert page["growth_of_derivatives"](page["ball"], 4, LENGTH)[-1] == pytest.approx(
        growths[3], abs=1e-3
    )
