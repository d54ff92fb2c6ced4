"""MJCF read as a problem: out and in again, files as people write them, MuJoCo's numbers."""

import json
import math

import numpy as np
import pytest
from typer.testing import CliRunner

import tippetop as tt
from tippetop.cli.commands import app
from tippetop.engines.bodies import mjcf
from tippetop.engines.mjcf.document import Document
from tippetop.engines.mjcf.model import MjcfModel
from tippetop.engines.mjcf.poses import matrix
from tippetop.engines.mjcf.reading import problem_of_mjcf

RHO = 3.0 * math.pi / 16.0
FRICTIONS = {
    "coulomb": tt.CoulombFriction(mu=0.3),
    "patch": tt.ContensouFriction(mu=0.3, patch_radius=7e-4, pressure="ellipsoidal"),
    "smooth": tt.ViscousFriction(mu=0.0),
}
BODIES = {
    "eccentric sphere": tt.presets.REPORT,
    "two spheres": tt.presets.LEINE_GLOCKER_STEM.model_copy(update={"profile": None}),
    "cylinder": tt.presets.COIN,
    "spheroid": tt.presets.EGG,
}
LAUNCHES = {
    "leaning": {"tilt": 0.3, "azimuth": 0.7, "spin": 100.0},
    "precessing": {"tilt": 2.2, "azimuth": -2.0, "spin": 90.0, "precession": 7.0, "tilt_rate": 3.0},
    "slipping": {"tilt": 1.2, "spin": 50.0, "slip": (0.03, -0.01)},
    "dropped": {"tilt": 0.8, "spin": 50.0, "gap": 0.01, "velocity": (0.1, 0.2, -0.3)},
}


@pytest.mark.parametrize("launch", LAUNCHES)
@pytest.mark.parametrize("friction", FRICTIONS)
@pytest.mark.parametrize("body", BODIES)
def test_out_and_in_again_is_the_same_problem(body, friction, launch):
    problem = tt.Problem(
        body=BODIES[body], friction=FRICTIONS[friction], launch=tt.Launch(**LAUNCHES[launch])
    )
    text, written = mjcf(problem)
    assert not written.remarks
    again = problem_of_mjcf(text)
    one, two = problem.model_dump(), again.model_dump()
    # A part of the file's precision in each number; of a rate, in the angular velocity.
    flat_one, flat_two = (dict(_numbers(fields)) for fields in (one, two))
    assert flat_one.keys() == flat_two.keys()
    rates = {"launch.spin", "launch.precession", "launch.tilt_rate"}
    fastest = math.hypot(*problem.launch.angular_velocity())
    speed = max(1e-3, math.hypot(*map(float, problem.start().velocity)))
    for name, value in flat_one.items():
        scale = abs(value) if isinstance(value, float) else 0.0
        if name in rates:
            scale = fastest / math.sin(problem.launch.tilt)
        elif name.startswith(("launch.slip", "launch.velocity")):
            scale = speed
        elif name == "launch.gap":
            scale = float(problem.start().height)
        elif name in ("launch.tilt", "launch.azimuth"):
            scale = math.pi
        if isinstance(value, float):
            assert abs(flat_two[name] - value) <= 1e-15 * scale, name
        else:
            assert flat_two[name] == value, name


@pytest.mark.parametrize("slope", [0.2, 1e-7])
def test_a_slope_goes_out_and_in_again(slope):
    level = tt.Problem(
        body=tt.presets.REPORT,
        friction=tt.CoulombFriction(mu=0.3),
        launch=tt.Launch(tilt=1, spin=9),
    )
    sloping = level.replace({"table.slope": slope, "table.azimuth": -2.0})
    text, written = mjcf(sloping)
    assert not written.remarks
    again = problem_of_mjcf(text)
    assert again.gravity == pytest.approx(sloping.gravity, rel=1e-15)
    assert again.table.slope == pytest.approx(slope, rel=1e-15)
    assert again.table.azimuth == pytest.approx(-2.0, rel=1e-15)


def test_a_plane_that_is_turned_slopes():
    plane = PLANE.replace("type=", 'euler="0 10 0" type=')
    read = problem_of_mjcf(model_text(free(BALL, 'pos="0 0 .1"'), world=plane))
    # The plane falls towards x, and the launch is counted from its normal.
    turned = math.radians(10.0)
    assert (read.table.slope, read.table.azimuth) == pytest.approx((turned, 0.0), abs=1e-15)
    assert read.launch.tilt == pytest.approx(turned)
    assert read.launch.gap == pytest.approx(0.1 * math.cos(turned) - 0.02)


