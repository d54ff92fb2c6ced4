"""A fit to many points does not look at all of them for each."""

import math

import pytest

from tippetop.lathe import fitting
from tippetop.lathe.arcs import circle_through
from tippetop.lathe.edges import Edge
from tippetop.lathe.fitting import fit


def wavy(count: int, waves: int) -> list[tuple[float, float]]:
    """Half outline of a body whose radius waves, mm, with four decimals as drawings have them."""
    points = []
    for k in range(count + 1):
        angle = math.pi * (k / count - 0.5)
        radius = 15.0 + 0.3 * math.sin(2 * waves * angle)
        points.append((round(radius * math.cos(angle), 4), round(radius * math.sin(angle), 4)))
    points[0], points[-1] = (0.0, points[0][1]), (0.0, points[-1][1])
    return points


def work(count: int, waves: int, patch: pytest.MonkeyPatch) -> int:
    """Return how many points are compared with circles and edges in a fit to so many points."""
    done = [0]

    def counted_circle(points: object) -> object:
        done[0] += len(points)  # type: ignore[arg-type]
        return circle_through(points)  # type: ignore[arg-type]

    def counted_distance(edge: Edge, point: complex) -> float:
        done[0] += 1
        return distance(edge, point)

    distance = Edge.distance
    with patch.context() as patched:
        patched.setattr(fitting, "circle_through", counted_circle)
        patched.setattr(Edge, "distance", counted_distance)
        result = fit(wavy(count, waves))
    assert result.deviation < 1e-4 * 31.0
    return done[0]


@pytest.mark.parametrize("waves", [5, 40])
def test_points_of_a_wavy_outline_are_looked_at_some_times_each(
    waves: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    count = 1200
    assert work(count, waves, monkeypatch) < 250 * count, "and not all for each"
