"""Maps show the values of their sweep, where they belong."""

import matplotlib as mpl
import numpy as np
import pytest
import xarray as xr
from matplotlib.collections import QuadMesh
from sweep_cases import lively

from tippetop.figures.maps import FLAGS, MAPPED, phase_map
from tippetop.figures.style import save
from tippetop.problem.presets import report_problem
from tippetop.support.errors import InvalidInput
from tippetop.sweeps import SWEPT, Draws, Outcome, Product, Sweep, compute
from tippetop.sweeps.axes import Spaced


@pytest.fixture(scope="module")
def plane():
    axes = Spaced("launch.spin", 100.0, 200.0, 3), Spaced("friction.mu", 0.1, 1.0, 4, "log")
    return compute(Sweep(report_problem(tilt=1.0), Product(axes), 0.2))


SAVED = ("outcome", "turnover_time")
"""Maps that are written: one of words and one of numbers."""


@pytest.mark.parametrize("name", [name for name in SWEPT if name != "steps"])
def test_a_map_holds_every_cell(plane, name, tmp_path):
    figure = phase_map(plane, name)
    axes, bar = figure.axes
    mesh = next(child for child in axes.get_children() if isinstance(child, QuadMesh))
    values = np.asarray(plane[name].values, dtype=float).T
    shown = np.ma.filled(mesh.get_array().astype(float), np.nan)
    assert np.array_equal(shown, values, equal_nan=True)
    assert axes.get_xscale() == "linear"
    assert axes.get_yscale() == "log"
    assert "spin" in axes.get_xlabel()
    assert "μ" in axes.get_ylabel()
    if "flag_meanings" in plane[name].attrs:
        labels = [label.get_text().replace(" ", "_") for label in bar.get_yticklabels()]
        assert labels == plane[name].attrs["flag_meanings"].split()
    if name in SAVED:
        save(figure, tmp_path / "map.png")


def test_what_is_not_computed_is_not_shown(plane):
    partly = plane.copy(deep=True)
    partly["is_done"][0, :] = False
    mesh = next(
        child for child in phase_map(partly).axes[0].get_children() if isinstance(child, QuadMesh)
    )
    assert mesh.get_array().mask[:, 0].all()
    assert not mesh.get_array().mask[:, 1:].any()


def test_cells_are_drawn_where_their_values_are(plane):
    """Each value is in the middle of its cell, by eye, and nothing is drawn beyond the cells."""
    mu = str(plane["final_tilt"].dims[1])
    for drawn in (plane, plane.isel({mu: [2, 0, 3, 1]}), plane.isel({mu: [1]})):
        axes = phase_map(drawn).axes[0]
        mesh = next(child for child in axes.get_children() if isinstance(child, QuadMesh))
        corners, in_order = mesh.get_coordinates(), drawn.sortby(mu)
        pixels = axes.transData.transform(corners.reshape(-1, 2)).reshape(corners.shape)
        centres = (pixels[:-1, :-1] + pixels[1:, 1:]) / 2
        values = np.meshgrid(in_order["spin"].values, in_order["mu"].values)
        expected = axes.transData.transform(np.stack(values, axis=-1).reshape(-1, 2))
        np.testing.assert_allclose(centres.reshape(-1, 2), expected, atol=1e-6)
        assert np.array_equal(mesh.get_array(), in_order["final_tilt"].values.T)
        assert np.all(pixels[1:, 1:] > pixels[:-1, :-1] + 1.0)
        assert axes.get_ylim() == pytest.approx((corners[0, 0, 1], corners[-1, 0, 1]))


def test_an_axis_of_negative_numbers_is_drawn_with_even_steps(plane):
    backwards = plane.assign_coords(mu=-plane["mu"])
    axes = phase_map(backwards).axes[0]
    assert axes.get_yscale() == "linear"
    assert axes.get_ylim()[0] < -1.0 < -0.1 < axes.get_ylim()[1]


def test_one_axis_is_a_curve_and_draws_are_points():
    curve = compute(Sweep(report_problem(), Product((Spaced("launch.spin", 1, 9, 5),)), 0.1))
    line, dots = phase_map(curve, "final_tilt").axes[0].lines
    assert dots.get_ydata() == pytest.approx(line.get_ydata()), "all are still moving"
    assert line.get_ydata() == pytest.approx(curve["final_tilt"].values)
    never = phase_map(curve, "turnover_time").axes[0]
    assert never.get_xlim() == pytest.approx((0.0, 10.0))
    assert never.get_title(loc="left").endswith("no point: not within the run")
    spins, tilts = {"launch.spin": {"from": 1, "to": 9}}, {"launch.tilt": {"from": 0.1, "to": 0.2}}
    draws = compute(Sweep(report_problem(), Draws.of(spins | tilts, 6), 0.1))
    points = phase_map(draws, "final_tilt").axes[0].collections[-1]
    assert np.asarray(points.get_offsets())[:, 0] == pytest.approx(draws["spin"].values)
    assert np.asarray(points.get_array()) == pytest.approx(draws["final_tilt"].values)
    single = compute(Sweep(report_problem(), Draws.of(spins, 6), 0.1))
    assert phase_map(single).axes[0].lines[0].get_xdata() == pytest.approx(single["spin"].values)


