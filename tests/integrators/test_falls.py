"""Where guards fall that are smaller than the solution inside a step is wrong by."""

import numpy as np
import pytest

from tippetop.integrators import Guard
from tippetop.integrators.base import Motion
from tippetop.integrators.sampling import Accepted, StepByStep
from tippetop.integrators.zero_crossings import first_fall

ERROR = 1e-11
STEP = (3.0, 4.0)
LOW, SURE = (lambda y, number=n: float(y[number]) for n in range(2))


def fall(exact, *, end=None, late=False):
    """The first fall of two guards, of which the first is interpolated too low inside the step.

    It is so later, if asked. The step itself may end a little apart from others that end there.
    """

    def advance(time):
        return np.array(exact(time - STEP[0]))

    def dense(time):
        if time == STEP[1] and end is not None:
            return np.array(end)
        part = time - STEP[0]
        return advance(time) - np.array([4.0 * ERROR * part ** (1 + late) * (1.0 - part), 0.0])

    return first_fall([LOW, SURE], dense, advance, STEP)


def test_what_only_the_interpolation_shows_is_no_fall():
    assert fall(lambda t: (0.1 * ERROR * (1.0 + t), 1.0)) is None


def test_nor_is_it_where_the_guard_does_not_change():
    assert fall(lambda _: (0.1 * ERROR, 1.0)) is None


def test_nor_is_it_back_where_the_guard_rose_through_zero():
    """Secants lead there."""
    assert fall(lambda t: (0.8 * ERROR * (t - 1e-6), 1.0), late=True) is None


def test_what_falls_at_once_and_is_back_in_the_end_was_zero_but_for_errors():
    assert fall(lambda t: (0.1 * ERROR * (t - 1e-4) * (t - 0.9), 1.0)) is None


def test_nor_does_such_a_fall_hide_a_later_one_of_the_same_guard():
    """It is positive again at 0.3, and falls at 0.6 until 0.9."""
    number, time, _ = fall(lambda t: (ERROR * (t - 1e-4) * (t - 0.3) * (t - 0.6) * (t - 0.9), 1.0))
    assert number == 0
    assert time == pytest.approx(3.6, abs=1e-12)


def test_another_guard_that_falls_in_the_same_step_is_not_lost():
    number, time, state = fall(lambda t: (0.1 * ERROR * (1.0 + t), 0.8 - t))
    assert number == 1
    assert time == pytest.approx(3.8, abs=1e-15)
    assert state[1] == pytest.approx(0.0, abs=1e-15)


def test_a_fall_is_where_steps_of_their_own_show_it():
    number, time, _ = fall(lambda t: (ERROR * (0.9 - t) * (1.0 + t), 1.0))
    assert number == 0
    assert time == pytest.approx(3.9, abs=1e-12)


def test_a_guard_that_is_below_zero_in_the_end_has_fallen():
    """Not in other steps that end there, but the motion would go on with it so."""
    number, time, _ = fall(lambda t: (0.1 * ERROR * (1.0 + t), 1.0), end=(-1e-17, 1.0))
    assert number == 0
    assert time == pytest.approx(STEP[1], abs=1e-12)


@pytest.mark.parametrize("pole", [0.5, 0.7])
def test_a_pole_beyond_which_a_guard_is_negative_hides_no_fall_before_it(pole):
    """Among the places that are looked at, and among those that are found, one may be the pole."""

    def along(time):
        return np.array([time - STEP[0]])

    beyond = Guard(
        "beyond", lambda y, p: 1.0 / (pole + STEP[0] - (y[0] + STEP[0]))
    ).with_parameters(())
    before = Guard("before", lambda y, p: pole - 1e-3 - y[0]).with_parameters(())
    with pytest.raises(ZeroDivisionError):
        beyond(along(STEP[0] + pole))
    number, time, _ = first_fall([beyond, before], along, along, STEP)
    assert number == 1
    assert time == pytest.approx(STEP[0] + pole - 1e-3, abs=1e-14)


class Leaping(StepByStep):
    """A method whose interpolation ends beside the states between which it leads."""

    degree = 2

    def steps(self, rates, start, end):
        for time, number in ((1.0, 0.5), (2.0, -1e-9), (3.0, -1.0)):

            def dense(at):
                return np.array([1e-9 if at < 2.5 else -1.0])

            yield Accepted(time, np.array([number]), dense, dense)


def test_a_guard_that_only_the_state_after_a_step_shows_below_zero_falls_in_that_step():
    positive = Motion(
        lambda y, _: (0.0 * y[0],),
        size=1,
        parameters=0,
        guards=(Guard("positive", lambda y, _: y[0]),),
    )
    (arc,) = Leaping().integrate(positive, (), (0.0, np.array([1.0])), 3.0)
    assert arc.guard == "positive"
    assert arc.solution.end == pytest.approx(2.0, abs=1e-9)
