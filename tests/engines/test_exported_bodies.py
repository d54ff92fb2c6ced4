"""Bodies in the formats of other programs: numbers in the files, meshes, and files that load."""

import logging
import math
import re
from xml.etree import ElementTree

import numpy as np
import pytest

import tippetop as tt
from tippetop.engines.bodies import friction_numbers, launch_state, mjcf, save_mjcf, save_urdf, urdf
from tippetop.engines.cases import CASES
from tippetop.engines.mjcf.reading import problem_of_mjcf
from tippetop.engines.outline import revolved

DRY = tt.CoulombFriction(mu=0.3)
ABSENT = "{} is not installed: pip install 'tippetop[engines]'"


def problem_of(body: tt.Body, **others) -> tt.Problem:
    return tt.Problem(
        body=body, friction=DRY, launch=tt.Launch(tilt=0.3, spin=100.0, azimuth=0.7), **others
    )


ROUND = tt.Body(mass=0.02, shape=tt.Ring(radius=0.01, center=0.001, tube=0.004), I1=1e-6, I3=1.2e-6)
BODIES = {
    "sphere": tt.presets.REPORT,
    "two spheres": tt.presets.LEINE_GLOCKER_STEM,
    "cylinder": tt.presets.COIN,
    "spheroid": tt.presets.EGG,
    "round ring": ROUND,
}


WIDEST = {"cylinder": 0.02325 / 2, "spheroid": 0.028**2 / 0.022, "round ring": 0.014}
"""Largest radii of curvature of their surfaces, m."""


@pytest.mark.parametrize("name", WIDEST)
def test_a_mesh_is_closed_and_its_error_shrinks_as_the_square_of_its_facets(name):
    trimesh = pytest.importorskip("trimesh")
    coarse, fine = (revolved(BODIES[name], facets) for facets in (48, 96))
    for mesh in (coarse, fine):
        solid = trimesh.Trimesh(mesh.points, mesh.triangles, process=False)
        assert solid.is_watertight
        assert solid.volume > 0.0
    assert coarse.error / fine.error == pytest.approx(4.0, rel=0.1)
    # A chord leaves out 1 - cos(half its angle), around the axis and along it.
    bound = 2.0 * (1.0 - math.cos(math.pi / 96)) * WIDEST[name]
    assert 0.0 < fine.error < bound


def test_the_state_at_launch_is_that_of_the_problem():
    start = problem_of(tt.presets.REPORT).replace(
        {"launch.precession": 7.0, "launch.tilt_rate": 3.0}
    )
    state = launch_state(start)
    w, x, y, z = state.quaternion
    turn = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
    tilt, azimuth = 0.3, 0.7
    leaning = (math.sin(tilt) * math.cos(azimuth), math.sin(tilt) * math.sin(azimuth))
    assert turn[:, 2] == pytest.approx([*leaning, math.cos(tilt)], abs=1e-15)
    assert turn @ state.omega_body == pytest.approx(state.omega, rel=1e-14)
    momentum = np.array([start.body.I1, start.body.I1, start.body.I3]) * state.omega_body
    assert turn @ momentum == pytest.approx([float(x) for x in start.start().momentum], rel=1e-13)


def test_what_a_format_cannot_say_is_said():
    film = problem_of(tt.presets.REPORT).replace({"friction.kind": "viscous"})
    assert "not mapped" in friction_numbers(film).remarks[0]
    patch = next(case for case in CASES if case.name == "drilling-hertz").problem
    numbers = friction_numbers(patch)
    assert numbers.torsional == pytest.approx(0.3 * 3 * math.pi / 16 * 5e-4)
    assert "Hertz" in numbers.remarks[0]
    stopping = problem_of(tt.presets.REPORT).replace({"contact.liftoff": "stop"})
    assert any("contact.liftoff = 'stop'" in remark for remark in mjcf(stopping)[1].remarks)
    assert any("mesh" in remark for remark in mjcf(problem_of(ROUND))[1].remarks)
    assert mjcf(problem_of(tt.presets.EGG))[1].remarks == (), "MuJoCo has ellipsoids"


def test_gravity_has_the_direction_of_a_slope():
    problem = tt.presets.report_problem().replace(
        {"friction.kind": "coulomb", "table.slope": 0.1, "table.azimuth": 2.0}
    )
    text, written = mjcf(problem)
    gravity = [float(part) for part in re.search(r'gravity="([^"]+)"', text)[1].split()]
    expected = np.array([math.cos(2.0), math.sin(2.0), -1.0 / math.tan(0.1)])
    assert gravity == pytest.approx(9.8 * math.sin(0.1) * expected, rel=1e-14)
    read = problem_of_mjcf(text)
    assert read.gravity == pytest.approx(9.8)
    assert (read.table.slope, read.table.azimuth) == pytest.approx((0.1, 2.0))
    assert not any("air" in remark for remark in written.remarks)
    braked = problem.replace({"air.axial_linear": 1e-7})
    assert any("air is not mapped" in remark for remark in mjcf(braked)[1].remarks)
    assert any("no gravity: set" in remark for remark in urdf(problem)[2].remarks)