def _numbers(fields, place=""):
    items = fields.items() if isinstance(fields, dict) else enumerate(fields)
    for name, value in items:
        if isinstance(value, dict | list | tuple):
            yield from _numbers(value, f"{place}{name}.")
        else:
            yield f"{place}{name}", value


PLANE = '<geom name="floor" type="plane" size="1 1 .1"/>'


def model_text(body, head="", world=PLANE, tail=""):
    return f"<mujoco>{head}<worldbody>{world}{body}</worldbody>{tail}</mujoco>"


READ = {
    "a ball with a stem and ballast that touches nothing": model_text(
        """<body name="top" pos="0 0 .02"><freejoint/>
           <geom name="ball" type="sphere" size=".02"/>
           <geom name="stem" type="cylinder" pos="0 0 .02" size="0.004 .008"/>
           <geom name="ballast" type="box" size=".015 .015 .004" pos="0 0 -.01"
             contype="0" conaffinity="0" group="3"/></body>""",
        head='<option integrator="RK4"/><asset><texture name="grid" type="2d"'
        ' builtin="checker" width="300" height="300"/><material name="grid" texture="grid"/>'
        '</asset><visual><headlight ambient=".4 .4 .4"/></visual>',
        world=f'{PLANE}<light pos="0 0 .6"/><camera name="near" pos="0 -.1 .07"/>',
        tail='<keyframe><key name="fast" qpos="0 0 .02 1 0 0 0" qvel="0 0 0 0 1 200"/></keyframe>',
    ),
    "a coin by default classes, in radians, rolling on its edge": model_text(
        """<body name="coin" childclass="metal" pos="0 0 .0116" euler="1.5707963267948966 0 0">
           <joint type="free" damping="0"/><geom size=".0116 .0012"/>
           <geom class="drawn" type="box" size=".001 .001 .001" pos=".05 0 0"/></body>""",
        head="""<compiler angle="radian" autolimits="true"/><default><geom friction=".4 .001 .001"/>
           <default class="metal"><geom type="cylinder" density="7800" condim="4"/>
           <default class="drawn"><geom contype="0" conaffinity="0" mass="0"/></default>
           </default></default>""",
    ),
    "a pill from point to point along x, dropped": model_text(
        """<body name="pill" pos="0 0 .5" euler="0 30 0"><freejoint/>
           <geom type="capsule" fromto="-.02 0 0 .02 0 0" size=".01" mass=".01"/></body>"""
    ),
    "an egg in a frame, with a stated inertia": model_text(
        """<frame pos="0 0 .05" axisangle="1 0 0 40"><body name="egg"><freejoint/>
           <inertial pos="0 0 -.002" mass=".06" diaginertia="2e-5 2e-5 1.6e-5"/>
           <geom type="ellipsoid" size=".02 .02 .028" friction=".6"/></body></frame>""",
        tail='<option gravity="0 0 -1.62"/>',
    ),
    "hurricane balls of two bodies welded together": model_text(
        """<body name="one" pos="0 0 .03"><freejoint/><geom size=".01" pos="-.01 0 0"/>
           <body name="two" pos=".01 0 0"><geom size=".01"/></body></body>""",
        head='<compiler settotalmass=".064"/>',
    ),
    "a top on a raised plane, its friction in a contact pair": model_text(
        """<body name="top" pos="0 0 .22"><freejoint/><geom name="ball" size=".02"/>
           <geom type="cylinder" size=".01 .002" pos="0 0 -.01" contype="0" conaffinity="0"
             density="8000"/></body>""",
        world='<geom name="floor" type="plane" size="1 1 .1" pos="0 0 .2" zaxis="0 0 1"/>',
        tail="""<contact><pair geom1="ball" geom2="floor" condim="6"
            friction=".5 .5 .0002 .0001 .0001"/></contact>""",
    ),
    "four weights about the axis, by quaternions of few digits": model_text(
        """<body name="top" pos="0 0 .02" quat="0.9990482 0.0436194 0 0"><freejoint align="false"/>
           <geom size=".02" density="500"/><geom class="weight" pos=".01 0 -.003"/>
           <geom class="weight" pos="-.01 0 -.003"/><geom class="weight" pos="0 .01 -.003"/>
           <geom class="weight" pos="0 -.01 -.003" quat="0.7071068 0 0 0.7071068"/></body>""",
        head="""<default><default class="weight"><geom type="box" size=".002 .002 .002"
            contype="0" conaffinity="0" mass=".001"/></default></default>""",
    ),
    "a priority that decides, and a fluid without density": model_text(
        """<body name="ball" pos="0 0 .1"><freejoint/>
           <geom size=".05" friction=".2" priority="1" condim="3" rgba="1 0 0 1"/></body>""",
        world='<geom name="floor" type="plane" size="1 1 .1" friction="1.5 .1 .1" condim="6"/>',
        tail='<option density="0" timestep="0.001" cone="elliptic"/><size memory="1M"/>'
        '<statistic extent="1"/><sensor/>',
    ),
}
"""Files as people write them, by what they have."""


