"""The bands that fast oscillations are drawn as."""

import numpy as np
import pytest

from tippetop.figures.envelope import envelope


def test_a_fast_oscillation_becomes_the_band_that_it_fills() -> None:
    t = np.linspace(0.0, 20.0, 40_001)
    middle, size = 1.0 + 0.1 * t, 0.2 + 0.05 * np.sin(0.5 * t)
    grid, low, high = envelope(t, middle + size * np.cos(2 * np.pi * 20.0 * t))
    inner = (grid > 0.1) & (grid < 19.9)
    expected = np.interp(grid, t, size)
    assert high[inner] == pytest.approx((1.0 + 0.1 * grid + expected)[inner], abs=2e-3)
    assert low[inner] == pytest.approx((1.0 + 0.1 * grid - expected)[inner], abs=2e-3)


def test_what_can_be_seen_stays_a_line() -> None:
    t = np.linspace(0.0, 20.0, 40_001)
    for values in (np.exp(-t), np.sin(t), np.zeros_like(t)):
        grid, low, high = envelope(t, values)
        assert low == pytest.approx(np.interp(grid, t, values), abs=1e-6)
        assert high == pytest.approx(low, abs=1e-12)


def test_an_oscillation_that_dies_ends_in_a_line_and_what_is_not_finite_is_left_out() -> None:
    t = np.linspace(0.0, 20.0, 40_001)
    values = np.where(t < 10.0, np.cos(2 * np.pi * 20.0 * t), 1.0 + (t - 10.0))
    values[123] = np.nan
    grid, low, high = envelope(t, values)
    early, late = (grid > 0.1) & (grid < 9.9), grid > 10.2
    assert high[early] - low[early] == pytest.approx(2.0, abs=1e-2)
    assert high[late] == pytest.approx(1.0 + grid[late] - 10.0, abs=1e-6)
    assert low[late] == pytest.approx(high[late], abs=1e-12)
