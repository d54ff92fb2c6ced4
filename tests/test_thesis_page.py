"""The page of ten tasks of a thesis: every task in at most six lines, and with the right result."""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
import pytest
import scipy.stats

import tippetop as tt
from package_kinds import forget_own_kinds

PAGE = Path(__file__).parents[1] / "docs" / "howto" / "thesis.md"
CELL = re.compile(r"^```\{code-cell\} python\n(.*?)^```$", re.MULTILINE | re.DOTALL)
TASKS = PAGE.read_text("utf-8").split("\n## ")
MOST_LINES = 6


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, dict[str, Any]]]:
    """Yield the names that every task defines, by the title of the task.

    A thousand launches are 100 here.
    """
    plt = pytest.importorskip("matplotlib.pyplot")
    found = dict[str, dict[str, Any]]()
    with pytest.MonkeyPatch.context() as patch, mpl.rc_context():
        patch.chdir(tmp_path_factory.mktemp("thesis"))
        forget_own_kinds(patch)
        mpl.use("agg")
        begin, *tasks = TASKS
        for task in tasks:
            names: dict[str, Any] = {"__name__": "__main__"}
            plt.close("all")
            for cell in [*CELL.findall(begin), *CELL.findall(task)]:
                code = cell.replace("count=1000", "count=100")
                exec(compile(code, str(PAGE), "exec"), names)
            axes = [axes for number in plt.get_fignums() for axes in plt.figure(number).axes]
            found[task.partition("\n")[0]] = names | {
                "lines": [len(one.get_lines()) for one in axes],
                "folder": Path.cwd(),
            }
        plt.close("all")
        yield found


def test_every_task_takes_at_most_six_lines() -> None:
    assert len(TASKS) == 11
    for task in TASKS[1:]:
        first, *_ = CELL.findall(task)
        assert 0 < len(first.splitlines()) <= MOST_LINES, task


def test_the_curves_are_drawn(results: dict[str, dict[str, Any]]) -> None:
    assert results["Five spins in one plot"]["lines"] == [5]
    assert results["A Poincaré section"]["lines"] == [1]
    assert results["The force in the body's frame"]["lines"] == [3]
    assert results["A bifurcation diagram"]["lines"] == [3]


def test_the_parts_of_the_energy_are_the_energy(results: dict[str, dict[str, Any]]) -> None:
    names = results["Where the energy is"]
    table = names["table"]
    np.testing.assert_allclose(table[names["parts"]].sum(axis=1), table["energy"], rtol=1e-12)


def test_the_diagram_has_the_branches_of_the_theory(results: dict[str, dict[str, Any]]) -> None:
    names = results["A bifurcation diagram"]
    critical, settled = names["critical"], names["settled"]["final_tilt"]
    below = settled.where(settled["spin"] < critical.upright, drop=True)
    above = settled.where(settled["spin"] > critical.inverted, drop=True)
    assert below.size > 5 < above.size
    assert float(below.max()) < 0.01
    assert float(above.min()) > np.pi - 0.01


def test_the_section_is_where_the_tilt_is_least(results: dict[str, dict[str, Any]]) -> None:
    names = results["A Poincaré section"]
    section, solution = names["section"], names["solution"]
    assert len(section.tilt) > 50
    beside = solution(np.maximum(section.time - 1e-4, 0.0)), solution(section.time + 1e-4)
    assert all((section.tilt <= near.tilt).all() for near in beside)


def test_the_body_s_force_is_as_large_as_the_table_s(results: dict[str, dict[str, Any]]) -> None:
    run = results["The force in the body's frame"]["run"]
    sizes = [np.linalg.norm(run[f"contact_force{end}"], axis=1) for end in ("", "_body")]
    np.testing.assert_allclose(sizes[0], sizes[1], rtol=1e-12)


def test_the_event_is_in_the_table(results: dict[str, dict[str, Any]]) -> None:
    run = results["An event of your own"]["run"]
    events = tt.to_dataframe(run, "events")
    times = events["time"][events["kind"] == "60 degrees"]
    problem = results["An event of your own"]["problem"]
    again = tt.simulate(problem, 10.0, times=[0.0, *times, 10.0])
    assert len(times) > 0
    np.testing.assert_allclose(again["tilt"][1:-1], np.pi / 3, rtol=0, atol=1e-12)


def test_the_samples_have_the_distributions(results: dict[str, dict[str, Any]]) -> None:
    names = results["A thousand launches, and an interval"]
    launches = names["launches"]
    assert launches.sizes["draw"] == 100
    for field in ("spin", "tilt"):
        assert scipy.stats.kstest(launches[field].values, names[field].cdf).pvalue > 1e-3
    low, high = names["interval"].values
    inside = (launches["turnover_time"] >= low) & (launches["turnover_time"] <= high)
    assert float(inside.mean()) == pytest.approx(0.95, abs=0.011)


def test_the_table_is_read_again(results: dict[str, dict[str, Any]]) -> None:
    names = results["A table into Parquet"]
    again = pd.read_parquet(names["folder"] / "run.parquet")
    pd.testing.assert_frame_equal(again.set_index("time"), tt.to_dataframe(names["run"]))


def test_the_law_is_swept_with_the_numbers_of_single_runs(
    results: dict[str, dict[str, Any]],
) -> None:
    names = results["A friction law of your own in a sweep"]
    for mu in (0.1, 0.3):
        run = tt.simulate(names["mine"].replace({"friction.mu": mu}), 10.0, tolerance=1e-9)
        assert float(names["swept"]["final_tilt"].sel(mu=mu)) == pytest.approx(
            float(run["final_tilt"]), abs=1e-6
        )


def test_a_restart_goes_on_as_the_run_does(results: dict[str, dict[str, Any]]) -> None:
    names = results["A restart from a state in mid-run"]
    solution, run = names["solution"], names["run"]
    later = tt.simulate(solution.problem_at(2.0), 18.0)
    assert 2.0 + float(later["turnover_time"]) == pytest.approx(
        float(run["turnover_time"]), abs=1e-9
    )
    assert float(names["later"]["turnover_time"]) > float(later["turnover_time"])
