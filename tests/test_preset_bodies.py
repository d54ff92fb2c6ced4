"""The bodies known by name: what is said of them, and that each can be launched."""

import math

import pytest

import tippetop as tt
from tippetop.theory.groups import Group
from tippetop.theory.prospects import prospects


@pytest.mark.parametrize("name", tt.presets.BODIES)
def test_each_goes_into_text_and_comes_back(name: str) -> None:
    problem = tt.presets.report_problem().model_copy(update={"body": tt.presets.body(name)})
    assert tt.Problem.from_toml(problem.to_toml()) == problem
    assert tt.Problem.from_json(problem.to_json()) == problem


def test_the_centre_of_a_coin_is_its_middle() -> None:
    coin = tt.presets.COIN
    low, high = coin.shapes
    assert low.surface.center == -high.surface.center == pytest.approx(-2.33e-3 / 2)
    assert 0.5 < coin.I1 / coin.I3 < 0.52, "a disk that is almost thin"


def test_hurricane_balls_touch_one_another_at_their_centre_of_mass() -> None:
    for ball in tt.presets.HURRICANE_BALLS.shapes:
        assert ball.surface.radius == abs(ball.surface.center)


def test_the_report_s_stems_leave_its_top_as_it_is() -> None:
    report = tt.presets.REPORT
    for body in (tt.presets.REPORT_STEM, tt.presets.REPORT_THIN_STEM):
        assert (body.mass, body.I1, body.I3) == (report.mass, report.I1, report.I3)
        for c in (-0.5, 0.3, 1.0):
            assert body.shapes[0].surface.height(c) == pytest.approx(report.surface.height(c))


def test_the_wooden_top_turns_over_and_has_the_measures_of_its_source() -> None:
    ball, tip = tt.presets.WOODEN.shapes
    assert (2 * ball.surface.radius, 2 * tip.surface.radius) == pytest.approx((31.75e-3, 6.35e-3))
    mouth = 0.5 * 25.4e-3 * math.sqrt(1.25**2 - 0.875**2)
    end = tip.surface.center - ball.surface.center + tip.surface.radius
    assert end - mouth == pytest.approx(0.49 * 25.4e-3), "the spindle above the counterbore"
    found = prospects(tt.presets.WOODEN, list(tt.presets.WOODEN.shapes))
    assert found is not None
    assert found.group is not Group.IA
    assert 50.0 < found.critical_spins.upright < 100.0


@pytest.mark.parametrize("name", [n for n, body in tt.presets.BODIES.items() if body.profile])
def test_what_is_drawn_is_what_touches(name: str) -> None:
    body = tt.presets.body(name)
    drawn = tt.Body.turned(body.profile, density=1.0)
    above = tt.Workpiece(profile=body.profile, density=1.0).mass_properties.center
    for shape, other in zip(body.shapes, drawn.shapes, strict=True):
        assert shape.surface.radius == pytest.approx(other.surface.radius, rel=1e-9)
        assert shape.surface.center == pytest.approx(other.surface.center + above, rel=1e-9)


def test_the_profile_of_a_turned_body_is_from_its_centre_of_mass() -> None:
    again = tt.Workpiece(profile=tt.presets.WOODEN.profile, density=720.0).mass_properties
    assert again.center == pytest.approx(0.0, abs=1e-15)
    for name in ("mass", "I1", "I3"):
        assert getattr(again, name) == pytest.approx(getattr(tt.presets.WOODEN, name), rel=1e-12)


def test_a_profile_that_is_no_body_s_is_refused() -> None:
    with pytest.raises(tt.InvalidInput, match="an open line"):
        tt.presets.EGG.model_copy(update={"profile": [(0.01, 0.0), (0.02, 0.01)]})
