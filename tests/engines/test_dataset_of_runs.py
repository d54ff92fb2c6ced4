"""Data sets of random problems: the same bytes, problems that stand by themselves, derivatives."""

import numpy as np
import pytest
import xarray as xr
from typer.testing import CliRunner

import tippetop as tt
from tippetop.cli.commands import app
from tippetop.engines import dataset
from tippetop.engines.families import FAMILIES, SHARES, drawn_problem

pytest.importorskip("zarr", reason="zarr is not installed: pip install 'tippetop[sweep]'")

SHORT = {"duration": 0.3, "samples": 7}


def files_of(folder):
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


@pytest.fixture(scope="module")
def store(tmp_path_factory):
    """A data set of one problem a family, in two chunks."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(dataset, "CHUNK", 3)
        place = tmp_path_factory.mktemp("data") / "top.zarr"
        return dataset.write_dataset(place, len(FAMILIES), 7, workers=1, **SHORT)


@pytest.mark.parametrize("workers", [1, pytest.param(2, marks=pytest.mark.slow)])
def test_the_same_seed_gives_the_same_bytes_in_any_number_of_processes(
    store, tmp_path, monkeypatch, workers
):
    monkeypatch.setattr(dataset, "CHUNK", 3)
    place = tmp_path / "top.zarr"
    again = dataset.write_dataset(place, len(FAMILIES), 7, workers=workers, **SHORT)
    assert files_of(again) == files_of(store)
    assert again.with_suffix(".md").read_text() == store.with_suffix(".md").read_text()


def test_a_store_states_its_problems_whole_and_has_their_runs(store):
    data = xr.open_zarr(store, consolidated=False).load()
    names = list(data.attrs["families"])
    assert [names[k] for k in data["family"].values] == [one.name for one in FAMILIES]
    events = np.split(data["event_time"].values, np.cumsum(data["event_count"].values)[:-1])
    for row in range(data.sizes["problem"]):
        base = tt.Problem(**data.attrs["families"][names[row]]["problem"])
        fields = dict(zip(data.attrs["fields"], data["fields"].values[row].tolist(), strict=True))
        changes = {name: value for name, value in fields.items() if not np.isnan(value)}
        if "launch.slip.0" in changes:
            changes["launch.slip"] = (changes.pop("launch.slip.0"), 0.0)
        run = tt.simulate(base.replace(changes), 0.3, times=data["time"].values)
        for name in ("axis", "angular_velocity", "velocity", "height"):
            assert np.array_equal(data[name].values[row], run[name].values), name
        words = [data["mode"].attrs["words"][k] for k in data["mode"].values[row]]
        assert words == run["mode"].values.tolist()
        assert np.array_equal(events[row], run["event_time"].values)
        assert data["energy_error"].values[row] < 1e-10
    kinds = {data["event_kind"].attrs["words"][k] for k in data["event_kind"].values}
    assert "touchdown" in kinds, "of the ball that is dropped"


def test_derivatives_are_the_limits_of_differences(store):
    data = xr.open_zarr(store, consolidated=False).load()
    assert data["derived_problem"].values.tolist() == [0, 3]
    fields, numbers = data.attrs["fields"], data.attrs["numbers"]
    problem = drawn_problem(7, 0).problem
    for field in ("friction.mu", "body.I1"):
        value, ends = problem.get(field), []
        for step in (1e-5, -1e-5):
            beside = problem.replace({field: value * (1.0 + step)})
            ends.append(tt.simulate(beside, 0.3, times=[0.0, 0.3])["angular_velocity"].values[-1])
        expected = (ends[0] - ends[1]) / (2e-5 * value)
        row = data["derivative"].values[0, fields.index(field)]
        stored = row[[numbers.index(f"angular_velocity_{letter}") for letter in "xyz"]]
        assert stored == pytest.approx(expected, rel=1e-4, abs=1e-4 * np.abs(expected).max())
    absent = data["derivative"].values[0, fields.index("friction.patch_radius")]
    assert np.isnan(absent).all(), "a film has no patch"


def test_problems_are_as_stated_and_do_not_depend_on_their_number():
    drawn = [drawn_problem(3, number) for number in range(600)]
    assert {one.family for one in drawn} == set(range(len(FAMILIES)))
    for one in drawn:
        body = one.problem.body
        assert 0.0 < body.I3 <= 2.0 * body.I1
    counts = np.bincount([one.split for one in drawn]) / len(drawn)
    # Within four standard deviations of a binomial distribution.
    for share, count in zip(SHARES.values(), counts, strict=True):
        assert abs(count - share) < 4.0 * np.sqrt(share * (1.0 - share) / len(drawn))
    assert drawn_problem(3, 599) == drawn[599]
    assert drawn_problem(4, 599) != drawn[599]


def test_misuse_is_a_sentence_and_nothing_is_written_over(tmp_path):
    words = ["dataset", "--out", str(tmp_path / "top.zarr"), "--count", "1", "--duration", "0.1"]
    words += ["--samples", "2", "--workers", "1"]
    done = CliRunner().invoke(app, words)
    assert done.exit_code == 0, done.output
    before = files_of(tmp_path)
    assert isinstance(CliRunner().invoke(app, words).exception, tt.FileTrouble)
    assert files_of(tmp_path) == before
    assert CliRunner().invoke(app, [*words, "--force"]).exit_code == 0
    assert files_of(tmp_path) == before
    spins = {"launch.spin": [1.0]}
    tt.sweep(tt.presets.report_problem(), spins, duration=0.01, out=tmp_path / "sweep.zarr")
    with pytest.raises(tt.FileTrouble, match="no data set"):
        dataset.write_dataset(tmp_path / "sweep.zarr", 1, overwrite=True)
    (tmp_path / "mine.zarr").mkdir()
    with pytest.raises(tt.FileTrouble, match="no data set"):
        dataset.write_dataset(tmp_path / "mine.zarr", 1, overwrite=True)
    for wrong in ({"count": 0}, {"seed": -1}, {"samples": 1}, {"duration": 0.0}, {"workers": -3}):
        with pytest.raises(tt.InvalidInput, match=next(iter(wrong))):
            dataset.write_dataset(tmp_path / "b.zarr", **{"count": 1, **wrong})
    with pytest.raises(tt.InvalidInput, match="zarr"):
        dataset.write_dataset(tmp_path / "b.nc", 1)