@pytest.mark.parametrize("name", BODIES)
def test_the_files_have_mass_and_inertia_to_the_last_digit(name):
    problem = problem_of(BODIES[name])
    body = problem.body
    inertial = ElementTree.fromstring(mjcf(problem)[0]).find(".//inertial").attrib
    assert float(inertial["mass"]) == body.mass
    assert [float(x) for x in inertial["diaginertia"].split()] == [body.I1, body.I1, body.I3]
    text, mesh, _ = urdf(problem)
    root = ElementTree.fromstring(text)
    assert float(root.find(".//mass").get("value")) == body.mass
    assert float(root.find(".//inertia").get("izz")) == body.I3
    assert (mesh is None) == (name in ("sphere", "two spheres", "cylinder"))


def test_nothing_is_written_over_and_nothing_by_halves(tmp_path):
    problem = problem_of(ROUND)
    (tmp_path / "top.obj").write_text("mine")
    with pytest.raises(tt.FileTrouble, match="exists"):
        tt.write_urdf(problem, tmp_path / "top.urdf")
    assert not (tmp_path / "top.urdf").exists()
    with pytest.raises(tt.InvalidInput, match="xml"):
        tt.write_mjcf(problem, tmp_path / "top.txt")


@pytest.mark.parametrize("name", BODIES)
def test_mujoco_loads_a_body_as_it_is(name, tmp_path):
    mujoco = pytest.importorskip("mujoco", reason=ABSENT.format("MuJoCo"))
    problem = problem_of(BODIES[name])
    save_mjcf(problem, tmp_path / "top.xml", overwrite=False)
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "top.xml"))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    body = problem.body
    assert model.body_mass[1] == pytest.approx(body.mass, rel=1e-9)
    assert sorted(model.body_inertia[1]) == pytest.approx(
        sorted([body.I1, body.I1, body.I3]), rel=1e-9
    )
    # The table touches, within the mesh's error, and the centre of mass is where it was.
    assert data.ncon <= 4
    low = problem.start().height - min((contact.pos[2] for contact in data.contact), default=0.0)
    assert low == pytest.approx(float(problem.start().height), abs=2e-5)
    assert data.xipos[1] == pytest.approx([0.0, 0.0, float(problem.start().height)], abs=1e-15)
    matrix = data.xmat[1].reshape(3, 3)
    assert matrix[:, 2] == pytest.approx([float(x) for x in problem.start().axis], abs=1e-14)


@pytest.mark.parametrize("name", BODIES)
def test_bullet_loads_a_body_as_it_is(name, tmp_path, capfd):
    pybullet = pytest.importorskip("pybullet", reason=ABSENT.format("PyBullet"))
    problem = problem_of(BODIES[name])
    save_urdf(problem, tmp_path / "top.urdf", overwrite=False)
    client = pybullet.connect(pybullet.DIRECT)
    top = pybullet.loadURDF(str(tmp_path / "top.urdf"), flags=pybullet.URDF_USE_INERTIA_FROM_FILE)
    mass, _, inertia, *_ = pybullet.getDynamicsInfo(top, -1)
    pybullet.disconnect(client)
    body = problem.body
    assert mass == pytest.approx(body.mass, rel=1e-9)
    assert inertia == pytest.approx((body.I1, body.I1, body.I3), rel=1e-9)
    assert "arning" not in "".join(capfd.readouterr())


@pytest.mark.parametrize("name", BODIES)
def test_drake_loads_a_body_as_it_is(name, tmp_path, caplog):
    pytest.importorskip("pydrake", reason=ABSENT.format("Drake"))
    from pydrake.multibody.parsing import Parser  # noqa: PLC0415
    from pydrake.multibody.plant import AddMultibodyPlantSceneGraph  # noqa: PLC0415
    from pydrake.systems.framework import DiagramBuilder  # noqa: PLC0415

    problem = problem_of(BODIES[name])
    save_urdf(problem, tmp_path / "top.urdf", overwrite=False)
    with caplog.at_level(logging.WARNING):
        plant, _ = AddMultibodyPlantSceneGraph(DiagramBuilder(), 1e-3)
        Parser(plant).AddModels(str(tmp_path / "top.urdf"))
        plant.Finalize()
    assert not caplog.records
    inertia = plant.GetBodyByName("top").default_spatial_inertia()
    body = problem.body
    assert inertia.get_mass() == pytest.approx(body.mass, rel=1e-9)
    moments = inertia.CalcRotationalInertia().get_moments()
    assert moments == pytest.approx([body.I1, body.I1, body.I3], rel=1e-9)
