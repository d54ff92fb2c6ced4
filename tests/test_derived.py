"""Variables that follow from others: parts of the energy, vectors in the body frame, and frames."""

import numpy as np
import pytest
import xarray as xr
from scipy.spatial.transform import Rotation

import tippetop as tt
from tippetop.results.catalogue import DERIVED, FRAMES, METRICS, SAMPLED


@pytest.fixture(scope="module")
def sliding() -> xr.Dataset:
    """A run that turns over and leaves the table on its way."""
    return tt.simulate(tt.presets.report_problem(spin=175.0), 8.0, samples=801)


@pytest.fixture(scope="module")
def flying() -> xr.Dataset:
    """A run in free flight: launched high above the table, and shorter than the fall."""
    launch = tt.Launch(
        tilt=1.0, tilt_rate=3.0, spin=120.0, precession=20.0, gap=1.0, velocity=(0.3, -0.2, 0.4)
    )
    problem = tt.Problem(body=tt.presets.REPORT, friction=tt.ViscousFriction(mu=0.3), launch=launch)
    return tt.simulate(problem, 0.2, samples=401)


@pytest.fixture(params=["sliding", "flying"])
def run(request: pytest.FixtureRequest) -> xr.Dataset:
    """Each of the two."""
    found: xr.Dataset = request.getfixturevalue(request.param)
    return found


def test_the_parts_of_the_energy_add_up_to_it(run: xr.Dataset) -> None:
    parts = ("height", "translation", "spin", "turning")
    total = sum(run[f"energy_{part}"].values for part in parts)
    # Rounding adds up over the run to 1e-14 in the length of the axis, and so in one of the parts.
    np.testing.assert_allclose(total, run["energy"].values, rtol=1e-13)


def test_each_part_of_the_energy_has_its_closed_form_in_euler_angles(run: xr.Dataset) -> None:
    problem = tt.Problem.from_json(run.attrs["problem"])
    body, gravity = problem.body, problem.gravity
    rates = run["tilt_rate"] ** 2 + (run["precession"] * np.sin(run["tilt"])) ** 2
    parts = {
        "height": body.mass * gravity * run["height"],
        "translation": 0.5 * body.mass * (run["velocity"] ** 2).sum("space"),
        "spin": 0.5 * body.I3 * run["spin"] ** 2,
        "turning": 0.5 * body.I1 * rates,
    }
    for part, expected in parts.items():
        np.testing.assert_allclose(
            run[f"energy_{part}"].values, expected.values, rtol=1e-9, atol=1e-12
        )


@pytest.mark.parametrize(
    "name", ["contact_force", "velocity", "angular_momentum", "angular_velocity"]
)
def test_the_orientation_turns_vectors_of_the_body_frame_to_the_table(
    run: xr.Dataset, name: str
) -> None:
    turn = Rotation.from_quat(run["orientation"].values, scalar_first=True)
    back = turn.apply(run[f"{name}_body"].values)
    size = np.abs(run[name].values).max()
    np.testing.assert_allclose(back, run[name].values, rtol=0.0, atol=1e-13 * size)


def test_the_body_frame_has_the_principal_moments_of_inertia(run: xr.Dataset) -> None:
    body = tt.Problem.from_json(run.attrs["problem"]).body
    moments = [body.I1, body.I1, body.I3]
    expected = run["angular_velocity_body"].values * moments
    size = np.abs(expected).max()
    np.testing.assert_allclose(
        run["angular_momentum_body"].values, expected, rtol=0.0, atol=1e-13 * size
    )


def test_in_flight_the_angular_velocity_turns_about_the_axis_as_euler_says(
    flying: xr.Dataset,
) -> None:
    """Without torque omega1 + i omega2 turns in the body frame at (I3 - I1)/I1 omega3."""
    body = tt.Problem.from_json(flying.attrs["problem"]).body
    omega = flying["angular_velocity_body"].values
    across = omega[:, 0] + 1j * omega[:, 1]
    rate = (body.I3 - body.I1) / body.I1 * omega[0, 2]
    expected = across[0] * np.exp(1j * rate * flying["time"].values)
    np.testing.assert_allclose(across, expected, rtol=0.0, atol=1e-10 * abs(across[0]))
    np.testing.assert_allclose(omega[:, 2], omega[0, 2], rtol=1e-12)


def test_all_that_has_components_or_a_direction_names_its_frame(sliding: xr.Dataset) -> None:
    scalars = {
        *("energy", "work", "jellett", "sliding_loss", "drilling_loss", "rolling_loss"),
        "air_loss",
        *(name for name in DERIVED if name.startswith("energy_")),
    }
    for name in {**SAMPLED, **DERIVED}:
        attributes = sliding[name].attrs
        assert (attributes.get("frame") in FRAMES) == (name not in scalars), name
    assert sliding["contact_force_body"].attrs["frame"] == "body"
    assert sliding["slip_x"].attrs["frame"] == "contact"
    assert sliding["orientation"].attrs["convention"].startswith("scalar first: w, x, y, z")
    same = {"min_normal_force": "normal_force", "max_height": "height", "max_gap": "gap"}
    same |= {f"final_{name}": name for name in SAMPLED if f"final_{name}" in METRICS}
    for name, sampled in same.items():
        assert sliding[name].attrs["frame"] == sliding[sampled].attrs["frame"], name


def test_slip_is_the_velocity_of_the_lowest_point_and_friction_acts_against_it(
    sliding: xr.Dataset,
) -> None:
    touching = sliding["normal_force"] > 0.0
    lean = sliding["azimuth"]
    force = sliding["contact_force"]
    along = force.sel(space="x") * np.cos(lean) + force.sel(space="y") * np.sin(lean)
    across = force.sel(space="y") * np.cos(lean) - force.sel(space="x") * np.sin(lean)
    power = (along * sliding["slip_x"] + across * sliding["slip_y"]).where(touching, drop=True)
    assert (power < 0.0).all()
