import pytest

import tippetop as tt
from tippetop.export.words import arrival, known_spins, tell
from tippetop.theory.prediction import predict
from tippetop.theory.thresholds import critical_spins


def told(spin: float, duration: float = 20.0, **changes: object) -> str:
    problem = tt.presets.report_problem(spin=spin).replace(changes)
    return tell(tt.simulate(problem, duration)).headline


def test_a_slow_top_stays_upright_and_is_told_why() -> None:
    spins = critical_spins(tt.presets.report_problem())
    assert told(0.8 * spins.upright) == f"stays upright: spin below {spins.upright:.1f} rad/s"
    assert "still moving" in told(1.1 * spins.upright)


def test_a_fast_top_inverts_when_its_tilt_arrives() -> None:
    problem = tt.presets.report_problem(spin=155.0)
    coarse, fine = (tt.simulate(problem, 20.0, samples=count) for count in (2001, 20001))
    assert tell(fine).headline == f"inverts at {arrival(fine):.2f} s"
    assert arrival(coarse) == pytest.approx(arrival(fine), abs=2e-3)


def test_in_between_it_settles_where_theory_says() -> None:
    problem = tt.presets.report_problem(spin=50.0)
    story = tell(tt.simulate(problem, 20.0))
    final = predict(problem).final
    assert story.headline.startswith(f"settles at {final.tilt * 180 / 3.141592653589793:.1f}°")
    assert f"θ = {final.tilt:.3f} rad" in story.details[0]


def test_flights_are_counted_from_the_first() -> None:
    run = tt.simulate(tt.presets.report_problem(spin=175.0), 20.0)
    first = float(run["flight_start"][0])
    assert tell(run).headline.endswith(f"leaves the table {run.sizes['flight']} times from {first:.2f} s")
    bilateral = tell(
        tt.simulate(tt.presets.report_problem(spin=175.0).replace({"contact.liftoff": "stop"}), 20.0)
    )
    assert "would have to pull" in bilateral.headline
    assert bilateral.details[0].startswith(tt.Outcome.LIFTED_OFF.value[:30])


def test_where_no_theory_holds_the_motion_alone_is_told() -> None:
    egg = tt.Body(mass=0.02, shape=tt.Spheroid(across=0.015, along=0.025), I1=4e-6, I3=2e-6)
    problem = tt.presets.report_problem(spin=10.0).model_copy(update={"body": egg})
    assert known_spins(problem) is None
    run = tt.simulate(problem, 1.0)
    assert tell(run).details == ()
    assert tell(run.isel(time=[0])).headline.endswith("and still moving"), "it ended where it began"


def test_a_top_set_on_its_stem_stays_there() -> None:
    assert told(155.0, **{"launch.tilt": 3.1}) == "stays inverted"
