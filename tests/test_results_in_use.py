"""Results in use: drawn into a panel, as methods of datasets, written and read again."""

import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from matplotlib.figure import Figure

import tippetop as tt

PROBLEM = tt.presets.report_problem(spin=50.0)


@pytest.fixture(scope="module")
def run() -> xr.Dataset:
    return tt.simulate(PROBLEM, 0.05, samples=6)


@pytest.fixture(scope="module")
def swept() -> xr.Dataset:
    spins = xr.DataArray([10.0, 20.0, 30.0], dims="spin")
    return tt.sweep(PROBLEM, {"launch.spin": spins}, duration=0.01, workers=1)


@pytest.fixture(scope="module")
def fitted() -> tt.FitResult:
    run = tt.simulate(PROBLEM, 0.2, samples=30)
    noise = 1e-4 * np.sin(np.arange(30.0) ** 2)
    film = tt.Measurement.of_variables(run["time"], {"tilt": run["tilt"] + noise}, noise=1e-4)
    return tt.fit(PROBLEM, film, "friction.mu")


def test_every_result_is_drawn_into_a_panel_and_by_itself(run, swept, fitted) -> None:
    comparison = tt.compare_fits({"one": fitted, "two": fitted})
    results = [run, swept, fitted, comparison, tt.steady_states(PROBLEM), tt.predict(PROBLEM)]
    for result in results:
        panel = Figure().subplots()
        assert tt.plot(result, ax=panel) is panel.figure
        assert panel.has_data(), result
        assert isinstance(tt.plot(result), Figure)
    (line,) = tt.plot(run, "spin").axes[0].lines
    assert line.get_ydata().tolist() == run["spin"].values.tolist()


@pytest.mark.parametrize(
    ("arguments", "field"),
    [
        ((3,), "result"),
        (([],), "result"),
        (("run", "tlt"), "variable"),
        (("swept", "tlt"), "variable"),
    ],
)
def test_what_cannot_be_drawn_is_refused(run, swept, arguments, field) -> None:
    result, *variable = arguments
    named = {"run": run, "swept": swept}
    with pytest.raises(tt.InvalidInput, match=f"^{field}"):
        tt.plot(named.get(result, result) if isinstance(result, str) else result, *variable)


def test_the_accessor_does_what_the_functions_do(run, swept, tmp_path: Path) -> None:
    assert str(run.tippetop.describe()) == str(tt.describe(run))
    assert run.tippetop.to_dataframe().equals(tt.to_dataframe(run))
    assert swept.tippetop.to_dataframe().equals(tt.to_dataframe(swept))
    assert tt.read_run(run.tippetop.write(tmp_path / "run.nc")).equals(run)
    assert isinstance(swept.tippetop.plot("final_tilt"), Figure)
    quantities = run.tippetop.quantify()
    spin = quantities["spin"].data[0]
    assert spin.to("rpm").magnitude == pytest.approx(50.0 * 30.0 / np.pi, rel=1e-12)
    assert quantities["mode"].dtype == run["mode"].dtype


def test_a_fit_is_written_and_read_with_all_its_methods(fitted, tmp_path: Path) -> None:
    again = tt.read_fit(tt.write_fit(fitted, tmp_path / "fit.json"))
    assert again.values == fitted.values
    assert again.covariance.equals(fitted.covariance)
    assert again.problem == fitted.problem
    assert again.summary() == fitted.summary()
    assert again.profile("friction.mu") == pytest.approx(fitted.profile("friction.mu"), rel=1e-9)
    (tmp_path / "other.json").write_text("{}")
    with pytest.raises(tt.FileTrouble, match="is not a fit"):
        tt.read_fit(tmp_path / "other.json")


def test_a_problem_is_written_in_the_format_of_its_suffix(tmp_path: Path) -> None:
    for name in ("top.toml", "top.json"):
        assert tt.Problem.read(PROBLEM.write(tmp_path / name)) == PROBLEM
    with pytest.raises(tt.FileTrouble, match="exists"):
        PROBLEM.write(tmp_path / "top.toml")
    with pytest.raises(tt.InvalidInput, match="toml"):
        PROBLEM.write(tmp_path / "top.txt")


@pytest.mark.parametrize(
    ("name", "options", "read"),
    [
        ("run.csv", {}, {}),
        ("run.csv", {"decimal": ","}, {"sep": ";", "decimal": ","}),
        ("run.tsv", {}, {"sep": "\t"}),
        ("run.txt", {"sep": " ", "units": False}, {"sep": " "}),
    ],
)
def test_tables_have_the_separators_and_headings_that_are_asked_for(tmp_path, name, options, read):
    run = tt.simulate(tt.presets.report_problem(), 0.1, samples=5)
    table = pd.read_csv(tt.write_csv(run, tmp_path / name, **options), **read)
    heading = "tilt (rad)" if options.get("units", True) else "tilt"
    assert table[heading].to_numpy() == pytest.approx(run["tilt"].values, rel=1e-15)


@pytest.mark.parametrize(
    ("name", "options", "field"),
    [
        ("run.ods", {}, "path"),
        ("run.xlsx", {"decimal": ","}, "decimal"),
        ("run.csv", {"sep": ";;"}, "sep"),
        ("run.csv", {"sep": ",", "decimal": ","}, "sep"),
        ("run.csv", {"decimal": "'"}, "decimal"),
        ("run.csv", {"units": "no"}, "units"),
    ],
)
def test_tables_of_other_kinds_are_refused(tmp_path, name, options, field):
    run = tt.simulate(tt.presets.report_problem(), 0.1, samples=5)
    with pytest.raises(tt.InvalidInput) as refusal:
        tt.write_csv(run, tmp_path / name, **options)
    assert refusal.value.field == field
    assert not list(tmp_path.iterdir())


def test_a_workbook_is_written_by_openpyxl(tmp_path, monkeypatch):
    run = tt.simulate(tt.presets.report_problem(), 0.1, samples=5)
    with monkeypatch.context() as without:
        without.setitem(sys.modules, "openpyxl", None)
        with pytest.raises(tt.Unavailable, match="install openpyxl, or write"):
            tt.write_csv(run, tmp_path / "run.xlsx")
    assert not list(tmp_path.iterdir())
    table = pd.read_excel(run.tippetop.write(tmp_path / "run.xlsx"))
    assert table["tilt (rad)"].to_numpy() == pytest.approx(run["tilt"].values, rel=1e-15)


def test_a_field_of_another_part_is_replaced_and_not_copied():
    problem = tt.presets.report_problem()
    with pytest.raises(tt.InvalidInput, match=r"replace\(\{'friction.mu': 0.1\}\)"):
        problem.model_copy(update={"friction.mu": 0.1})
    with pytest.raises(tt.InvalidInput, match=r"model_copy\(update=\{'mu': 0.1\}\)"):
        problem.friction.model_copy(update={"friction.mu": 0.1})