@pytest.mark.parametrize(("count", "drawn"), [(2, [0, 1]), (17, [0, 2, 4, 6, 8, 10, 12, 14, 16])])
def test_more_axes_go_from_panel_to_panel(plane, count, drawn, tmp_path):
    tilts = np.linspace(0.1, 0.9, count)
    parts = [plane.assign(final_tilt=plane["final_tilt"] + k) for k in range(count)]
    cube = xr.concat(parts, xr.DataArray(tilts, dims="tilt", name="tilt"))
    cube = cube.expand_dims({"gravity": [1.0, 2.0, 3.0]}).transpose("spin", "mu", "tilt", "gravity")
    cube["gravity"].attrs["units"] = "m s-2"
    figure = phase_map(cube)
    meshes = [
        child
        for axes in figure.axes
        for child in axes.get_children()
        if isinstance(child, QuadMesh)
    ]
    maps = [mesh for mesh in meshes if mesh.get_array().shape == (4, 3)]
    assert len(maps) == len(drawn)
    for mesh, place in zip(maps, drawn, strict=True):
        assert np.array_equal(mesh.get_array(), parts[place]["final_tilt"].values.T)
        assert f"{tilts[place]:.4g}" in mesh.axes.get_title(loc="left")
    assert "Gravity (m/s²) = 2" in figure.get_suptitle()
    if count < 4:
        save(figure, tmp_path / "map.png")


def test_making_a_map_leaves_the_style_alone(plane):
    before = dict(mpl.rcParams)
    for name in MAPPED:
        phase_map(plane, name)
    assert dict(mpl.rcParams) == before


def test_launches_that_were_stopped_at_lift_off_show_no_final_tilt():
    sweep = compute(lively("stop"))
    lifted = sweep["outcome"].values == Outcome.LIFTED_OFF
    assert lifted.any()
    assert not lifted.all()
    axes = phase_map(sweep).axes[0]
    mesh = next(child for child in axes.get_children() if isinstance(child, QuadMesh))
    assert np.array_equal(np.ma.getmaskarray(mesh.get_array()), lifted.T)
    assert "left the table" in axes.get_title(loc="left")


def test_launches_that_failed_or_are_inaccurate_show_no_final_tilt(plane):
    some = plane.copy(deep=True)
    some["outcome"].values[0, :2] = Outcome.INACCURATE, Outcome.FAILED
    axes = phase_map(some).axes[0]
    mesh = next(child for child in axes.get_children() if isinstance(child, QuadMesh))
    masked = np.ma.getmaskarray(mesh.get_array()).T
    assert masked[0, :2].all()
    assert masked.sum() == 2
    assert "grey: failed, inaccurate" in axes.get_title(loc="left")
    assert "grey" not in phase_map(plane).axes[0].get_title(loc="left")


def test_every_flag_has_a_colour_of_its_own():
    assert len(set(FLAGS)) == len(FLAGS) >= max(len(kind.flags) for kind in SWEPT.values())


def test_axes_have_the_units_of_the_problem():
    """The friction coefficient of dry friction has none."""
    problem = report_problem(tilt=1.0).replace({"friction.kind": "coulomb"})
    grid = Product.of({"friction.mu": [0.1, 0.2], "launch.gap": [0.01, 0.02]})
    axes = phase_map(compute(Sweep(problem, grid, 0.01))).axes[0]
    assert axes.get_xlabel() == "Friction coefficient μ"
    assert axes.get_ylabel() == "Height of the lowest point at launch (m)"


@pytest.mark.parametrize("values", [np.linspace, np.geomspace])
def test_an_axis_that_is_too_long_to_be_drawn_is_refused(plane, values):
    far = plane.copy(deep=True)
    name = str(far["final_tilt"].dims[0])
    far = far.assign_coords(
        {name: values(1e-3, 1e299 if values is np.geomspace else 1e308, far.sizes[name])}
    )
    with pytest.raises(InvalidInput, match=f"{name}: .* reach too far to be drawn"):
        phase_map(far)


def test_words_along_an_axis_are_no_lengths(plane):
    name = str(plane["final_tilt"].dims[0])
    words = [f"{value:g}" for value in plane[name].values]
    assert phase_map(plane.assign_coords(label=(name, words))).axes
