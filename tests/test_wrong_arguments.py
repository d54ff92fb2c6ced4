"""What the public functions are given by mistake is refused in a sentence that names it."""

import re
from functools import cache

import numpy as np
import pytest
import xarray as xr

import tippetop as tt
from tippetop.sweeps.axes import Listed
from tippetop.sweeps.definition import Sweep
from tippetop.sweeps.grid import Product

PROBLEM = tt.presets.report_problem()
PIECE = tt.Workpiece(profile=[(0, -20), (0, 20, 20)], density=700, unit="mm")
NONE = {
    "None": None,
    "a word": "x",
    "a number": 3,
    "a body": PROBLEM.body,
    "rows": np.zeros((2, 2)),
}

OF_A_PROBLEM = {
    "simulate": lambda wrong: tt.simulate(wrong, 1.0),
    "sweep": lambda wrong: tt.sweep(wrong, {"launch.spin": [50.0]}, duration=1.0, workers=1),
    "critical_spins": tt.critical_spins,
    "predict": tt.predict,
    "standing_time": tt.standing_time,
    "steady_states": tt.steady_states,
    "spectrum": lambda wrong: tt.spectrum(wrong, tt.steady_states(PROBLEM)[0]),
    "least_straight_spin": tt.least_straight_spin,
}
OF_A_RUN = {
    "plot": tt.plot,
    "summarize": tt.summarize,
    "view": tt.view,
    "to_dataframe": tt.to_dataframe,
    "write_csv": lambda wrong: tt.write_csv(wrong, "run.csv"),
    "write_parquet": lambda wrong: tt.write_parquet(wrong, "run.parquet"),
    "write_glb": lambda wrong: tt.write_glb(wrong, "run.glb"),
    "write_html": lambda wrong: tt.write_html(wrong, "run.html"),
    "write_movie": lambda wrong: tt.write_movie(wrong, "run.gif"),
}


@cache
def run():
    return tt.simulate(PROBLEM, 0.1, samples=5)


def refused(field, call, *arguments):
    with pytest.raises(tt.InvalidInput) as refusal:
        call(*arguments)
    assert refusal.value.field == field
    told = str(refusal.value)
    assert re.match(rf"{re.escape(field)}(: \S| is missing \()", told)
    assert "\n" not in told


@pytest.mark.parametrize("name", OF_A_PROBLEM)
@pytest.mark.parametrize("wrong", NONE)
def test_what_is_no_problem(name, wrong):
    refused("problem", OF_A_PROBLEM[name], NONE[wrong])


def test_a_whole_number_beyond_all_floats():
    for duration in (10**400, -(10**400)):
        refused("duration", tt.simulate, PROBLEM, duration)


