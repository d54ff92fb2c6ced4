"""Results as tables: of pandas, in CSV and in Parquet."""

import csv
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import tippetop as tt


@pytest.fixture(scope="module")
def swept() -> xr.Dataset:
    """A sweep over two axes, one cell of which is no launch."""
    over = {"launch.spin": [50.0, 155.0], "launch.tilt": [0.1, 4.0]}
    return tt.sweep(tt.presets.report_problem(), over, duration=0.1, workers=1)


def test_samples_have_a_column_for_every_component(flying: xr.Dataset) -> None:
    table = tt.to_dataframe(flying)
    assert table.index.name == "time"
    assert np.array_equal(table.index, flying["time"])
    columns = 0
    for name, variable in flying.data_vars.items():
        if variable.dims == ("time",) and name != "mode":
            assert np.array_equal(table[name], variable.values, equal_nan=True), name
            columns += 1
        elif variable.dims[:1] == ("time",) and name != "mode":
            for label in variable[variable.dims[1]].values:
                part = variable.sel({variable.dims[1]: label}).values
                assert np.array_equal(table[f"{name}_{label}"], part), (name, label)
                columns += 1
    assert len(table.columns) == columns + 1
    assert set(table["mode"]) == {"sliding", "flight"}
    assert (table.loc[table["mode"] == "flight", "normal_force"] == 0.0).all()


def test_events_and_flights_are_tables_of_their_own(flying: xr.Dataset) -> None:
    events, flights = (tt.to_dataframe(flying, name) for name in ("events", "flights"))
    assert list(events.columns) == ["time", "kind", "impulse", "energy_lost", "surface"]
    assert list(flights.columns) == ["start", "end", "max_gap"]
    assert len(flights) == int(flying["flights"]) > 0
    lasting = (flights["end"] - flights["start"]).sum()
    assert lasting == pytest.approx(float(flying["airborne_time"]), rel=1e-12)
    assert events["energy_lost"].sum() == pytest.approx(
        float(flying["energy_lost_impacts"]), rel=1e-12
    )
    assert events.attrs["units"]["impulse"] == "N s"


def test_a_sweep_is_a_table_of_launches(swept: xr.Dataset) -> None:
    table = tt.to_dataframe(swept)
    assert list(table.columns[:2]) == ["spin", "tilt"]
    assert len(table) == 4
    for _, row in table.iterrows():
        cell = swept.sel(spin=row["spin"], tilt=row["tilt"])
        for name in swept.data_vars:
            value = cell[name].item()
            assert row[name] == value or (np.isnan(row[name]) and np.isnan(value)), name
    assert set(table.query("tilt > 3.2")["outcome"]) == {"invalid"}
    assert table.attrs["units"]["spin"] == "rad s-1"
    assert len(tt.to_dataframe(swept.isel(spin=0, tilt=0))) == 1


def test_draws_are_a_table_too() -> None:
    spins = {"launch.spin": {"from": 10.0, "to": 200.0}}
    table = tt.to_dataframe(
        tt.sweep(tt.presets.report_problem(), draw=spins, count=3, duration=0.01)
    )
    assert list(table.columns[:2]) == ["draw", "spin"]
    assert table["spin"].between(10.0, 200.0).all()


@pytest.mark.parametrize("table", [None, "samples", "events", "flights"])
def test_parquet_comes_back_with_its_units_and_attributes(
    flying: xr.Dataset, tmp_path: Path, table: str | None
) -> None:
    pytest.importorskip("pyarrow", reason="pyarrow writes Parquet; it comes with the test extra")
    again = pd.read_parquet(tt.write_parquet(flying, tmp_path / "run.parquet", table=table))
    expected = tt.to_dataframe(flying, table)
    if expected.index.name:
        expected = expected.reset_index()
    pd.testing.assert_frame_equal(again, expected, check_exact=True)
    assert again.attrs == expected.attrs
    assert tt.Problem.from_json(again.attrs["problem"]) == tt.presets.report_problem(spin=175.0)


def test_csv_and_parquet_hold_sweeps(swept: xr.Dataset, tmp_path: Path) -> None:
    pytest.importorskip("pyarrow", reason="pyarrow writes Parquet; it comes with the test extra")
    expected = tt.to_dataframe(swept)
    parquet = pd.read_parquet(tt.write_parquet(swept, tmp_path / "sweep.parquet"))
    pd.testing.assert_frame_equal(parquet, expected, check_exact=True)
    with tt.write_csv(swept, tmp_path / "sweep.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["spin (rad s-1)"]) for row in rows] == expected["spin"].tolist()
    assert [row["outcome"] for row in rows] == expected["outcome"].tolist()


def test_csv_holds_the_tables_of_a_run(flying: xr.Dataset, tmp_path: Path) -> None:
    path = tt.write_csv(flying, tmp_path / "flights.csv", table="flights")
    head, *rows = path.read_text().splitlines()
    assert head == "start (s),end (s),max_gap (m)"
    assert [float(row.split(",")[0]) for row in rows] == flying["flight_start"].values.tolist()


@pytest.mark.parametrize("call", [tt.to_dataframe, tt.write_csv, tt.write_parquet])
def test_what_is_no_table_is_refused(
    flying: xr.Dataset, swept: xr.Dataset, tmp_path: Path, call: Callable[..., object]
) -> None:
    place = () if call is tt.to_dataframe else (tmp_path / "table",)
    with pytest.raises(tt.InvalidInput, match=r"table: 'flight' .*did you mean flights"):
        call(flying, *place, table="flight")
    with pytest.raises(tt.InvalidInput, match="None for a sweep"):
        call(swept, *place, table="events")
    with pytest.raises(tt.InvalidInput, match=r"^run: "):
        call(3, *place)
    assert list(tmp_path.iterdir()) == []


def test_without_pyarrow_parquet_says_what_to_install(
    flying: xr.Dataset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tippetop.export.tables.find_spec", lambda name: None)
    with pytest.raises(tt.Unavailable, match=r"pip install '.*\[parquet\]'"):
        tt.write_parquet(flying, tmp_path / "run.parquet")
    assert list(tmp_path.iterdir()) == []
