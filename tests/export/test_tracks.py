"""The block of data that the player is given holds the run, its flights and its losses."""

import json

import numpy as np
import pytest
import xarray as xr

import tippetop as tt
from launches import in_javascript
from tippetop.export import track
from tippetop.results import sample_counts


def test_a_block_holds_the_run(flying: xr.Dataset) -> None:
    block = track.pack_run(flying)
    header = track.unpack_header(block)
    assert header["problem"] == json.loads(flying.attrs["problem"])
    assert header["samples"] == flying.sizes["time"]
    offset = block.index(b"{") + 0
    start = 8 + int.from_bytes(block[4:8], "little")
    assert offset == 8
    assert start % 8 == 0
    times = np.frombuffer(block, "<f8", header["samples"], start)
    assert times == pytest.approx(flying["time"].values, abs=0)
    numbers = np.frombuffer(block, "<f4", offset=start + times.nbytes)
    assert len(numbers) == header["samples"] * sum(width for _, width in header["columns"])
    assert numbers[: 4 * len(times)].reshape(-1, 4) == pytest.approx(
        flying["orientation"].values, abs=1e-7
    )


def test_every_flight_is_shaded_and_neighbours_are_joined_when_there_are_too_many(
    flying: xr.Dataset, monkeypatch: pytest.MonkeyPatch
) -> None:
    shaded = np.array(track.flights(flying))
    assert shaded[:, 0] == pytest.approx(flying["flight_start"].values)
    monkeypatch.setattr(track, "SHADINGS", 8)
    few = track.flights(flying)
    assert len(few) <= 8
    for begin, end in shaded:
        assert any(low <= begin and end <= high for low, high in few)


def test_of_a_part_of_a_run_only_what_it_shows_is_told(flying: xr.Dataset) -> None:
    starts, ends = flying["flight_start"].values, flying["flight_end"].values
    begin, end = 0.5 * (starts[2] + ends[2]), 0.5 * (starts[6] + ends[6])
    part = flying.sel(time=slice(begin, end))
    first, last = part["time"].values[[0, -1]]
    shaded = track.flights(part)
    assert (shaded[0][0], shaded[-1][1]) == (first, last)
    assert shaded[1:-1] == np.stack([starts[3:6], ends[3:6]], axis=1).tolist()
    turnover_time = float(flying["turnover_time"])
    assert not first < turnover_time < last
    assert track.unpack_header(track.pack_run(part))["turnover_time"] is None
    about = flying.sel(time=slice(turnover_time - 0.1, turnover_time + 0.1))
    assert track.unpack_header(track.pack_run(about))["turnover_time"] == turnover_time


def test_friction_takes_the_energy_that_slides_away() -> None:
    problem = tt.presets.report_problem(spin=155.0)
    run = tt.simulate(problem, 5.0, samples=20001)
    force = run["contact_force"].values[:, :2]
    phi = run["azimuth"].values
    slip_x, slip_y = run["slip_x"].values, run["slip_y"].values
    slip = np.stack(
        [slip_x * np.cos(phi) - slip_y * np.sin(phi), slip_x * np.sin(phi) + slip_y * np.cos(phi)],
        axis=1,
    )
    power = np.einsum("ij,ij->i", force, slip)
    work = np.concatenate(
        [[0], np.cumsum(0.5 * (power[1:] + power[:-1]) * np.diff(run["time"].values))]
    )
    assert work == pytest.approx(run["work"].values, abs=1e-4 * abs(run["work"].values[-1]))


def test_a_faster_top_gets_more_samples_up_to_a_limit() -> None:
    counts = [
        sample_counts.sample_count(tt.presets.report_problem(spin=spin), 20.0)
        for spin in (50.0, 155.0, 300.0, 1e5)
    ]
    assert counts == sorted(counts)
    assert counts[-1] <= sample_counts.MOST_SAMPLES + 1


def test_a_tumbling_top_turns_little_between_samples() -> None:
    """The tilt rate counts as the spin does."""
    problem = tt.presets.report_problem(spin=0.0).replace({"launch.tilt_rate": 400.0})
    samples = sample_counts.sample_count(problem, 1.0)
    assert 400.0 / (samples - 1) <= sample_counts.TURN_PER_SAMPLE
    still = tt.presets.report_problem(spin=0.0, tilt=0.0)
    assert sample_counts.sample_count(still, 1.0) < samples


def test_the_page_samples_by_the_same_rule() -> None:
    problems = [
        tt.presets.report_problem(spin=spin).replace({"launch.tilt_rate": rate})
        for spin, rate in ((0.0, 400.0), (155.0, 0.0), (1e5, 0.0))
    ]
    asked = [{"samples": 20.0, "problem": one.model_dump(mode="json")} for one in problems]
    assert list(in_javascript(asked)) == [sample_counts.sample_count(one, 20.0) for one in problems]
