"""The bodies known by name: what is said of them, and that each can be launched."""

import pytest

import tippetop as tt


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