@pytest.mark.parametrize("name", OF_A_RUN)
def test_what_is_no_run(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    no_runs = (*NONE.values(), xr.Dataset(), run()["tilt"], run()[["tilt"]])
    for wrong in (*no_runs, run().isel(time=[]), run().isel(time=0)):
        # What is drawn need not be a run; a dataset that is no sweep has to be one.
        drawn = name == "plot" and not isinstance(wrong, xr.Dataset)
        refused("result" if drawn else "run", OF_A_RUN[name], wrong)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("lost", ["problem", "status", "message", "integrator"])
def test_a_run_that_lost_an_attribute(lost):
    poor = run().copy()
    del poor.attrs[lost]
    refused(f"run.attrs.{lost}", tt.summarize, poor)


@pytest.mark.parametrize("wrong", [[], {}, None, "reprot"])
def test_no_body_of_such_a_name(wrong):
    refused("preset", tt.presets.body, wrong)


@pytest.mark.parametrize("name", ["run.csv", "run.HTML", "run.toml", "run.stl"])
def test_a_run_is_not_written_under_the_ending_of_another_kind(name, tmp_path):
    refused("path", lambda: tt.write_run(run(), tmp_path / name))
    assert list(tmp_path.iterdir()) == []


def test_some_samples_of_a_run_are_a_run():
    assert tt.summarize(run().isel(time=slice(2, 4)))["final"]["tilt"] == run()["tilt"][3]


@pytest.mark.parametrize("wrong", NONE)
def test_what_is_no_piece_and_no_stem(wrong, tmp_path):
    wrong = None if wrong == "a body" else NONE[wrong]
    refused("piece", lambda: tt.design_insert(wrong, 0.1, 1.0))
    refused("piece", lambda: tt.write_solid(wrong, tmp_path / "x.stl"))
    refused("body", lambda: tt.least_jellett_to_stand(wrong))


@pytest.mark.parametrize("gravity", [0, -9.8, float("nan"), "g", None])
def test_no_gravity_to_stand_in(gravity):
    refused(
        "gravity", lambda: tt.least_jellett_to_stand(tt.presets.LEINE_GLOCKER_STEM, gravity=gravity)
    )


@pytest.mark.parametrize(
    ("field", "wrong"),
    [
        *(("mode_limit", bad) for bad in (-1, 1.5, "many", None, True)),
        *(("step_limit", bad) for bad in (-1, 1.5, "many", None, True)),
        ("times", np.zeros((2, 2))),
    ],
)
def test_limits_and_times_of_a_run(field, wrong):
    refused(field, lambda: tt.simulate(PROBLEM, 0.1, **{field: wrong}))


@pytest.mark.parametrize(
    ("field", "wrong"),
    [
        *(("frame_rate", bad) for bad in (0, "a", float("nan"), True)),
        *(("speed", bad) for bad in (0, "a", float("nan"), None)),
        *(("pixels", bad) for bad in (3, "ab", (64,), (64, 64, 64), (64.0, 64.0), (65, 64), 0)),
    ],
)
def test_settings_of_a_film(field, wrong, tmp_path):
    refused(field, lambda: tt.write_movie(run(), tmp_path / "run.gif", **{field: wrong}))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("wrong", [3, "told", 0])
def test_what_cannot_be_called_back(wrong, tmp_path):
    over = {"launch.spin": [50.0]}
    refused("callback", lambda: tt.simulate(PROBLEM, 0.1, callback=wrong))
    refused("callback", lambda: tt.sweep(PROBLEM, over, duration=0.1, workers=1, callback=wrong))
    refused("progress", lambda: tt.write_movie(run(), tmp_path / "run.gif", progress=wrong))


@pytest.mark.parametrize("wrong", ["no", 1, None])
def test_what_is_neither_true_nor_false(wrong, tmp_path):
    (tmp_path / "run.nc").write_text("mine")
    refused("overwrite", lambda: tt.write_run(run(), tmp_path / "run.nc", wrong))
    assert (tmp_path / "run.nc").read_text() == "mine"
    for name in ("overwrite", "resume"):
        asked = {"duration": 0.1, "workers": 1, "out": tmp_path / "a.zarr", name: wrong}
        refused(name, lambda asked=asked: tt.sweep(PROBLEM, {"launch.spin": [50.0]}, **asked))
    assert not (tmp_path / "a.zarr").exists()


@pytest.mark.parametrize("name", ["overwrite", "resume"])
def test_there_is_nothing_to_overwrite_or_resume_in_memory(name):
    refused(
        name,
        lambda: tt.sweep(PROBLEM, {"launch.spin": [50.0]}, duration=0.1, workers=1, **{name: True}),
    )


@pytest.mark.parametrize("height", [0, -3, "tall", 1.5, float("nan"), None])
def test_the_height_of_a_player(height):
    refused("height", lambda: tt.view(run(), height))


@pytest.mark.parametrize("wrong", [None, 3, "launch.spin", [("launch.spin", 3.0)], {3: 3.0}])
def test_changes_that_are_no_dict(wrong):
    refused("changes", PROBLEM.replace, wrong)


@pytest.mark.parametrize(
    "wrong", [[1], [("launch.spin", [50.0], 3)], [(None, [50.0])], ["launch.spin"], 3]
)
def test_axes_that_are_no_table(wrong):
    refused("over", lambda: tt.sweep(PROBLEM, wrong, duration=1.0, workers=1))


@pytest.mark.parametrize("wrong", [3, None])
def test_a_product_of_no_axes(wrong):
    refused("axes", Product, wrong)


@pytest.mark.parametrize("wrong", [(1.0, 2.0, 3.0, 4.0), "ab", 3])
@pytest.mark.parametrize(
    ("field", "accepted"), [("slip", "2 numbers"), ("velocity", "2 or 3 numbers")]
)
def test_velocities_that_are_no_lists_of_numbers(field, accepted, wrong):
    with pytest.raises(tt.InvalidInput) as refusal:
        tt.Launch(tilt=0.1, spin=1.0, **{field: wrong})
    assert refusal.value.accepted == accepted


def test_a_slip_of_one_number():
    refused("slip", lambda: tt.Launch(tilt=0.1, spin=1.0, slip=(1.0,)))


@pytest.mark.parametrize("wrong", [None, 3, ["a.nc"]])
def test_what_is_no_name_of_a_file(wrong):
    writers = (
        *(tt.write_csv, tt.write_parquet, tt.write_run),
        *(tt.write_glb, tt.write_html, tt.write_movie),
    )
    calls = [lambda write=write: write(run(), wrong) for write in writers]
    for call in (*calls, lambda: tt.write_solid(PIECE, wrong)):
        refused("path", call)
    for read in (tt.Problem.read, tt.read_run, tt.read_sweep):
        refused("path", read, wrong)


@pytest.mark.parametrize("wrong", [None, 3, b"gravity = 9.8"])
def test_what_is_no_text(wrong):
    for read in (tt.Problem.from_toml, tt.Problem.from_json):
        refused("problem", read, wrong)


@pytest.mark.parametrize("wrong", NONE)
def test_what_is_no_dataset_to_write(wrong, tmp_path):
    refused("run", lambda: tt.write_run(NONE[wrong], tmp_path / "run.nc"))
    assert list(tmp_path.iterdir()) == []


def test_more_values_than_fields():
    refused("Listed", Listed, "launch.spin", (1.0, 2.0), 3)
    refused(
        "Sweep", Sweep, PROBLEM, Product([Listed("launch.spin", (1.0, 2.0))]), 1.0, 1e-9, None, 7
    )


@pytest.mark.parametrize("name", ["numbers", "values", "field"])
def test_a_field_in_its_place_and_by_its_name(name):
    refused(name, lambda: Listed("launch.spin", (1.0,), **{name: (2.0,)}))


@pytest.mark.parametrize("name", ["problem", "grid", "over"])
def test_a_part_of_a_sweep_in_its_place_and_by_its_name(name):
    grid = Product.of({"launch.spin": [1.0]})
    refused(name, lambda: Sweep(PROBLEM, grid, **{name: grid}))


def test_a_sweep_of_both_axes_and_draws():
    draw = {"launch.spin": {"from": 1.0, "to": 2.0}}
    refused(
        "over, draw",
        lambda: Sweep(PROBLEM, Product.of({"launch.tilt": [0.1]}), draw=draw),
    )


def test_a_sweep_that_is_to_last_nothing():
    refused("duration", lambda: Sweep(PROBLEM, Product.of({"launch.spin": [1.0]}), duration=None))


def test_axes_in_their_place_and_by_their_name():
    axes = (Listed("launch.spin", (1.0,)),)
    assert Product(axes=axes) == Product(axes)
    refused("axes", lambda: Product(axes, axes=axes))


@pytest.mark.parametrize("entry", [{"values": [1.0]}, {"from": 1.0, "to": 2.0, "count": 2}])
def test_a_field_in_the_table_of_its_axis(entry):
    refused("launch.spin.field", Product.of, {"launch.spin": entry | {"field": "launch.tilt"}})


@pytest.mark.parametrize("wrong", [np.array(3.0), {1.0, 2.0}, "ab", None])
def test_values_in_no_order(wrong):
    refused("launch.spin", Product.of, {"launch.spin": wrong})


def test_a_truth_value_of_numpy_is_no_number():
    refused("launch.spin.values.0", Product.of, {"launch.spin": np.array([True, False])})


@pytest.mark.parametrize("wrong", [0.0, -1.0, float("nan"), "x", None, True])
def test_no_patch_of_contact(wrong):
    steel = tt.MATERIALS["steel"]
    refused("load", tt.hertz_patch_radius, wrong, 0.02, steel)
    refused("radius", tt.hertz_patch_radius, 0.2, wrong, steel)
    refused("body", tt.hertz_patch_radius, 0.2, 0.02, wrong)
    refused("modulus", lambda: tt.Material(modulus=wrong, poisson=0.3))


@pytest.mark.parametrize("wrong", [-1.0, 0.6, float("nan"), "x"])
def test_no_material(wrong):
    refused("poisson", lambda: tt.Material(modulus=1e9, poisson=wrong))
    refused("table", tt.hertz_patch_radius, 0.2, 0.02, tt.MATERIALS["wood"], wrong)


@pytest.mark.parametrize("size", [1e300, 1e-300])
def test_no_number_for_a_patch(size):
    refused("load", tt.hertz_patch_radius, size, size, tt.MATERIALS["steel"])


@pytest.mark.parametrize("ends", [(-1.7e308, 1.7e308), (1e-200, 1e200), (1e200, 1e-200)])
def test_ends_of_an_axis_too_far_apart_for_numbers(ends):
    spacing = "linear" if ends[0] < 0.0 else "log"
    entry = {"from": ends[0], "to": ends[1], "count": 3, "spacing": spacing}
    refused("friction.mu", Product.of, {"friction.mu": entry})
