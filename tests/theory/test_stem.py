"""Which stems a top stands up on: the theory against whole runs, and against numbers of another
solver.
"""

import math

import numpy as np
import pytest

import tippetop as tt
from tippetop.problem.problem import top_of
from tippetop.theory.outlook import outlook
from tippetop.theory.stem import jellett_about


def test_the_least_jellett_to_stand_is_what_another_solver_states() -> None:
    found = tt.least_jellett_to_stand(tt.presets.LEINE_GLOCKER_STEM, gravity=9.81)
    assert found == pytest.approx(1.29518e-06, rel=1e-5)
    assert tt.least_jellett_to_stand(tt.presets.REPORT_THIN_STEM) == pytest.approx(
        1.12145e-05, rel=1e-5
    )


def run_of(radius: float, center: float) -> tuple[float, float, float]:
    """Jellett's integral about the stem when it touches first, the least, and the tilt at the
    end.
    """
    stem = {"kind": "sphere", "radius": radius, "center": center}
    sphere = tt.presets.REPORT_STEM.shapes[0].model_dump()
    problem = tt.presets.report_problem().replace({"body.shape": [sphere, stem]})
    run = tt.simulate(problem, 12.0, samples=1201)
    touched = run["event_time"].values[run["event_kind"].values == "touchdown"][0]
    here = run.sel(time=touched, method="bfill")
    axis, momentum = (tuple(here[name].values.tolist()) for name in ("axis", "angular_momentum"))
    about = jellett_about(1, axis, momentum, top_of(problem))
    return about, tt.least_jellett_to_stand(problem.body), float(run["final_tilt"])


@pytest.mark.parametrize("radius", [0.004, 0.008, 0.0115, 0.012])
def test_a_top_stands_up_on_its_stem_where_the_theory_says(radius: float) -> None:
    """The report's top, launched as in its Fig. 4, with stems that all reach 3 to 4 mm beyond the
    sphere.
    """
    about, least, tilt = run_of(radius, 0.0295 - radius)
    assert abs(about / least - 1.0) > 0.005, "not on the edge, where more than one touch decides"
    assert (tilt > math.pi - 1e-3) == (about > least)


def test_a_heavy_end_below_stands_without_spin_and_a_needle_never() -> None:
    sphere, tip = tt.Sphere(radius=0.02, center=0.006), tt.Sphere(radius=0.0005, center=-0.02)
    body = tt.presets.REPORT.model_copy(update={"shape": (sphere, tip)})
    assert tt.least_jellett_to_stand(body) == 0.0
    blunt = tt.Sphere(radius=0.015, center=0.0145)
    slow = body.model_copy(update={"I1": 20 * body.I3, "shape": (sphere, blunt)})
    assert tt.least_jellett_to_stand(slow) == np.inf


def test_what_is_no_tip_is_refused() -> None:
    with pytest.raises(tt.InvalidInput, match="surface: 2"):
        tt.least_jellett_to_stand(tt.presets.REPORT_STEM, 2)
    with pytest.raises(tt.InvalidInput, match="that of a sphere"):
        tt.least_jellett_to_stand(tt.presets.COIN, 1)
    with pytest.raises(tt.InvalidInput, match="surface: 1 is"):
        tt.least_jellett_to_stand(tt.presets.REPORT_STEM, 1.0)  # type: ignore[arg-type]
    with pytest.raises(tt.InvalidInput, match=r"body\.shape: one surface .* the stem's tip"):
        tt.least_jellett_to_stand(tt.presets.REPORT)


STEMMED = tt.presets.report_problem().model_copy(update={"body": tt.presets.REPORT_STEM})


def test_critical_spins_are_of_one_surface_and_not_told_of_several() -> None:
    with pytest.raises(
        tt.InvalidInput, match=r"body\.shape: a body of several surfaces is beyond the theory"
    ):
        tt.critical_spins(STEMMED)


@pytest.mark.parametrize(("tilt", "spin"), [(0.1, 30.0), (0.1, 155.0), (3.0, 40.0), (3.0, 250.0)])
def test_steady_states_are_told_of_the_surface_that_touches(tilt: float, spin: float) -> None:
    """Those of its sphere below, and of its tip beyond, the tilt at which both touch: 8 = 11 |cos|,
    mm.
    """
    both = math.acos(-8 / 11)
    problem = STEMMED.replace({"launch.tilt": tilt, "launch.spin": spin})
    number = int(tilt > both)
    alone = tt.steady_states(problem.replace({"body.shape": problem.body.shapes[number]}))
    inside = [state for state in alone if (state.tilt > both) == bool(number)]
    assert tt.steady_states(problem) == inside
    assert len(inside) < len(alone), "there are states that the other surface keeps it from"
    found = outlook(problem)
    assert [judged.state for judged in found.steady] == inside
    assert found.surface == number
    assert found.tilts == pytest.approx((both, math.pi) if number else (0.0, both), abs=1e-12)
    assert (found.prediction is None) == (spin in (155.0, 40.0)), (
        "energy lets the other surface touch"
    )
    if number:
        assert found.jellett_inverted == pytest.approx(
            tt.least_jellett_to_stand(problem.body), rel=1e-12
        )