@pytest.mark.parametrize("name", READ)
def test_files_as_people_write_them_are_read(name):
    problem = problem_of_mjcf(READ[name])
    run = tt.simulate(problem, 0.01, samples=3)
    assert run.attrs["status"] in ("completed", "at_rest")


@pytest.mark.parametrize("name", READ)
def test_mass_and_inertia_are_mujocos(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # where MuJoCo writes its log
    mujoco = pytest.importorskip(
        "mujoco", reason="MuJoCo is not installed: pip install 'tippetop[engines]'"
    )
    model = mujoco.MjModel.from_xml_string(READ[name])
    data = mujoco.MjData(model)
    if model.nkey:
        mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    top = MjcfModel(Document.of(READ[name])).top()[0]
    mass = MjcfModel(Document.of(READ[name])).mass(top)
    inertia = np.zeros((3, 3))
    center = np.average(data.xipos[1:], axis=0, weights=model.body_mass[1:])
    for body in range(1, model.nbody):
        turn = data.ximat[body].reshape(3, 3)
        away = data.xipos[body] - center
        steiner = model.body_mass[body] * (away @ away * np.eye(3) - np.outer(away, away))
        inertia += turn @ np.diag(model.body_inertia[body]) @ turn.T + steiner
    problem = problem_of_mjcf(READ[name])
    assert mass.mass == pytest.approx(model.body_mass[1:].sum(), rel=1e-12)
    assert problem.body.mass == mass.mass
    moments = sorted([problem.body.I1, problem.body.I1, problem.body.I3])
    assert moments == pytest.approx(np.linalg.eigvalsh(inertia).tolist(), rel=1e-6)
    start = problem.start()
    assert float(start.height) == pytest.approx(center[2] - model.geom("floor").pos[2], abs=1e-9)
    # The kinetic energy knows the velocities.
    mujoco.mj_energyVel(model, data)
    body, launch = problem.body, problem.launch
    first, second, spin = launch.angular_velocity("body")
    velocity = np.array(start.velocity, float)
    energy = 0.5 * body.mass * velocity @ velocity
    energy += 0.5 * (body.I1 * (first**2 + second**2) + body.I3 * spin**2)
    assert energy == pytest.approx(data.energy[1], rel=1e-6, abs=1e-15)


def test_the_numbers_of_the_files_are_those_written():
    ballast = problem_of_mjcf(READ["a ball with a stem and ballast that touches nothing"])
    assert ballast.friction == tt.CoulombFriction(mu=1.0)
    assert [shape.kind for shape in ballast.body.shapes] == ["sphere", "ring"]
    assert ballast.launch.slip == pytest.approx((-0.02, 0.0), abs=1e-17)
    assert (ballast.launch.spin, ballast.launch.tilt_rate) == (200.0, 1.0)
    coin = problem_of_mjcf(READ["a coin by default classes, in radians, rolling on its edge"])
    # Of the coin and of the table the larger: both have the same default but for condim.
    assert coin.friction.mu == 0.4
    assert coin.friction.patch_radius == pytest.approx(0.001 / (0.4 * RHO), rel=1e-15)
    assert coin.rolling_resistance == 0.0
    assert coin.launch.tilt == pytest.approx(math.pi / 2, abs=1e-15)
    pill = problem_of_mjcf(READ["a pill from point to point along x, dropped"])
    assert pill.launch.tilt == pytest.approx(math.radians(120.0), abs=1e-15)
    assert pill.launch.gap == pytest.approx(0.5 - 0.01 - 0.02 * 0.5, abs=1e-15)
    egg = problem_of_mjcf(READ["an egg in a frame, with a stated inertia"])
    assert egg.body.shapes[0] == tt.Spheroid(across=0.02, along=0.028, center=0.002)
    assert (egg.gravity, egg.friction.mu) == (1.62, 1.0)
    assert egg.launch.tilt == pytest.approx(math.radians(40.0), abs=1e-15)
    raised = problem_of_mjcf(READ["a top on a raised plane, its friction in a contact pair"])
    assert raised.launch.gap == 0.0
    assert raised.rolling_resistance == 1e-4
    assert raised.friction.patch_radius == pytest.approx(2e-4 / (0.5 * RHO), rel=1e-15)
    priority = problem_of_mjcf(READ["a priority that decides, and a fluid without density"])
    assert priority.friction == tt.CoulombFriction(mu=0.2)
    assert priority.launch.gap == pytest.approx(0.05, abs=1e-15)


BALL = '<geom name="ball" size=".02"/>'


def free(inside, attributes='pos="0 0 .02"'):
    return f'<body name="top" {attributes}><freejoint name="free"/>{inside}</body>'


REFUSED = {
    "geom 'fin'.type: 'box' touches the table": model_text(
        free(BALL + '<geom name="fin" type="box" size=".03 .001 .01"/>')
    ),
    "geom 'shell'.type: 'mesh' touches the table": model_text(
        free('<geom name="shell" type="mesh" mesh="top" mass="0"/><geom size=".01"/>')
    ),
    "geom 'tip'.pos: 0.003 m is its distance from the axis": model_text(
        free(
            '<geom size=".02" mass="1"/><geom name="tip" type="capsule" size=".004 .02"/>'
            '<geom name="tip" size=".004" mass="0" pos=".003 0 .03"/>'
        )
    ),
    "inertia: .* no two across the axis are equal": model_text(
        free(BALL + '<geom type="box" size=".01 .005 .002" contype="0" conaffinity="0"/>')
    ),
    "body 'arm': '<joint>' lets it move against the body around it": model_text(
        free(BALL + '<body name="arm"><joint/><geom size=".01"/></body>')
    ),
    "worldbody: body 'a', body 'b' is not one body": model_text(
        free(BALL).replace('"top"', '"a"') + free(BALL).replace('"top"', '"b"')
    ),
    "joint 'slide'.type: 'slide' is not free": model_text(
        f'<body name="top"><joint name="slide" type="slide"/>{BALL}</body>'
    ),
    "geom 'wall'.type: 'box' touches the body": model_text(
        free(BALL), world=f'{PLANE}<geom name="wall" type="box" size=".1 .1 .1" pos="1 0 0"/>'
    ),
    "option.gravity: 1 0 9.81 is not a vector that points into the plane": model_text(
        free(BALL), head='<option gravity="1 0 9.81"/>'
    ),
    "option.density: 1.2 is not 0": model_text(free(BALL), head='<option density="1.2"/>'),
    "actuator: '<motor>' is not read": model_text(
        free(BALL), tail='<actuator><motor joint="free"/></actuator>'
    ),
    "equality: '<weld>' is not read": model_text(
        free(BALL), tail='<equality><weld body1="top"/></equality>'
    ),
    "pos: the height of the launch, 0.019 m, is 0.001 m inside the table": model_text(
        free(BALL, 'pos="0 0 .019"')
    ),
    r"geom 'stem'.friction: .* is not that of geom 'ball'": model_text(
        free(BALL + '<geom name="stem" type="capsule" size=".004 .03" friction="2"/>')
    ),
    "include: scene.xml is another file|include: 'scene.xml' is another file": model_text(
        free(BALL), head='<include file="scene.xml"/>'
    ),
    "geom 'ball'.frictoin: 1 is no attribute": model_text(
        free(BALL.replace("size", 'frictoin="1" size'))
    ),
    r"geom 'ball'.size: '0.02 x' is not 1 or 2 or 3 finite numbers|size: 0.02 x is not": model_text(
        free(BALL.replace(".02", "0.02 x"))
    ),
    "geom 'ball'.class: 'wood' is not": model_text(free(BALL.replace("size", 'class="wood" size'))),
    r"friction: drilling friction of 0.01 m needs a patch of radius 0.0424 m": model_text(
        free(BALL.replace("size", 'condim="4" friction=".4 .01" size')),
        world='<geom name="floor" type="plane" size="1 1 .1" friction=".4"/>',
    ),
    "geom 'ball'.margin: 0.001 is not 0": model_text(
        free(BALL.replace("size", 'margin="0.001" size'))
    ),
    r"geom2: '?ground'? is not the name of a geom": model_text(
        free(BALL), tail='<contact><pair geom1="ball" geom2="ground"/></contact>'
    ),
    r"pair of None and floor.geom1 is missing \(write the name of a geom of the file\)": model_text(
        free(BALL), tail='<contact><pair geom2="floor"/></contact>'
    ),
    r"mass of body 'top' is missing \(state the body's <inertial>": model_text(
        free(BALL.replace("size", 'mass="0" size'))
    ),
    "text: '<robot>' is not MJCF": "<robot/>",
    "text: .* is not XML": "<mujoco>",
    "text: '<!DOCTYPE mujoco>' is not read": (
        '<!DOCTYPE mujoco [<!ENTITY a "a"><!ENTITY b "&a;&a;">]><mujoco model="&b;"/>'
    ),
}


@pytest.mark.parametrize("sentence", REFUSED)
def test_what_a_problem_cannot_state_is_refused_by_name(sentence):
    with pytest.raises(tt.InvalidInput, match=sentence):
        problem_of_mjcf(REFUSED[sentence])


def test_a_keyframe_is_chosen_by_its_name(tmp_path):
    path = tmp_path / "top.xml"
    keys = '<key name="slow" qvel="0 0 0 0 0 1"/><key name="fast" qvel="0 0 0 0 0 300"/>'
    path.write_text(model_text(free(BALL), tail=f"<keyframe>{keys}</keyframe>"))
    assert tt.read_mjcf(path).launch.spin == 1.0
    assert tt.read_mjcf(path, keyframe="fast").launch.spin == 300.0
    with pytest.raises(tt.InvalidInput, match=r"keyframe: 'fats'.*fast"):
        tt.read_mjcf(path, keyframe="fats")
    path.write_text(model_text(free(BALL), head='<option density="2"/>'))
    with pytest.raises(tt.InvalidInput, match=r"option.density in top.xml: 2 is not 0"):
        tt.read_mjcf(path)


def test_a_command_launches_from_the_keyframe_that_is_named(tmp_path):
    path = tmp_path / "top.xml"
    keys = '<key name="slow" qvel="0 0 0 0 0 1"/><key name="fast" qvel="0 0 0 0 0 300"/>'
    path.write_text(model_text(free(BALL), tail=f"<keyframe>{keys}</keyframe>"))
    run = CliRunner().invoke
    assert "spin = 1.0" in run(app, ["problem", str(path)]).stdout
    assert "spin = 300.0" in run(app, ["problem", str(path), "--keyframe", "fast"]).stdout
    for words, sentence in [
        ([str(path), "--keyframe", "fats"], "keyframe: 'fats'"),
        (["--keyframe", "fast"], "--keyframe: 'fast' is only for a file in MJCF"),
    ]:
        refused = run(app, ["problem", *words]).exception
        assert isinstance(refused, tt.InvalidInput)
        assert sentence in str(refused)


@pytest.mark.parametrize("sequence", ["xyz", "XYZ", "zyx", "zxZ"])
def test_orientations_are_mujocos(sequence):
    mujoco = pytest.importorskip(
        "mujoco", reason="MuJoCo is not installed: pip install 'tippetop[engines]'"
    )
    for stated in (
        'euler="30 40 50"',
        'axisangle="1 2 3 40"',
        'xyaxes="1 1 0 0 1 1"',
        'zaxis="1 -2 3"',
        'quat="1 2 3 4"',
    ):
        text = model_text(
            free(
                f'{BALL}<geom type="cylinder" size=".01 .02" mass="2" contype="0"'
                f' conaffinity="0" {stated}/>'
            ),
            head=f'<compiler eulerseq="{sequence}"/>',
        )
        model = mujoco.MjModel.from_xml_string(text)
        turn = np.zeros(9)
        mujoco.mju_quat2Mat(turn, model.geom_quat[2])
        geoms = MjcfModel(Document.of(text)).top()[0].geoms
        assert np.abs(matrix(geoms[1].pose.orientation) - turn.reshape(3, 3)).max() < 1e-14


def test_the_command_line_takes_mjcf(tmp_path):
    path = tmp_path / "top.xml"
    path.write_text(READ["a ball with a stem and ballast that touches nothing"])
    done = CliRunner().invoke(app, ["simulate", str(path), "--duration", "0.01", "--json"])
    assert done.exit_code == 0
    assert json.loads(done.stdout)["problem"]["launch"]["spin"] == 200.0
