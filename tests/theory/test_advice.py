"""Advice is the least change of a size with which theory lets a top stand."""

import math

import pytest

import tippetop as tt
from tippetop.theory.advice import BISECTIONS, STEPS, Size, advice, standing_spin

REACH = 240.0
"""Spins that are within reach, rad/s."""

REPORT = tt.presets.report_problem().body


def eccentric(value: float) -> tt.Body:
    shape = tt.EccentricSphere(radius=0.02, eccentricity=value)
    return REPORT.model_copy(update={"shape": shape})


def with_stem(value: float) -> tt.Body:
    """The report's top with a round stem of a radius."""
    spheres = (tt.Sphere(radius=0.02, center=0.006), tt.Sphere(radius=value, center=0.029))
    return REPORT.model_copy(update={"shape": spheres})


def test_the_least_eccentricity_is_where_the_groups_meet() -> None:
    """A sphere turns over between 1 - alpha and 1 + alpha for gamma = I1/I3."""
    size = Size("eccentricity", 0.02, 0.01, 0.5)
    (found,) = advice(lambda _, value: eccentric(value), [size], 1e6)
    least = 1.0 - REPORT.I1 / REPORT.I3
    within = (size.high - size.value) / STEPS / 2**BISECTIONS
    assert found.value == pytest.approx(least, abs=1.01 * within)
    assert found.value > least
    assert standing_spin(eccentric(least - within)) == math.inf


def test_a_top_stands_with_the_change_and_not_with_less() -> None:
    size = Size("stem", 0.002, 0.001, 0.012)
    (found,) = advice(lambda _, value: with_stem(value), [size], REACH)
    assert standing_spin(with_stem(found.value)) == found.spin <= REACH
    within = (size.high - size.value) / STEPS / 2**BISECTIONS
    assert standing_spin(with_stem(found.value - within)) > REACH


def test_a_run_confirms_the_spin_that_advice_names() -> None:
    size = Size("stem", 0.002, 0.001, 0.012)
    (found,) = advice(lambda _, value: with_stem(value), [size], REACH)
    tilts = [
        float(
            tt.simulate(
                tt.presets.report_problem(spin=share * found.spin).replace(
                    {"body": with_stem(found.value)}
                ),
                20.0,
                samples=2,
            )["final_tilt"]
        )
        # What is lost while both surfaces touch comes on top of the spin that theory names.
        for share in (0.85, 1.4)
    ]
    assert tilts[0] < 0.8 * math.pi
    assert tilts[1] > 0.97 * math.pi


def test_what_no_change_of_one_size_can_do_is_left_out() -> None:
    size = Size("eccentricity", 0.02, 0.01, 0.06)
    assert advice(lambda _, value: eccentric(value), [size], 200.0) == []


def test_sizes_of_which_there_is_no_body_do_not_do() -> None:
    size = Size("eccentricity", 0.02, -0.5, 0.5)
    (found,) = advice(lambda _, value: eccentric(value), [size], 100.0)
    assert found.value > 0.02
